"""Novelty over all rotations of each model, and the share of draws whose nearest particle is their parent.

    python -m benchmarks.novelty [SAMPLE] [SEED] [PARTICLES] [DRAWS] [RESULT.json]

Fitted to a random half; novelty is the distance to the nearest particle of that half over the median of such
distances within it, once where mirror images count as different and once where they count as the same. The
other half itself comes first.
"""

import sys

import numpy as np

from benchmarks.populations import sample_from
from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics.coefficients import orders
from regolith_studio.shape_models.inertia_ellipsoid import canonical
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.novelty import distances_among, nearest_over_rotations
from regolith_studio.shape_models.realizations import Realizations
from regolith_studio.studies.population import FRAME_DEGREE, default_settings

KEYS = ("recombined", "sample_matched", "hull_field", "log_field", "gaussian_field")


def radii_of(draws: Realizations) -> FloatArray:
    """Coefficients of the radii at the degree of the comparison, shape (n, (FRAME_DEGREE + 1)^2)."""
    return np.stack([draws.particle(index, FRAME_DEGREE).values for index in range(len(draws))])


def main(path: str, seed: int, n: int, n_draws: int, result: str) -> None:
    """Print a row for the other half and for each model: both novelties, and parents in percent."""
    whole = sample_from(path)
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    sample = whole.chosen(rng.permutation(len(whole))[:n])
    train, test = sample.halves(seed)
    radii = sample.truncated(FRAME_DEGREE).coefficients
    measured = canonical(radii[train])
    mirror = np.where(orders(radii.shape[1]) < 0, -1.0, 1.0)
    picks = np.unique(np.linspace(0, len(train) - 1, n_draws).astype(np.int64))
    unit = float(np.median(distances_among(measured, picks)))
    print(f"median distance among measured particles: {100 * unit:.2f} % of r_eq")
    rows: Rows = {}

    def row(name: str, drawn: FloatArray, parents: FloatArray) -> None:
        distances, nearest = nearest_over_rotations(measured, canonical(drawn))
        images, _ = nearest_over_rotations(measured, canonical(drawn * mirror))
        both = np.median(distances), np.median(np.minimum(distances, images))
        show_row(rows, name, [each / unit for each in both] + [100 * (nearest == parents).mean()])

    row("other half", radii[test][:n_draws], np.full(min(n_draws, len(test)), -1.0))
    for key in KEYS:
        draws = MODELS[key].fit(sample.chosen(train), default_settings(key, sample)).draw(n_draws, seed)
        row(key, radii_of(draws), np.asarray(draws.parents, dtype=np.float64))
    add_result(result, "novelty", rows, seed=seed, particles=n, draws=n_draws)


if __name__ == "__main__":
    words = [*sys.argv[1:], *("", "5", "1600", "100", "")[len(sys.argv) - 1 :]]
    main(words[0], int(words[1]), int(words[2]), int(words[3]), words[4])
