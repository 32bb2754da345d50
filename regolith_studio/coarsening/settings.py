"""Settings of a coarsening: target, method, weights, stopping criterion, seed (section 2.4).

Imports no numerics: the command line makes its options of these fields.
"""

from dataclasses import dataclass

from regolith_studio.messages import N_
from regolith_studio.settings import check_settings, setting

DEFAULT_METHOD = "exact"
DEFAULT_PRESET = "all"
FACETS_LIMITS = (5, 500)
"""Section 2.4 asks for n > 4."""
MAX_SEED = 2**63 - 1


@dataclass(frozen=True)
class CoarseningSettings:
    """What a polyhedron imitates, how it is found, and what says how fine it is."""

    target: str = setting(
        "particle",
        N_("Target"),
        N_("What the coarsening imitates: the particle, or its fit (section 3.2 of the paper)."),
        choices={"fit": N_("Spherical-harmonics fit"), "particle": N_("Particle")},
    )
    method: str = setting(
        DEFAULT_METHOD,
        N_("Coarsening method"),
        N_("Coarsening method: exact, annealing, quadric, pchs, or compound (a union of convex parts)."),
        symbol=N_("Method"),
        metavar="NAME",
    )
    preset: str = setting(
        DEFAULT_PRESET,
        N_("Preset"),
        N_(
            "Preset of the loss weights (Eq. 9): quadric, descriptors, volume_sphericity_aspect_ratio, "
            "aspect_ratio_overlap, overlap, all, size, hull or shape_first."
        ),
        metavar="NAME",
    )
    stop_at: str = setting(
        "facets",
        N_("Stopping criterion"),
        N_("Which of n_facets, n_triangles, n_vertices and largest_error says how fine polyhedra are."),
        symbol=N_("Limit"),
        choices={
            "facets": N_("Facets"),
            "triangles": N_("Triangles"),
            "vertices": N_("Vertices"),
            "error": N_("Error ≤"),
        },
    )
    n_facets: int = setting(
        20,
        N_("Number of facets"),
        N_("Number of facets of each polyhedron; n in general position have 2n−4 vertices, 4n−12 triangles."),
        minimum=FACETS_LIMITS[0],
        maximum=FACETS_LIMITS[1],
        slider=(FACETS_LIMITS[0], 60),
        option="--facets",
    )
    n_triangles: int = setting(
        68,
        N_("Maximum number of triangles"),
        N_("The number of facets follows from it: n facets have at most 4n−12 triangles."),
        minimum=8,
        maximum=1_000_000,
        slider=(8, 228),
        option="--triangles",
    )
    n_vertices: int = setting(
        64,
        N_("Maximum number of vertices"),
        N_("The number of facets follows from it: n facets have at most 2n−4 vertices."),
        minimum=6,
        maximum=1_000_000,
        slider=(6, 128),
        option="--vertices",
    )
    largest_error: float = setting(
        0.01,
        N_("Largest error"),
        N_(
            "The smallest number of facets is sought at which no weighted descriptor has a larger error. "
            "V and CH cannot both be met: of their errors only what exceeds the lower bound counts."
        ),
        unit="%",
        factor=100.0,
        maximum=0.5,
        step=0.0005,
        slider=(0.0005, 0.1),
        option="--max-error",
    )
    seed: int = setting(
        0,
        N_("Seed"),
        N_("Seed of the random numbers: the same seed gives the same result."),
        minimum=0,
        maximum=MAX_SEED,
    )

    def __post_init__(self) -> None:
        check_settings(self)
