"""Axes, hands and distances that other programs state: particles come in as they are, not as mirror images.

The scan is V[x, y, z] = 100 x + 10 y + z, so that a swap or a flip of axes shows in the numbers.
"""

import json

import numpy as np
import pytest

from regolith_studio.errors import FileError, InputError
from regolith_studio.readers.volumes.read import describe_volume, open_slabs, read_volume

NX, NY, NZ = 6, 5, 4
V = sum(np.meshgrid(100 * np.arange(NX), 10 * np.arange(NY), np.arange(NZ), indexing="ij")).astype(np.uint16)
EDGES = (2.0, 3.0, 5.0)
MIRRORED = "The axes of the volume are left-handed: particles come in as their mirror images."
SKEWED = "The axes of the volume are not at right angles to each other; they were taken as if they were."


def read(path, **options):
    return read_volume(path, kind="grey", **({"voxel_size": 1.0} | options)).array


def notes(path, **options):
    return [str(note) for note in describe_volume(path, **options).notes]


@pytest.fixture
def file(tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as opened:
        yield opened


def closed(file):
    """The path of an HDF5 file, which is written."""
    from pathlib import Path

    path = Path(file.filename)
    file.close()
    return path


def test_that_matlab_stores_rows_last_and_columns_in_the_middle(file):
    """MATLAB's A(row, column, slice), rows along y, is written with its dimensions in reverse order."""
    a = V.transpose(1, 0, 2)  # A(y, x, z)
    file["A"] = a.transpose(2, 1, 0)
    file["A"].attrs["MATLAB_class"] = np.bytes_("uint16")
    path = closed(file)
    np.testing.assert_array_equal(read(path), V)
    assert "as MATLAB stores it" in notes(path)[0]
    np.testing.assert_array_equal(read(path, axes="zxy"), V)
    assert notes(path, axes="zyx") == []


@pytest.mark.parametrize("order", ["xyz", "zyx", "yxz", "zxy"])
@pytest.mark.parametrize("names", ["{}", "sample_{}", "{}_position", "{}axis"])
def test_that_nxdata_names_its_axes_and_states_their_distances(order, names, file):
    data = file.create_group("entry/data")
    data.attrs["NX_class"], data.attrs["signal"] = "NXdata", "counts"
    data.attrs["axes"] = [names.format(axis) for axis in order]
    data["counts"] = V.transpose(["xyz".index(axis) for axis in order])
    for axis, n, edge in zip("xyz", V.shape, EDGES, strict=True):
        data[names.format(axis)] = 7.0 + edge * np.arange(n)
        data[names.format(axis)].attrs["units"] = "um"
    path = closed(file)
    np.testing.assert_array_equal(read(path), V)
    assert describe_volume(path).micrometres() == pytest.approx(EDGES)
    assert notes(path) == []


@pytest.mark.parametrize("order", ["xyz", "zyx", "zxy"])
def test_that_dimension_scales_name_axes(order, file):
    file["v"] = V.transpose(["xyz".index(axis) for axis in order])
    for place, axis in enumerate(order):
        k = "xyz".index(axis)
        file[f"scales/{axis}"] = EDGES[k] * np.arange(V.shape[k])
        file[f"scales/{axis}"].attrs["units"] = "nm"
        file[f"scales/{axis}"].make_scale(axis)
        file["v"].dims[place].attach_scale(file[f"scales/{axis}"])
    path = closed(file)
    np.testing.assert_array_equal(read(path), V)
    assert describe_volume(path).micrometres() == pytest.approx(np.array(EDGES) * 1e-3)


@pytest.mark.parametrize(("down", "note"), [("x", True), ("xz", False), ("xyz", True)])
def test_that_coordinates_that_go_down_turn_the_hand(down, note, file):
    data = file.create_group("data")
    data.attrs["NX_class"], data.attrs["signal"], data.attrs["axes"] = "NXdata", "v", ["x", "y", "z"]
    data["v"] = V
    for axis, n in zip("xyz", V.shape, strict=True):
        data[axis] = np.arange(n)[:: -1 if axis in down else 1]
    assert (MIRRORED in notes(closed(file))) is note


def test_that_bigdataviewer_means_unsigned_numbers(file):
    bright = V + np.uint16(40_000)
    file["t00000/s00/0/cells"] = bright.T.view(np.int16)
    path = closed(file)
    assert describe_volume(path).dtype == np.uint16
    np.testing.assert_array_equal(read(path), bright)
    assert "unsigned" in notes(path)[0]


@pytest.mark.parametrize("more", [(1,), (1, 1)])
@pytest.mark.parametrize("depth", [4, 40])
def test_that_an_axis_of_one_in_front_is_dropped(more, depth, file):
    v = np.arange(3 * 5 * depth, dtype=np.uint16).reshape(3, 5, depth)
    file["predictions"] = v.reshape(*more, *v.shape)
    np.testing.assert_array_equal(read(closed(file)), v.T)


def test_that_imaris_states_its_size_without_padding_and_its_voxel(file):
    padded = np.zeros((8, 16, 16), dtype=np.uint16)
    padded[:NZ, :NY, :NX] = V.T
    channel = file.create_group("DataSet/ResolutionLevel 0/TimePoint 0/Channel 0")
    channel["Data"] = padded
    image = file.create_group("DataSetInfo/Image")

    def letters(text):
        return np.array([letter.encode() for letter in text], dtype="S1")

    for k, (axis, n, edge) in enumerate(zip("XYZ", V.shape, EDGES, strict=True)):
        channel.attrs[f"ImageSize{axis}"] = letters(str(n))
        image.attrs[f"ExtMin{k}"], image.attrs[f"ExtMax{k}"] = letters("-1.5"), letters(f"{n * edge - 1.5}")
    image.attrs["Unit"] = letters("um")
    path = closed(file)
    renamed = path.rename(path.with_suffix(".ims"))
    header = describe_volume(renamed)
    assert header.shape == V.shape
    assert header.micrometres() == pytest.approx(EDGES)
    np.testing.assert_array_equal(read(renamed), V)


def nifti(path, affine, pixdim=None, unit="mm"):
    nibabel = pytest.importorskip("nibabel")
    image = nibabel.Nifti1Image(V, affine)
    image.header.set_xyzt_units(unit)
    if pixdim is not None:
        image.header["pixdim"][1:4] = pixdim
    image.to_filename(path)
    return path


@pytest.mark.parametrize("suffix", [".nii", ".nii.gz"])
def test_that_nifti_whose_pixdim_is_not_that_of_its_matrix_is_asked_about(suffix, tmp_path):
    path = nifti(tmp_path / f"a{suffix}", np.diag([0.002, 0.003, 0.005, 1.0]), (1.0, 1.0, 1.0))
    assert "states voxels of 1 × 1 × 1 and, by its matrix, of 0.002 × 0.003 × 0.005" in notes(path)[0]
    with pytest.raises(InputError, match=r"micrometres\. The file states voxels of 1 × 1 × 1 and, by"):
        open_slabs(path)
    agreeing = nifti(tmp_path / f"b{suffix}", np.diag([0.002, 0.003, 0.005, 1.0]))
    assert describe_volume(agreeing).micrometres() == pytest.approx(EDGES)
    np.testing.assert_array_equal(read(agreeing), V)


def test_that_a_sheared_nifti_is_said(tmp_path):
    affine = np.diag([0.002, 0.003, 0.005, 1.0])
    affine[0, 2] = 0.002
    assert notes(nifti(tmp_path / "a.nii", affine)) == [SKEWED]


def nrrd(path, fields, encoding="raw"):
    text = "NRRD0005\ntype: ushort\ndimension: 3\nsizes: 6 5 4\nendian: little\nencoding: " + encoding
    path.write_bytes(f"{text}\n{fields}\n\n".encode() + V.T.astype("<u2").tobytes())
    return path


HANDS = {"right-anterior-superior": 1, "RAS": 1, "left-posterior-superior": 1, "LPS": 1,
         "left-anterior-superior": -1, "LAS": -1, "left-anterior-superior-time": -1,
         "3D-right-handed": 1, "3D-left-handed": -1, "scanner-xyz": 1}  # fmt: skip


@pytest.mark.parametrize("space", HANDS)
@pytest.mark.parametrize("flip", [1, -1])
def test_that_the_hand_of_an_nrrd_is_that_of_space_and_directions_together(space, flip, tmp_path):
    fields = f"space: {space}\nspace directions: ({2 * flip},0,0) (0,3,0) (0,0,5)\n"
    path = nrrd(tmp_path / "a.nrrd", fields + 'space units: "um" "um" "um"')
    assert notes(path) == ([MIRRORED] if HANDS[space] * flip < 0 else [])
    assert describe_volume(path).micrometres() == pytest.approx(EDGES)


def test_that_an_encoding_of_nrrd_is_named_before_the_byte_order(tmp_path):
    path = tmp_path / "a.nrrd"
    path.write_text("NRRD0005\ntype: ushort\ndimension: 3\nsizes: 1 1 1\nencoding: ascii\n\n7\n")
    with pytest.raises(FileError, match="in the encoding “ascii”; raw and gzip are read"):
        describe_volume(path)


def ngff(path, axes, arrays, scales, units=("micrometer",) * 3):
    """An OME-Zarr 0.4 of levels, each one chunk."""
    datasets = []
    for level, (array, scale) in enumerate(zip(arrays, scales, strict=True)):
        (path / str(level)).mkdir(parents=True)
        shape = list(array.shape)
        stated = {"zarr_format": 2, "shape": shape, "chunks": shape, "dtype": "<u2", "compressor": None,
                  "fill_value": 0, "order": "C", "filters": None}  # fmt: skip
        (path / str(level) / ".zarray").write_text(json.dumps(stated))
        (path / str(level) / ".".join("0" for _ in shape)).write_bytes(array.astype("<u2").tobytes())
        transform = [{"type": "scale", "scale": scale}]
        datasets.append({"path": str(level), "coordinateTransformations": transform})
    spatial = iter(units)
    entries = [{"name": axis, **({"unit": next(spatial)} if axis.lower() in "xyz" else {})} for axis in axes]
    image = {"version": "0.4", "axes": entries, "datasets": datasets}
    (path / ".zgroup").write_text('{"zarr_format": 2}')
    (path / ".zattrs").write_text(json.dumps({"multiscales": [image]}))
    return path


@pytest.mark.parametrize("axes", ["zyx", "xyz", "ZYX", "yxz"])
def test_that_ome_zarr_is_turned_to_the_letters_of_its_axes(axes, tmp_path):
    pytest.importorskip("zarr")
    order = ["xyz".index(axis) for axis in axes.lower()]
    path = ngff(tmp_path / "a.zarr", axes, [V.transpose(order)], [[EDGES[k] for k in order]])
    np.testing.assert_array_equal(read(path), V)
    assert describe_volume(path).micrometres() == pytest.approx(EDGES)
    assert notes(path) == []


def test_that_of_channels_of_an_ome_zarr_one_is_read_with_a_note(tmp_path):
    pytest.importorskip("zarr")
    path = ngff(tmp_path / "a.zarr", "czyx", [np.stack([V.T, V.T + 1])], [[1.0, *EDGES[::-1]]])
    assert notes(path) == ["The file holds 2 volumes; 0[0] was read."]
    np.testing.assert_array_equal(read(path, dataset="0[1]"), V + 1)
    assert notes(path, dataset="0[1]") == []


def test_that_the_finest_level_of_an_ome_zarr_is_read_wherever_it_stands(tmp_path):
    pytest.importorskip("zarr")
    coarse = V.T[::2, ::2, ::2]
    scales = [[2 * edge for edge in EDGES[::-1]], list(EDGES[::-1])]
    path = ngff(tmp_path / "a.zarr", "zyx", [coarse, V.T], scales)
    np.testing.assert_array_equal(read(path), V)
    assert describe_volume(path).micrometres() == pytest.approx(EDGES)
