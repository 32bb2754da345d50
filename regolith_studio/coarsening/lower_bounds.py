"""Lower bounds of the errors of any convex polyhedron with n facets, and the reasons that follow."""

from collections.abc import Mapping

import numpy as np

from regolith_studio.coarsening.weights import JACCARD, LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.messages import N_, Message, Number

MAX_FACETS = 100_000
"""Sphericities that ask for more facets count as unreachable."""
PREMISE_TOLERANCE = 1e-5
"""Relative error up to which V or CH counts as exact."""


def max_sphericity(n_facets: int) -> float:
    """Upper bound of Wadell's sphericity of a convex polyhedron with 4 or more facets (Goldberg 1935).

    Attained by the tetrahedron, the cube and the dodecahedron (n = 4, 6, 12).
    """
    if n_facets < 4:
        raise ValueError(f"a polyhedron has at least 4 facets, got {n_facets}")
    w = n_facets * np.pi / (6 * (n_facets - 2))
    return float((36 * np.pi / (54 * (n_facets - 2) * np.tan(w) * (4 * np.sin(w) ** 2 - 1))) ** (1 / 3))


def min_facets(sphericity: float) -> int | None:
    """Fewest facets whose Goldberg bound reaches `sphericity`; ``None`` above 100,000 facets."""
    if max_sphericity(MAX_FACETS) < sphericity:
        return None
    low, high = 4, MAX_FACETS
    while low < high:
        middle = (low + high) // 2
        low, high = (low, middle) if max_sphericity(middle) >= sphericity else (middle + 1, high)
    return low


def volume_is_preferred(weights: LossWeights, descriptors: Mapping[str, float]) -> bool:
    """Whether V is kept and CH misses: a convex polyhedron has V = CH, a particle V < CH.

    Eq. 9 is least at one of the two ends: at V where alpha_V / V >= alpha_CH / CH, else at CH.
    """
    volume = weights["volume"] / descriptors["volume"]
    hull = weights["convex_hull_volume"] / descriptors["convex_hull_volume"]
    return volume >= hull


def attainable_errors(
    descriptors: Mapping[str, float], n_facets: int, weights: LossWeights
) -> dict[str, float]:
    """Least relative error of each term of the loss, for any convex polyhedron with `n_facets` facets.

    V and CH are bounded together: the one that the weights prefer can be met, the other misses by the
    solidity s = V/CH: 1 - s or 1/s - 1. The Jaccard distance is at least that of the volumes alone.
    Sphericity follows Goldberg's bound; all others have the bound 0.
    """
    solidity = min(1.0, descriptors["volume"] / descriptors["convex_hull_volume"])
    keep_volume = volume_is_preferred(weights, descriptors)
    free = not (weights["volume"] or weights["convex_hull_volume"])
    return dict.fromkeys(LOSS_KEYS, 0.0) | {
        JACCARD: 0.0 if keep_volume or free else 1.0 - solidity,
        "volume": 0.0 if keep_volume else 1.0 / solidity - 1.0,
        "sphericity": max(0.0, 1.0 - max_sphericity(n_facets) / descriptors["sphericity"]),
        "convex_hull_volume": 1.0 - solidity if keep_volume else 0.0,
    }


def bounds_in_force(bounds: Mapping[str, float], errors: Mapping[str, float]) -> dict[str, float]:
    """The bounds whose premise a polyhedron with these errors meets; the others are 0.

    V and CH are bounded together: the bound of the one holds where the other is exact, that of the Jaccard
    distance where CH is. A polyhedron that is smaller than the preferred volume may be below them.
    """
    held = dict(bounds)
    if errors["volume"] > PREMISE_TOLERANCE:
        held["convex_hull_volume"] = 0.0
    if errors["convex_hull_volume"] > PREMISE_TOLERANCE:
        held["volume"] = held[JACCARD] = 0.0
    return held


def sphericity_reason(sphericity: float, n_facets: int) -> str | None:
    """Why `n_facets` facets cannot have this sphericity, or ``None`` if Goldberg's bound allows it."""
    limit = max_sphericity(n_facets)
    if sphericity <= limit:
        return None
    # As many digits as it takes for the two numbers to differ in print.
    digits = next((d for d in range(3, 9) if f"{sphericity:.{d}f}" != f"{limit:.{d}f}"), 9)
    shown, most = Number(sphericity, f".{digits}f"), Number(limit, f".{digits}f")
    values = {"sphericity": shown, "faces": n_facets, "most": most}
    if (needed := min_facets(sphericity)) is None:
        template = N_(
            "Sphericity {sphericity} needs more than 100,000 facets; with {faces} the most is {most}."
        )
        return Message(template, **values)
    template = N_("Sphericity {sphericity} needs at least {needed} facets; with {faces} the most is {most}.")
    return Message(template, needed=needed, **values)
