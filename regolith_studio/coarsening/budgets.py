"""Other ways to say how fine a polyhedron shall be: by triangles, or by the largest error."""

from collections.abc import Generator
from dataclasses import dataclass
from typing import Any

from regolith_studio.coarsening.coarsen import DEFAULT_METHOD, FACES_LIMITS, coarsen
from regolith_studio.coarsening.result import Coarsened
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import JACCARD, LossWeights
from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh


@dataclass(frozen=True)
class Trial:
    """One number of faces that was tried, and how it went."""

    n_faces: int
    largest_error: float
    result: Coarsened


def faces_for_triangles(n_triangles: int) -> int:
    """Most facets whose polyhedron has at most `n_triangles` triangles: 4 n - 12 in general position.

    For solvers that count triangles.

    Raises
    ------
    InputError
        If the budget does not reach for 5 facets.
    """
    n_faces = (int(n_triangles) + 12) // 4
    low, high = FACES_LIMITS
    if n_faces < low:
        raise InputError(f"{n_triangles} triangles are too few: {low} faces have up to {4 * low - 12}.")
    return min(n_faces, high)


def largest_error(result: Coarsened, weights: LossWeights, jaccard_limit: float | None = None) -> float:
    """Largest relative error of the weighted descriptors, beyond what no polyhedron can avoid.

    V and CH cannot both be met; of the one that gives way only the excess over its bound counts. With
    `jaccard_limit` the Jaccard distance takes part, scaled so that the limit counts as no error.
    """
    errors = [
        max(0.0, error - result.bounds[key]) if key in ("volume", "convex_hull_volume") else error
        for key, error in result.errors.items()
        if weights[key]
    ]
    if jaccard_limit is not None:
        errors.append(max(0.0, result.jaccard_distance - jaccard_limit))
    return max(errors, default=0.0)


def fewest_faces(
    mesh: Mesh | Target,
    limit: float,
    jaccard_limit: float | None = None,
    method: str = DEFAULT_METHOD,
    weights: LossWeights | None = None,
    seed: int = 0,
    particle_index: int = 0,
    settings: Any = None,
) -> Generator[Trial, None, Coarsened]:
    """The polyhedron with the fewest faces whose weighted descriptors are all off by at most `limit`.

    Doubles the number of faces from 5 until the limit is met, then halves the interval; yields each trial.

    Parameters
    ----------
    limit
        Relative error, for example 0.01.
    jaccard_limit
        The Jaccard distance must not exceed it either, where given.

    Raises
    ------
    InputError
        If the limit is not positive, or not even 200 faces meet it.
    """
    if not limit > 0.0:
        raise InputError(f"The largest error must be above 0, got {limit}.")
    if weights is None:
        weights = LossWeights.from_preset("all")
    if jaccard_limit is None and weights.replaced(**{JACCARD: 0.0}).all_zero:
        raise InputError("No descriptor has a weight, so there is no error to stop at.")
    target = mesh if isinstance(mesh, Target) else Target.of(mesh)

    def tried(n_faces: int) -> Trial:
        found = coarsen(target, n_faces, method, weights, seed, particle_index, settings)
        return Trial(n_faces, largest_error(found, weights, jaccard_limit), found)

    low, high = FACES_LIMITS
    failed, n_faces = low - 1, low
    while True:
        trial = tried(n_faces)
        yield trial
        if trial.largest_error <= limit:
            break
        if n_faces == high:
            raise InputError(
                f"Not even {high} faces bring all errors below {100 * limit:g} %:"
                f" the largest is still {100 * trial.largest_error:.2g} %."
            )
        failed, n_faces = n_faces, min(2 * n_faces, high)
    best = trial
    while best.n_faces - failed > 1:
        trial = tried((best.n_faces + failed) // 2)
        yield trial
        if trial.largest_error <= limit:
            best = trial
        else:
            failed = trial.n_faces
    return best.result
