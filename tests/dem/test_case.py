"""Tables 1 and 2, coarse graining, and what the number of particles means."""

import pickle
from dataclasses import fields

import numpy as np
import pytest

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.parameters import (
    NOT_GIVEN,
    ContactParameters,
    DrumRotation,
    LiftingCylinderTest,
    missing_in_paper,
)
from regolith_studio.dem.case import ReposeCase, bond_number, prepare, rayleigh_time, scaling_report
from regolith_studio.errors import InputError


def test_that_the_defaults_are_the_paper_s_tables() -> None:
    contact, test = ContactParameters(), LiftingCylinderTest()
    assert (contact.density, contact.youngs_modulus, contact.poissons_ratio) == (3075.0, 30e9, 0.2)
    assert (contact.static_friction, contact.dynamic_friction, contact.surface_energy) == (0.8, 0.8, 0.01)
    assert (test.diameter, test.height, test.mass) == (0.02, 0.08, 0.015)


def test_that_what_the_paper_does_not_give_is_marked() -> None:
    assert missing_in_paper(ContactParameters) == ("rolling_friction", "restitution")
    assert missing_in_paper(LiftingCylinderTest) == (
        "lift_speed",
        "wall_friction",
        "plate_friction",
        "gravity",
    )
    marks = {
        each.metadata["source"] for kind in (ContactParameters, LiftingCylinderTest) for each in fields(kind)
    }
    assert marks == {"Table 1", "Table 2", NOT_GIVEN}


@pytest.mark.parametrize(
    ("kind", "name", "value"),
    [
        (ContactParameters, "static_friction", -0.1),
        (ContactParameters, "density", float("nan")),
        (ContactParameters, "restitution", 1.5),
        (LiftingCylinderTest, "gravity", 0.0),
        (LiftingCylinderTest, "mass", -1.0),
        (ReposeCase, "n_particles", 3),
        (ReposeCase, "seed", -1),
        (ReposeCase, "shapes", "stars"),
        (ReposeCase, "cohesion", "glue"),
        (ReposeCase, "bond_number", -1.0),
        (DrumRotation, "rpm", 0.0),
        (DrumRotation, "moments", 3),
    ],
)
def test_that_an_impossible_value_is_one_sentence(kind: type, name: str, value: object) -> None:
    with pytest.raises(InputError) as refusal:
        kind(**{name: value})
    assert str(refusal.value).endswith(".")


def test_that_coarse_graining_gives_the_particles_the_mass_of_the_test(boxes: Dataset) -> None:
    prepared = prepare(boxes, ReposeCase(n_particles=500))
    volume = np.pi / 6 * (prepared.diameters**3).sum()
    assert 3075.0 * volume == pytest.approx(0.015)
    assert prepared.mass == pytest.approx(0.015)
    assert prepared.fill_height == pytest.approx(0.015 / 3075 / 0.55 / (np.pi * 0.01**2))
    assert set(np.round(prepared.diameters / prepared.coarse_graining * 1e6, 6)) == {80.0, 100.0}


def test_that_eight_times_the_particles_are_half_the_size(boxes: Dataset) -> None:
    few, many = (prepare(boxes, ReposeCase(n_particles=n)) for n in (1000, 8000))
    assert many.coarse_graining / few.coarse_graining == pytest.approx(0.5, rel=0.01)


def test_that_scaled_cohesion_keeps_its_ratio_to_weight(boxes: Dataset) -> None:
    prepared = prepare(boxes, ReposeCase(n_particles=500, cohesion="scaled"))
    ratio = prepared.coarse_graining / 10
    assert prepared.surface_energy == pytest.approx(0.01 * ratio**2)
    at_ten = bond_number(0.01, prepared.mean_diameter / ratio, 3075, 9.81)
    assert scaling_report(prepared).bond_number[2] == pytest.approx(at_ten)


def test_that_the_bond_number_is_pull_off_over_weight() -> None:
    """3/2 pi w d/4 over rho pi/6 d^3 g is 9 w / (4 rho g d^2)."""
    on_earth = bond_number(0.010, 250e-6, 3075, 9.81)
    assert on_earth == pytest.approx(9 * 0.010 / (4 * 3075 * 9.81 * 250e-6**2))
    assert bond_number(0.010, 250e-6, 3075, 1.62) / on_earth == pytest.approx(9.81 / 1.62)


def test_that_full_stiffness_needs_twenty_million_steps_a_second() -> None:
    """25 um particles ten times enlarged, a fifth of Rayleigh's time."""
    assert 1 / (0.2 * rayleigh_time(250e-6, 3075, 30e9, 0.2)) == pytest.approx(20e6, rel=0.3)


def test_that_a_cylinder_too_narrow_or_too_low_is_refused(boxes: Dataset) -> None:
    with pytest.raises(InputError, match="wider cylinder"):
        prepare(boxes, ReposeCase(n_particles=20))
    with pytest.raises(InputError, match="only 2 cm high"):
        prepare(boxes, ReposeCase(LiftingCylinderTest(height=0.02), n_particles=1000))


def test_that_a_prepared_case_travels_between_processes(boxes: Dataset) -> None:
    prepared = prepare(boxes, ReposeCase(n_particles=200, seed=3))
    copy = pickle.loads(pickle.dumps(prepared))
    assert np.array_equal(copy.diameters, prepared.diameters)
    assert copy.case == prepared.case
    assert copy.mean_facets == prepared.mean_facets == 6.0
    assert not copy.diameters.flags.writeable
