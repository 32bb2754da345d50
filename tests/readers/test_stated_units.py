"""Units that files state are applied once: every format with every unit that it can state.

Each writer makes a file of 2 x 3 x 4 of the unit: a box of a mesh, the positions of particles, or a voxel.
"""

import json

import numpy as np
import pytest
import tifffile

from regolith_studio.readers.particles import read_mesh
from regolith_studio.readers.positions import read_positions
from regolith_studio.readers.volumes.read import describe_volume
from tests.readers.test_stated_axes import ngff
from tests.readers.test_unused_points import glb

MICROMETRES = {
    "micron": 1.0, "um": 1.0, "µm": 1.0, "micrometer": 1.0, "mm": 1e3, "millimeter": 1e3, "cm": 1e4,
    "centimeter": 1e4, "m": 1e6, "meter": 1e6, "nm": 1e-3, "nanometer": 1e-3, "inch": 25_400.0,
    "foot": 304_800.0, "angstrom": 1e-4,
}  # fmt: skip
SIZE = np.array([2.0, 3.0, 4.0])
VOXELS = np.arange(60, dtype=np.uint16).reshape(3, 4, 5)


@pytest.mark.parametrize("unit", ["micron", "millimeter", "centimeter", "inch", "foot", "meter", ""])
def test_that_3mf_comes_in_its_unit_or_in_millimetres(unit, cube, tmp_path):
    (tmp_path / "box.3mf").write_bytes(cube.three_mf(unit, SIZE))
    particle = read_mesh(tmp_path / "box.3mf")
    edge = MICROMETRES[unit or "mm"]
    assert particle.mesh.bounds[1] == pytest.approx(SIZE * edge)
    assert (unit or "states no unit; that of 3MF") in particle.notes[0]
    assert read_mesh(tmp_path / "box.3mf", "voxel:2").mesh.bounds[1] == pytest.approx(SIZE * 2)


def test_that_a_unit_which_3mf_does_not_have_is_refused(cube, refusal):
    assert "states the unit “furlong”" in refusal("box.3mf", cube.three_mf("furlong", SIZE))


def test_that_gltf_comes_in_metres_whatever_unit_is_asked(cube, tmp_path):
    corners, faces = (cube.vertices * SIZE).astype("<f4"), cube.faces.astype("<u4")
    (tmp_path / "box.glb").write_bytes(glb(corners.tobytes() + faces.tobytes(), 8, faces.size))
    for unit in ("um", "mm"):
        particle = read_mesh(tmp_path / "box.glb", unit)
        assert particle.mesh.bounds[1] == pytest.approx(SIZE * 1e6)
        assert particle.notes == ("The unit of glTF is the metre.",)
    assert read_mesh(tmp_path / "box.glb", "voxel:1").mesh.bounds[1] == pytest.approx(SIZE)


@pytest.mark.parametrize("unit", MICROMETRES)
@pytest.mark.parametrize("form", ["names", "line"])
def test_that_tables_of_positions_come_in_the_unit_of_their_head(unit, form, tmp_path):
    names = ["x", "y", "z", "d"]
    head = ",".join(f"{name} [{unit}]" for name in names)
    if form == "line":
        head = ",".join(names) + "\n" + ",".join([unit] * 4)
    (tmp_path / "a.csv").write_text(f"{head}\n2,3,4,1\n4,6,8,2\n", encoding="utf-8")
    found = read_positions(tmp_path / "a.csv", unit="cm")
    factor = MICROMETRES[unit] * 1e-6
    np.testing.assert_allclose(found.points, [SIZE * factor, 2 * SIZE * factor], rtol=1e-12)
    np.testing.assert_allclose(found.diameters, [factor, 2 * factor], rtol=1e-12)


def shown(edges):
    return " ".join(f"{edge:.9g}" for edge in edges)


def imagej(path, units, edges):
    units = [unit.replace("µ", "\\u00B5") for unit in units]  # as ImageJ writes it
    metadata = {"spacing": edges[2], "unit": units[0], "axes": "ZYX"}
    metadata |= {
        name: unit for name, unit in zip(("yunit", "zunit"), units[1:], strict=True) if unit != units[0]
    }
    tifffile.imwrite(path, VOXELS, imagej=True, resolution=tuple(1 / edges[:2]), metadata=metadata)


def ome(path, units, edges):
    metadata = {"axes": "ZYX"}
    for axis, edge, unit in zip("XYZ", edges, units, strict=True):
        metadata |= {f"PhysicalSize{axis}": float(edge), f"PhysicalSize{axis}Unit": unit}
    tifffile.imwrite(path, VOXELS, ome=True, metadata=metadata)


def nrrd(path, units, edges, directions=False):
    quoted = " ".join(f'"{unit}"' for unit in units)
    place = f"spacings: {shown(edges)}\nunits: {quoted}\n"
    if directions:
        place = "space dimension: 3\nspace directions: ({},0,0) (0,{},0) (0,0,{})\n".format(*edges)
        place += f"space units: {quoted}\n"
    head = f"NRRD0005\ntype: ushort\ndimension: 3\nsizes: 5 4 3\nendian: little\nencoding: raw\n{place}\n"
    path.write_bytes(head.encode() + VOXELS.astype("<u2").tobytes())


def nrrd_directions(path, units, edges):
    nrrd(path, units, edges, directions=True)


def ome_zarr(path, units, edges):
    return ngff(path.with_suffix(".zarr"), "zyx", [VOXELS], [edges[::-1].tolist()], units[::-1])


def metaimage(path, units, edges):
    head = "ObjectType = Image\nNDims = 3\nDimSize = 5 4 3\nElementType = MET_USHORT\n"
    head += f"ElementSpacing = {shown(edges)}\nDistanceUnits = {units[0]}\nElementDataFile = LOCAL\n"
    path.write_bytes(head.encode() + VOXELS.astype("<u2").tobytes())


def amira(path, units, edges):
    head = "# AmiraMesh BINARY-LITTLE-ENDIAN 2.1\n\ndefine Lattice 5 4 3\n\nParameters {\n"
    head += f'    Units {{\n        Coordinates "{units[0]}"\n    }}\n    CoordType "uniform",\n'
    head += "    BoundingBox 0 {} 0 {} 0 {}\n".format(*(edges * [4, 3, 2]))
    head += "}\n\nLattice { ushort Data } @1\n\n# Data section follows\n@1\n"
    path.write_bytes(head.encode() + VOXELS.astype("<u2").tobytes() + b"\n")


def vgi(path, units, edges):
    text = "{volume1}\n[representation]\nsize = 5 4 3\ndatatype = unsigned integer\nbitsperelement = 16\n"
    text += f"[file1]\nName = scan.vol\n[geometry]\nresolution = {shown(edges)}\nunit = {units[0]}\n"
    path.write_text(text, encoding="utf-8")
    path.with_name("scan.vol").write_bytes(VOXELS.astype("<u2").tobytes())


def ilastik(path, units, edges):
    import h5py

    with h5py.File(path, "w") as file:
        data = file.create_dataset("exported_data", data=VOXELS)
        axes = [{"key": a, "resolution": float(e)} for a, e in zip("zyx", edges[::-1], strict=True)]
        data.attrs["axistags"] = json.dumps({"axes": axes})
        data.attrs["axis_units"] = json.dumps(dict(zip("xyz", units, strict=True)))


VOLUMES = {
    "imagej.tif": imagej, "ome.tif": ome, "spacings.nrrd": nrrd, "directions.nrrd": nrrd_directions,
    "ngff": ome_zarr, "ilastik.h5": ilastik, "a.mha": metaimage, "a.am": amira, "a.vgi": vgi,
}  # fmt: skip
WITH_ONE_UNIT = ("a.mha", "a.am", "a.vgi")
OME_UNITS = ("µm", "mm", "cm", "m", "nm")
"""Those of the table that are units of OME."""


@pytest.mark.parametrize("unit", MICROMETRES)
@pytest.mark.parametrize("name", VOLUMES)
def test_that_voxels_come_in_the_unit_that_the_file_states(name, unit, tmp_path):
    if name == "ome.tif" and unit not in OME_UNITS:
        pytest.skip("no unit of OME")
    edges = SIZE if MICROMETRES[unit] <= 1e4 else SIZE * 1e-5
    path = VOLUMES[name](tmp_path / name, [unit] * 3, edges) or tmp_path / name
    np.testing.assert_allclose(describe_volume(path).micrometres(), edges * MICROMETRES[unit], rtol=1e-6)


@pytest.mark.parametrize("units", [("um", "mm", "nm"), ("µm", "µm", "mm"), ("mm", "um", "um")])
@pytest.mark.parametrize("name", [name for name in VOLUMES if name not in WITH_ONE_UNIT])
def test_that_each_axis_may_have_its_own_unit(name, units, tmp_path):
    units = tuple(unit.replace("um", "µm") for unit in units)
    path = VOLUMES[name](tmp_path / name, units, SIZE) or tmp_path / name
    expected = SIZE * [MICROMETRES[unit] for unit in units]
    header = describe_volume(path)
    if max(expected) > 1e4 * min(expected):
        assert header.voxel_size is None
        assert "implausible" in str(header.notes[-1])
    else:
        np.testing.assert_allclose(header.micrometres(), expected, rtol=1e-6)
