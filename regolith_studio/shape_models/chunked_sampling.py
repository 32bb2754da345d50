"""Reproducible drawing in chunks, independent of the number of workers and of particles.

Particles are drawn in chunks of :data:`CHUNK`. Chunk i is drawn whole by its own generator, seeded with
``SeedSequence(seed, spawn_key=(i,))``, and cut if fewer are wanted. The first particles of a longer draw are
therefore those of a shorter one, and chunks may be drawn in any process and order.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import BoolArray, FloatArray
from regolith_studio.shape_models.protocol import SizeRange
from regolith_studio.shape_models.realizations import Realizations

CHUNK = 500
MAX_ROUNDS = 200
"""Maximum rounds of redrawing in one chunk; then the range of sizes counts as unreachable."""


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


class ChunkedSampler(ABC):
    """Base of fitted models that draw chunk by chunk: long draws report progress and can be cancelled."""

    @abstractmethod
    def draw_chunks(self, n: int, seed: int, size_range: SizeRange | None = None) -> Iterator[Realizations]:
        """The chunks of :meth:`draw`, in order.

        Raises
        ------
        InputError
            If `n` is negative, the range is none, or hardly any draw is acceptable.
        """

    def draw(self, n: int, seed: int, size_range: SizeRange | None = None) -> Realizations:
        """`n` particles, in the range of equivalent radii if given.

        Raises
        ------
        InputError
            As :meth:`draw_chunks`.
        """
        found = list(self.draw_chunks(n, seed, size_range))
        return joined(found) if found else replace(next(self.draw_chunks(1, seed)).chosen([]), rejected=0)


def joined(parts: Sequence[Realizations]) -> Realizations:
    """Concatenation of at least one chunk."""
    first = parts[0]
    return replace(
        first,
        coefficients=np.concatenate([part.coefficients for part in parts]),
        rejected=sum(part.rejected for part in parts),
        parents=np.concatenate([np.asarray(part.parents) for part in parts]),
        components=np.concatenate([np.asarray(part.components) for part in parts]),
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
    for _ in range(MAX_ROUNDS):
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
        f"Of {MAX_ROUNDS * CHUNK} particles that the model drew only {count} have a positive radius and the "
        "size asked for: widen the range of sizes, lower l_max, or take a model of log r."
    )
