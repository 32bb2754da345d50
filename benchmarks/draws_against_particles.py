"""Draws against the particles themselves: fit to one half, draw, compare with the other half at all degrees.

    python -m benchmarks.draws_against_particles [FIT.json] [SEED] [PARTICLES] [SPLITS] [RESULT.json]

Wasserstein distances in percent of the mean, by number, of as many draws as the half fitted to has particles;
means over the splits, and processor seconds of a fit and of 2,000 draws. With a result file the numbers are
added to it under the name of the sample.
"""

import json
import sys
import time
from pathlib import Path

import numpy as np

from benchmarks.populations import CARD, measured, realized, sample_from
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.shape_models.goodness_of_fit import relative_wasserstein
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.sample import Sample
from regolith_studio.studies.population import KEYS, N_FLOOR_SPLITS

CUTS = (10, 20)
N_DRAWS = 2000
MODEL_KEYS = ("recombined", "hull_field", "sample_matched")
Rows = dict[str, list[float]]


def far(one: FloatArray, two: FloatArray) -> FloatArray:
    """Distance of each descriptor in percent, shape (keys,)."""
    ones, others = np.ones(len(one)), np.ones(len(two))
    pairs = zip(one.T, two.T, strict=True)
    return np.array([100 * relative_wasserstein(a, b, ones, others) for a, b in pairs])


def show(rows: Rows, name: str, numbers: FloatArray) -> None:
    """Print a row of the table and keep it."""
    rows[name] = [round(float(number), 2) for number in numbers]
    print("|", name, "|", " | ".join(f"{number:.2f}" for number in numbers), "|", flush=True)


def judged(
    key: str, sample: Sample, table: FloatArray, halves: list[tuple[IntArray, IntArray]]
) -> FloatArray:
    """Distances of a model's draws from the halves that it has not seen, and processor seconds."""
    found = []
    for number, (train, test) in enumerate(halves):
        begin = time.process_time()
        model = MODELS[key]
        draws = model.fit(sample.chosen(train), model.Settings(l_max=sample.l_max)).draw(N_DRAWS, number)
        spent = time.process_time() - begin
        found.append([*far(table[test], measured(draws.chosen(range(len(train))), KEYS)), spent])
    return np.mean(found, axis=0)


def table_of(sample: Sample, seed: int, n_splits: int) -> Rows:
    """All rows of the table of one sample."""
    rows: Rows = {}
    table = measured(realized(sample), KEYS)
    halves = [sample.halves(seed + split) for split in range(N_FLOOR_SPLITS)]
    floor = [far(table[a], table[b]) for a, b in halves]
    show(rows, "floor", np.mean(floor, axis=0))
    show(rows, "floor, 95th percentile", np.quantile(floor, 0.95, axis=0))
    show(rows, "the half fitted to", np.mean([far(table[b], table[a]) for a, b in halves[:n_splits]], axis=0))
    for degree in (degree for degree in CUTS if degree < sample.l_max):
        cut = measured(realized(sample.truncated(degree)), KEYS)
        show(rows, f"cut at l = {degree}", far(table, cut))
    for key in MODEL_KEYS:
        show(rows, key, judged(key, sample, table, halves[:n_splits]))
    return rows


def main(path: str, seed: int, n: int, n_splits: int, result: str) -> None:
    """Print the table of one sample, and add it to a result file."""
    whole = sample_from(path)
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    sample = whole.chosen(rng.permutation(len(whole))[:n])
    rows = table_of(sample, seed, n_splits)
    if result:
        file, name = Path(result), Path(path).stem or CARD
        known = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
        known[name] = {"seed": seed, "particles": len(sample), "splits": n_splits, "rows": rows}
        file.write_text(json.dumps(known, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    words = [*sys.argv[1:], *("", "11", "1200", "4", "")[len(sys.argv) - 1 :]]
    main(words[0], int(words[1]), int(words[2]), int(words[3]), words[4])
