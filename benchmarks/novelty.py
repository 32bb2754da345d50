"""Novelty over all rotations of each model, and the share of draws whose nearest particle is their parent.

    python -m benchmarks.novelty [FIT.json] [SEED] [PARTICLES] [DRAWS]

Fitted to a random half; novelty is the distance to the nearest particle of that half over the median of such
distances within it. The other half itself comes first.
"""

import sys

import numpy as np

from benchmarks.populations import sample_from
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.shape_models.inertia_ellipsoid import canonical
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.novelty import distances_among, nearest_over_rotations
from regolith_studio.studies.population import FRAME_DEGREE, default_settings, frames_of

KEYS = ("recombined", "sample_matched", "hull_field", "log_field", "gaussian_field")


def main(path: str, seed: int, n: int, n_draws: int) -> None:
    """Print a line for the other half and for each model."""
    whole = sample_from(path)
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    sample = whole.chosen(rng.permutation(len(whole))[:n])
    train, test = sample.halves(seed)
    rows = sample.truncated(FRAME_DEGREE).coefficients
    measured = canonical(rows[train])
    picks = np.unique(np.linspace(0, len(train) - 1, n_draws).astype(np.int64))
    unit = float(np.median(distances_among(measured, picks)))
    scale = 100 * unit
    print(f"median distance among measured particles: {scale:.2f} % of r_eq")

    def line(name: str, drawn: FloatArray, parents: FloatArray) -> None:
        distances, nearest = nearest_over_rotations(measured, drawn)
        share = 100 * float((nearest == parents).mean())
        print(f"{name:16} novelty {np.median(distances) / unit:.2f}   nearest is the parent {share:.0f} %")

    line("other half", canonical(rows[test][:n_draws]), np.full(min(n_draws, len(test)), -1.0))
    for key in KEYS:
        draws = MODELS[key].fit(sample.chosen(train), default_settings(key, sample)).draw(n_draws, seed)
        line(key, frames_of(draws, FRAME_DEGREE), np.asarray(draws.parents, dtype=np.float64))


if __name__ == "__main__":
    words = [*sys.argv[1:], *("", "5", "1600", "100")[len(sys.argv) - 1 :]]
    main(words[0], int(words[1]), int(words[2]), int(words[3]))
