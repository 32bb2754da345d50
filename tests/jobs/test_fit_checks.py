"""A fit whose descriptors are far from those of its particle says so, and which degree would be near."""

import re
from dataclasses import replace

import numpy as np
import pytest

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.jobs.particle_jobs import TOLERANCE, FitRequest, check_fits, draw_surface, fit_sample
from regolith_studio.messages import Message
from regolith_studio.steps import result_of


def bumpy(amplitude: float, degree: int) -> Mesh:
    """A sphere with waves that harmonics below `degree` do not have."""
    sphere = icosphere(4)
    x, y = sphere.vertices[:, 0], sphere.vertices[:, 1]
    waves = np.real((x + 1j * y) ** degree)
    return Mesh(sphere.vertices * (1 + amplitude * waves)[:, None], sphere.faces)


def sentence(mesh: Mesh, l_max: int) -> str:
    particles, request = [Particle("grain", mesh)], FitRequest(l_max)
    return result_of(check_fits(particles, result_of(fit_sample(particles, request)), request))[0]


def test_that_a_fit_without_the_waves_of_its_grain_names_the_degree_that_has_them() -> None:
    assert TOLERANCE == 0.05
    said = sentence(bumpy(0.2, 12), 10)
    assert re.match(r"At l = 10 off by more than 5 %: Sphericity \d+ %, ", said)
    assert said.endswith("; l_max 15 would do.")


def test_that_a_near_fit_says_nothing() -> None:
    assert sentence(bumpy(0.2, 12), 20) == ""
    egg = icosphere(3)
    assert sentence(Mesh(egg.vertices * [1.0, 1.2, 1.5], egg.faces), 8) == ""


def test_that_a_fit_with_negative_radii_is_refused_in_a_sentence_that_can_be_translated() -> None:
    values = np.zeros(9)
    values[0], values[6] = np.sqrt(4 * np.pi), 4.0
    sphere = fit_harmonics(icosphere(3), 2)
    with pytest.raises(GeometryError, match="up to l = 2 has negative radii and bounds no solid") as refusal:
        result_of(draw_surface(replace(sphere, coefficients=ShCoefficients(values)), 2, 2))
    assert isinstance(str(refusal.value), Message)
