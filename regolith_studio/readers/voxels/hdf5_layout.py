"""What programs that write HDF5 state of an array: axes, distances of voxels, its true size.

NeXus names axes beside its signal, HDF5 itself has dimension scales, MATLAB stores its dimensions in reverse
order, BigDataViewer unsigned numbers as signed ones, and Imaris pads its arrays.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from regolith_studio.messages import N_
from regolith_studio.readers.voxels.header import Shape, Sizes, hand_note, stated_edges

MAX_SCALE = 1 << 20
EVEN = 1e-3
"""Difference of two distances along an axis over their mean, up to which they are even."""
_MATLAB = N_("The array was read as MATLAB stores it: its rows are along y, its columns along x.")
_UNSIGNED = N_("BigDataViewer stores unsigned numbers as signed ones; they were read as unsigned.")
_CELLS = re.compile(r"t\d{5}/s\d{2}/\d+/cells")
_IMARIS = re.compile(r"(DataSet/ResolutionLevel \d+/TimePoint \d+/Channel \d+)/Data")
_AXIS = re.compile(r"(?:.*[_ ])?([xyztc])(?:[_ ].*|axis|pos(?:ition)?)?", re.IGNORECASE)


@dataclass(frozen=True)
class StatedLayout:
    """What a file states of one array.

    Parameters
    ----------
    axes
        A letter of ``tczyx`` for each axis; empty where they are not stated.
    voxel_size, unit
        Edges along x, y and z, and the key of their unit.
    shape
        Slices, rows and columns without padding, where that is less than the array has.
    unsigned
        Whether signed numbers are unsigned ones.
    notes
        Sentences for the user.
    """

    axes: str = ""
    voxel_size: Sizes | None = None
    unit: str | None = None
    shape: Shape | None = None
    unsigned: bool = False
    notes: tuple[str, ...] = ()


UNSTATED = StatedLayout()


def stated_layout(file: Any, path: str, dataset: Any) -> StatedLayout:
    """The layout of the array at `path` of an open ``h5py.File``, by the first program that it shows."""
    for reader in _READERS:
        found = reader(file, path, dataset)
        if found is not None:
            return found
    return UNSTATED


def _imaris(file: Any, path: str, dataset: Any) -> StatedLayout | None:
    match = _IMARIS.fullmatch(path)
    if match is None or len(dataset.shape) != 3:
        return None
    channel, image = file[match[1]], file.get("DataSetInfo/Image")
    sizes = [_number(channel, f"ImageSize{axis}") for axis in "ZYX"]
    if not all(
        0 < size <= edge and size == int(size) for size, edge in zip(sizes, dataset.shape, strict=True)
    ):
        return None
    shape = int(sizes[0]), int(sizes[1]), int(sizes[2])
    if image is None:
        return StatedLayout("zyx", shape=shape)
    extents = [_number(image, f"ExtMax{k}") - _number(image, f"ExtMin{k}") for k in range(3)]
    edges = [extent / size for extent, size in zip(extents, shape[::-1], strict=True)]
    size, unit = stated_edges(edges, [_text(image, "Unit")] * 3)
    return StatedLayout("zyx", size, unit, shape)


def _big_data_viewer(_file: Any, path: str, dataset: Any) -> StatedLayout | None:
    if _CELLS.fullmatch(path) is None or dataset.dtype != np.int16:
        return None
    return StatedLayout("zyx", unsigned=True, notes=(_UNSIGNED,))


def _nexus(file: Any, path: str, dataset: Any) -> StatedLayout | None:
    """The axes of an NXdata group, by the names of the arrays along them."""
    group = file[path.rpartition("/")[0] or "/"]
    if _text(group, "NX_class") != "NXdata" or _text(group, "signal") != path.rpartition("/")[2]:
        return None
    names = group.attrs.get("axes", ())
    names = [_decoded(name) for name in np.ravel(names).tolist()]
    if len(names) == 1 and ":" in names[0]:
        names = names[0].split(":")
    return _by_names(names, [_child(group, name) for name in names], dataset)


def _scales(_file: Any, _path: str, dataset: Any) -> StatedLayout | None:
    """The dimension scales of HDF5, by their names."""
    if "DIMENSION_LIST" not in dataset.attrs:
        return None
    scales = [next(iter(dimension.values()), None) for dimension in dataset.dims]
    names = ["" if scale is None else _scale_name(scale) for scale in scales]
    return _by_names(names, scales, dataset)


def _scale_name(scale: Any) -> str:
    return _text(scale, "NAME") or str(scale.name).rpartition("/")[2]


def _matlab(_file: Any, _path: str, dataset: Any) -> StatedLayout | None:
    dimensions = len(dataset.shape)
    if "MATLAB_class" not in dataset.attrs or dimensions not in (3, 4):
        return None
    return StatedLayout("zxy" if dimensions == 3 else "czxy", notes=(_MATLAB,))


_READERS: tuple[Callable[[Any, str, Any], StatedLayout | None], ...] = (
    _imaris, _big_data_viewer, _nexus, _scales, _matlab,
)  # fmt: skip


def _by_names(names: list[str], scales: list[Any], dataset: Any) -> StatedLayout | None:
    """The layout of an array along whose axes named arrays of coordinates lie."""
    letters = [match[1].lower() if (match := _AXIS.fullmatch(name)) else "" for name in names]
    if (
        len(letters) != len(dataset.shape)
        or len(set(letters)) != len(letters)
        or not set("zyx") <= set(letters)
    ):
        return None
    by_letter = dict(zip(letters, scales, strict=True))
    edges = [_distance(by_letter[axis]) for axis in "xyz"]
    size, unit = stated_edges(edges, [_text(by_letter[axis], "units") for axis in "xyz"])
    return StatedLayout("".join(letters), size, unit, notes=hand_note(edges))


def _distance(scale: Any) -> float:
    """The distance of coordinates that are evenly spaced; not a number otherwise."""
    shape = getattr(scale, "shape", None)
    if not shape or len(shape) != 1 or not 2 <= shape[0] <= MAX_SCALE or scale.dtype.kind not in "uif":
        return float("nan")
    gaps = np.diff(scale[()].astype(np.float64))
    mean = float(f"{gaps.mean():.9g}")
    return mean if mean and np.abs(gaps - mean).max() <= EVEN * abs(mean) else float("nan")


def _child(group: Any, name: str) -> Any:
    import h5py

    if not name or "/" in name or not isinstance(group.get(name, getlink=True), h5py.HardLink):
        return None
    return group[name]


def _decoded(value: Any) -> str:
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def _text(item: Any, name: str) -> str:
    """A short attribute as text: also one of single letters, as Imaris writes them."""
    if item is None or name not in item.attrs or item.attrs.get_id(name).get_storage_size() > MAX_SCALE:
        return ""
    values = np.ravel(item.attrs[name]).tolist()
    return "".join(map(_decoded, values)).strip()


def _number(item: Any, name: str) -> float:
    try:
        return float(_text(item, name))
    except ValueError:
        return float("nan")
