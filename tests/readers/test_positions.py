"""Positions as tables, XYZ and LAMMPS dumps."""

import pickle

import numpy as np
import pytest

from regolith_studio.errors import FileError, InputError
from regolith_studio.readers.positions import ParticlePositions, asks_for_columns, read_positions

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


@pytest.mark.parametrize("head", ["#format x_y_z_r", "# format x_y_z_r"])
def test_that_the_head_of_yade_says_that_the_fourth_column_is_a_radius(head, read) -> None:
    found = read("a.txt", f"{head}\n" + rows(POINTS, DIAMETERS / 2, separator="\t"))
    assert np.allclose(found.diameters, DIAMETERS, atol=1e-6)
    assert found.notes == ()


@pytest.mark.parametrize("name", ["a.csv", "a.xyz"])
def test_that_a_user_may_name_the_columns(name, read) -> None:
    text = rows(POINTS, DIAMETERS / 2)
    found = read(name, text, columns="x y z radius")
    assert np.allclose(found.diameters, DIAMETERS, atol=1e-6)
    assert found.notes == ()
    counted = "50\ncomment\n" + rows(np.arange(50), DIAMETERS, POINTS[:, ::-1])
    same(read(name, counted, columns="id,d,z,y,x"))


def test_that_names_which_do_not_fit_are_refused(read) -> None:
    with pytest.raises(FileError, match="has 4 columns, and “x y z” names 3"):
        read("a.csv", rows(POINTS, DIAMETERS), columns="x y z")
    with pytest.raises(FileError, match="needs columns called x, y and z; “x y radius mass” does not"):
        read("a.csv", rows(POINTS, DIAMETERS), columns="x y radius mass")
    with pytest.raises(FileError, match="names its columns itself"):
        read("a.dump", dump("x y z", POINTS), columns="x y z")


@pytest.mark.parametrize("first", ["1", "glass"])
def test_that_xyz_with_types_and_velocities_is_read_with_a_note(first, read) -> None:
    lines = [f"{first} {row}" for row in rows(POINTS, 0 * POINTS).splitlines()]
    found = read("a.xyz", "\n".join(["50", "Atoms. Timestep: 0", *lines]))
    same(found, diameters=False)
    kind = "type" if first == "1" else "species"
    assert found.notes == (
        f"The columns have no names; they were interpreted as {kind}, x, y, z, vx, vy, vz.",
    )


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.xyz", "50\ncomment\n" + rows(POINTS, DIAMETERS)),
        ("a.xyz", "50\ncomment\n" + rows(POINTS, DIAMETERS, DIAMETERS)),
        ("a.xyz", "50\ncomment\n" + rows(np.ones(50), POINTS, DIAMETERS)),
        ("a.csv", rows(np.arange(50), POINTS)),
        ("a.csv", rows(POINTS, DIAMETERS, DIAMETERS)),
        ("a.csv", "id;mass;x;y;z\n" + rows(POINTS, separator=",")),
    ],
)
def test_that_columns_whose_meaning_is_not_known_are_asked_for(name, text, read) -> None:
    with pytest.raises(
        FileError, match=r"name its columns, for example “x y z radius” \(--columns\)"
    ) as caught:
        read(name, text)
    assert asks_for_columns(caught.value)


@pytest.mark.parametrize(
    "header",
    [
        "x,y,z,diameter",
        "X,Y,Z,D",
        '"x [m]","y [m]","z [m]","diameter [m]"',
        "x_m,y_m,z_m,d_m",
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


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252"])
def test_that_micrometres_in_the_head_are_understood_in_every_encoding(encoding, read) -> None:
    text = "x [µm],y [µm],z [µm],Diameter [µm]\n" + rows(POINTS, DIAMETERS, separator=",")
    found = read("a.csv", text.encode(encoding))
    assert np.allclose(found.points, POINTS * 1e-6, rtol=1e-12, atol=0)
    assert np.allclose(found.diameters, DIAMETERS * 1e-6, rtol=1e-12, atol=0)


def test_that_a_head_that_cannot_be_decoded_is_refused(read) -> None:
    with pytest.raises(FileError, match="in an encoding that is known"):
        read("a.csv", b"x [\x81m],y,z\n" + rows(POINTS, separator=",").encode())


@pytest.mark.parametrize(
    ("head", "sentence"),
    [
        ("x [furlong],y [furlong],z [furlong],d", "the unit “furlong” for a column, which is not known"),
        ("x [m],y [m],z [m],d [parsec]", "the unit “parsec”"),
        ("x [m],y [mm],z [m],d", "different units for x, y and z"),
    ],
)
def test_that_units_which_cannot_be_understood_are_refused(head, sentence, read) -> None:
    with pytest.raises(FileError, match=sentence):
        read("a.csv", head + "\n" + rows(POINTS, DIAMETERS, separator=","))


@pytest.mark.parametrize(
    ("style", "metres"),
    [("si", 1.0), ("cgs", 1e-2), ("real", 1e-10), ("metal", 1e-10), ("micro", 1e-6), ("nano", 1e-9),
     ("electron", 5.29177e-11), ("lj", 1.0)],
)  # fmt: skip
def test_that_the_units_of_a_lammps_dump_apply_to_all_its_steps(style, metres, read) -> None:
    table = np.column_stack([POINTS, DIAMETERS / 2])
    text = f"ITEM: UNITS\n{style}\nITEM: TIME\n0.1\n" + 2 * dump("x y z radius", table)
    found = read("pile.dump", text)
    assert np.allclose(found.points, POINTS * metres, rtol=1e-5, atol=0)
    assert np.allclose(found.diameters, DIAMETERS * metres, rtol=1e-4, atol=0)


GERMAN = rows(POINTS, DIAMETERS, separator=";").replace(".", ",")
QUOTED = "\n".join(
    ",".join(f'"{number}"' for number in row.split(";")) for row in GERMAN.splitlines()
)  # fmt: skip


@pytest.mark.parametrize(
    "text",
    [
        "x;y;z;d\n1;2;3;1\n" + GERMAN,
        "sep=;\nx;y;z;d\n1;2;3;1\n" + GERMAN,
        "sep=;\r\nx;y;z;d;;\r\n1;2;3;1;;\r\n" + GERMAN.replace("\n", ";;\r\n"),
        "x\ty\tz\td\n1\t2\t3\t1\n" + GERMAN.replace(";", "\t"),
        "x y z d\n1 2 3 1\n" + GERMAN.replace(";", " "),
        '"x","y","z","d"\n1,2,3,1\n' + QUOTED,
        'x;y;z;d\n"1";"2";"3";"1"\n' + QUOTED.replace('","', '";"'),
        "sep=,\nx,y,z,d\n1,2,3,1\n" + rows(POINTS, DIAMETERS, separator=","),
    ],
)
def test_that_tables_of_german_and_of_excel_are_read(text, read) -> None:
    found = read("a.csv", text)
    assert np.allclose(found.points, [[1, 2, 3], *POINTS], rtol=0, atol=1e-12)
    assert np.allclose(found.diameters, [1, *DIAMETERS], rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("x;y;z\n1.234,5;2,5;3\n", "“1.234,5” in row 1, column 1: write numbers without separators"),
        ("x;y;z\n1,5;2,5;1.234\n", "“1.234” in row 1, column 3: write numbers without separators"),
        ("x;y;z\n1,5;2,5;0.25\n", "“0.25” in row 1, column 3, and decimal commas elsewhere"),
        ('x,y,z\n"1,234.5",2,3\n', "“1,234.5” in row 1, column 1: write numbers without separators"),
        ('x,y,z\n"1,234",2,3\n', "“1,234”, whose comma may be a decimal comma or separate thousands"),
        ("x;y;z\n1'234.5;2;3\n", "“1'234.5” in row 1, column 1: write numbers without separators"),
        ("x;y;z\n1;2\N{NO-BREAK SPACE}345;3\n", "in row 1, column 2: write numbers without separators"),
    ],
)
def test_that_separators_of_thousands_are_refused_by_name(text, sentence, read) -> None:
    with pytest.raises(FileError, match=sentence.replace("'", ".")):
        read("a.csv", text)


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


@pytest.mark.parametrize("options", [{"unit": "furlong"}, {"unit": "voxel:2"}, {"columns": "x"}])
def test_that_options_that_mean_nothing_are_refused(options, read) -> None:
    with pytest.raises(InputError):
        read("a.csv", rows(POINTS), **options)
