"""The loss of Eq. 9, of known errors and as a fast function of half-spaces."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from regolith_studio.coarsening.core.intersection import FINE
from regolith_studio.coarsening.core.overlap import crossings_of, jaccard, shared_by_planes
from regolith_studio.coarsening.core.polyhedron_measures import MeasuredPolyhedron, measure_polyhedron
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import JACCARD, LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.describe import describe, relative_errors
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.minimum_box import minimum_box
from regolith_studio.geometry.minimum_box.hull_topology import Facets


def loss(weights: LossWeights, errors: Mapping[str, float], jaccard_distance: float) -> float:
    """Eq. 9: the weighted sum of the Jaccard distance (Eq. 7, NaN without weight) and the relative errors."""
    total = sum(weights[key] * errors[key] for key in LOSS_KEYS if weights[key])
    return float(total + (weights[JACCARD] * jaccard_distance if weights[JACCARD] else 0.0))


BOX_KEYS = ("min_diameter", "max_diameter", "aspect_ratio")
NO_EDGE = 1e-8
"""Edges of a polyhedron of about unit volume that are shorter bear no box."""


@dataclass(frozen=True)
class Evaluation:
    """Errors (Eq. 8), Jaccard distance (Eq. 7) and loss (Eq. 9); NaN for what was not asked for."""

    errors: dict[str, float]
    jaccard_distance: float
    loss: float


class LossFunction:
    """Eq. 9 as a function of half-spaces; of terms with weight 0 too, if of `everything`."""

    def __init__(self, target: Target, weights: LossWeights, everything: bool = False) -> None:
        self._target = target
        self._weights = weights
        # At 20 facets the box takes more than nine tenths of an evaluation.
        self._with_box = everything or any(weights[key] for key in BOX_KEYS)
        rays = target.rays
        self._crossings: FloatArray | None = None
        if everything or weights[JACCARD]:
            self._crossings = crossings_of(rays.directions, rays.first, rays.distance, rays.sign)

    def __call__(self, normals: FloatArray, offsets: FloatArray) -> Evaluation | None:
        """Errors and loss, or ``None`` where the half-spaces bound no proper polyhedron."""
        polyhedron = measure_polyhedron(np.array(normals), np.array(offsets))
        if polyhedron.status != FINE:
            return None
        shortest = longest = shared = np.nan
        if self._with_box:
            extents = box_extents(polyhedron)
            shortest, longest = float(extents.min()), float(extents.max())
            if not shortest > 0.0:
                return None
        if self._crossings is not None:
            dual = polyhedron.normals / polyhedron.offsets[:, None]
            shared = shared_by_planes(dual, self._crossings, self._target.rays.weight)
        volume = polyhedron.volume
        found = {
            "volume": volume,
            "sphericity": float(np.cbrt(np.pi) * (6 * volume) ** (2 / 3) / polyhedron.surface_area),
            "min_diameter": shortest,
            "max_diameter": longest,
            "aspect_ratio": longest / shortest,
            "convex_hull_volume": volume,
        }
        # Descriptors that were added to the loss have no fast way.
        if others := tuple(key for key in LOSS_KEYS if key not in found):
            solid = ConvexPolyhedron.from_half_spaces(HalfSpaces(polyhedron.normals, polyhedron.offsets))
            found |= describe(solid, others)
        errors = relative_errors(self._target.descriptors, found)
        jaccard_distance = jaccard(shared, 1.0, volume)
        return Evaluation(errors, jaccard_distance, loss(self._weights, errors, jaccard_distance))

    def value(self, normals: FloatArray, offsets: FloatArray) -> float:
        """The loss alone, infinite where the half-spaces bound no proper polyhedron."""
        found = self(normals, offsets)
        return np.inf if found is None else found.loss


def box_extents(polyhedron: MeasuredPolyhedron) -> FloatArray:
    """Edges of the minimum-volume box, shape (3,).

    Edges of the polyhedron that are too short to have a direction are passed over, as if their ends were one
    vertex.
    """
    vertices, edges = polyhedron.vertices, polyhedron.edges
    lengths = np.linalg.norm(vertices[edges[:, 1]] - vertices[edges[:, 0]], axis=1)
    points = np.ascontiguousarray(vertices.T)
    axes = minimum_box(Facets(points, polyhedron.normals, edges[lengths >= NO_EDGE]))
    return np.asarray(np.ptp(axes @ points, axis=1))
