"""Build a dataset from particles and the polyhedra that approximate them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from importlib.metadata import PackageNotFoundError, version
from typing import Protocol

from regolith_studio.dataset.dataset import Dataset, Provenance, Representative, aligned
from regolith_studio.dataset.schema import Approximation
from regolith_studio.dataset.size_distributions import (
    DiscreteSizeDistribution,
    ShapeClass,
    SizeDistribution,
    Weighting,
    equivalent_diameter,
    normalised_shares,
)
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import Polyhedron
from regolith_studio.geometry.particle import Particle
from regolith_studio.io.file_names import unique_name
from regolith_studio.version import __version__

PACKAGES = ("numpy", "scipy", "numba", "pyshtools", "scikit-image", "fast-simplification", "vtk")


class CoarsenedShape(Protocol):
    """What a dataset needs to know of a coarsened particle; ``coarsening.result.CoarseningResult`` has it."""

    @property
    def polyhedron(self) -> Polyhedron:
        """About `centre`, in micrometres."""

    @property
    def centre(self) -> FloatArray:
        """Origin of the polyhedron in the particle's frame, shape (3,)."""

    @property
    def errors(self) -> Mapping[str, float]:
        """Eq. 8."""

    @property
    def jaccard_distance(self) -> float:
        """Eq. 7."""

    @property
    def loss(self) -> float:
        """Eq. 9."""

    @property
    def method(self) -> str:
        """Key of the method."""

    @property
    def n_facets_asked(self) -> int:
        """Requested number of facets."""

    @property
    def reason(self) -> str | None:
        """Why a request was not met, if it was not."""


def build_dataset(
    entries: Sequence[tuple[Particle, CoarsenedShape]],
    classes: Sequence[ShapeClass] | None = None,
    *,
    name: str = "dataset",
    weighting: Weighting = "number",
    sizes: SizeDistribution | None = None,
    provenance: Provenance | None = None,
) -> Dataset:
    """A dataset in which each entry is a representative.

    Parameters
    ----------
    entries
        Particles in micrometres, and what they were coarsened to.
    classes
        Weight and sizes of each, for example of
        :func:`~regolith_studio.dataset.representatives.choose_representatives`; by default each entry
        is a class of its own, with equal weights and its own size.
    weighting
        What the weights of `classes` count.
    sizes
        One size distribution for all classes, in place of their own.
    provenance
        Software versions are filled in where they are missing.

    Raises
    ------
    InputError
        If there is no entry, or the number of classes differs from that of the entries.
    """
    if not entries:
        raise InputError("A dataset needs at least one particle.")
    own = [singleton_class(particle) for particle, _ in entries] if classes is None else list(classes)
    if len(own) != len(entries):
        raise InputError(f"{len(entries)} particles need {len(entries)} classes, got {len(own)}.")
    weights = normalised_shares([one.weight for one in own])
    taken: dict[str, int] = {}
    names = [unique_name(particle.name, "", taken) for particle, _ in entries]
    representatives = tuple(
        representative_of(title, particle, shape, replace(one, weight=weight, sizes=sizes or one.sizes))
        for title, (particle, shape), one, weight in zip(names, entries, own, weights, strict=True)
    )
    origin = provenance or Provenance()
    return Dataset(
        name=name,
        representatives=representatives,
        weighting=weighting,
        provenance=origin if origin.software else replace(origin, software=software_versions()),
    )


def software_versions() -> dict[str, str]:
    """Versions of the program and of the packages that its results depend on."""
    versions = {"regolith-studio": __version__}
    for package in PACKAGES:
        try:
            versions[package] = version(package)
        except PackageNotFoundError:
            continue
    return versions


def singleton_class(particle: Particle) -> ShapeClass:
    """The class of a particle that represents only itself."""
    return ShapeClass(1.0, DiscreteSizeDistribution.empirical([equivalent_diameter(particle.mesh.volume)]))


def representative_of(
    name: str, particle: Particle, coarsened: CoarsenedShape, own: ShapeClass
) -> Representative:
    """The representative of a class, aligned and at unit volume."""
    shape, frame = aligned(coarsened.polyhedron, coarsened.centre)
    approximation = Approximation(
        method=coarsened.method,
        n_facets_asked=coarsened.n_facets_asked,
        errors=dict(coarsened.errors),
        jaccard_distance=coarsened.jaccard_distance,
        loss=coarsened.loss,
        reason=coarsened.reason,
    )
    return Representative(
        name=name,
        shape=shape,
        weight=own.weight,
        sizes=own.sizes,
        frame=frame,
        n_members=own.n_members,
        approximation=approximation,
        group=particle.group,
        source=particle.source,
    )
