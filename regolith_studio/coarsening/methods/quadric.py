"""Quadric decimation of the convex hull: the paper's baseline, and the start of its annealing."""

from collections.abc import Generator, Mapping
from dataclasses import dataclass, field

import fast_simplification
import numpy as np

from regolith_studio.coarsening.loss import loss
from regolith_studio.coarsening.progress import MethodStep
from regolith_studio.coarsening.result import MethodResult
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import JACCARD, LossWeights
from regolith_studio.descriptors.comparison import relative_errors
from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import GeometryError, InputError
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.overlap import jaccard_distance


@dataclass(frozen=True)
class QuadricSettings:
    """How the decimated mesh is read as a polyhedron.

    Parameters
    ----------
    restore_volume
        Scale the half-spaces' polyhedron to the volume of the particle.
    """

    restore_volume: bool = field(default=False, metadata={"label": "Restore the volume"})


def decimated_hull(target: Target, n_faces: int) -> Mesh:
    """The convex hull of the unit-volume particle, decimated to `n_faces` triangles.

    Quadric edge collapse as in fast-simplification. The result is closed but as a rule not convex.

    Raises
    ------
    InputError
        If the hull has fewer triangles than asked for.
    """
    hull = target.mesh.hull
    if len(hull.faces) < n_faces:
        raise InputError(
            f"The particle's convex hull has {len(hull.faces)} triangles only, fewer than the {n_faces} faces"
            " asked for."
        )
    points, faces = fast_simplification.simplify(
        hull.vertices.copy(), hull.faces.astype(np.int32), target_count=n_faces
    )
    return Mesh(points, faces)


def quadric_half_spaces(target: Target, n_faces: int) -> HalfSpaces:
    """The half-spaces of the decimated hull's triangles (the start of section 2.4).

    Where two triangles lie in one plane, the plane counts once.

    Raises
    ------
    GeometryError
        If the decimated hull does not hold the particle's centroid inside all of its planes.
    """
    mesh = decimated_hull(target, n_faces)
    sound = mesh.face_areas > 1e-12
    normals = mesh.face_area_vectors[sound] / mesh.face_areas[sound, None]
    offsets = np.einsum("ij,ij->i", normals, mesh.triangles[sound, 0])
    inside = offsets > 1e-6
    if np.count_nonzero(inside) < 4:
        raise GeometryError("The decimated convex hull does not hold the particle's centroid inside.")
    return HalfSpaces(normals[inside], offsets[inside])


def variants(target: Target, n_faces: int) -> dict[str, dict[str, float]]:
    """Errors of the three readings of the baseline: ``mesh``, ``half_spaces``, ``volume_restored``."""
    half_spaces = quadric_half_spaces(target, n_faces)
    polyhedron = ConvexPolyhedron.from_half_spaces(half_spaces)
    restored = ConvexPolyhedron.from_half_spaces(restored_volume(half_spaces))
    solids: Mapping[str, Mesh | ConvexPolyhedron] = {
        "mesh": decimated_hull(target, n_faces),
        "half_spaces": polyhedron,
        "volume_restored": restored,
    }
    table = {name: dict(relative_errors(target.descriptors, describe(s))) for name, s in solids.items()}
    table["half_spaces"][JACCARD] = jaccard_distance(target.mesh, polyhedron)
    table["volume_restored"][JACCARD] = jaccard_distance(target.mesh, restored)
    return table


def restored_volume(half_spaces: HalfSpaces) -> HalfSpaces:
    """The same polyhedron scaled to unit volume."""
    return half_spaces.scaled(ConvexPolyhedron.from_half_spaces(half_spaces).volume ** (-1 / 3))


class QuadricMethod:
    """Fast quadric mesh simplification of the convex hull (section 2.4); weights do not matter."""

    key = "quadric"
    label = "Quadric decimation"
    Settings = QuadricSettings

    def run(
        self,
        target: Target,
        n_faces: int,
        weights: LossWeights,
        seed: np.random.SeedSequence,  # noqa: ARG002
        settings: QuadricSettings,
    ) -> Generator[MethodStep, None, MethodResult]:
        """One step; the loss is that of the half-spaces."""
        half_spaces = quadric_half_spaces(target, n_faces)
        if settings.restore_volume:
            half_spaces = restored_volume(half_spaces)
        others = variants(target, n_faces)
        chosen = others["volume_restored" if settings.restore_volume else "half_spaces"]
        value = loss(weights, chosen, chosen[JACCARD])
        yield MethodStep(1, 1, value, half_spaces)
        return MethodResult(half_spaces, loss_history=(value,), variants=others)


METHOD = QuadricMethod()
