"""The input file that YADE's script reads, and the states that it writes.

YADE decides by absolute lengths what touches and what coincides (2e-11 m and 3e-10 m), so the solver's mean
diameter is always 2 mm: smaller grains would spend more time in touches that it cannot resolve, and larger
ones would have less exact overlaps. Density and gravity are 3,000 kg/m3 and 9.81 m/s2; the test is free of
units but for these.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engines.yade.program import YadeSettings
from regolith_studio.dem.initial_packing import enclosing_radii, loose_column
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.arrays import FloatArray

LENGTH, DENSITY, GRAVITY = 2e-3, 3000.0, 9.81
TIME = float(np.sqrt(LENGTH / GRAVITY))
WEIGHT = DENSITY * np.pi / 6 * LENGTH**3 * GRAVITY
"""Of a mean particle, in the solver's newtons."""
LOOK = 0.25
"""Between two looks, in sqrt(d/g)."""
CONTACT_AREA = 0.5
"""Of the smallest particle on a flat neighbour, over its diameter squared."""
RETRY_STEP_FACTOR = 0.97
"""Factor on the time step after a crash, so that the same contact does not recur."""
SHEAR = 0.2
"""YADE multiplies the stiffness by it for shear: far above what is stable, so that friction is Coulomb's at
once whichever way a contact slides (its law keeps one shear force for all contacts, not one for each)."""


@dataclass(frozen=True, eq=False)
class YadeState:
    """One state written by YADE, in mean diameters and sqrt(d/g); energies in m g d.

    Parameters
    ----------
    number, phase, time, rim, steps
        Which snapshot it is, and where the test stands.
    kinetic, potential
        Mean energies of a particle.
    last, at_rest
        Whether the test is over, and whether it ended at rest.
    rows
        Place, turn (w, x, y, z), velocity and spin of each particle in the solver's units, shape (n, 13).
    """

    number: int
    phase: str
    time: float
    rim: float
    steps: int
    kinetic: float
    potential: float
    last: bool
    at_rest: bool
    rows: FloatArray


def input_document(
    prepared: PreparedCase, settings: YadeSettings, duration: float, after: YadeState | None
) -> dict[str, Any]:
    """Content of the input file: from the initial state, or from the last state before a crash.

    Parameters
    ----------
    duration
        Expected, in sqrt(d/g); sets the interval of the snapshots.
    after
        The last state of a resumed run.
    """
    case = prepared.case
    contact, test = case.contact, case.test
    speed = test.lift_speed / np.sqrt(test.gravity * prepared.mean_diameter)
    top = float((loose_column(prepared).points[:, 2] + enclosing_radii(prepared)).max())
    height = top / prepared.mean_diameter + 2.0
    return {
        "density": DENSITY,
        "gravity": GRAVITY,
        "young": young_modulus(settings),
        "poisson": SHEAR,
        "friction": contact.static_friction,
        "wall_friction": test.wall_friction,
        "plate_friction": test.plate_friction,
        "damping": settings.damping,
        "time_step": time_step(prepared, settings) * (1.0 if after is None else RETRY_STEP_FACTOR),
        "skin": 0.02 * LENGTH,
        "shapes": [shape.tolist() for shape in prepared.shapes],
        "particles": _particles(prepared, after),
        "tube": {
            "radius": test.diameter / 2 / prepared.mean_diameter * LENGTH,
            "height": height * LENGTH,
            "thickness": 2.0 * LENGTH,
            "n_segments": settings.n_segments,
        },
        "number": 0 if after is None else after.number + 1,
        "phase": "fill" if after is None else after.phase,
        "time": 0.0 if after is None else after.time * TIME,
        "rim": 0.0 if after is None else after.rim * LENGTH,
        "plan": {
            "look": LOOK * TIME,
            "picture": duration / settings.snapshots * TIME,
            "max_fill_speed": settings.max_fill_speed * LENGTH / TIME,
            "rest_energy": settings.rest_energy * WEIGHT * LENGTH,
            "rest_time": settings.rest_time * TIME,
            "max_fill_time": (10.0 + 1.5 * height / settings.max_fill_speed) * TIME,
            "max_rest_time": settings.max_rest_time * TIME,
            "max_lift_time": (2.0 * height / speed + 10.0) * TIME,
            "lift_speed": float(speed) * LENGTH / TIME,
            "reach": float(enclosing_radii(prepared).max() / prepared.mean_diameter + 0.5) * LENGTH,
        },
    }


def young_modulus(settings: YadeSettings) -> float:
    """YADE's stiffness of a material; two equal ones are springs in a row."""
    return float(2 * settings.stiffness * WEIGHT / LENGTH**3)


def time_step(prepared: PreparedCase, settings: YadeSettings) -> float:
    """In the solver's seconds: a share of 1/omega of the smallest particle on a flat neighbour."""
    smallest = float(prepared.diameters.min()) / prepared.mean_diameter * LENGTH
    stiffness = young_modulus(settings) / 2 * CONTACT_AREA * smallest**2
    return float(settings.step_share * np.sqrt(DENSITY * np.pi / 6 * smallest**3 / stiffness))


def _particles(prepared: PreparedCase, after: YadeState | None) -> list[dict[str, Any]]:
    if after is None:
        column = loose_column(prepared)
        places = column.points / prepared.mean_diameter * LENGTH
        rows = np.hstack([places, column.orientations, np.zeros((len(prepared), 6))])
    else:
        rows = after.rows
    scales = (prepared.scales / prepared.mean_diameter * LENGTH).tolist()
    return [
        {
            "shape": kind,
            "scale": scale,
            "place": row[:3],
            "turn": row[3:7],
            "velocity": row[7:10],
            "spin": row[10:],
        }
        for kind, scale, row in zip(prepared.class_index.tolist(), scales, rows.tolist(), strict=True)
    ]


def read_yade_state(path: Path, count: int) -> YadeState:
    """A state that YADE wrote.

    Raises
    ------
    RegolithError
        If particles were lost on the way.
    """
    found = json.loads(path.read_text("utf-8"))
    rows = np.asarray(found["particles"], dtype=np.float64)
    if rows.shape != (count, 13) or not np.isfinite(rows).all():
        raise RegolithError("YADE lost particles; take a smaller step (step_share).")
    energy = WEIGHT * LENGTH
    return YadeState(
        number=int(path.stem.split(".")[1]),
        phase=found["phase"],
        time=found["time"] / TIME,
        rim=found["rim"] / LENGTH,
        steps=int(found["steps"]),
        kinetic=found["kinetic"] / energy,
        potential=found["potential"] / energy,
        last=bool(found["last"]),
        at_rest=bool(found["at_rest"]),
        rows=rows,
    )
