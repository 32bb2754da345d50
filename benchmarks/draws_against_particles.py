"""Draws against the particles themselves: fit to one half, draw, compare with the other half at all degrees.

    python -m benchmarks.draws_against_particles [FIT.json] [SEED] [PARTICLES]

Wasserstein distances in percent of the mean, by number; processor seconds of the fit and of 2,000 draws.
"""

import sys
import time

import numpy as np

from benchmarks.populations import measured, realized, sample_from
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.shape_models.goodness_of_fit import relative_wasserstein
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.sample import Sample
from regolith_studio.studies.population import KEYS, N_FLOOR_SPLITS

DEGREES = (10, 20, 30)
N_DRAWS = 2000
MODEL_KEYS = ("sample_matched", "hull_field")


def far(one: FloatArray, two: FloatArray) -> FloatArray:
    """Distance of each descriptor in percent, shape (keys,)."""
    ones, others = np.ones(len(one)), np.ones(len(two))
    pairs = zip(one.T, two.T, strict=True)
    return np.array([100 * relative_wasserstein(a, b, ones, others) for a, b in pairs])


def show(name: str, numbers: FloatArray) -> None:
    """A row of the table."""
    print("|", name, "|", " | ".join(f"{number:.2f}" for number in numbers), "|", flush=True)


def main(path: str, seed: int, n: int) -> None:
    """Print the table of one sample."""
    whole = sample_from(path)
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    sample = whole.chosen(rng.permutation(len(whole))[:n])
    table = measured(realized(sample), KEYS)
    halves = [sample.halves(seed + split) for split in range(N_FLOOR_SPLITS)]
    floor = [far(table[a], table[b]) for a, b in halves]
    show("floor", np.mean(floor, axis=0))
    show("floor, 95th percentile", np.quantile(floor, 0.95, axis=0))
    train, test = halves[0]
    fit_to: Sample = sample.chosen(train)
    show("the half fitted to", far(table[test], table[train]))
    for degree in (degree for degree in DEGREES if degree <= sample.l_max):
        cut = measured(realized(sample.chosen(test).truncated(degree)), KEYS)
        show(f"other half cut at {degree}", far(table[test], cut))
        for key in MODEL_KEYS:
            begin = time.process_time()
            model = MODELS[key]
            draws = model.fit(fit_to, model.Settings(l_max=degree)).draw(N_DRAWS, seed)
            spent = time.process_time() - begin
            drawn = measured(draws.chosen(range(min(N_DRAWS, len(test)))), KEYS)
            show(f"{key} at {degree}, {spent:.1f} s", far(table[test], drawn))


if __name__ == "__main__":
    words = [*sys.argv[1:], *("", "11", "1600")[len(sys.argv) - 1 :]]
    main(words[0], int(words[1]), int(words[2]))
