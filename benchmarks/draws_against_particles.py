"""Draws against the particles themselves: fit to one half, draw, compare with the other half at all degrees.

    python -m benchmarks.draws_against_particles [SAMPLE] [--seed 11] [--particles 1200] [--splits 3]
        [--models recombined,hull_field,sample_matched] [--draws 2000] [--odd] [--l-max L]
        [--level 4] [--name NAME] [-o RESULT.json]

Wasserstein distances in percent of the mean, by number, of as many draws as the half fitted to has
particles; means over the splits and over up to five such parts of DRAWS draws, and processor seconds of a fit
and of 2,000 draws. Then the splits, in percent, in which this mean is beyond the 95th percentile of the
floor: particles of the half fitted to are so in 5 % of many splits. SAMPLE is a fit, or tables of complex
coefficients. With ``--l-max`` its particles are cut at that degree first, with ``--odd`` only every second
one is taken, from the second on; ``--level`` is that of the meshes. Set OPENBLAS_NUM_THREADS=1 for seconds
that compare.
"""

import argparse
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmarks.populations import CARD, measured, realized, sample_from
from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.shape_models.goodness_of_fit import relative_wasserstein
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.sample import Sample
from regolith_studio.studies.population import KEYS, MESH_LEVEL, N_FLOOR_SPLITS

CUTS = (10, 20)
N_DRAWS, N_PARTS = 2000, 5
MODEL_KEYS = ("recombined", "hull_field", "sample_matched")


def far(one: FloatArray, two: FloatArray) -> FloatArray:
    """Distance of each descriptor in percent, shape (keys,)."""
    ones, others = np.ones(len(one)), np.ones(len(two))
    pairs = zip(one.T, two.T, strict=True)
    return np.array([100 * relative_wasserstein(a, b, ones, others) for a, b in pairs])


def evaluated(
    key: str,
    sample: Sample,
    table: FloatArray,
    halves: list[tuple[IntArray, IntArray]],
    level: int,
    seed: int,
    n_draws: int,
) -> FloatArray:
    """A row a split: distances of a model's draws from the half that it has not seen, processor seconds."""
    found = []
    for number, (train, test) in enumerate(halves):
        begin = time.process_time()
        model = MODELS[key]
        draws = model.fit(sample.chosen(train), model.Settings(l_max=sample.l_max)).draw(
            N_DRAWS, seed + number
        )
        spent = time.process_time() - begin
        n, parts = len(train), min(N_PARTS, n_draws // len(train))
        drawn = measured(draws.chosen(range(parts * n)), KEYS, level).reshape(parts, n, -1)
        found.append([*np.mean([far(table[test], part) for part in drawn], axis=0), spent])
    return np.array(found)


def tables_of(
    sample: Sample, seed: int, n_splits: int, keys: Sequence[str], level: int, n_draws: int
) -> tuple[Rows, Rows]:
    """All rows of the table of one sample, and splits beyond the 95th percentile of the floor in percent."""
    rows: Rows = {}
    beyond: Rows = {}
    table = measured(realized(sample), KEYS, level)
    halves = [sample.halves(seed + split) for split in range(N_FLOOR_SPLITS)]
    floor = np.array([far(table[a], table[b]) for a, b in halves])
    limits = np.quantile(floor, 0.95, axis=0)
    show_row(rows, "floor", floor.mean(axis=0))
    show_row(rows, "floor, 95th percentile", limits)
    for degree in (degree for degree in CUTS if degree < sample.l_max):
        cut = measured(realized(sample.truncated(degree)), KEYS, level)
        show_row(rows, f"cut at l = {degree}", far(table, cut))
    chosen = halves[:n_splits]
    found = {"the half fitted to": np.array([far(table[b], table[a]) for a, b in chosen])}
    for key in ("the half fitted to", *keys):
        if key not in found:
            found[key] = evaluated(key, sample, table, chosen, level, seed, n_draws)
        show_row(rows, key, found[key].mean(axis=0))
        show_row(beyond, key, 100 * (found[key][:, : len(KEYS)] > limits).mean(axis=0), digits=0)
    return rows, beyond


def main() -> None:
    """Print the table of one sample, and add it to a result file."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sample", nargs="?", default="")
    for name, number in (
        ("seed", 11),
        ("particles", 1200),
        ("splits", 3),
        ("draws", N_DRAWS),
        ("l-max", 0),
        ("level", MESH_LEVEL),
    ):
        parser.add_argument(f"--{name}", type=int, default=number)
    parser.add_argument("--models", default=",".join(MODEL_KEYS))
    parser.add_argument("--odd", action="store_true")
    parser.add_argument("--name", default="")
    parser.add_argument("-o", "--output", default="")
    options = parser.parse_args()
    whole = sample_from(options.sample)
    whole = whole.chosen(range(1, len(whole), 2)) if options.odd else whole
    whole = whole.truncated(options.l_max) if options.l_max else whole
    rng = np.random.default_rng(np.random.SeedSequence(options.seed))
    sample = whole.chosen(rng.permutation(len(whole))[: options.particles])
    keys = options.models.split(",")
    rows, beyond = tables_of(sample, options.seed, options.splits, keys, options.level, options.draws)
    made_with = {"seed": options.seed, "particles": len(sample), "splits": options.splits}
    name = options.name or Path(options.sample).stem or CARD
    add_result(options.output, name, rows, **made_with)
    add_result(options.output, f"beyond the percentile, {name}", beyond, **made_with)


if __name__ == "__main__":
    main()
