"""The arrays in an HDF5 file that can be volumes: found without following a link out of the file."""

import json
import re
from dataclasses import dataclass
from math import prod
from typing import Any

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import printable
from regolith_studio.readers.units import FILE_UNITS, in_one_unit
from regolith_studio.readers.voxels.hdf5_layout import UNSTATED, StatedLayout, stated_layout
from regolith_studio.readers.voxels.header import MAX_EDGE, VOXEL_TYPES, Sizes, sizes_or_none

MAX_OBJECTS = 10_000
MAX_CHANNELS = 32
MAX_ATTRIBUTE = 1 << 16
_GUESSED = {3: "zyx", 4: "zyxc", 5: "tzyxc"}
_ILASTIK = "exported_data"


@dataclass(frozen=True)
class Hdf5Volume:
    """A volume in a file: a dataset, or one channel of it.

    Parameters
    ----------
    name
        As the chooser shows it: the dataset's path, with the channel in brackets where it has several.
    path, channel
        The dataset, and the index along its channel axis.
    axes
        A letter of ``tczyx`` for each axis of the dataset.
    shape
        Of the dataset, all axes.
    """

    name: str
    path: str
    channel: int
    axes: str
    shape: tuple[int, ...]
    dtype: str
    layout: StatedLayout = UNSTATED

    @property
    def spatial(self) -> tuple[int, int, int]:
        """Slices, rows, columns."""
        if self.layout.shape is not None:
            return self.layout.shape
        nz, ny, nx = (self.shape[self.axes.index(axis)] if axis in self.axes else 1 for axis in "zyx")
        return nz, ny, nx


def find_volumes(file: Any, axes: str = "") -> list[Hdf5Volume]:
    """All volumes of an open ``h5py.File``, ilastik's own name first, then the largest.

    Parameters
    ----------
    axes
        Letters that override the axes in the file, for arrays of as many dimensions.

    Raises
    ------
    FileError
        If the file holds more objects than any volume file does.
    """
    found = [
        candidate for path, dataset in _datasets(file) for candidate in _volumes_of(file, path, dataset, axes)
    ]
    return sorted(found, key=lambda each: (each.path != _ILASTIK, -prod(each.shape), each.path, each.channel))


def check_storage(dataset: Any) -> None:
    """Refuse a dataset whose values lie in other files.

    Raises
    ------
    FileError
        If they do.
    """
    if dataset.external:
        raise FileError("keeps these voxels in another file, which is not followed; copy them into one file.")
    if dataset.is_virtual:
        raise FileError("maps these voxels from other files, which is not followed; copy them into one file.")


def element_size(dataset: Any, candidate: Hdf5Volume) -> tuple[Sizes | None, str | None]:
    """Voxel edges along x, y and z, and their unit.

    By Fiji's ``element_size_um``, by ilastik's tags, or by the axes of another program.
    """
    size = _listed_size(dataset, candidate) or _tagged_size(dataset)
    return (size, "um") if size else (candidate.layout.voxel_size, candidate.layout.unit)


def _listed_size(dataset: Any, candidate: Hdf5Volume) -> Sizes | None:
    """The attribute ``element_size_um``, slices first."""
    values = _attribute(dataset, "element_size_um")
    if values is None:
        return None
    try:
        edges = np.asarray(values, dtype=np.float64).ravel()
    except (TypeError, ValueError):
        return None
    if len(edges) == 3:
        order = [axis for axis in candidate.axes if axis in "zyx"]
        order = order if len(order) == 3 else ["z", "y", "x"]
        return sizes_or_none([float(edges[order.index(axis)]) for axis in "xyz"])
    return None


def _tagged_size(dataset: Any) -> Sizes | None:
    """Resolutions of vigra's axis tags in the units of ilastik's ``axis_units``; 0 means unknown."""
    tags, units = _parsed(dataset, "axistags"), _parsed(dataset, "axis_units")
    if not isinstance(tags, dict) or not isinstance(units, dict):
        return None
    try:
        edges = {axis["key"]: float(axis["resolution"]) for axis in tags["axes"]}
        found = in_one_unit([edges[axis] for axis in "xyz"], [str(units[axis]) for axis in "xyz"])
        return sizes_or_none([edge * FILE_UNITS[found[1]] for edge in found[0]]) if found else None
    except (KeyError, TypeError, ValueError):
        return None


def _datasets(file: Any) -> list[tuple[str, Any]]:
    """Datasets reached by hard links only, each once."""
    import h5py

    found: list[tuple[str, Any]] = []
    waiting: list[tuple[str, Any]] = [("", file)]
    seen: set[Any] = set()
    count = 0
    while waiting:
        path, group = waiting.pop()
        for name in group:
            count += 1
            if count > MAX_OBJECTS:
                raise FileError(
                    f"holds more than {MAX_OBJECTS:,} objects: it is damaged or no file of volumes."
                )
            if not isinstance(group.get(name, getlink=True), h5py.HardLink):
                continue
            each = group[name]
            address = h5py.h5o.get_info(each.id).addr
            if address in seen:
                continue
            seen.add(address)
            inner = f"{path}/{name}" if path else name
            if isinstance(each, h5py.Group):
                waiting.append((inner, each))
            elif isinstance(each, h5py.Dataset):
                found.append((inner, each))
    return found


def _volumes_of(file: Any, path: str, dataset: Any, stated: str) -> list[Hdf5Volume]:
    shape = dataset.shape
    if not shape or min(shape) < 1 or max(shape) > MAX_EDGE or not _is_number(dataset):
        return []
    layout = stated_layout(file, path, dataset) if len(shape) > 2 else UNSTATED
    axes = stated.lower() if _fits(stated, len(shape)) else _axes(dataset, layout)
    if axes is None:
        return []
    if axes != layout.axes:
        layout = StatedLayout(unsigned=layout.unsigned, notes=layout.notes if layout.unsigned else ())
    edges = dict(zip(axes, shape, strict=True))
    if (
        edges.get("t", 1) != 1
        or not {"x", "y"} <= set(axes)
        or edges.get("z", 1) * edges["x"] * edges["y"] < 2
    ):
        return []
    channels = edges.get("c", 1)
    if channels > MAX_CHANNELS or (len(shape) - (channels > 1) < 3 and "z" not in axes):
        return []
    names = [path] if channels == 1 else [f"{path}[{channel}]" for channel in range(channels)]
    kind = "uint16" if layout.unsigned else dataset.dtype.name
    return [Hdf5Volume(name, path, k, axes, tuple(shape), kind, layout) for k, name in enumerate(names)]


def _fits(stated: str, dimensions: int) -> bool:
    letters = set(stated.lower())
    return len(stated) == len(letters) == dimensions and {"x", "y", "z"} <= letters <= set("tczyx")


def _is_number(dataset: Any) -> bool:
    try:
        kind = dataset.dtype
    except (TypeError, ValueError, OSError):
        return False
    return f"{kind.kind}{kind.itemsize}" in VOXEL_TYPES


def _axes(dataset: Any, layout: StatedLayout) -> str | None:
    """A letter for each axis: vigra's tags, an attribute ``axes``, labels, the layout's, or the usual."""
    dimensions = len(dataset.shape)
    for stated in (_tags(dataset), _letters(_attribute(dataset, "axes")), _labels(dataset), layout.axes):
        if len(stated) == dimensions and len(set(stated)) == dimensions and set(stated) <= set("tczyx"):
            return stated
    if dimensions > 3 and dataset.shape[0] == 1:
        return _of_one(dataset.shape)
    return _GUESSED.get(dimensions)


def _of_one(shape: tuple[int, ...]) -> str | None:
    """Axes without names where the first has one element: a time, and perhaps channels before or after."""
    if len(shape) == 4:
        return "tzyx"
    return (
        "tczyx"
        if len(shape) == 5 and (shape[1] == 1 or shape[4] > MAX_CHANNELS)
        else _GUESSED.get(len(shape))
    )


def _tags(dataset: Any) -> str:
    try:
        return "".join(str(axis["key"]) for axis in _parsed(dataset, "axistags")["axes"])
    except (KeyError, TypeError):
        return ""


def _parsed(dataset: Any, name: str) -> Any:
    """The JSON in an attribute, or None."""
    text = _attribute(dataset, name)
    if isinstance(text, bytes):
        text = text.decode("utf-8", "replace")
    if not isinstance(text, str):
        return None
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return None


def _letters(value: Any) -> str:
    if isinstance(value, np.ndarray):
        value = "".join(map(str, value.ravel().tolist()))
    if isinstance(value, bytes):
        value = value.decode("utf-8", "replace")
    return re.sub(r"[^a-z]", "", value.lower()) if isinstance(value, str) else ""


def _labels(dataset: Any) -> str:
    if "DIMENSION_LABELS" not in dataset.attrs:
        return ""
    return "".join(str(dimension.label) for dimension in dataset.dims).lower()


def _attribute(dataset: Any, name: str) -> Any:
    """A small attribute's value, or None."""
    if name not in dataset.attrs:
        return None
    stored = dataset.attrs.get_id(name)
    if stored.get_storage_size() > MAX_ATTRIBUTE:
        return None
    return dataset.attrs[name]


def format_names(candidates: list[Hdf5Volume]) -> str:
    """The first few names for an error message."""
    names = ", ".join(printable(each.name)[:40] for each in candidates[:4])
    return f"{names}, …" if len(candidates) > 4 else names
