"""Randomness that neither the number of workers nor the number of particles can change.

Particles are drawn in chunks of :data:`CHUNK`. Chunk i is drawn whole, by a generator of its own from
``SeedSequence(seed, spawn_key=(i,))``, and cut if fewer are wanted. So the first particles of a longer
draw are those of a shorter one, and chunks may be drawn anywhere, in any order.
"""

from collections.abc import Callable, Iterator

import numpy as np

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import BoolArray, FloatArray
from regolith_studio.model.draws import Draws

CHUNK = 500
MOST_ROUNDS = 200
"""Rounds of redrawing in one chunk after which a range of sizes counts as out of reach."""


def chunks(n: int, seed: int) -> Iterator[tuple[np.random.Generator, int]]:
    """Generator of each chunk, and how many of its :data:`CHUNK` particles are wanted.

    Raises
    ------
    InputError
        If `n` is negative.
    """
    if n < 0:
        raise InputError(f"The number of particles must not be negative, got {n}.")
    for index, first in enumerate(range(0, n, CHUNK)):
        sequence = np.random.SeedSequence(seed, spawn_key=(index,))
        yield np.random.default_rng(sequence), min(CHUNK, n - first)


def joined(parts: list[Draws], empty: Draws) -> Draws:
    """The chunks as one; `empty` where there are none."""
    if not parts:
        return empty
    first = parts[0]
    return Draws(
        np.concatenate([part.coefficients for part in parts]),
        first.scale,
        first.model,
        first.seed,
        first.unit,
        sum(part.rejected for part in parts),
        np.concatenate([part.parents for part in parts if part.parents is not None]),
        np.concatenate([part.components for part in parts if part.components is not None]),
    )


def accepted(
    propose: Callable[[int], FloatArray], acceptable: Callable[[FloatArray], BoolArray], wanted: int
) -> tuple[FloatArray, int]:
    """The first `wanted` acceptable rows out of rounds of proposals, and how many before them were not.

    Parameters
    ----------
    propose
        Draws that many rows; called with :data:`CHUNK` each round.
    acceptable
        Tells for each row of a round whether it is kept.

    Raises
    ------
    InputError
        If hardly any proposal is acceptable.
    """
    kept: list[FloatArray] = []
    count = rejected = 0
    for _ in range(MOST_ROUNDS):
        rows = propose(CHUNK)
        good = np.flatnonzero(acceptable(rows))
        if count + len(good) >= wanted:
            last = int(good[wanted - count - 1])
            return np.concatenate([*kept, rows[good[: wanted - count]]]), rejected + last + 1 - (
                wanted - count
            )
        kept.append(rows[good])
        count += len(good)
        rejected += len(rows) - len(good)
    raise InputError(
        f"Of {MOST_ROUNDS * CHUNK} particles that the model drew only {count} have a positive radius and the "
        "size asked for: widen the range of sizes, lower l_max, or take a model of log r."
    )
