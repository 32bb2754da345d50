"""Coarsening: convex polyhedra with few facets that keep what matters of a particle (section 2.4)."""


def warm_up() -> None:
    """Compile every kernel, or load it from the cache on disk, on a tiny particle.

    To be called in a background thread at the start of a program with a window.
    """
    import numpy as np

    from regolith_studio.coarsening.coarsen import coarsen
    from regolith_studio.geometry.mesh import Mesh
    from regolith_studio.geometry.sphere_points import icosphere

    sphere = icosphere(2)
    egg = Mesh(sphere.vertices * (1.0, 0.8, 0.6) + 0.1 * np.abs(sphere.vertices), sphere.faces)
    coarsen(egg, 8, "annealing", settings={"iterations": 2, "facet_repair": True})
    coarsen(egg, 8, "exact")
