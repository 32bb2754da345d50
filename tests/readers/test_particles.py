"""Files and folders to particles: names, groups, units, problems, notes."""

import hashlib

import pytest

from regolith_studio.errors import FileError, GeometryError, InputError
from regolith_studio.io.atomic import staged_folder
from regolith_studio.readers.particles import read_mesh, read_particles, sample_particles
from regolith_studio.readers.sandbox.parent import sha256_of
from regolith_studio.readers.settings import UNITS, unit_factor


@pytest.fixture
def tree(tmp_path, cube):
    """A folder as databases of simulants have it: simulant, fraction, files."""
    for name in ("JSC-1A/fine/p1.stl", "JSC-1A/fine/p2.STL", "JSC-1A/coarse/p1.stl", "JSC-1A/whole.stl"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(cube.binary_stl())
    (tmp_path / "JSC-1A/README.txt").write_text("about the data")
    (tmp_path / "JSC-1A/fine/.hidden.stl").write_bytes(b"")
    (tmp_path / "JSC-1A/.cache").mkdir()
    (tmp_path / "JSC-1A/.cache/p3.stl").write_bytes(b"")
    return tmp_path / "JSC-1A"


@pytest.mark.parametrize(
    "name", ["binary.stl", "ascii.stl", "cube.obj", "cube.off", "ascii.ply", "little.ply", "big.ply"]
)
def test_that_the_same_cube_comes_out_of_every_format(name, cube, accepted):
    particle = accepted(name, cube.files()[name])
    assert particle.name == name.partition(".")[0]
    assert particle.mesh.volume == pytest.approx(1.0)
    assert particle.notes == ()


def test_that_a_folder_tree_becomes_groups(tree):
    particles = read_particles([tree])
    assert [(particle.group, particle.name) for particle in particles] == [
        ("JSC-1A", "whole"),
        ("coarse", "p1"),
        ("fine", "fine_p1"),
        ("fine", "p2"),
    ]


def test_that_numbered_files_and_folders_come_in_the_order_of_their_numbers(tmp_path, cube):
    for name in ("set10/rock1", "set2/rock11", "set2/rock3", "set2/rock1"):
        path = tmp_path / "all" / f"{name}.stl"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(cube.binary_stl())
    places = [
        (each.group, each.source.path.rpartition("/")[2]) for each in read_particles([tmp_path / "all"])
    ]
    assert places == [
        ("set2", "rock1.stl"),
        ("set2", "rock3.stl"),
        ("set2", "rock11.stl"),
        ("set10", "rock1.stl"),
    ]


def test_that_several_folders_keep_their_names_in_the_groups(tree):
    groups = [particle.group for particle in read_particles([tree / "fine", tree])]
    assert groups == ["fine", "fine", "JSC-1A", "JSC-1A/coarse", "JSC-1A/fine", "JSC-1A/fine"]


def test_that_names_are_unique(tree):
    names = [particle.name for particle in read_particles([tree / "fine/p1.stl"] * 3 + [tree])]
    assert len(set(names)) == len(names) == 7


def test_that_single_files_have_no_group(tree):
    assert read_particles([tree / "fine/p1.stl"])[0].group == ""


def test_that_unreadable_files_of_a_folder_are_told_and_the_rest_is_read(tree):
    (tree / "fine/bad.stl").write_bytes(b"bad")
    (tree / "fine/sheet.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    problems = []
    particles = read_particles(
        [tree], on_problem=lambda path, sentence: problems.append((path.name, sentence))
    )
    assert len(particles) == 4
    assert [name for name, _ in problems] == ["bad.stl", "sheet.obj"]
    assert problems[0][1].startswith("bad.stl is too short")
    assert problems[1][1].startswith("sheet.obj holds no particle: the mesh is an open sheet")


def test_that_nothing_readable_raises_the_first_sentence(tmp_path):
    for name in ("a.stl", "b.stl", "c.stl"):
        (tmp_path / name).write_bytes(b"bad")
    with pytest.raises(
        FileError, match=r"^a\.stl is too short.*\(2 more files could not be read either\.\)$"
    ):
        read_particles([tmp_path])


def test_that_a_folder_without_meshes_says_so(tmp_path):
    with pytest.raises(FileError, match=r"holds no mesh file; meshes end in \.3mf, \.glb"):
        read_particles([tmp_path])


def test_that_no_paths_are_refused():
    with pytest.raises(FileError, match="no file to read"):
        read_particles([])


def test_that_an_unknown_suffix_is_refused_with_those_that_are_known(refusal):
    assert "supported are meshes in .3mf" in refusal("points.xyz", b"1 2 3\n4 5 6\n")


def test_that_the_content_decides_where_the_name_lies(cube, accepted):
    particle = accepted("cube.stl", cube.ascii_ply())
    assert particle.mesh.volume == pytest.approx(1.0)
    assert particle.notes == ("The file is named .stl but holds PLY.",)
    assert accepted("cube", cube.off()).notes == ("The file is named without a suffix but holds OFF.",)


@pytest.mark.parametrize(
    ("unit", "factor"), [("um", 1), ("mm", 1e3), ("cm", 1e4), ("m", 1e6), ("nm", 1e-3), ("voxel:2.5", 2.5)]
)
def test_that_units_are_turned_into_micrometres(unit, factor, cube, accepted):
    particle = accepted("cube.stl", cube.binary_stl(), unit=unit)
    assert particle.mesh.volume == pytest.approx(factor**3)
    assert particle.source.unit == unit


def test_that_a_voxel_needs_a_size_and_an_unknown_unit_is_named():
    assert "voxel" in UNITS
    with pytest.raises(InputError, match=r"write for example voxel:2\.5"):
        unit_factor("voxel")
    for size in ("0", "-1", "nan", "inf", "wide"):
        with pytest.raises(InputError, match="voxel"):
            unit_factor(f"voxel:{size}")
    with pytest.raises(InputError, match=r"no unit “furlong”; the units are um, mm"):
        unit_factor("furlong")


def test_that_a_particle_of_one_micrometre_given_in_metres_is_whole(cube, accepted):
    lines = cube.obj().decode().splitlines()
    tiny = "\n".join(line.replace(" 1", " 1e-6") if line.startswith("v") else line for line in lines)
    particle = accepted("tiny.obj", tiny.encode(), unit="m")
    assert particle.mesh.volume == pytest.approx(1.0)
    assert particle.notes == ()


def test_that_the_source_tells_path_hash_and_unit(cube, tmp_path):
    path = tmp_path / "cube.stl"
    path.write_bytes(cube.binary_stl())
    source = read_mesh(path, unit="mm").source
    assert source.path == str(path)
    assert source.sha256 == hashlib.sha256(cube.binary_stl()).hexdigest() == sha256_of(path)


def test_that_repair_can_be_switched_off_and_the_problems_stay(cube, accepted):
    inside_out = cube.obj().replace(b"f 1 2 4 3", b"f 3 4 2 1")
    particle = accepted("cube.obj", inside_out, repair=False)
    assert particle.notes == ("Its faces are not oriented consistently.",)
    mended = accepted("cube.obj", inside_out)
    assert mended.mesh.volume == pytest.approx(1.0)
    assert mended.notes[1:] == ("Reoriented 2 faces.",)


def test_that_without_repair_an_open_sheet_is_kept_as_it_is(accepted):
    particle = accepted("sheet.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", repair=False)
    assert len(particle.mesh.faces) == 1
    assert any("not closed" in note for note in particle.notes)


def test_that_what_holds_no_particle_is_refused_by_name(tmp_path):
    path = tmp_path / "sheet.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with pytest.raises(GeometryError, match=r"^sheet\.obj holds no particle: the mesh is an open sheet"):
        read_mesh(path)


def test_that_the_shipped_particles_are_sound_and_named():
    particles = sample_particles()
    if not particles:
        pytest.skip("this checkout ships no particles")
    assert len({particle.name for particle in particles}) == len(particles)
    for particle in particles:
        assert particle.mesh.volume > 0.0
        assert particle.source.path == f"sample:{particle.name}"
        assert particle.source.unit == "um"
        assert particle.group == "synthetic"
        assert particle.is_synthetic


@pytest.fixture
def result(cube, tmp_path):
    """A folder of two cubes and their weights, as a command leaves it."""
    with staged_folder(tmp_path / "result", "extract") as stage:
        (stage / "a.stl").write_bytes(cube.binary_stl())
        (stage / "b.stl").write_bytes(cube.binary_stl())
        (stage / "particles.csv").write_text("name,weight\na,1.5\n")
    return tmp_path / "result"


def test_that_a_file_that_is_not_the_one_of_its_list_is_refused_by_name(result):
    assert [particle.weight for particle in read_particles([result])] == [1.5, 1.0]
    (result / "b.stl").write_bytes(b"another run".ljust(80) + (result / "b.stl").read_bytes()[80:])
    problems = []
    assert len(read_particles([result], on_problem=lambda *problem: problems.append(problem))) == 1
    assert [path.name for path, _ in problems] == ["b.stl"]


def test_that_weights_of_another_run_are_refused(result):
    (result / "particles.csv").write_text("name,weight\na,2.5\n")
    with pytest.raises(FileError, match=r"particles\.csv is not the file that the list"):
        read_particles([result])
    (result / "extract.sha256").unlink()
    assert [particle.weight for particle in read_particles([result])] == [2.5, 1.0]
