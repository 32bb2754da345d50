"""Sampling noise of representatives: what the program says of a part of a sample, and how far the rest is.

    python -m benchmarks.sampling_noise [FIT.json] [SEED] [RESULT.json]

Wasserstein distances in standard deviations, means of 20 random choices, and the quality curve of all
particles with the mean over its descriptors.
"""

import sys

import numpy as np

from benchmarks.populations import measured, realized, sample_from
from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.dataset.representatives import NEEDED, quality_steps, sampling_noise
from regolith_studio.steps import result_of

PARTS, CHOICES = (10, 60, 150, 600), 20
COUNTS = (1, 5, 10, 20, 70, 200)
COMPARED = ("aspect_ratio", "sphericity", "min_diameter")


def main(path: str, seed: int, result: str) -> None:
    """Print both tables."""
    from scipy.stats import wasserstein_distance

    sample = sample_from(path)
    table = measured(realized(sample), NEEDED, 4)
    rows = [dict(zip(NEEDED, row, strict=True)) for row in table.tolist()]
    compared = table[:, [NEEDED.index(key) for key in COMPARED]]
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    parts: Rows = {}
    for n in PARTS:
        both = np.zeros((2, len(COMPARED)))
        for _ in range(CHOICES):
            order = rng.permutation(len(rows))
            noise = sampling_noise([rows[i] for i in order[:n]])
            both[0] += [noise[key] for key in COMPARED]
            pairs = zip(compared[order[:n]].T, compared[order[n:]].T, compared.std(axis=0), strict=True)
            both[1] += [wasserstein_distance(part, rest) / deviation for part, rest, deviation in pairs]
        show_row(parts, str(n), (both.ravel() / CHOICES).tolist())
    curve = result_of(quality_steps(rows, COUNTS))
    distances: Rows = {}
    for count, errors in (
        *((str(point.count), point.errors) for point in curve.points),
        ("noise", curve.noise),
    ):
        numbers = list(errors.values())
        show_row(distances, count, [*numbers, float(np.mean(numbers))])
    add_result(result, "particles", parts, seed=seed, choices=CHOICES)
    add_result(result, "N", distances, particles=len(rows))


if __name__ == "__main__":
    words = [*sys.argv[1:], *("", "7", "")[len(sys.argv) - 1 :]]
    main(words[0], int(words[1]), words[2])
