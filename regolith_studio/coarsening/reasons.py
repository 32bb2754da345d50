"""Why a result is not as asked: terms that were to be kept and are missed, and missing facets."""

from collections.abc import Iterable, Mapping

from regolith_studio.coarsening.lower_bounds import sphericity_reason
from regolith_studio.coarsening.weights import WEIGHT_KEYS, LossWeights
from regolith_studio.descriptors.describe import relative_errors
from regolith_studio.messages import N_, Message, Number, join_messages

EXACT = 1e-6
"""Relative errors up to this count as none."""
NAMES = {
    "jaccard_distance": N_("Jaccard distance"),
    "volume": N_("volume"),
    "sphericity": N_("sphericity"),
    "aspect_ratio": N_("aspect ratio"),
    "min_diameter": N_("min diameter"),
    "max_diameter": N_("max diameter"),
    "convex_hull_volume": N_("convex hull volume"),
}
"""Of terms inside a sentence."""
MISSED = N_(
    "No polyhedron with {faces} facets was found that meets all descriptors; this one misses {missed}."
    " Set a weight to 0 to ignore a descriptor."
)
THIS_MISSES = N_("This one misses {missed}.")
MISSED_BY = N_("{name} by {error} %")


def kept_sentence(weights: LossWeights) -> Message:
    """Which terms the exact methods keep with these weights, and which have a price only."""
    kept, prices = (
        join_messages((Message(NAMES.get(key, key)) for key in keys), ", ")
        for keys in (
            [key for key in WEIGHT_KEYS if key in weights.kept],
            [key for key in WEIGHT_KEYS if weights[key] and key not in weights.kept],
        )
    )
    if not weights.kept:
        return Message(N_("The exact method keeps no descriptor."))
    if not prices:
        return Message(N_("The exact method keeps {kept}."), kept=kept)
    return Message(N_("The exact method keeps {kept}; weighed: {prices}."), kept=kept, prices=prices)


def missed_terms(
    target: Mapping[str, float], achieved: Mapping[str, float], keep: Iterable[str]
) -> dict[str, float]:
    """Relative errors above :data:`EXACT` of the descriptors to be kept, the largest first."""
    keys = tuple(keep)
    errors = relative_errors(target, achieved, keys)
    return {key: errors[key] for key in sorted(keys, key=lambda key: -errors[key]) if errors[key] > EXACT}


def named_errors(missed: Mapping[str, float]) -> Message:
    """Names and errors of descriptors in one phrase."""
    return join_messages(
        (
            Message(MISSED_BY, name=Message(NAMES[key]) if key in NAMES else key, error=_per_cent(error))
            for key, error in missed.items()
        ),
        ", ",
    )


def _per_cent(error: float) -> str:
    """Two digits, and no power of ten for errors of 100 per cent and more."""
    return Number(100 * error, ".2g") if error < 0.995 else Number(100 * error, ".0f")


def reason_for(
    target: Mapping[str, float],
    achieved: Mapping[str, float],
    keep: Iterable[str],
    n_facets: int,
    n_real: int,
    free_distance: float,
) -> str | None:
    """Sentences that name every term that is missed, what it costs, and missing facets.

    They say what was found; that more cannot be is said only where Goldberg's bound proves it. ``None`` where
    all of `keep` is met to 1e-6 with `n_real` = `n_facets` facets. `free_distance` is the Jaccard distance
    where the overlap alone counts.
    """
    keys = tuple(keep)
    missed = missed_terms(target, achieved, keys)
    if not missed:
        return None if n_real == n_facets else facets_reason(n_real, n_facets)
    proof = sphericity_reason(target["sphericity"], n_facets) if "sphericity" in keys else None
    sentences = (
        [Message(MISSED, faces=n_facets, missed=named_errors(missed))]
        if proof is None
        else [proof, Message(THIS_MISSES, missed=named_errors(missed))]
    )
    sentences.append(
        Message(
            N_("With the overlap alone the Jaccard distance would be {free}."),
            free=Number(free_distance, ".3f"),
        )
    )
    if n_real != n_facets:
        template = N_("The result has {real} facets instead of {faces}.")
        sentences.append(Message(template, real=n_real, faces=n_facets))
    return join_messages(sentences)


def own_reason(n_own: int, n_facets: int) -> str | None:
    """One sentence about a convex particle with fewer facets than it shall have, which is its own result."""
    if n_own == n_facets:
        return None
    return Message(
        N_(
            "The result has {real} facets instead of {faces}: the particle is a convex polyhedron with {real}"
            " facets itself."
        ),
        real=n_own,
        faces=n_facets,
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
