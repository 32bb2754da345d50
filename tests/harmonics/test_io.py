"""Tables of other programs, and the document and arrays of a fitted sample."""

import csv
import json

import numpy as np
import pyshtools
import pytest
from scipy.special import sph_harm_y

from regolith_studio.errors import InputError
from regolith_studio.geometry.sphere_points import fibonacci_directions
from regolith_studio.harmonics.coefficients import ShCoefficients, degrees, orders, to_pyshtools
from regolith_studio.harmonics.fit import HarmonicFit, fit_harmonics
from regolith_studio.harmonics.io import (
    fits_arrays,
    fits_document,
    fits_from,
    from_complex_rows,
    from_shtools_rows,
)
from regolith_studio.harmonics.synthesis import radii, reconstruct
from tests.harmonics.tables import complex_rows, shtools_rows


def test_that_complex_rows_sum_up_to_the_radius_with_scipys_harmonics(rough):
    directions = fibonacci_directions(80)
    theta, phi = np.arccos(directions[:, 2]), np.arctan2(directions[:, 1], directions[:, 0])
    total = sum(
        (re + 1j * im) * sph_harm_y(int(degree), int(order), theta, phi)
        for degree, order, re, im in complex_rows(rough(7))
    )
    np.testing.assert_allclose(total.imag, 0.0, atol=1e-12)
    np.testing.assert_allclose(total.real, radii(rough(7), directions), atol=1e-12)


def test_that_complex_rows_are_read_back_in_any_order_and_without_negative_orders(rough):
    rows = complex_rows(rough(9))
    np.testing.assert_allclose(from_complex_rows(rows[::-1]).values, rough(9).values, atol=1e-15)
    half = rows[rows[:, 1] >= 0]
    np.testing.assert_allclose(from_complex_rows(half).values, rough(9).values, atol=1e-15)
    other_half = rows[rows[:, 1] <= 0]
    np.testing.assert_allclose(from_complex_rows(other_half).values, rough(9).values, atol=1e-15)


def test_that_tables_of_shtools_are_understood(rough, tmp_path):
    particle = rough(9)
    theirs = pyshtools.SHCoeffs.from_array(to_pyshtools(particle), normalization="ortho", csphase=1)
    theirs.convert(normalization="4pi").to_file(tmp_path / "clm.sh", format="shtools")
    rows = np.loadtxt(tmp_path / "clm.sh", delimiter=",")
    np.testing.assert_allclose(from_shtools_rows(rows).values, particle.values, atol=1e-14)
    np.testing.assert_allclose(shtools_rows(particle), rows, atol=1e-14)
    np.testing.assert_allclose(
        from_shtools_rows(shtools_rows(particle, "ortho"), "ortho").values, particle.values, atol=1e-15
    )


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (lambda rows: rows.__setitem__((5, 2), np.nan), r"1 of 16 rows .* row 6: 2  -1  nan"),
        (lambda rows: rows.__setitem__((5, 1), 3), r"Row 6 begins with 2 3"),
        (lambda rows: rows.__setitem__((5, 0), 2.5), r"Row 6 begins with 2.5 -1"),
        (lambda rows: rows.__setitem__((5, 0), 10**6), r"a degree l from 0 to 200"),
        (lambda rows: rows.__setitem__((5, 1), 0), r"l = 2, m = 0 comes more than once"),
        (lambda rows: rows.__setitem__((5, 2), 9.0), r"l = 2, m = 1 and m = -1 contradict"),
    ],
)
def test_that_a_spoilt_table_is_refused_in_one_sentence(rough, spoil, sentence):
    rows = complex_rows(rough(3))
    spoil(rows)
    with pytest.raises(InputError, match=sentence):
        from_complex_rows(rows)


@pytest.mark.parametrize("rows", [np.empty((0, 4)), np.ones((3, 3)), np.ones(4)])
def test_that_tables_of_another_shape_are_refused(rows):
    with pytest.raises(InputError, match=r"4 numbers a row"):
        from_complex_rows(rows)


def test_that_shtools_tables_are_checked(rough):
    with pytest.raises(InputError, match=r"4pi or ortho"):
        from_shtools_rows(shtools_rows(rough(2)), "schmidt")
    with pytest.raises(InputError, match=r"no negative orders"):
        from_shtools_rows(complex_rows(rough(2)))


def test_that_a_fitted_sample_comes_back_from_its_document_and_arrays(rough, ellipsoid):
    calm = fit_harmonics(ellipsoid(3.0, 2.0, 1.0, level=2), 4, sampling_degree=10, reference="ellipsoid")
    fits = [HarmonicFit(rough(6), np.array([1.0, 2.0, 3.0]), notes=("Look out.",)), calm]
    document = json.loads(json.dumps(fits_document(["one", "two"], fits)))
    assert "orthonormal" in document["convention"]
    assert "without the Condon-Shortley phase" in document["convention"]
    assert document["unit"] == "um"
    back = fits_from(document, fits_arrays(["one", "two"], fits))
    np.testing.assert_array_equal(back["one"].coefficients.values, rough(6).truncated(4).values)
    np.testing.assert_array_equal(back["one"].star_point, [1.0, 2.0, 3.0])
    np.testing.assert_array_equal(back["two"].reference.semi_axes, calm.reference.semi_axes)
    assert back["one"].notes == ("Look out.",)


def test_that_documents_and_arrays_of_two_samples_do_not_mix():
    document = {"particles": [{}, {}]}
    arrays = {"coefficients": np.ones((1, 4)), "star_points": np.zeros((1, 3))}
    with pytest.raises(InputError, match=r"names 2 particles but holds coefficients of 1"):
        fits_from(document, arrays)


@pytest.mark.real_data
@pytest.mark.slow
def test_that_volume_and_area_of_real_particles_are_the_published_ones(real_data):
    """300 of 3,338, within 0.5 percent: coefficients against an independent program's volume and area.

    The published numbers belong to the degree in the column "l used", where 28 stands for 28 or 30.
    """
    with np.load(real_data("cement140/coefficients.npz")) as data:
        table, names = data["anm"], data["name"]
    with real_data("cement140/geometry.csv").open(newline="") as lines:
        published = {row[0]: [float(cell) for cell in row[1:]] for row in csv.reader(lines)}
    worst = 0.0
    for index in np.random.default_rng(140).choice(len(table), 300, replace=False):
        values = table[index]
        rows = np.column_stack([degrees(961), orders(961), values.real, values.imag])
        row = published[str(names[index])]
        volume, area, used = row[6], row[7], int(row[11])
        particle = from_complex_rows(rows)
        candidates = [particle.truncated(k) for k in ((28, 30) if used == 28 else (used,))]
        gap = min(_gap(reconstruct(cut, level=5), volume, area) for cut in candidates)
        worst = max(worst, gap)
    assert worst < 0.005, f"volume or area is off by {worst:.2%}"


def _gap(surface, volume, area):
    return max(abs(surface.volume / volume - 1), abs(surface.surface_area / area - 1))


def test_that_the_mean_radius_is_the_first_complex_coefficient_over_root_four_pi(rough):
    rows = complex_rows(rough(2).scaled(3.0))
    assert ShCoefficients(from_complex_rows(rows).values).mean_radius == pytest.approx(
        rows[0, 2] / np.sqrt(4 * np.pi)
    )
