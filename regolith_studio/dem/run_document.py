"""``repose.json``: the result of a run with everything that it followed from."""

from dataclasses import asdict
from typing import Any

import regolith_studio
from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest, missing_in_paper
from regolith_studio.dem.case import Prepared, ReposeCase
from regolith_studio.dem.consequences import consequences
from regolith_studio.dem.engine import Checks, Ending, Engine
from regolith_studio.dem.evaluation.refusal import NoPile
from regolith_studio.dem.repose import ReposeMeasurement, measurement_document
from regolith_studio.dem.run_folder import FORMAT, SCHEMA_VERSION


def run_document(
    prepared: Prepared,
    engine: Engine,
    settings: Any,
    *,
    state: str,
    seconds: float,
    ending: Ending | None = None,
    measured: ReposeMeasurement | NoPile | None = None,
    problem: str | None = None,
    n_snapshots: int = 0,
) -> dict[str, Any]:
    """The document. SI units, angles in degrees.

    Parameters
    ----------
    state
        ``finished``, ``stopped`` by the user, or ``failed``.
    seconds
        That the run took.
    measured
        The angle, or why there is none.
    problem
        The sentence of a run that failed.
    """
    case = prepared.case
    return {
        "format": FORMAT,
        "schema_version": SCHEMA_VERSION,
        "state": state,
        "problem": problem,
        "dataset": {"name": prepared.dataset_name, "sha256": prepared.dataset_hash or None},
        "engine": {
            "key": engine.key,
            "label": engine.label,
            "version": engine.find().version,
            "settings": asdict(settings),
            "represents": asdict(engine.represents),
        },
        "software": {"regolith-studio": regolith_studio.__version__},
        "length_unit": "m",
        "case": case_document(case),
        "not_given_in_the_paper": [
            *missing_in_paper(LiftingCylinderTest),
            *missing_in_paper(ContactParameters),
        ],
        "particles": {
            "mass": prepared.mass,
            "mean_facets": prepared.mean_facets,
            "surface_energy": prepared.surface_energy,
            **_plain(asdict(consequences(prepared))),
        },
        "run": {
            "seconds": round(seconds, 3),
            "steps": ending.steps if ending else None,
            "simulated_time": ending.simulated_time if ending else None,
            "n_snapshots": n_snapshots,
            "notes": list(ending.notes) if ending else [],
        },
        "checks": _checks(ending.checks) if ending else None,
        "measurement": _measurement(measured),
    }


def case_document(case: ReposeCase) -> dict[str, Any]:
    """What was chosen, as plain JSON."""
    return {
        "test": asdict(case.test),
        "contact": asdict(case.contact),
        "n_particles": case.n_particles,
        "coarse_graining_asked": case.coarse_graining or None,
        "shapes": case.shapes,
        "cohesion": case.cohesion,
        "seed": case.seed,
    }


def _measurement(measured: ReposeMeasurement | NoPile | None) -> dict[str, Any] | None:
    match measured:
        case ReposeMeasurement():
            return measurement_document(measured)
        case NoPile():
            return {"status": measured.status, "angle_deg": None, "reason": str(measured)}
        case _:
            return None


def _checks(checks: Checks) -> dict[str, Any]:
    return _plain(asdict(checks)) | {"passed": not checks.problems}


def _plain(fields: dict[str, Any]) -> dict[str, Any]:
    return {name: list(value) if isinstance(value, tuple) else value for name, value in fields.items()}
