"""Particles given by their coefficients, and the weights that stand beside extracted meshes."""

import csv
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.errors import FileError, GeometryError
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.readers.particles import read_mesh, read_particles, read_weights
from tests.harmonics.tables import complex_rows


def table_of(values) -> str:
    """Rows ``l m Re Im`` of real orthonormal coefficients."""
    rows = complex_rows(ShCoefficients(np.asarray(values, dtype=float)))
    return "\n".join(f"{row[0]:.0f} {row[1]:.0f} {row[2]:.12e} {row[3]:.12e}" for row in rows)


BALL = table_of([20.0 * np.sqrt(4 * np.pi), 0.0, 0.0, 0.0])


@pytest.mark.parametrize("name", ["ball.anm", "ball.txt", "ball.DAT", "ball.csv"])
def test_that_a_table_with_a_mean_radius_only_is_a_ball(name, tmp_path) -> None:
    (tmp_path / name).write_text(BALL)
    particle = read_mesh(tmp_path / name)
    assert particle.name == "ball"
    assert particle.mesh.volume == pytest.approx(4 / 3 * np.pi * 20.0**3, rel=1e-9)
    assert particle.mesh.surface_area == pytest.approx(4 * np.pi * 20.0**2, rel=1e-3)
    assert particle.notes == ()


def test_that_the_unit_of_a_table_scales_the_particle(tmp_path) -> None:
    (tmp_path / "ball.anm").write_text(BALL)
    assert read_mesh(tmp_path / "ball.anm", "mm").mesh.volume == pytest.approx(4 / 3 * np.pi * 2e4**3)
    assert read_mesh(tmp_path / "ball.anm", "voxel:2").mesh.volume == pytest.approx(4 / 3 * np.pi * 40.0**3)


def test_that_folders_give_their_tables_and_meshes_but_no_other_texts(tmp_path, cube) -> None:
    (tmp_path / "ball.anm").write_text(BALL)
    (tmp_path / "cube.stl").write_bytes(cube.binary_stl())
    (tmp_path / "notes.txt").write_text("Dear Sir")
    (tmp_path / "particles.csv").write_text("name,volume\nball,3\n")
    assert [particle.name for particle in read_particles([tmp_path])] == ["ball", "cube"]


def test_that_a_mesh_in_a_text_file_is_still_a_mesh(tmp_path, cube) -> None:
    (tmp_path / "cube.txt").write_bytes(cube.files()["ascii.stl"])
    assert read_mesh(tmp_path / "cube.txt").mesh.volume == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("Dear Sir\nYours", "is not a mesh, and as a table of coefficients it holds no row of numbers"),
        ("x y z\n1 2 3\n4 5 6", "it has 3 columns; .* Points alone enclose no particle"),
        ("0 0 3 0\n1 0 0.1 0\n1 1 0.1 0.2", "it does not show its convention"),
    ],
)
def test_that_a_text_that_is_neither_mesh_nor_table_is_one_sentence(content, sentence, tmp_path) -> None:
    (tmp_path / "letter.txt").write_text(content)
    with pytest.raises(FileError, match=sentence):
        read_mesh(tmp_path / "letter.txt")


def test_that_a_table_is_cut_at_the_degree_asked_for(tmp_path) -> None:
    """A ball with a part of the third degree; what is cut off is said."""
    (tmp_path / "bump.anm").write_text(table_of([20.0 * np.sqrt(4 * np.pi), *[0.0] * 8, 9.0, *[0.0] * 6]))
    ball = 4 / 3 * np.pi * 20.0**3
    whole, cut, more = (read_mesh(tmp_path / "bump.anm", l_max=degree) for degree in (None, 2, 12))
    assert whole.mesh.volume == more.mesh.volume == pytest.approx(ball + 20.0 * 9.0**2, rel=1e-4)
    assert cut.mesh.volume == pytest.approx(ball, rel=1e-9)
    assert cut.notes == ("Coefficients above l = 2 are left out; its table has them up to 3.",)
    assert (whole.notes, more.notes) == ((), ())
    assert [each.source.l_max for each in (whole, cut, more)] == [None, 2, 12]
    assert [each.notes for each in read_particles([tmp_path], l_max=2)] == [cut.notes]


def test_that_a_surface_through_its_centre_is_refused(tmp_path) -> None:
    (tmp_path / "eight.anm").write_text(table_of([1.0, 0.0, 5.0, 0.0]))
    with pytest.raises(GeometryError, match=r"^eight\.anm holds no particle"):
        read_mesh(tmp_path / "eight.anm")


@pytest.mark.slow
def test_that_volume_and_area_agree_with_the_numbers_of_the_table_s_own_program(real_data, tmp_path) -> None:
    """Cement grains; the volumes and areas come from another program, at the degree that it says."""
    folder = real_data("cement140")
    arrays = np.load(folder / "coefficients.npz")
    with (folder / "geometry.csv").open(newline="") as file:
        stated = {row[0].strip(): [float(cell) for cell in row[1:]] for row in csv.reader(file)}
    volumes, areas = [], []
    for at in range(0, 3338, 300):
        name = str(arrays["name"][at])
        volume, area, degree = stated[name][6], stated[name][7], int(stated[name][11])
        orders = [(n, m) for n in range(31) for m in range(-n, n + 1)]
        rows = zip(orders, arrays["anm"][at], strict=True)
        path = tmp_path / f"{Path(name).stem}.anm"
        path.write_text("\n".join(f"{n} {m} {a.real:.9e} {a.imag:.9e}" for (n, m), a in rows))
        mesh = read_mesh(path, l_max=degree).mesh
        volumes.append(mesh.volume / volume - 1)
        areas.append(mesh.surface_area / area - 1)
    assert np.abs(volumes).max() < 5e-3
    assert abs(np.mean(areas)) < 5e-3


def test_that_extracted_meshes_come_in_with_the_weights_beside_them(tmp_path, cube) -> None:
    for name in ("a", "b", "c"):
        (tmp_path / f"{name}.stl").write_bytes(cube.binary_stl())
    (tmp_path / "particles.csv").write_text("name,voxels,weight\na,1000,1.25\nb,20,\n")
    assert [particle.weight for particle in read_particles([tmp_path])] == [1.25, 1.0, 1.0]
    assert read_particles([tmp_path / "a.stl"])[0].weight == 1.25


@pytest.mark.parametrize(
    "content",
    [b"", b"name,weight\na,heavy\n", b"weight\n3\n", b"name,weight\na,-1\n", b"\xff\xfe\0", b"a\0b"],
)
def test_that_a_table_of_weights_that_makes_no_sense_gives_none(content, tmp_path) -> None:
    (tmp_path / "particles.csv").write_bytes(content)
    assert read_weights(tmp_path) == {}
