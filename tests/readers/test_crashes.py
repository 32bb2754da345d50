"""Files that once broke a parser, and files made to keep one busy: each has its answer now.

The small files were found by fuzzing and by the mutations beside this file. Through
the sandbox a small file has 1.5 s of work, so that an answer other than giving up proves that a trap is none.
"""

import io
import zipfile
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.errors import FileError, GeometryError
from regolith_studio.readers.particles import read_mesh
from regolith_studio.readers.volumes.read import describe_volume, open_slabs

HERE = Path(__file__).parent
MESHES = {
    "bad-deflate.3mf": "is not a valid 3MF: its archive is damaged; export it again.",
    "endless-name.ply": "is not a valid PLY: row 0 of “face” declares “ver",
}
VOLUMES = {
    "endless-loop.h5": "was given up after ",
    "endless-name.mha": "points to voxels in “�",
    "no-pixels.tif": "is a broken TIFF file, or is cut short",
}


def refusal_of_mesh(path: Path) -> str:
    with pytest.raises((FileError, GeometryError)) as caught:
        read_mesh(path)
    return str(caught.value).removeprefix(f"{path.name} ")


def read_voxels(path: Path) -> None:
    header = describe_volume(path)
    open_slabs(path, voxel_size=1.0, kind="grey").read(0, header.shape[2])


def test_that_every_file_that_was_found_is_asked_for() -> None:
    found = {path.name for path in (HERE / "crashes").iterdir()}
    assert found == MESHES.keys()
    stated = VOLUMES.keys() | UNBELIEVABLE.keys()
    assert {path.name for path in (HERE / "crashes_volumes").iterdir()} == stated


@pytest.mark.parametrize("name", MESHES)
def test_that_meshes_that_once_broke_a_parser_are_refused_in_words(name: str) -> None:
    assert refusal_of_mesh(HERE / "crashes" / name).startswith(MESHES[name])


@pytest.mark.parametrize("name", VOLUMES)
def test_that_volumes_that_once_broke_a_parser_are_refused_in_words(name: str) -> None:
    with pytest.raises(FileError) as caught:
        read_voxels(HERE / "crashes_volumes" / name)
    assert str(caught.value).startswith(f"{name} {VOLUMES[name]}")


UNBELIEVABLE = {
    "thinner-than-an-atom.nii": "The file states voxels of 0.5 × 9.313e-10 × 2 and, by its matrix, of "
    "0.5 × 1 × 2; give the size of a voxel.",
    "pixels-of-fourteen-metres.tif": "The file states a voxel of 1 × 1.45e+07 × 1 um, which is implausible; "
    "give the size of a voxel.",
}


@pytest.mark.parametrize("name", UNBELIEVABLE)
def test_that_a_voxel_size_that_no_scan_has_is_asked_for_instead(name: str) -> None:
    header = describe_volume(HERE / "crashes_volumes" / name)
    assert header.voxel_size is None
    assert UNBELIEVABLE[name] in header.notes


def polygon(points: np.ndarray) -> bytes:
    """An OBJ of one face."""
    lines = ["v {:g} {:g} {:g}".format(*point) for point in points]
    return "\n".join([*lines, "f " + " ".join(map(str, range(1, len(points) + 1)))]).encode()


def spiral(turns: int, n: int) -> np.ndarray:
    """The corners of a ribbon that winds around a point, shape (2 n, 3)."""
    angle = np.linspace(0.0, 2 * np.pi * turns, n)
    arms = [np.column_stack([r * np.cos(angle), r * np.sin(angle)]) for r in (angle + 1.0, angle + 2.0)]
    return np.pad(np.concatenate([arms[0], arms[1][::-1]]), ((0, 0), (0, 1)))


def components(levels: int) -> bytes:
    """A 3MF whose object holds two of the next, which holds two of the next, and so on to nothing."""
    pairs = [f'<component objectid="{k + 1}"/>' * 2 for k in range(levels)]
    parts = "".join(
        f'<object id="{k}"><components>{pair}</components></object>' for k, pair in enumerate(pairs)
    )
    last = f'<object id="{levels}"><mesh><vertices/><triangles/></mesh></object>'
    model = f'<model><resources>{parts}{last}</resources><build><item objectid="0"/></build></model>'
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as made:
        made.writestr("3D/3dmodel.model", model)
    return file.getvalue()


def zeros_3mf() -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as made:
        made.writestr("3D/3dmodel.model", bytes(60_000_000))
    return file.getvalue()


TRAPS = {
    "knot.obj": (
        polygon(np.pad(np.random.default_rng(0).random((1500, 2)), ((0, 0), (0, 1)))),
        "holds no particle",
    ),
    "spiral.obj": (polygon(spiral(20, 900)), "holds no particle"),
    "corners.off": (
        b"OFF\n1 1 0\n0 0 0\n9999999 " + b"0\n" * 200_000,
        "declares 9999999 corners and has 200000",
    ),
    "components.3mf": (components(45), "its components form a cycle, or are too many"),
    "zeros.3mf": (zeros_3mf(), "unpacks to 60 MB, 100 times its size or more, which no mesh does"),
}


@pytest.mark.parametrize("name", TRAPS)
def test_that_a_file_made_to_keep_its_reader_busy_is_answered(name: str, tmp_path: Path) -> None:
    data, words = TRAPS[name]
    (tmp_path / name).write_bytes(data)
    assert words in refusal_of_mesh(tmp_path / name)
