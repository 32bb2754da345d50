"""HDF5 as ilastik, Fiji and beamlines write it; links and mappings to other files are not followed.

The arrays in an HDF5 file that can be volumes, and their axes, distances of voxels and true size.

They are found without following a link out of the file. NeXus names axes beside its signal, HDF5 itself
has dimension scales, MATLAB stores its dimensions in reverse order, BigDataViewer unsigned numbers as
signed ones, and Imaris pads its arrays.
"""

import json
import os
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.messages import N_, Message
from regolith_studio.readers.error_messages import printable
from regolith_studio.readers.settings import FILE_UNITS, in_one_unit
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.header import (
    MAX_CACHED_BYTES,
    MAX_EDGE,
    VOXEL_TYPES,
    DatasetEntry,
    Shape,
    Sizes,
    VoxelHeader,
    hand_note,
    sizes_or_none,
    stated_axes,
    stated_edges,
    three_dimensions,
    voxel_type,
)

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

    - ``axes``: a letter of ``tczyx`` for each axis; empty where they are not stated.
    - ``voxel_size``, ``unit``: edges along x, y and z, and the key of their unit.
    - ``shape``: slices, rows and columns without padding, where that is less than the array has.
    - ``unsigned``: whether signed numbers are unsigned ones.
    - ``notes``: sentences for the user.
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
        layout = reader(file, path, dataset)
        if layout is not None:
            return layout
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


MAX_OBJECTS = 10_000
MAX_CHANNELS = 32
MAX_ATTRIBUTE = 1 << 16
_GUESSED = {3: "zyx", 4: "zyxc", 5: "tzyxc"}
_ILASTIK = "exported_data"


@dataclass(frozen=True)
class Hdf5Volume:
    """A volume in a file: a dataset, or one channel of it.

    - ``name``: as the chooser shows it: the dataset's path, with the channel in brackets where it has
      several.
    - ``path``, ``channel``: the dataset, and the index along its channel axis.
    - ``axes``: a letter of ``tczyx`` for each axis of the dataset.
    - ``shape``: of the dataset, all axes.
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

    ``axes``: letters that override the axes in the file, for arrays of as many dimensions.

    Raises FileError if the file holds more objects than any volume file does.
    """
    entries = [
        candidate for path, dataset in _datasets(file) for candidate in _volumes_of(file, path, dataset, axes)
    ]
    return sorted(
        entries, key=lambda each: (each.path != _ILASTIK, -prod(each.shape), each.path, each.channel)
    )


def check_storage(dataset: Any) -> None:
    """Refuse a dataset whose values lie in other files.

    Raises FileError if they do.
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
        size = in_one_unit([edges[axis] for axis in "xyz"], [str(units[axis]) for axis in "xyz"])
        return sizes_or_none([edge * FILE_UNITS[size[1]] for edge in size[0]]) if size else None
    except (KeyError, TypeError, ValueError):
        return None


def _datasets(file: Any) -> list[tuple[str, Any]]:
    """Datasets reached by hard links only, each once."""
    import h5py

    datasets: list[tuple[str, Any]] = []
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
                datasets.append((inner, each))
    return datasets


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
    for stated in (_tags(dataset), _axis_letters(_attribute(dataset, "axes")), _labels(dataset), layout.axes):
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


def _axis_letters(value: Any) -> str:
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


MAX_CHUNK_BYTES = 1 << 29
CACHE_SLOTS = 1_000_003
"""Of the cache of unpacked chunks: many, since two chunks in one slot expel each other."""


class Hdf5Voxels:
    """A dataset of an open ``h5py.File``, read in slices.

    `layer` is the depth of a chunk along z. HDF5's cache of unpacked chunks holds one layer of them, up to
    `MAX_CACHED_BYTES`, so that its chunks are unpacked once even where it is asked for in parts.
    """

    def __init__(self, file: Any, dataset: Any, candidate: Hdf5Volume, header: VoxelHeader) -> None:
        self.header = header
        self._file, self._dataset, self._choose = file, dataset, candidate
        axes = candidate.axes
        self.layer = int(dataset.chunks[axes.index("z")]) if dataset.chunks and "z" in axes else 1

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1, shape (z1 - z0, ny, nx)."""
        axes, every = self._choose.axes, slice(None)
        picked = {"z": slice(z0, z1), "y": every, "x": every, "c": self._choose.channel, "t": 0}
        if self._choose.layout.shape is not None:
            picked |= {"y": slice(self.header.shape[1]), "x": slice(self.header.shape[2])}
        try:
            part = self._dataset[tuple(picked[axis] for axis in axes)]
        except (OSError, ValueError, RuntimeError):
            raise FileError(f"is damaged: its slices {z0 + 1} to {z1} cannot be unpacked.") from None
        if self._choose.layout.unsigned:
            part = part.view(np.uint16)
        kept = [axis for axis in axes if axis in "zyx"]
        if "z" not in kept:
            part, kept = part[np.newaxis], ["z", *kept]
        ordered = part.transpose([kept.index(axis) for axis in "zyx"])
        return np.ascontiguousarray(ordered, dtype=self.header.dtype)

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def open_hdf5(path: Path, options: Mapping[str, Any]) -> Hdf5Voxels:
    """The volume ``options["dataset"]`` of a file, by default the likeliest, with its ``options["axes"]``."""
    import h5py

    file: Any = None
    try:
        file = h5py.File(path, "r", locking=False)
        return _chosen(file, options.get("dataset"), str(options.get("axes") or ""))
    except Exception as error:
        if file is not None:
            file.close()
        if isinstance(error, FileError | MemoryError):
            raise
        raise FileError("is a broken HDF5 file; export it again.") from None


def _chosen(file: Any, wanted: Any, axes: str) -> Hdf5Voxels:
    candidates = find_volumes(file, axes)
    if not candidates:
        raise FileError(
            "holds no volume: none of its arrays has three dimensions of numbers (links are not followed)."
        )
    candidate = _choose(candidates, wanted)
    dataset = file[candidate.path]
    if axes:
        stated_axes(axes, len(candidate.shape))
    check_storage(dataset)
    _check_chunks(dataset)
    size, unit = element_size(dataset, candidate)
    notes: tuple[str, ...] = candidate.layout.notes
    if wanted is None and len(candidates) > 1:
        notes += (
            Message(
                N_("The file holds {count} volumes; {name} was read."),
                count=len(candidates),
                name=printable(candidate.name)[:60],
            ),
        )
    header = VoxelHeader(
        three_dimensions(candidate.spatial),
        voxel_type(np.dtype(candidate.dtype)),
        size,
        unit,
        None,
        notes,
        tuple(DatasetEntry(each.name, each.spatial[::-1], each.dtype) for each in candidates),
        candidate.name,
    )
    if dataset.chunks and "z" in candidate.axes:
        layer = _layer_bytes(dataset, candidate.axes.index("z"))
        del dataset  # the cache of a dataset is set when it is opened first
        dataset = _open_with_cache(file, candidate.path, min(layer, MAX_CACHED_BYTES))
    return Hdf5Voxels(file, dataset, candidate, header)


def _layer_bytes(dataset: Any, z: int) -> int:
    """Unpacked size of the chunks at one depth along axis `z`, with those that reach beyond the edges."""
    edges = [-(-n // chunk) * chunk for n, chunk in zip(dataset.shape, dataset.chunks, strict=True)]
    edges[z] = dataset.chunks[z]
    return int(prod(edges) * dataset.dtype.itemsize)


def _open_with_cache(file: Any, path: str, size: int) -> Any:
    """A dataset with room for `size` bytes of unpacked chunks; more room would fill up with old ones."""
    import h5py

    access = h5py.h5p.create(h5py.h5p.DATASET_ACCESS)
    access.set_chunk_cache(CACHE_SLOTS, size, 1.0)
    return h5py.Dataset(h5py.h5d.open(file.id, path.encode(), access))


def _choose(candidates: list[Hdf5Volume], wanted: Any) -> Hdf5Volume:
    if wanted is None:
        return candidates[0]
    name = str(wanted).strip("/")
    for each in candidates:
        if name in (each.name, each.path):
            return each
    raise FileError(f"has no volume “{printable(name)[:40]}”; it holds {format_names(candidates)}.")


def _check_chunks(dataset: Any) -> None:
    if dataset.chunks and prod(dataset.chunks) * dataset.dtype.itemsize > MAX_CHUNK_BYTES:
        raise FileError("is packed in chunks of more than 0.5 GiB; save it with smaller ones.")


def _prepare() -> None:
    os.environ["HDF5_PLUGIN_PRELOAD"] = "::"  # no shared libraries for filters that a file asks for
    import h5py  # noqa: F401


FORMAT = VolumeFormat(
    "hdf5",
    "an HDF5 file",
    (".h5", ".hdf5", ".hdf", ".nxs", ".ims"),
    lambda head: head.startswith(b"\x89HDF\r\n\x1a\n"),
    open_hdf5,
    _prepare,
)
