"""Sampling noise of representatives: what the program says of a part of a sample, and how far the rest is.

    python -m benchmarks.sampling_noise [FIT.json] [SEED]

Wasserstein distances in standard deviations, and the quality curve of all particles.
"""

import sys

import numpy as np

from benchmarks.populations import measured, realized, sample_from
from regolith_studio.dataset.quality import quality_curve
from regolith_studio.dataset.representatives import NEEDED, sampling_noise

PARTS, CHOICES = (60, 150, 600), 20
COUNTS = (1, 5, 10, 20, 70, 200)


def main(path: str, seed: int) -> None:
    """Print both tables."""
    from scipy.stats import wasserstein_distance

    sample = sample_from(path)
    table = measured(realized(sample), NEEDED, 4)
    rows = [dict(zip(NEEDED, row, strict=True)) for row in table.tolist()]
    compared = {key: table[:, NEEDED.index(key)] for key in ("aspect_ratio", "sphericity", "min_diameter")}
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    for n in PARTS:
        said, found = dict.fromkeys(compared, 0.0), dict.fromkeys(compared, 0.0)
        for _ in range(CHOICES):
            order = rng.permutation(len(rows))
            part, rest = order[:n], order[n:]
            noise = sampling_noise([rows[i] for i in part])
            for key, values in compared.items():
                said[key] += noise[key] / CHOICES
                found[key] += wasserstein_distance(values[part], values[rest]) / values.std() / CHOICES
        pairs = (f"{key} said {said[key]:.3f} found {found[key]:.3f}" for key in compared)
        print(f"{n:5} particles:", *pairs)
    curve = quality_curve(rows, COUNTS)
    for errors in (*(point.errors for point in curve.points), curve.noise):
        print(*(f"{key} {error:.3f}" for key, error in errors.items()))


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "", int(sys.argv[2]) if len(sys.argv) > 2 else 7)
