"""The functions for notebooks take what the readers give."""

import numpy as np
import pytest

import regolith_studio as rs


@pytest.mark.parametrize("work", ["describe", "fit_harmonics", "coarsen"])
def test_that_a_particle_counts_as_its_mesh(work):
    particle = next(each for each in rs.sample_particles() if each.name == "angular-1")
    of_particle, of_mesh = getattr(rs, work)(particle), getattr(rs, work)(particle.mesh)
    if work == "describe":
        assert of_particle == of_mesh
    elif work == "fit_harmonics":
        assert np.array_equal(of_particle.coefficients.values, of_mesh.coefficients.values)
    else:
        assert np.array_equal(of_particle.polyhedron.vertices, of_mesh.polyhedron.vertices)
