"""What throwing draws away does to a Gaussian field of the radius, of a sample and of cards of spectra.

    python -m benchmarks.rejection [FIT.json] [SEED] [RESULT.json]

Percent of draws thrown away, and by how much the mean radius and the power of the second degree of those
kept are above the field's, at l_max = 10.
"""

import sys

import numpy as np

from benchmarks.populations import CARD_DEGREE, sample_from
from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.shape_models.materials import materials
from regolith_studio.shape_models.models.gaussian_field import MODEL
from regolith_studio.shape_models.sample import Sample

PARTICLES = 1000


def main(path: str, seed: int, result: str) -> None:
    """Print a row for each sample."""
    samples = {"cement": sample_from(path)} if path else {}
    for name, card in ((name, card) for name, card in materials().items() if card.hull_field is None):
        draws = card.field(CARD_DEGREE).draw(PARTICLES, seed)
        samples[name] = Sample(np.stack([draws.particle(i).values for i in range(PARTICLES)]))
    rows: Rows = {}
    for name, sample in samples.items():
        bias = MODEL.fit(sample).rejection_bias()
        show_row(rows, name, 100 * np.array([bias.rejected, bias.mean_radius, bias.second_degree]), 1)
    add_result(result, "field of", rows, seed=seed, particles=PARTICLES)


if __name__ == "__main__":
    words = [*sys.argv[1:], *("", "2", "")[len(sys.argv) - 1 :]]
    main(words[0], int(words[1]), words[2])
