"""Reproducible drawing in chunks, independent of the number of workers and of particles.

Particles are drawn in chunks of :data:`CHUNK`. Chunk i is drawn whole by its own generator, seeded with
``SeedSequence(seed, spawn_key=(i,))``, and cut if fewer are wanted. The first particles of a longer draw are
therefore those of a shorter one, and chunks may be drawn in any process and order.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.io.machine_memory import check_memory
from regolith_studio.messages import N_, Message
from regolith_studio.shape_models.protocol import SizeRange
from regolith_studio.shape_models.realizations import Realizations, Scale, acceptable, positive_rows
from regolith_studio.shape_models.sample import sized
from regolith_studio.shape_models.shape_features import powers
from regolith_studio.shape_models.size_law import LogNormalSizes, checked_bounds

# Part of what a seed means: chunks of another size would be other particles.
CHUNK = 500
MAX_ROUNDS = 200
"""Maximum rounds of redrawing in one chunk; then the range of sizes counts as unreachable."""
N_COMPARED = 5000
"""Draws by which the bias of those with a positive radius is found."""


def chunks(n: int, seed: int) -> Iterator[tuple[np.random.Generator, int]]:
    """Generator of each chunk, and how many of its :data:`CHUNK` particles are wanted.

    Raises InputError if `n` is negative.
    """
    if n < 0:
        raise InputError(f"The number of particles must not be negative, got {n}.")
    for index, first in enumerate(range(0, n, CHUNK)):
        sequence = np.random.SeedSequence(seed, spawn_key=(index,))
        yield np.random.default_rng(sequence), min(CHUNK, n - first)


def check_draws(n: int, l_max: int) -> None:
    """Check that the coefficients of `n` particles, and a copy of them, can be held.

    Raises InputError if this machine has less memory.
    """
    check_memory(2 * 8 * n * (l_max + 1) ** 2, f"{n:,} particles of l_max = {l_max}")


class ChunkedSampler(ABC):
    """Base of fitted models that draw chunk by chunk: long draws report progress and can be cancelled."""

    if TYPE_CHECKING:  # a property, or a field of a dataclass

        @property
        def l_max(self) -> int:
            """Degree of the particles."""

    @abstractmethod
    def draw_chunks(self, n: int, seed: int, size_range: SizeRange | None = None) -> Iterator[Realizations]:
        """The chunks of :meth:`draw`, in order."""

    def draw(self, n: int, seed: int, size_range: SizeRange | None = None) -> Realizations:
        """`n` particles, in the range of equivalent radii if given."""
        check_draws(n, self.l_max)
        chunks = list(self.draw_chunks(n, seed, size_range))
        # No particles, but with the unit and the degree of the model.
        return joined(chunks) if chunks else replace(next(self.draw_chunks(1, seed)).chosen([]), rejected=0)


class SizedSampler(ChunkedSampler):
    """Base of models with a law of sizes and shapes that can be scaled to any size: none is rejected."""

    unit: str
    key: ClassVar[str]
    scale: ClassVar[Scale] = "log_radius"

    if TYPE_CHECKING:  # at run time a dataclass would take the property for the default of its field

        @property
        def sizes(self) -> LogNormalSizes:
            """Law of equivalent radii."""

    def draw_chunks(self, n: int, seed: int, size_range: SizeRange | None = None) -> Iterator[Realizations]:
        """`n` particles; their equivalent radii follow the law of sizes, cut to the range if given."""
        bounds = checked_bounds(size_range)
        for rng, wanted in chunks(n, seed):
            # A chunk is drawn whole and cut afterwards, or a shorter draw would use other random numbers.
            radii, components = self.sizes.draw(CHUNK, rng, bounds)
            shapes, origins = self.shapes(radii, components, rng)
            rows = sized(shapes, radii, self.scale)[:wanted]
            parents, of_size = (
                origins[name][:wanted] if name in origins else None for name in ("parents", "components")
            )
            yield Realizations(
                rows, self.scale, self.key, seed, self.unit, parents=parents, components=of_size
            )

    @abstractmethod
    def shapes(
        self, radii: FloatArray, components: IntArray, rng: np.random.Generator, /
    ) -> tuple[FloatArray, dict[str, IntArray]]:
        """Shapes of any size, shape (n, (l_max + 1)^2), and what :class:`Realizations` says of their origin.

        ``radii``, ``components``: equivalent radius of each particle, and the component of the law of sizes,
        shape (n,).
        """


@dataclass(frozen=True)
class RejectionBias:
    """How kept draws differ from the field, which rejects draws whose radius is not positive.

    ``rejected``: share of all draws. ``mean_radius``, ``second_degree``: mean radius and A_2 of the kept
    draws over those of all, less one.
    """

    rejected: float
    mean_radius: float
    second_degree: float


class RejectionSampler(ChunkedSampler):
    """Base of fields of the radius itself: draws whose radius is not positive everywhere are rejected."""

    unit: str
    key: ClassVar[str]

    @abstractmethod
    def propose(self, rng: np.random.Generator, n: int) -> FloatArray:
        """Coefficients of `n` draws, and the component of each in a last column."""

    def draw_chunks(self, n: int, seed: int, size_range: SizeRange | None = None) -> Iterator[Realizations]:
        """`n` particles with a positive radius, and in the range of equivalent radii if given."""
        bounds = checked_bounds(size_range)
        for rng, wanted in chunks(n, seed):
            rows, rejected = accepted(
                partial(self.propose, rng), lambda rows: acceptable(bounds, rows[:, :-1]), wanted
            )
            components = rows[:, -1].astype(np.int64)
            yield Realizations(
                rows[:, :-1], "radius", self.key, seed, self.unit, rejected, components=components
            )

    def rejection_bias(self) -> RejectionBias:
        """Bias of the draws that are kept, from 5,000 draws."""
        rows = self.propose(np.random.default_rng(np.random.SeedSequence(0)), N_COMPARED)[:, :-1]
        kept = rows[positive_rows(rows)]
        mean_radius = float(kept[:, 0].mean() / rows[:, 0].mean()) - 1
        ratio = powers(kept).mean(axis=0) / np.maximum(powers(rows).mean(axis=0), 1e-300)
        return RejectionBias(
            1 - len(kept) / len(rows), mean_radius, float(ratio[2]) - 1 if len(ratio) > 2 else 0.0
        )


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

    ``propose``: draws that many rows; called with :data:`CHUNK` each round. ``acceptable``: tells for each
    row of a round whether it is kept.

    Raises InputError if hardly any proposal is acceptable.
    """
    kept: list[FloatArray] = []
    count = rejected = 0
    for _ in range(MAX_ROUNDS):
        rows = propose(CHUNK)
        good = np.flatnonzero(acceptable(rows))
        if count + len(good) >= wanted:
            # Draws after the last one that is used are not counted, or the rate would depend on CHUNK.
            last = int(good[wanted - count - 1])
            return np.concatenate([*kept, rows[good[: wanted - count]]]), rejected + last + 1 - (
                wanted - count
            )
        kept.append(rows[good])
        count += len(good)
        rejected += len(rows) - len(good)
    sentence = N_(
        "Of {total} particles that the model drew only {count} have a positive radius and the size asked "
        "for: widen the range of sizes, lower l_max, or take a model of log r."
    )
    raise InputError(Message(sentence, total=MAX_ROUNDS * CHUNK, count=count))
