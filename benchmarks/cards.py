"""How far the card of a sample is from the sample, and the pooled field that cards without particles have.

    python -m benchmarks.cards [SAMPLE] [SEED] [PARTICLES] [RESULT.json]

Wasserstein distances in percent of the mean, by number, of as many draws as the sample has particles, both at
l_max = 10; then the judgement that the card carries, on a grid of directions.
"""

import sys

import numpy as np

from benchmarks.draws_against_particles import far
from benchmarks.populations import measured, realized, sample_from
from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.shape_models.materials import MaterialCard
from regolith_studio.studies.population import KEYS

DEGREE, LEVEL = 10, 3


def main(path: str, seed: int, n: int, result: str) -> None:
    """Print both rows, the judgement and the size of the card."""
    whole = sample_from(path)
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    sample = whole.chosen(rng.permutation(len(whole))[:n])
    card = MaterialCard.of(sample, "card", "Card", "A benchmark.")
    table = measured(realized(sample.truncated(DEGREE)), KEYS, LEVEL)
    rows: Rows = {}
    for name, model in (("hull field", card.model(DEGREE)), ("pooled field", card.field(DEGREE))):
        show_row(rows, name, far(table, measured(model.draw(n, seed), KEYS, LEVEL)))
    print(card.judgement, f"{len(card.model_dump_json()) / 1000:.0f} kB")
    add_result(result, "model of the card", rows, seed=seed, particles=n)


if __name__ == "__main__":
    words = [*sys.argv[1:], *("", "5", "1000", "")[len(sys.argv) - 1 :]]
    main(words[0], int(words[1]), int(words[2]), words[3])
