"""Tables of coefficients come in as the radius that scipy's and SHTOOLS' own harmonics give."""

import numpy as np
import pytest
from scipy.special import sph_harm_y

from regolith_studio.errors import FileError
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.sphere_grid import harmonics
from regolith_studio.readers.coefficient_tables import read_coefficients
from tests.harmonics.tables import complex_rows, shtools_rows

RNG = np.random.default_rng(6)
VALUES = np.concatenate([[30.0], RNG.normal(size=35)])
COEFFICIENTS = ShCoefficients(VALUES)


def text(table, separator=" "):
    """Rows of two whole numbers and then floats."""
    return "\n".join(
        separator.join([f"{row[0]:.0f}", f"{row[1]:.0f}", *(f"{number:.12e}" for number in row[2:])])
        for row in table
    )


@pytest.fixture
def read(tmp_path):
    """Writes a text into a file and reads its coefficients."""

    def read_text(content, **options):
        (tmp_path / "grain.dat").write_text(content)
        return read_coefficients(tmp_path / "grain.dat", **options)

    return read_text


def test_that_complex_rows_give_the_radius_that_scipy_gives(read) -> None:
    table = complex_rows(COEFFICIENTS)
    found = read(text(table)).coefficients
    theta, phi = RNG.uniform(0, np.pi, 40), RNG.uniform(0, 2 * np.pi, 40)
    expected = sum((row[2] + 1j * row[3]) * sph_harm_y(int(row[0]), int(row[1]), theta, phi) for row in table)
    directions = np.column_stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])
    assert np.abs(expected.imag).max() < 1e-9
    assert found.values @ harmonics(directions, 5) == pytest.approx(expected.real)


def test_that_a_file_of_shtools_gives_its_coefficients(tmp_path) -> None:
    """Written by pyshtools itself, in its usual normalisation."""
    pyshtools = pytest.importorskip("pyshtools")
    degree = np.repeat(np.arange(6), np.arange(6) * 2 + 1)
    order = np.concatenate([np.arange(-each, each + 1) for each in range(6)])
    made = pyshtools.SHCoeffs.from_zeros(5, normalization="4pi", csphase=1)
    made.coeffs[np.where(order < 0, 1, 0), degree, np.abs(order)] = VALUES / np.sqrt(4 * np.pi)
    made.to_file(str(tmp_path / "pysh.sh"), format="shtools")
    found = read_coefficients(tmp_path / "pysh.sh")
    assert found.coefficients.values == pytest.approx(VALUES)
    assert found.notes[0].startswith("Interpreted as a table of SHTOOLS")


@pytest.mark.parametrize(
    "header", ["", "# a comment\n", "1.738e3, 4.9e3, 7.3e-5, 900, 900\n", "l, m, C, S\n"]
)
@pytest.mark.parametrize("norm", ["4pi", "ortho"])
def test_that_headers_and_normalisations_of_shtools_are_known(header, norm, read) -> None:
    table = text(shtools_rows(COEFFICIENTS, norm), ", ")
    found = read(header + table, convention=f"shtools-{norm}")
    assert found.coefficients.values == pytest.approx(VALUES)


def test_that_the_unit_scales_the_radius(read) -> None:
    found = read(text(complex_rows(COEFFICIENTS)), unit="voxel:2.5")
    assert found.coefficients.mean_radius == pytest.approx(2.5 * COEFFICIENTS.mean_radius)
    assert (found.name, found.source.unit) == ("grain", "voxel:2.5")


def test_that_rows_that_are_not_finite_are_named(read) -> None:
    table = complex_rows(COEFFICIENTS)
    table[7, 2] = np.nan
    with pytest.raises(
        FileError, match="1 of 36 rows hold a number that is not finite, the first is row 8: 2  1  nan"
    ):
        read(text(table))


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda rows: rows[:, :3], "has 3 columns"),
        (lambda rows: rows[rows[:, 1] >= 0], "does not show its convention"),
        (lambda rows: rows[1:], "has no positive mean radius"),
        (lambda rows: rows * [1, 1, -1, 1], "has no positive mean radius"),
        (lambda rows: np.vstack([rows, rows[:2]]), "comes more than once"),
        (lambda rows: np.vstack([rows, [[3, 4, 0, 0]]]), "begins with 3 4"),
        (lambda rows: np.vstack([rows, [[900, 4, 0, 0]]]), "begins with 900 4"),
        (lambda rows: rows + [0, 0, 0, 1] * (rows[:, 1:2] > 0), "contradict each other"),
    ],
)
def test_that_broken_tables_are_refused_in_one_sentence(change, sentence, read) -> None:
    with pytest.raises(FileError, match=sentence) as caught:
        read(text(change(complex_rows(COEFFICIENTS))))
    assert str(caught.value).startswith("grain.dat ")


@pytest.mark.real_data
def test_that_real_particles_printed_as_rows_come_back(real_data, read) -> None:
    """The tables of NIST lineage themselves: l, then m = -l .. l."""
    with np.load(real_data("cement140/coefficients.npz")) as stored:
        complex_values = stored["anm"][:5]
    degree = np.repeat(np.arange(31), np.arange(31) * 2 + 1)
    order = np.concatenate([np.arange(-each, each + 1) for each in range(31)])
    for values in complex_values:
        found = read(text(np.column_stack([degree, order, values.real, values.imag])))
        assert found.coefficients.mean_radius == pytest.approx(values[0].real / np.sqrt(4 * np.pi))
        assert np.sum(found.coefficients.values**2) == pytest.approx(np.sum(np.abs(values) ** 2), rel=1e-5)
