"""Files that ITK, pynrrd and nibabel wrote of one volume, whose voxel [x, y, z] is x + 10 y + 100 z.

ITK is SimpleITK 2.5.7 and writes millimetres into NIfTI and no unit elsewhere; pynrrd 1.1.3 and
nibabel 5.4.2 were told that the edges 0.5, 1 and 2 are micrometres.
"""

import struct
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.readers.volumes.files import volume_files
from regolith_studio.readers.volumes.read import describe_volume, open_slabs, read_volume

FOLDER = Path(__file__).with_name("foreign_volumes")
FILES = volume_files(FOLDER)
Z, Y, X = np.mgrid[:4, :5, :6]
SLICES = X + 10 * Y + 100 * Z


def test_that_voxels_of_detached_headers_are_not_listed() -> None:
    assert {path.suffix for path in FILES} == {".mha", ".mhd", ".nrrd", ".nhdr", ".nii", ".gz"}
    assert len(FILES) == 20


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_that_every_voxel_is_where_the_other_program_put_it(path) -> None:
    expected = SLICES / 3 if path.name == "nib-scaled.nii" else SLICES
    volume = read_volume(path, voxel_size=1.0, kind="grey")
    assert pytest.approx(expected, abs=3e-3) == volume.array.T
    source = open_slabs(path, voxel_size=1.0, kind="grey")
    for z0, z1 in ((2, 4), (0, 1), (1, 3)):
        assert pytest.approx(expected[z0:z1], abs=3e-3) == source.read(z0, z1).T


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_that_the_voxel_size_is_what_the_other_program_wrote(path) -> None:
    header = describe_volume(path)
    assert header.shape == (6, 5, 4)
    assert header.voxel_size == pytest.approx((0.5, 1.0, 2.0))
    in_millimetres = path.name in ("itk.nii", "itk.nii.gz", "nib-scaled.nii")
    silent = path.name.startswith("itk") and not in_millimetres
    assert header.unit == (None if silent else "mm" if in_millimetres else "um")


def test_that_a_size_without_a_unit_asks_for_the_unit() -> None:
    with pytest.raises(InputError, match=r"a voxel of 0\.5 × 1 × 2 without a unit"):
        read_volume(FOLDER / "itk-raw.mha")
    assert read_volume(FOLDER / "itk-raw.mha", unit="mm").voxel_size == pytest.approx([500.0, 1000.0, 2000.0])


def test_that_an_intent_of_labels_counts_as_one() -> None:
    assert describe_volume(FOLDER / "nib-labels.nii").kind == "labels"


@pytest.mark.parametrize("name", ["plain.mha", "packed.mha", "plain.nii", "packed.nii.gz"])
def test_that_vtk_writes_what_is_read(name, tmp_path) -> None:
    """A fourth program, which is on this machine and so can be asked for more than small files."""
    pyvista = pytest.importorskip("pyvista")
    from vtkmodules.vtkIOImage import vtkMetaImageWriter, vtkNIFTIImageWriter

    slices = np.random.default_rng(3).integers(0, 255, (40, 50, 60)).astype(np.uint8)
    grid = pyvista.ImageData(dimensions=(60, 50, 40), spacing=(1.5, 2.5, 3.5))
    grid.point_data["grey"] = slices.ravel()
    writer = vtkMetaImageWriter() if name.endswith("mha") else vtkNIFTIImageWriter()
    if name.endswith("mha"):
        writer.SetCompression("packed" in name)
    writer.SetFileName(str(tmp_path / name))
    writer.SetInputData(grid)
    writer.Write()
    volume = read_volume(tmp_path / name, unit="mm")
    assert volume.voxel_size == pytest.approx([1500.0, 2500.0, 3500.0])
    # VTK's NIfTI writer turns the rows round unless it is given a matrix; MetaImage keeps them.
    found = volume.array.T
    assert np.array_equal(found, slices) or np.array_equal(found[:, ::-1, :], slices)


def test_that_left_handed_axes_are_told(tmp_path) -> None:
    """The same file with the first axis turned round: particles are their mirror images."""
    data = bytearray((FOLDER / "nib1.nii").read_bytes())
    assert describe_volume(FOLDER / "nib1.nii").notes == ()
    struct.pack_into("<f", data, 280, -0.5)
    (tmp_path / "turned.nii").write_bytes(data)
    assert (
        describe_volume(tmp_path / "turned.nii").notes[0].startswith("The axes of the volume are left-handed")
    )
    text = (FOLDER / "pynrrd-raw.nrrd").read_bytes().replace(b"(0.5,0,0)", b"(-.5,0,0)")
    (tmp_path / "turned.nrrd").write_bytes(text)
    assert (
        describe_volume(tmp_path / "turned.nrrd")
        .notes[0]
        .startswith("The axes of the volume are left-handed")
    )
