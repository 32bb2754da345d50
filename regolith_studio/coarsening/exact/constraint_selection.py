"""From weights to constraints: which descriptors are kept exactly, and why some cannot be."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from regolith_studio.coarsening.exact.constraints import Problem
from regolith_studio.coarsening.lower_bounds import sphericity_reason, volume_is_preferred
from regolith_studio.coarsening.target import RayTable, Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.comparison import relative_errors
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.messages import N_, Message, Number, join_messages

CONSTRAINT_KEYS = ("volume", "sphericity", "min_diameter", "max_diameter", "aspect_ratio")
"""Descriptors in the order of :mod:`regolith_studio.coarsening.exact.constraints`."""


EXACT = 1e-6
"""Relative errors up to this count as none."""


NEARLY = 5e-3
"""Relative errors up to this are of constraints that were meant to be met."""


FLAT, COPLANAR = 1e-6, 1e-5
"""Concavity and triangles that count as none; difference of the planes of one facet. At unit volume."""


NAMES = {
    "volume": N_("volume"),
    "sphericity": N_("sphericity"),
    "aspect_ratio": N_("aspect ratio"),
    "min_diameter": N_("min diameter"),
    "max_diameter": N_("max diameter"),
    "convex_hull_volume": N_("convex hull volume"),
}
"""Of descriptors inside a sentence."""
MISSED = N_(
    "No polyhedron with {faces} facets was found that meets all descriptors; this one misses {missed}."
    " A weight of 0 frees a descriptor."
)
THIS_MISSES = N_("This one misses {missed}.")
MISSED_BY = N_("{name} by {error} %")


@dataclass(frozen=True)
class ConstraintRequest:
    """What is kept exactly.

    Parameters
    ----------
    values
        Wanted values in the order of :data:`CONSTRAINT_KEYS`, for the particle of unit volume.
    asked
        Which of them are constraints. The aspect ratio follows where both diameters are asked for.
    keeps_hull
        Whether V is sacrificed to CH.
    ratio_counts
        Whether the aspect ratio is asked for, as a constraint or by both diameters.
    """

    values: tuple[float, ...]
    asked: tuple[bool, ...]
    keeps_hull: bool
    ratio_counts: bool

    @classmethod
    def of(cls, target: Target, weights: LossWeights) -> "ConstraintRequest":
        """A weight above 0 makes a constraint; of V and CH the one that Eq. 9 prefers."""
        wanted = target.descriptors
        keeps_volume = volume_is_preferred(weights, wanted)
        volume = wanted["volume"] if keeps_volume else wanted["convex_hull_volume"]
        box = (weights["min_diameter"] > 0, weights["max_diameter"] > 0)
        asked = (
            weights["volume"] > 0 or weights["convex_hull_volume"] > 0,
            weights["sphericity"] > 0,
            *box,
            weights["aspect_ratio"] > 0 and not all(box),
        )
        values = (volume, *[wanted[key] for key in CONSTRAINT_KEYS[1:]])
        return cls(values, asked, not keeps_volume, weights["aspect_ratio"] > 0)

    @property
    def keys(self) -> tuple[str, ...]:
        """Descriptors that are constraints."""
        return tuple(key for key, asked in zip(CONSTRAINT_KEYS, self.asked, strict=True) if asked)

    def nearly_met_by(self, found: Mapping[str, float], nearly: float) -> "ConstraintRequest":
        """The same constraints, but at the value of `found` where its relative error is above `nearly`."""
        values = tuple(
            value if abs(found[key] / value - 1.0) <= nearly else found[key]
            for key, value in zip(CONSTRAINT_KEYS, self.values, strict=True)
        )
        return replace(self, values=values)

    def problem(
        self, rays: RayTable, sample_angle: float, only_volume: bool = False, sphericity: bool = True
    ) -> Problem:
        """The problem to solve; `only_volume` leaves out all other constraints, not `sphericity` that one."""
        asked = np.array(self.asked)
        if only_volume:
            asked[1:] = False
        asked[1] &= sphericity
        return Problem(rays, np.log(self.values), asked, sample_angle, 0)


def reason_for(
    target: Target, request: ConstraintRequest, n_facets: int, n_real: int, found: Mapping[str, float]
) -> str | None:
    """Sentences that name every constraint that is missed, the largest error first, and missing facets.

    They say what was found; that more cannot be is said only where Goldberg's bound proves it. ``None`` where
    the descriptors `found` meet all constraints to 1e-6 with `n_real` = `n_facets` facets.
    """
    missed = missed_constraints(target, request, found)
    if not missed:
        return None if n_real == n_facets else facets_reason(n_real, n_facets)
    listed, proof = _listed(missed, request), None
    if "sphericity" in request.keys:
        proof = sphericity_reason(target.descriptors["sphericity"], n_facets)
    reason = (
        Message(MISSED, faces=n_facets, missed=listed)
        if proof is None
        else join_messages([proof, Message(THIS_MISSES, missed=listed)])
    )
    if n_real == n_facets:
        return reason
    template = N_("The result has {real} facets instead of {faces}.")
    return join_messages([reason, Message(template, real=n_real, faces=n_facets)])


def missed_constraints(
    target: Target, request: ConstraintRequest, found: Mapping[str, float]
) -> dict[str, float]:
    """Relative errors above :data:`EXACT` of the descriptors that are constraints."""
    errors = relative_errors(target.descriptors, found)
    missed = {key: errors[_reported(key, request)] for key in request.keys}
    if request.ratio_counts:
        missed["aspect_ratio"] = errors["aspect_ratio"]
    return {key: error for key, error in missed.items() if error > EXACT}


def _listed(missed: Mapping[str, float], request: ConstraintRequest) -> Message:
    """Names and errors of descriptors, the largest first."""
    names = {key: _reported(key, request) for key in sorted(missed, key=lambda key: -missed[key])}
    return join_messages(
        (
            Message(MISSED_BY, name=Message(NAMES[name]), error=_per_cent(missed[key]))
            for key, name in names.items()
        ),
        ", ",
    )


def _per_cent(error: float) -> str:
    """Two digits, and no power of ten for errors of 100 per cent and more."""
    return Number(100 * error, ".2g") if error < 0.995 else Number(100 * error, ".0f")


def own_planes(target: Target, below: int) -> HalfSpaces | None:
    """Half-spaces of a particle that is a convex polyhedron with fewer than `below` facets; else ``None``."""
    descriptors, hull = target.descriptors, target.mesh.hull
    if descriptors["volume"] < (1.0 - FLAT) * descriptors["convex_hull_volume"]:
        return None
    areas = hull.face_areas
    sound = areas > FLAT
    normals = hull.face_area_vectors[sound] / areas[sound, None]
    planes = np.column_stack([normals, np.einsum("ij,ij->i", normals, hull.triangles[sound, 0])])
    left = planes[np.argsort(-areas[sound], kind="stable")]
    kept: list[FloatArray] = []
    while len(left) and len(kept) < below:
        kept.append(left[0])
        left = left[np.abs(left - left[0]).max(axis=1) > COPLANAR]
    own = np.array(kept)
    return HalfSpaces(own[:, :3], own[:, 3]) if len(own) < below else None


def own_reason(n_own: int, n_facets: int) -> str:
    """One sentence about a convex particle with fewer facets than it shall have."""
    return Message(
        N_(
            "The result has {real} facets instead of {faces}: the particle is convex and has {facets} facets"
            " itself, and no other polyhedron was found that meets all descriptors."
        ),
        real=n_own,
        faces=n_facets,
        facets=n_own,
    )


def facets_reason(n_real: int, n_facets: int) -> str:
    """One sentence about half-spaces that bound no facet."""
    return Message(
        N_(
            "The result has {real} facets instead of {faces}: no place was found where the other half-spaces"
            " bound a facet and all descriptors are met."
        ),
        real=n_real,
        faces=n_facets,
    )


def _reported(key: str, request: ConstraintRequest) -> str:
    return "convex_hull_volume" if key == "volume" and request.keeps_hull else key
