"""Positions as tables, XYZ, LAMMPS dumps and VTK files, the last written by VTK itself."""

import pickle

import numpy as np
import pytest

from regolith_studio.errors import FileError, InputError
from regolith_studio.readers.positions import ParticlePositions, read_positions

POINTS = np.random.default_rng(4).normal(size=(50, 3)).round(6)
DIAMETERS = np.random.default_rng(5).uniform(0.1, 0.5, 50).round(6)


def rows(*columns, separator=" "):
    """Lines of the numbers in the columns."""
    return (
        "\n".join(separator.join(f"{number:.6f}" for number in row) for row in np.column_stack(columns))
        + "\n"
    )


@pytest.fixture
def read(tmp_path):
    """Writes a text into a file and reads its positions."""

    def read_text(name, text, **options):
        (tmp_path / name).write_bytes(text if isinstance(text, bytes) else text.encode())
        return read_positions(tmp_path / name, **options)

    return read_text


def same(found, diameters=True):
    """Whether the particles are those above."""
    assert np.allclose(found.points, POINTS, rtol=0, atol=1e-12)
    if diameters:
        assert np.allclose(found.diameters, DIAMETERS, rtol=0, atol=1e-12)
    else:
        assert found.diameters is None


@pytest.mark.parametrize("name", ["a.csv", "a.txt", "a.dat", "a.xyz"])
@pytest.mark.parametrize("separator", [" ", ",", ";", "\t", ", "])
def test_that_columns_without_names_are_positions_and_diameter(name, separator, read) -> None:
    same(read(name, rows(POINTS, separator=separator)), diameters=False)
    found = read(name, rows(POINTS, DIAMETERS, separator=separator))
    same(found)
    assert found.notes == ("The fourth column has no name; it was interpreted as the diameter.",)


def test_that_a_fourth_column_may_be_a_radius_as_yade_writes_it(read) -> None:
    text = "#format x_y_z_r\n" + rows(POINTS, DIAMETERS / 2)
    assert np.allclose(read("a.txt", text, fourth_column="radius").diameters, DIAMETERS, atol=1e-6)


@pytest.mark.parametrize(
    "header",
    [
        "x,y,z,diameter",
        "X,Y,Z,D",
        '"x [m]","y [m]","z [m]","diameter [m]"',
        "Points:0,Points:1,Points:2,Diameter",
        "Particle X-Coordinate [m],Particle Y-Coordinate [m],Particle Z-Coordinate [m],Particle Size [m]",
        "pos_x,pos_y,pos_z,size",
    ],
)
def test_that_columns_are_found_by_their_names(header, read) -> None:
    same(read("a.csv", header + "\n" + rows(POINTS, DIAMETERS, separator=",")))


def test_that_named_columns_may_stand_in_any_order_among_others(read) -> None:
    text = "id,radius,z,y,x,vx\n" + rows(
        np.arange(50), DIAMETERS / 2, POINTS[:, ::-1], np.zeros(50), separator=","
    )
    found = read("a.csv", text)
    assert np.allclose(found.points, POINTS)
    assert np.allclose(found.diameters, DIAMETERS, atol=1e-6)


@pytest.mark.parametrize("units", ["mm,mm,mm,um", "[mm],[mm],[mm],[um]", '"mm","mm","mm","um"'])
def test_that_units_may_stand_in_a_line_of_their_own(units, read) -> None:
    found = read("a.csv", f"x,y,z,d\n{units}\n" + rows(POINTS, DIAMETERS, separator=","))
    assert np.allclose(found.points, POINTS * 1e-3)
    assert np.allclose(found.diameters, DIAMETERS * 1e-6)


def test_that_a_second_line_of_words_that_are_no_units_is_refused(read) -> None:
    with pytest.raises(FileError, match=r"line 2 begins with .written by hand"):
        read("a.csv", "x,y,z,d\nwritten by hand\n" + rows(POINTS, DIAMETERS, separator=","))


def test_that_units_in_the_names_count_more_than_the_callers(read) -> None:
    text = "x [mm],y [mm],z [mm],d (um)\n" + rows(POINTS, DIAMETERS, separator=",")
    found = read("a.csv", text, unit="cm")
    assert np.allclose(found.points, POINTS * 1e-3)
    assert np.allclose(found.diameters, DIAMETERS * 1e-6)


@pytest.mark.parametrize(
    ("unit", "metres"), [("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("um", 1e-6), ("nm", 1e-9)]
)
def test_that_positions_come_in_metres(unit, metres, read) -> None:
    assert np.allclose(read("a.csv", rows(POINTS), unit=unit).points, POINTS * metres, rtol=1e-12)


def test_that_decimal_commas_are_read_where_semicolons_separate(read) -> None:
    same(read("a.csv", rows(POINTS, DIAMETERS, separator=";").replace(".", ",")))


def test_that_xyz_has_a_count_a_comment_and_species(read) -> None:
    lines = [f"Si {row}" for row in rows(POINTS).splitlines()]
    same(read("a.xyz", "\n".join(["50", "comment", *lines])), diameters=False)


def test_that_extended_xyz_names_its_columns_and_the_last_frame_is_read(read) -> None:
    comment = 'Lattice="1 0 0 0 1 0 0 0 1" Properties=id:I:1:species:S:1:pos:R:3:radius:R:1 Time=0'
    lines = [f"{place} A {row}" for place, row in enumerate(rows(POINTS, DIAMETERS / 2).splitlines())]
    first = "1\n" + comment + "\n0 A 9 9 9 9\n"
    found = read("a.xyz", first + "\n".join(["50", comment, *lines]) + "\n")
    assert np.allclose(found.points, POINTS)
    assert np.allclose(found.diameters, DIAMETERS, atol=1e-6)
    assert found.notes == ("The file holds 2 time steps; the last was read.",)


def dump(columns, numbers, bounds="pp pp pp"):
    """One time step as LAMMPS writes it."""
    box = "-2 2\n-1 3\n0 8\n" if "xy" not in bounds else "-2 2 0\n-1 3 0\n0 8 0\n"
    head = f"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{len(numbers)}\nITEM: BOX BOUNDS {bounds}\n{box}"
    return head + f"ITEM: ATOMS {columns}\n" + rows(numbers)


def test_that_a_lammps_dump_gives_its_last_step(read) -> None:
    table = np.column_stack([np.arange(50), POINTS, DIAMETERS / 2])
    found = read("pile.dump", dump("id x y z radius", table + 1.0) + dump("id x y z radius", table))
    assert np.allclose(found.points, POINTS)
    assert np.allclose(found.diameters, DIAMETERS, atol=1e-6)


def test_that_shares_of_the_box_become_positions(read) -> None:
    shares = (POINTS - [-2, -1, 0]) / [4, 4, 8]
    assert np.allclose(read("a.dump", dump("xs ys zs", shares)).points, POINTS, atol=1e-5)
    with pytest.raises(FileError, match="tilted"):
        read("a.dump", dump("xs ys zs", shares, "xy xz yz pp pp pp"))


@pytest.fixture
def cloud():
    """The particles as VTK has them."""
    pyvista = pytest.importorskip("pyvista")
    made = pyvista.PolyData(POINTS)
    made.point_data["velocity"] = POINTS
    made.point_data["Radius"] = DIAMETERS / 2
    return made


@pytest.mark.parametrize("binary", [True, False])
def test_that_legacy_vtk_files_are_read(binary, cloud, tmp_path) -> None:
    cloud.save(tmp_path / "a.vtk", binary=binary)
    found = read_positions(tmp_path / "a.vtk")
    assert np.allclose(found.points, POINTS)
    assert np.allclose(found.diameters, DIAMETERS)


@pytest.mark.parametrize("mode", ["Ascii", "Binary", "Appended"])
@pytest.mark.parametrize("compressed", [True, False])
@pytest.mark.parametrize("encoded", [True, False])
@pytest.mark.parametrize("big", [True, False])
def test_that_vtps_are_read_however_they_are_packed(mode, compressed, encoded, big, cloud, tmp_path) -> None:
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    writer = vtkXMLPolyDataWriter()
    getattr(writer, f"SetDataModeTo{mode}")()
    writer.SetCompressorTypeToZLib() if compressed else writer.SetCompressorTypeToNone()
    writer.SetEncodeAppendedData(encoded)
    writer.SetByteOrderToBigEndian() if big else writer.SetByteOrderToLittleEndian()
    writer.SetBlockSize(1024)
    writer.SetInputData(cloud)
    writer.SetFileName(str(tmp_path / "a.vtp"))
    writer.Write()
    found = read_positions(tmp_path / "a.vtp")
    assert np.allclose(found.points, POINTS)
    assert np.allclose(found.diameters, DIAMETERS)


def test_that_particles_without_a_proper_position_or_size_are_left_out_and_counted(read) -> None:
    found = read("a.csv", "x,y,z,d\n0,0,0,1\nnan,0,0,1\n1,1,1,-1\n2,2,2,1\n")
    assert found.points.tolist() == [[0, 0, 0], [2, 2, 2]]
    assert found.notes == ("Left out 2 of 4 particles whose position or size is not a valid number.",)


def test_that_positions_check_themselves_and_survive_pickling() -> None:
    made = pickle.loads(pickle.dumps(ParticlePositions(POINTS, DIAMETERS, "a", ("b",))))
    assert (len(made), made.name, made.notes) == (50, "a", ("b",))
    with pytest.raises(ValueError, match="read-only"):
        made.points[0, 0] = 1.0
    with pytest.raises(ValueError, match="diameters"):
        ParticlePositions(POINTS, DIAMETERS[:-1])


@pytest.mark.parametrize("options", [{"unit": "furlong"}, {"unit": "voxel:2"}, {"fourth_column": "mass"}])
def test_that_options_that_mean_nothing_are_refused(options, read) -> None:
    with pytest.raises(InputError):
        read("a.csv", rows(POINTS), **options)
