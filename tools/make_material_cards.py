"""Write the material cards of returned soils: ``python -m tools.make_material_cards FOLDER [NAME...]``.

Each row of :data:`MATERIALS` has what is published, what a card takes from it, and what is assumed because it
is not published. Ratios are those of the edges of the minimum-volume box. A random field in ln r with the
relative amplitudes of the card `ma165` is given the mean ratios, and the share of the hull where one is
published, by correcting the forms and the roughness of its particles until draws of the card have them. Sizes
are log-normal by mass, counted by number after Hatch and Choate, between diameters of 10 and 1,000 um.
"""

import sys
from dataclasses import dataclass
from functools import partial
from multiprocessing import Pool
from pathlib import Path

import numpy as np
from scipy.optimize import brentq
from scipy.stats import norm

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics.sphere_grid import sphere_grid
from regolith_studio.shape_models.inertia_ellipsoid import forms, with_forms
from regolith_studio.shape_models.materials import MaterialCard, materials, write_card
from regolith_studio.shape_models.realizations import Realizations
from regolith_studio.shape_models.sample import Sample
from regolith_studio.shape_models.size_law import LogNormalSizes
from regolith_studio.studies.population import descriptors_of

SOURCE, DEGREE, N_PARTICLES, ROUNDS, N_SIZES = "ma165", 10, 2000, 4, 100_000
DEVIATION_PHI = 2.23
"""Of the sizes of soil 10084 by mass."""
DIAMETERS = (10.0, 1000.0)
KEYS = ("elongation", "flatness", "convexity", "sphericity")
ORIGIN = (
    "Synthesised by Regolith Studio from published means and sizes; the card states what is measured and "
    "what is assumed, and no measured particle is contained."
)
EPS = "Earth, Planets and Space 74, 2022, doi:10.1186/s40623-022-01737-9"
SPREAD_10084 = "the spread of the sizes, 2.23 phi by mass, is that of soil 10084 (Basu et al. 2001)"
ROUGHNESS = "the roughness is that of the set MA165, as none is published"
FORMS = "the spread of the ratios is that of a random field, and shape does not depend on size"
NO_SPREAD = "no errors of the means are known: 0.01 is taken"


@dataclass(frozen=True)
class PublishedMaterial:
    """What is published of a material.

    - ``sizes``: diameter in um and the share of the mass below it; without one the median of the whole law,
      before it is cut at :data:`DIAMETERS`.
    - ``aims``: mean elongation I/L and flatness S/I, and convexity where that is published; empty for the
      shapes of `lunar_soil`.
    - ``published``: mean and error by key of the catalogue, or ``S/L``.
    - ``n_particles``: particles that were measured; None where that is not known here.
    """

    label: str
    sizes: tuple[float, float | None]
    aims: tuple[float, ...]
    published: dict[str, tuple[float, float]]
    measured: tuple[str, ...]
    assumed: tuple[str, ...]
    n_particles: int | None = None


LUNAR_RATIOS = {"elongation": (0.758, 0.010), "flatness": (0.770, 0.008), "S/L": (0.581, 0.011)}
MATERIALS = {
    "lunar_soil": PublishedMaterial(
        "Lunar soil (published ratios and sizes)",
        (1000 * 2**-4.28, None),
        (0.758, 0.770),
        LUNAR_RATIOS,
        (
            "mean axial ratios S/I = 0.770(8), I/L = 0.758(10) and S/L = 0.581(11) of ten Apollo and Luna "
            f"soils ({EPS})",
            "sizes of soil 10084 by mass, 4.28 +/- 2.23 phi (Basu et al. 2001)",
        ),
        (ROUGHNESS, FORMS),
        65 + 1108 + 8 * 65,
    ),
    "chang_e_5": PublishedMaterial(
        "Chang'e-5 soil (published means)",
        (57.5, 0.5),
        (0.76**0.5, 0.76**0.5, 0.92),
        {"S/L": (0.76, 0.01), "convexity": (0.92, 0.01), "sphericity": (0.78, 0.01)},
        (
            "median size 57.5 um (JGR Planets 130, doi:10.1029/2024JE008787)",
            "of grains of millimetres: sphericity 0.78, convexity 0.92, short to long axis 0.76, and a "
            "Wadell roundness of 0.12, which is not used (Mendeley Data d4xx8vtchj)",
        ),
        (
            f"the median is one by mass; {SPREAD_10084}",
            "fine grains have the shapes of those of millimetres; the middle axis is the geometric mean of "
            "the others",
            f"the roughness is that of the set MA165, scaled to the convexity; {FORMS}",
            NO_SPREAD,
        ),
    ),
    "chang_e_6": PublishedMaterial(
        "Chang'e-6 soil (published sizes)",
        (48.4, 0.6),
        (),
        LUNAR_RATIOS,
        ("D60 = 48.4 um (Nature Astronomy 2025, doi:10.1038/s41550-025-02715-3)",),
        (
            f"the ratios are those of Apollo and Luna soils ({EPS}), as none are taken from there",
            f"D60 is one by mass; {SPREAD_10084}; {ROUGHNESS}; {FORMS}",
        ),
    ),
    "itokawa": PublishedMaterial(
        "Itokawa particles (published ratios)",
        (1000 * 2**-4.28, None),
        (0.707, 0.707),
        {"elongation": (0.707, 0.01), "flatness": (0.707, 0.01), "S/L": (0.500, 0.01)},
        (
            "mean axial ratios S/I = 0.707, I/L = 0.707 and S/L = 0.500, which are those of fragments of "
            f"impacts too ({EPS})",
        ),
        (f"the sizes are those of lunar soil 10084; {ROUGHNESS}; {FORMS}", NO_SPREAD),
    ),
}


def main(folder: Path, names: list[str]) -> None:
    """Make the cards and print the means of their draws."""
    for name in names or MATERIALS:
        card = published_card(name)
        print(name, card.drawn, card.missed)
        write_card(card, folder / f"{name}.json")


def published_card(name: str, n_particles: int = N_PARTICLES, rounds: int = ROUNDS) -> MaterialCard:
    """The card, whose draws have the published means after so many rounds of correction."""
    material = MATERIALS[name]
    sizes = size_law(*material.sizes)
    radii, _ = sizes.draw(n_particles, np.random.default_rng(np.random.SeedSequence(0)))
    if material.aims:
        card, drawn = _with_forms(name, material, radii, rounds)
    else:
        card = materials()["lunar_soil"]
        drawn = card.drawn
    logs = np.log(sizes.draw(N_SIZES, np.random.default_rng(0))[0])
    update = {
        "name": name,
        "label": material.label,
        "origin": ORIGIN,
        "median_radius": float(f"{np.exp(logs.mean()):.3g}"),
        "log_deviation": float(f"{logs.std():.3g}"),
        "hull_field": {**(card.hull_field or {}), "sizes": sizes.stored()},
        "evaluation": None,
        "n_particles": material.n_particles or n_particles,
        "measured": material.measured,
        "assumed": material.assumed,
        "stated": material.published,
        "drawn": {key: float(f"{drawn[key]:.3f}") for key in material.published},
    }
    return MaterialCard(**{**card.model_dump(), **update})


def _with_forms(
    name: str, material: PublishedMaterial, radii: FloatArray, rounds: int
) -> tuple[MaterialCard, dict[str, float]]:
    """A card with the published means, and the means of its draws."""
    grid = sphere_grid(3 * DEGREE + 1, DEGREE)
    field = materials()[SOURCE].field(DEGREE).draw(len(radii), 0).coefficients
    aims, factor = np.array(material.aims), np.ones(3)
    for _ in range(rounds):
        rough = field.copy()
        rough[:, 9:] *= factor[2]
        logs = grid.values(rough)
        form, _ = forms(logs, grid)
        shaped = with_forms(logs, form * factor[:2], grid, steps=2)
        rows = grid.expanded(np.exp(shaped - shaped.mean(axis=1, keepdims=True)))
        sample = Sample(rows * (radii / Sample(rows).equivalent_radii)[:, None])
        card = MaterialCard.of(sample, name, material.label, "to be replaced", DEGREE)
        table = measured_draws(card.model(DEGREE).draw(len(radii), 0))
        drawn = table.mean(axis=0)
        wrong = np.log(aims) / np.log(drawn[: len(aims)])
        wrong[2:] **= 0.5  # what a hull lacks goes with the square of the amplitudes
        factor[: len(aims)] *= wrong
    means = dict(zip(KEYS, drawn.tolist(), strict=True)) | {"S/L": float((table[:, 0] * table[:, 1]).mean())}
    return card, means


def size_law(diameter: float, share: float | None) -> LogNormalSizes:
    """Equivalent radii by number, of which `share` of the mass is below a diameter in um."""
    deviation = DEVIATION_PHI * np.log(2)
    ends = np.log(DIAMETERS)

    def below(median: float) -> float:
        low, here, high = norm.cdf((np.array([ends[0], np.log(diameter), ends[1]]) - median) / deviation)
        return float((here - low) / (high - low)) - (share or 0.0)

    median = np.log(diameter) if share is None else brentq(below, -5, 15)
    by_number = median - np.log(2) - 3 * deviation**2
    limits = (DIAMETERS[0] / 2, DIAMETERS[1] / 2)
    return LogNormalSizes(np.ones(1), np.array([by_number]), np.array([deviation]), limits)


def measured_draws(draws: Realizations) -> FloatArray:
    """:data:`KEYS` of drawn particles, shape (n, keys)."""
    parts = [draws.chosen(range(i, min(i + 50, len(draws)))) for i in range(0, len(draws), 50)]
    with Pool() as pool:
        return np.concatenate(pool.map(partial(descriptors_of, keys=KEYS, level=3), parts))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit("usage: python -m tools.make_material_cards FOLDER [NAME...]")
    main(Path(sys.argv[1]), sys.argv[2:])
