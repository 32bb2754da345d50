"""How far the draws of cards are from particles that the cards were not made of.

    python -m benchmarks.cards [SAMPLE] [SEED] [PARTICLES] [RESULT.json]

Wasserstein distances in percent of the mean, by number, all from the same PARTICLES of the sample with all
their degrees: of as many others, which the card is made of; of draws of the card's hull field; of those
others with random phases, each with the power of its own degrees; and of the field in ln r that cards without
particles have, at l_max = 10 and with all degrees. Then the judgement that the card carries, on a grid.
"""

import sys

import numpy as np

from benchmarks.draws_against_particles import far
from benchmarks.populations import measured, realized, sample_from
from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.shape_models.log_radius import log_shapes, sized
from regolith_studio.shape_models.materials import FIELD_DEGREE, MaterialCard
from regolith_studio.shape_models.realizations import Realizations
from regolith_studio.shape_models.sample import Sample
from regolith_studio.shape_models.shape_features import powers, with_powers
from regolith_studio.studies.population import KEYS


def with_random_phases(sample: Sample, rng: np.random.Generator) -> Realizations:
    """The particles with the power of each degree of ln r, and random coefficients within it."""
    shapes = log_shapes(sample)
    field = rng.standard_normal(shapes.coefficients.shape)
    field[:, 0] = 0.0
    rows = with_powers(field, powers(shapes.coefficients))
    return Realizations(sized(rows, shapes.equivalent_radii), "log_radius", "random phases", 0)


def main(path: str, seed: int, n: int, result: str) -> None:
    """Print the rows, the judgement and the size of the card."""
    whole = sample_from(path)
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    order = rng.permutation(len(whole))
    sample, others = whole.chosen(order[:n]), whole.chosen(order[n : 2 * n])
    table = measured(realized(others), KEYS)
    card = MaterialCard.of(sample, "card", "Card", "A benchmark.")
    rows: Rows = {}
    for name, draws in (
        ("particles of the card", realized(sample)),
        ("hull field", card.model().draw(n, seed)),
        ("random phases", with_random_phases(sample.star_shaped(), rng)),
        (f"pooled field, l_max = {FIELD_DEGREE}", card.field().draw(n, seed)),
        ("pooled field, all degrees", card.field(card.l_max).draw(n, seed)),
    ):
        show_row(rows, name, far(table, measured(draws, KEYS)).tolist())
    print(card.judged, f"{len(card.model_dump_json()) / 1000:.0f} kB")
    add_result(result, "draws of a card", rows, seed=seed, particles=n)


if __name__ == "__main__":
    words = [*sys.argv[1:], *("", "5", "1000", "")[len(sys.argv) - 1 :]]
    main(words[0], int(words[1]), int(words[2]), words[3])
