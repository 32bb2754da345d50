"""Distributions of measured and drawn particles: against closed forms for spheres."""

import numpy as np
import pytest

from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.jobs.model_jobs import compare_distributions
from regolith_studio.shape_models.realizations import Realizations
from regolith_studio.shape_models.sample import Sample
from regolith_studio.steps import result_of

RADII = np.array([1.0, 2.0, 3.0, 4.0])


def spheres(radii):
    """Coefficients of spheres: the mean radius is c_00 / sqrt(4 pi)."""
    rows = np.zeros((len(radii), 9))
    rows[:, 0] = np.sqrt(4.0 * np.pi) * radii
    return rows


@pytest.mark.slow
def test_that_spheres_have_their_radii_by_number_and_by_volume():
    assert ShCoefficients(spheres(RADII)[1]).mean_radius == pytest.approx(2.0)
    compared = result_of(
        compare_distributions(Sample(spheres(RADII)), Realizations(spheres(RADII[:2]), "radius", "x", 0))
    )
    measured, drawn = compared.distributions("equivalent_radius")
    assert measured.mean == pytest.approx(2.5, rel=1e-3)
    assert drawn.mean == pytest.approx(1.5, rel=1e-3)
    measured, _drawn = compared.distributions("equivalent_radius", "volume")
    assert measured.mean == pytest.approx((RADII**4).sum() / (RADII**3).sum(), rel=1e-3)
    measured, _drawn = compared.distributions("sphericity")
    assert measured.mean == pytest.approx(1.0, abs=0.01)


@pytest.mark.slow
def test_that_a_model_without_particles_has_drawn_ones_only():
    compared = result_of(compare_distributions(None, Realizations(spheres(RADII), "radius", "x", 0)))
    measured, drawn = compared.distributions("aspect_ratio")
    assert measured is None
    assert len(drawn.values) == 4
