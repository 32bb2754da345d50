"""What stands where a file should be: a pipe, a folder, a broken link, nothing, ten gigabytes of zeros.

A pipe nobody writes into keeps whoever opens it waiting for ever, so that each of these tests ends only if
nobody does.
"""

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from regolith_studio.dataset.folder_io import read_dataset
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.errors import RegolithError
from regolith_studio.jobs.extraction_settings import read_grain_settings
from regolith_studio.jobs.particle_jobs import load_particles
from regolith_studio.readers.coefficient_tables import read_coefficients
from regolith_studio.readers.particles import read_mesh
from regolith_studio.readers.positions import read_positions
from regolith_studio.readers.shape_files import read_shape_source
from regolith_studio.readers.volumes.read import describe_volume
from regolith_studio.session.file_kinds import FileKind, kind_of
from regolith_studio.session.preferences import Preferences
from regolith_studio.session.project import read_project
from regolith_studio.session.recipe import read_recipe
from regolith_studio.steps import result_of

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes and links of POSIX systems")

READERS: dict[str, Callable[[Path], object]] = {
    "a.stl": read_mesh,
    "a.tif": describe_volume,
    "a.anm": read_coefficients,
    "a.csv": read_positions,
    "fit.json": lambda path: read_shape_source(str(path)),
    "recipe.json": read_recipe,
    "a.regolith": read_project,
    "extraction.json": read_grain_settings,
    "dataset.json": lambda path: read_dataset(path.parent),
}


def sparse(path: Path) -> None:
    with path.open("wb") as file:
        file.truncate(10 * 2**30)


ODD: dict[str, tuple[Callable[[Path], object], str]] = {
    "pipe": (os.mkfifo, "is a device or a pipe, not a file|is not a regular file"),
    "folder": (os.mkdir, "is a folder, not a file|is not a regular file|holds no slices"),
    "dangling": (lambda path: path.symlink_to("nowhere"), "there is no such file"),
    "circle": (lambda path: path.symlink_to(path.name), "its links go round in circles"),
    "nothing": (str, "there is no such file"),
    "empty": (lambda path: path.write_bytes(b""), "is empty|is not JSON|holds no JSON"),
    "zeros": (sparse, r"at most \S+ (GiB )?are read|is larger than|is not a TIFF file"),
}


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("kind", ODD)
def test_that_what_is_no_proper_file_is_refused_in_words(kind: str, name: str, tmp_path: Path) -> None:
    make, words = ODD[kind]
    make(tmp_path / name)
    with pytest.raises(RegolithError, match=words) as caught:
        READERS[name](tmp_path / name)
    assert str(caught.value).count(name) == 1
    assert str(caught.value).endswith(".")


@pytest.mark.parametrize("kind", ODD)
@pytest.mark.parametrize("name", ["a.json", "a.regolith", "a.stl", "a.tif"])
def test_that_the_kind_of_what_is_no_proper_file_is_found(kind: str, name: str, tmp_path: Path) -> None:
    ODD[kind][0](tmp_path / name)
    assert kind_of(tmp_path / name) in FileKind


def test_that_odd_things_in_a_folder_cost_no_good_file(cube, tmp_path: Path) -> None:
    (tmp_path / "good.stl").write_bytes(cube.binary_stl())
    os.mkfifo(tmp_path / "particles.csv")
    for kind in ("pipe", "folder", "dangling", "empty", "zeros"):
        ODD[kind][0](tmp_path / f"{kind}.stl")
    loaded = result_of(load_particles([tmp_path]))
    assert [particle.name for particle in loaded.particles] == ["good"]
    told = sorted(Path(problem.path).stem for problem in loaded.problems)
    assert told == ["dangling", "empty", "pipe", "zeros"]


def test_that_links_in_circles_can_be_remembered_and_checked(tmp_path: Path) -> None:
    """Path.resolve fails on them with an error that is nobody's."""
    link = tmp_path / "circle"
    link.symlink_to("circle")
    known = Preferences()
    known.add_recent(link / "a.stl", "mm")
    assert known.unit_for(link / "a.stl") == "mm"
    (problem,) = validate_dataset(link)
    assert problem.endswith("cannot be read: its links go round in circles.")
    header = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: circle\n\n"
    (tmp_path / "a.nhdr").write_text(header)
    with pytest.raises(RegolithError, match=r"which is a link to another folder|which is not there"):
        describe_volume(tmp_path / "a.nhdr")


def test_that_a_file_without_permission_is_refused_in_words(cube, tmp_path: Path) -> None:
    path = tmp_path / "secret.stl"
    path.write_bytes(cube.binary_stl())
    path.chmod(0)
    if os.access(path, os.R_OK):
        pytest.skip("this user may read everything")
    with pytest.raises(RegolithError, match=r"^secret\.stl cannot be opened: you are not allowed to\.$"):
        read_mesh(path)
