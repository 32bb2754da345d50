"""How far the card of a sample is from the sample: the judgement that it carries.

python -m benchmarks.cards [FIT.json] [SEED] [PARTICLES]
"""

import sys

import numpy as np

from benchmarks.populations import sample_from
from regolith_studio.shape_models.materials import MaterialCard


def main(path: str, seed: int, n: int) -> None:
    """Print distances in percent of the mean, and the size of the card."""
    whole = sample_from(path)
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    card = MaterialCard.of(whole.chosen(rng.permutation(len(whole))[:n]), "card", "Card", "A benchmark.")
    print(card.judgement, f"{len(card.model_dump_json()) / 1000:.0f} kB")


if __name__ == "__main__":
    words = [*sys.argv[1:], *("", "5", "1000")[len(sys.argv) - 1 :]]
    main(words[0], int(words[1]), int(words[2]))
