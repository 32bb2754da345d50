"""A coarsened particle with everything that is known about how well it was met."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from regolith_studio.coarsening.progress import placed
from regolith_studio.descriptors.describe import Descriptors
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.messages import N_, Message, Number

COSTLY_OVERLAP = 1.5
"""Above so many times the Jaccard distance that the overlap alone leads to, a result has a warning."""


@dataclass(frozen=True)
class MethodResult:
    """What a method returns, for a particle of unit volume with its centroid at the origin.

    The `reason` is one sentence, ``None`` where the request is met. `steps` are numbers worth knowing about
    the run, `variants` relative errors (and the Jaccard distance) of other readings of the result.
    `polyhedron`, `achieved` and `jaccard_distance` are those of the solid, where the method has made or
    measured it already; `free_distance` is the Jaccard distance that a descent on the overlap alone leads to.
    A method that `makes_compounds` is not bound to miss V or CH.
    """

    solid: HalfSpaces | ConvexCompound
    loss_history: tuple[float, ...] = ()
    reason: str | None = None
    steps: Mapping[str, float] = field(default_factory=dict)
    variants: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    polyhedron: ConvexPolyhedron | None = None
    achieved: Descriptors | None = None
    jaccard_distance: float | None = None
    free_distance: float | None = None
    makes_compounds: bool = False


@dataclass(frozen=True)
class CoarseningResult:
    """A convex polyhedron, or a union of several, that stands for a particle.

    Parameters
    ----------
    polyhedron
        About `centre` (its origin is the particle's centroid), in the particle's unit.
    centre
        The particle's centroid in its own frame, shape (3,).
    target, achieved
        Descriptors of particle and polyhedron, in the particle's unit.
    errors
        Relative error of each descriptor of the loss (Eq. 8).
    jaccard_distance
        Eq. 7 (there IoU), with 16,000 rays; of a union of several parts with parallel lines.
    loss
        Eq. 9 of `errors` and `jaccard_distance`.
    loss_history
        Eq. 9 after each step of the method, as the method evaluates it.
    method
        Key of the method.
    n_facets_asked, n_facets, n_vertices, n_triangles
        Facets asked for; real facets, vertices and triangles.
    bounds
        Least attainable error of each descriptor, see :mod:`regolith_studio.coarsening.lower_bounds`.
    reason
        Why the request is not met, in one sentence; ``None`` where it is met.
    steps
        Numbers about the run: iterations, restarts, refused proposals ...
    variants
        Relative errors of other readings of the result (the quadric baseline has three).
    free_jaccard_distance
        Eq. 7 where the overlap alone counts, with 2,000 rays; ``None`` where the method did not look.
    genus
        Tunnels of the particle and of the union that stands for it, of a compound whose particle has any.
    """

    polyhedron: Polyhedron
    centre: FloatArray
    target: Descriptors
    achieved: Descriptors
    errors: Mapping[str, float]
    jaccard_distance: float
    loss: float
    loss_history: tuple[float, ...]
    method: str
    n_facets_asked: int
    bounds: Mapping[str, float]
    reason: str | None = None
    steps: Mapping[str, float] = field(default_factory=dict)
    variants: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    free_jaccard_distance: float | None = None
    genus: tuple[int, int] | None = None

    @property
    def warning(self) -> str | None:
        """That tunnels are lost, or what keeping descriptors costs where that is much overlap; a sentence."""
        if self.genus is not None and self.genus[1] < self.genus[0]:
            return Message(
                N_(
                    "The particle has tunnels (genus {particle}), the union of the convex parts has genus"
                    " {union}: no condition preserves tunnels, which may be closed or moved."
                ),
                particle=self.genus[0],
                union=self.genus[1],
            )
        free = self.free_jaccard_distance
        if free is None or self.jaccard_distance <= COSTLY_OVERLAP * free:
            return None
        return Message(
            N_(
                "Keeping the descriptors costs overlap: the Jaccard distance is {kept}; with the overlap"
                " alone it would be {free}. The preset Volume, diameters, overlap ignores the sphericity."
            ),
            kept=Number(self.jaccard_distance, ".3f"),
            free=Number(free, ".3f"),
        )

    @property
    def n_facets(self) -> int:
        """Real facets."""
        return self.polyhedron.n_facets

    @property
    def n_vertices(self) -> int:
        """Vertices."""
        return self.polyhedron.n_vertices

    @property
    def n_triangles(self) -> int:
        """Triangles of the facets' triangulation."""
        return self.polyhedron.n_triangles

    @property
    def n_parts(self) -> int:
        """Convex parts."""
        return self.polyhedron.n_parts if isinstance(self.polyhedron, ConvexCompound) else 1

    @property
    def half_spaces(self) -> HalfSpaces | None:
        """The half-spaces about the particle's centroid; ``None`` of a union of several parts."""
        return self.polyhedron.half_spaces if isinstance(self.polyhedron, ConvexPolyhedron) else None

    @property
    def mesh(self) -> Mesh:
        """Triangles in the particle's own frame: lies where the particle lies."""
        return placed(self.polyhedron, self.centre)
