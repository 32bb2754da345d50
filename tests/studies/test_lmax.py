"""The study of l_max: Eq. 10 by hand, bands, failures, tables and figures."""

import csv
import json

import numpy as np
import pytest

from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.describe import describe, rmsre
from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.oriented_box import minimum_volume_box
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.harmonics.fit_options import FitOptions
from regolith_studio.harmonics.synthesis import reconstruct
from regolith_studio.readers.particles import sample_particles
from regolith_studio.studies.figures.degrees import lmax_figure, write_lmax_study
from regolith_studio.studies.lmax import (
    LmaxStudy,
    enough_degrees,
    lmax_errors,
    lmax_study,
    particle_table,
    rmsre_table,
)
from tests.steps import played

DEGREES = (1, 4, 8)


@pytest.fixture(scope="module")
def particles():
    sphere = icosphere(3)
    shapes = [(2.0, 1.5, 1.0), (1.4, 1.2, 1.0), (1.8, 1.0, 0.9)]
    groups = ["long", "round", "long"]
    return [
        Particle(f"grain {i}", Mesh(sphere.vertices * shape, sphere.faces), group)
        for i, (shape, group) in enumerate(zip(shapes, groups, strict=True))
    ]


@pytest.fixture(scope="module")
def study(particles):
    return played(lmax_study(particles, DEGREES))[1]


@pytest.fixture
def made_up():
    """Four particles of two groups with known errors, one of them missing at the second degree."""
    errors = np.array([[[0.3], [0.03]], [[-0.4], [np.nan]], [[0.1], [0.01]], [[0.1], [0.01]]])
    return LmaxStudy((2, 5), ("volume",), ("a", "b", "c", "d"), ("x", "x", "y", "y"), errors)


@pytest.mark.slow
def test_that_the_rmsre_is_equation_ten_of_the_same_fits(study, particles):
    fits = [fit_harmonics(particle.mesh, 8) for particle in particles]
    wanted = [describe(particle.mesh, LOSS_KEYS) for particle in particles]
    boxes = ("volume", "min_diameter", "max_diameter", "aspect_ratio")
    for row, degree, level in zip(study.rmsre(), DEGREES, (3, 3, 4), strict=True):
        found = [describe(reconstruct(fit, degree, level=level), LOSS_KEYS) for fit in fits]
        expected = rmsre(wanted, found, boxes)
        np.testing.assert_allclose(
            [row[LOSS_KEYS.index(key)] for key in boxes], [expected[key] for key in boxes], rtol=1e-6
        )


def test_that_errors_are_those_of_meshes_so_fine_that_finer_ones_change_nothing():
    keys = ("sphericity", "convex_hull_volume")
    grain = next(each.mesh for each in sample_particles() if each.name == "angular-1")
    wanted, fit = describe(grain, keys), fit_harmonics(grain, 10)
    for degree, errors in zip((2, 4, 10), lmax_errors(grain, (2, 4, 10), keys), strict=True):
        found = describe(reconstruct(fit, degree, level=6), keys)
        np.testing.assert_allclose(errors, [found[key] / wanted[key] - 1 for key in keys], atol=1e-3)


def test_that_rmsre_is_the_root_of_the_mean_square_over_those_that_have_a_value(made_up):
    np.testing.assert_allclose(made_up.rmsre("x")[:, 0], [np.sqrt((0.09 + 0.16) / 2), 0.03])
    np.testing.assert_allclose(made_up.rmsre()[0, 0], np.sqrt((0.09 + 0.16 + 0.02) / 4))
    assert made_up.n_used("x") == (2, 1)


def test_that_bands_hold_the_estimate_and_vanish_for_equal_particles(made_up):
    low, high = made_up.bands("x")
    assert low[0, 0] <= made_up.rmsre("x")[0, 0] <= high[0, 0]
    np.testing.assert_allclose([low[0, 0], high[0, 0]], [0.3, 0.4])
    np.testing.assert_allclose(made_up.bands("y"), np.broadcast_to(made_up.rmsre("y"), (2, 2, 1)))


def test_that_the_smallest_l_max_is_the_first_with_all_errors_below(made_up, study):
    assert made_up.smallest_l_max(0.05) == 5
    assert made_up.smallest_l_max(0.15, "y") == 2
    assert made_up.smallest_l_max(0.001) is None
    assert study.smallest_l_max(1.0) in DEGREES
    lines = enough_degrees(made_up, 0.15).splitlines()
    assert lines[1] == "l_max = 2 is the smallest with every RMSRE of y below 15 %."
    assert enough_degrees(made_up, 0.001).startswith("No l_max that was studied is enough with every RMSRE")


def test_that_each_particle_is_told_of_with_the_study_so_far(particles):
    events, result = played(lmax_study(particles, (1, 2)))
    assert [(e.done, e.total, e.message) for e in events] == [(i + 1, 3, f"grain {i}") for i in range(3)]
    assert [len(e.partial.names) for e in events] == [1, 2, 3]
    np.testing.assert_array_equal(events[-1].partial.errors, result.errors)


def test_that_a_broken_particle_is_listed_and_stops_nothing(particles):
    mesh = particles[0].mesh
    broken = Particle("broken", Mesh(mesh.vertices, mesh.faces[1:]), "long")
    _, result = played(lmax_study([broken, *particles], (1,)))
    assert result.names == ("grain 0", "grain 1", "grain 2")
    assert result.failures[0][0] == "broken"
    assert "open" in result.failures[0][1]
    with pytest.raises(InputError, match=r"None of the 1 particles can be fitted: "):
        played(lmax_study([broken], (1,)))


def test_that_a_study_of_nothing_is_refused(particles):
    for arguments in (([], (1,)), (particles, ())):
        with pytest.raises(InputError, match=r"at least one particle and one degree"):
            played(lmax_study(*arguments))


def test_that_the_tables_hold_a_row_for_each_group_degree_and_descriptor(study):
    table = rmsre_table(study)
    assert len(table.rows) == 2 * len(DEGREES) * len(LOSS_KEYS)
    row = dict(zip([column.name for column in table.columns], table.rows[0], strict=True))
    assert (row["group"], row["l_max"], row["descriptor"], row["symbol"]) == ("long", 1, "volume", "V")
    assert row["rmsre"] == pytest.approx(100 * study.rmsre("long")[0, 0])
    assert row["n_particles"] == 2
    assert len(particle_table(study).rows) == 3 * len(DEGREES)


@pytest.mark.slow
def test_that_tables_and_figures_are_written_and_readable(study, tmp_path):
    paths = {path.name: path for path in write_lmax_study(study, tmp_path)}
    assert len(json.loads(paths["lmax_rmsre.json"].read_text())["rows"]) == 36
    with paths["lmax_particles.csv"].open(newline="") as lines:
        assert len(list(csv.reader(lines))) == 1 + 9
    assert paths["lmax_rmsre.png"].read_bytes().startswith(b"\x89PNG")
    drawing = paths["lmax_rmsre.svg"].read_text()
    assert drawing.rstrip().endswith("</svg>")
    write_lmax_study(study, tmp_path / "again")
    assert (tmp_path / "again" / "lmax_rmsre.svg").read_text() == drawing


@pytest.mark.slow
def test_that_the_smallest_diameter_steps_where_the_box_turns_and_the_surface_does_not():
    particle = next(each for each in sample_particles() if each.name == "agglutinate-1")
    own = minimum_volume_box(particle.mesh)
    fit = FitOptions().fit(particle.mesh, 30)
    boxes, extents = [], []
    for degree in (15, 18):
        surface = reconstruct(fit, degree, 5)
        boxes.append(minimum_volume_box(surface))
        extents.append(np.ptp(surface.vertices @ own.axes.T, axis=0).min() / own.min_diameter - 1)
    errors = [box.min_diameter / own.min_diameter - 1 for box in boxes]
    assert errors == pytest.approx([-0.046, 0.038], abs=0.01)
    assert extents == pytest.approx([-0.021, -0.026], abs=0.01)


def test_that_the_figure_has_a_panel_a_group_and_a_line_a_descriptor(study):
    figure = lmax_figure(study)
    assert [axis.get_title() for axis in figure.axes] == ["long (n = 2)", "round (n = 1)"]
    assert len(figure.axes[0].lines) == len(LOSS_KEYS)
    line = figure.axes[0].lines[1]
    np.testing.assert_allclose(line.get_ydata(), 100 * study.rmsre("long")[:, 1])


@pytest.mark.slow
@pytest.mark.real_data
def test_that_fig_3_of_real_grains_has_the_published_shape(real_data):
    """Volume falls steeply, the other errors are a few percent at l = 10 and level off (n = 20)."""
    import trimesh

    sample = []
    for path in sorted(real_data("cement140/smooth").glob("*.stl"))[:20]:
        loaded = trimesh.load(path)
        sample.append(Particle(path.stem, Mesh(loaded.vertices, loaded.faces), "cement"))
    _, result = played(lmax_study(sample, (2, 5, 10, 15)))
    at = {key: result.rmsre()[2, k] for k, key in enumerate(result.keys)}
    assert at["volume"] < 0.005
    assert 0.02 < at["sphericity"] < 0.07
    assert 0.02 < at["convex_hull_volume"] < 0.09


def test_that_a_study_without_particles_has_errors_and_bands_that_are_not_numbers():
    empty = LmaxStudy((2, 5), ("volume",), (), (), np.empty((0, 2, 1)))
    assert np.isnan(empty.rmsre()).all()
    assert np.isnan(empty.bands()).all()
    assert empty.bands().shape == (2, 2, 1)
