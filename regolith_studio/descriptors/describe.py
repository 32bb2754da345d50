"""Descriptors of one particle."""

from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from typing import Any

from regolith_studio.descriptors.catalogue import CATALOGUE, DEFAULT_KEYS, ShapeCache
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle


class Descriptors(Mapping[str, float]):
    """Values of descriptors by key, in the order of `CATALOGUE`; never changes.

    Raises ValueError if a key is not in the catalogue.
    """

    __slots__ = ("_values",)
    _values: dict[str, float]

    def __init__(self, values: Mapping[str, float]) -> None:
        _check_keys(values)
        object.__setattr__(self, "_values", {key: float(values[key]) for key in CATALOGUE if key in values})

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"Descriptors cannot be changed ({name})")

    def __reduce__(self) -> tuple[Callable[..., "Descriptors"], tuple[Any, ...]]:
        return Descriptors, (dict(self._values),)

    def __getitem__(self, key: str) -> float:
        return self._values[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __hash__(self) -> int:
        return hash(tuple(self._values.items()))

    def __repr__(self) -> str:
        return f"Descriptors({self._values})"


def describe(
    solid: Particle | Mesh | ConvexPolyhedron | ConvexCompound,
    keys: Iterable[str] | None = None,
    box_metric: str = "exact",
) -> Descriptors:
    """Descriptors of a closed, outward-oriented solid, in powers of its length unit.

    Parameters
    ----------
    solid
        In micrometres for particles; a compound counts as its union.
    keys
        Keys of `CATALOGUE`; by default all that are quick to work out (`DEFAULT_KEYS`).
    box_metric
        ``exact``, or ``trimesh`` for the heuristic box of the paper's program.

    Raises
    ------
    GeometryError
        If the solid has fewer than four faces, is flat or is inside out.
    ValueError
        If a key or the box metric is unknown.
    """
    steps = description_steps(solid, keys, box_metric)
    while True:
        try:
            next(steps)
        except StopIteration as end:
            result: Descriptors = end.value
            return result


def description_steps(
    solid: Particle | Mesh | ConvexPolyhedron | ConvexCompound,
    keys: Iterable[str] | None = None,
    box_metric: str = "exact",
) -> Generator[str, None, Descriptors]:
    """As :func:`describe`, with the label of each descriptor before it is worked out."""
    wanted = DEFAULT_KEYS if keys is None else tuple(keys)
    _check_keys(wanted)
    facts = ShapeCache(solid.mesh if isinstance(solid, Particle | ConvexCompound) else solid, box_metric)
    values = {}
    for key in wanted:
        yield CATALOGUE[key].label
        values[key] = CATALOGUE[key].compute(facts)
    return Descriptors(values)


def _check_keys(keys: Iterable[str]) -> None:
    unknown = [key for key in keys if key not in CATALOGUE]
    if unknown:
        raise ValueError(f"unknown descriptors {unknown}; the catalogue has {list(CATALOGUE)}")
