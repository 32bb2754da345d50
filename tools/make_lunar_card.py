"""Write the material card of lunar soil: ``python -m tools.make_lunar_card FILE``.

What is published of returned soils, and what the card takes from it:

- Mean ratios of the three diameters of ten samples of Apollo and Luna soils, 65 to 1,108 particles each,
  X-ray micro-CT: S/I = 0.770(8), I/L = 0.758(10), S/L = 0.581(11) ("Three-dimensional shape distribution of
  lunar regolith particles collected by the Apollo and Luna programs", Earth, Planets and Space 74, 2022,
  doi:10.1186/s40623-022-01737-9).
- Sizes of the submillimetre fraction of soil 10084, wet sieved, by mass: mean 4.28 phi, standard deviation
  2.23 phi (Basu, Wentworth and McKay, Meteoritics & Planetary Science 36, 2001, 177-181), taken as log-normal
  and counted by number after Hatch and Choate, between diameters of 10 and 1,000 um.

Not known from these: the spread of the ratios, the roughness, and how shape goes with size. The surface has
the relative amplitudes of the card `ma165`, the spread is what its random field has, and shape does not
depend on size. The diameters are the edges of the minimum-volume box.
"""

import sys
from functools import partial
from multiprocessing import Pool
from pathlib import Path

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics.sphere_grid import sphere_grid
from regolith_studio.shape_models.inertia_ellipsoid import forms, with_forms
from regolith_studio.shape_models.materials import MaterialCard, materials, write_card
from regolith_studio.shape_models.realizations import Realizations
from regolith_studio.shape_models.sample import Sample
from regolith_studio.shape_models.size_law import LogNormalSizes
from regolith_studio.studies.population import descriptors_of

RATIOS = {"elongation": 0.758, "flatness": 0.770}
"""Published means of I/L and S/I."""
SOURCE, DEGREE, N_PARTICLES, ROUNDS = "ma165", 10, 2000, 4
FEWEST_MEASURED = 65 + 1108 + 8 * 65
MEAN_PHI, DEVIATION_PHI = 4.28, 2.23
DIAMETERS = (10.0, 1000.0)
"""Of the finest sieve and of the coarsest, um."""
LABEL = "Lunar soil (published ratios and sizes)"
ORIGIN = (
    "Synthesised by Regolith Studio: mean axial ratios S/I = 0.770 and I/L = 0.758 of ten Apollo and Luna"
    " soils (doi:10.1186/s40623-022-01737-9), sizes of soil 10084 between 10 and 1,000 um (Basu et al. "
    "2001, by mass 4.28 +/- 2.23 phi); the roughness is that of the set MA165, as none is published, the "
    "spread of the ratios is that of a random field, shape does not depend on size, and no measured "
    "particle is contained."
)


def main(path: Path) -> None:
    """Make the card and print the ratios of its draws."""
    card = lunar_card()
    print(dict(zip(RATIOS, mean_ratios(card.model(DEGREE).draw(10_000, 1)), strict=True)))
    write_card(card, path)


def lunar_card(n_particles: int = N_PARTICLES, rounds: int = ROUNDS) -> MaterialCard:
    """The card, whose draws have the published ratios after so many rounds of correction."""
    grid = sphere_grid(3 * DEGREE + 1, DEGREE)
    logs = grid.values(materials()[SOURCE].field(DEGREE).draw(n_particles, 0).coefficients)
    form, _ = forms(logs, grid)
    sizes = size_law()
    radii, _ = sizes.draw(n_particles, np.random.default_rng(np.random.SeedSequence(0)))
    wanted, factor = np.array([*RATIOS.values()]), np.ones(2)
    for _ in range(rounds):
        shaped = with_forms(logs, form * factor, grid, steps=2)
        rows = grid.expanded(np.exp(shaped - shaped.mean(axis=1, keepdims=True)))
        present = Sample(rows).equivalent_radii
        sample = Sample(rows * (radii / present)[:, None])
        card = MaterialCard.of(sample, "lunar_soil", LABEL, ORIGIN, DEGREE)
        factor *= np.log(wanted) / np.log(mean_ratios(card.model(DEGREE).draw(n_particles, 0)))
    hull_field = {**(card.hull_field or {}), "sizes": sizes.stored()}
    update = {"hull_field": hull_field, "judgement": None, "n_particles": FEWEST_MEASURED}
    return MaterialCard(**{**card.model_dump(), **update})


def size_law() -> LogNormalSizes:
    """Equivalent radii by number: the median by number is that by mass times exp(-3 s^2)."""
    deviation = DEVIATION_PHI * np.log(2)
    median = 1000 * 2**-MEAN_PHI / 2 * np.exp(-3 * deviation**2)
    low, high = DIAMETERS[0] / 2, DIAMETERS[1] / 2
    return LogNormalSizes(np.ones(1), np.array([np.log(median)]), np.array([deviation]), (low, high))


def mean_ratios(draws: Realizations) -> FloatArray:
    """Means of :data:`RATIOS` of drawn particles, shape (2,)."""
    parts = [draws.chosen(range(i, min(i + 50, len(draws)))) for i in range(0, len(draws), 50)]
    with Pool() as pool:
        tables = pool.map(partial(descriptors_of, keys=tuple(RATIOS), level=3), parts)
    return np.asarray(np.concatenate(tables).mean(axis=0))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python -m tools.make_lunar_card FILE")
    main(Path(sys.argv[1]))
