"""OME-Zarr 0.4 and 0.5 in a local folder: pyramids of levels, of which one is read.

The metadata follow the NGFF specifications 0.4 (Zarr 2, ``.zattrs``) and 0.5 (Zarr 3, ``ome`` in
``zarr.json``). Only numbers and the codecs in :data:`CODECS` are read: others could run programs.
"""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.messages import N_, Message
from regolith_studio.readers.error_messages import any_fault, printable
from regolith_studio.readers.settings import in_one_unit
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.header import (
    MAX_CACHED_BYTES,
    DatasetEntry,
    Sizes,
    VoxelHeader,
    hand_note,
    sizes_or_none,
    three_dimensions,
    voxel_type,
)
from regolith_studio.readers.voxels.slice_series import is_zarr

CODECS = frozenset(
    ("blosc", "bz2", "bytes", "crc32c", "delta", "gzip", "lz4", "lzma", "sharding_indexed", "shuffle",
     "transpose", "zlib", "zstd")
)  # fmt: skip
MAX_CHUNK_BYTES = 1 << 29
MAX_METADATA_BYTES = 1 << 24
MAX_LEVELS, MAX_CHANNELS = 32, 32
_NO_IMAGE = "is no OME-Zarr: it describes no image of several scales."


@dataclass(frozen=True)
class _Level:
    """One array, or one channel of it.

    `name` is the path of the array, with the channel in brackets where there are several; `scale` has the
    edge of a voxel along each of its `axes`.
    """

    name: str
    path: str
    channel: int
    axes: str
    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    scale: tuple[float, ...]
    depth: int

    @property
    def spatial(self) -> tuple[int, int, int]:
        """Slices, rows, columns."""
        nz, ny, nx = (self.shape[self.axes.index(axis)] for axis in "zyx")
        return nz, ny, nx

    @property
    def size(self) -> Sizes | None:
        """Edges of a voxel along x, y and z."""
        return sizes_or_none([self.scale[self.axes.index(axis)] for axis in "xyz"])


class ZarrVoxels:
    """A level of an opened hierarchy; `layer` is the depth of its chunks along z.

    Slices are unpacked with all of their chunks: the layer that some were read of is kept for the next
    request, if it has at most :data:`MAX_CACHED_BYTES`.
    """

    def __init__(self, array: Any, level: _Level, header: VoxelHeader) -> None:
        self.header, self.layer = header, level.depth
        self._array, self._level = array, level
        self._kept: tuple[int, NDArray[Any]] | None = None

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1, shape (z1 - z0, ny, nx)."""
        first = z0 // self.layer * self.layer
        stop = min(first + self.layer, self.header.shape[0])
        n_bytes = (stop - first) * self.header.slice_bytes
        with any_fault(f"is damaged: its slices {z0 + 1} to {z1} cannot be unpacked."):
            if z1 <= stop and z1 - z0 < stop - first and n_bytes <= MAX_CACHED_BYTES:
                part = self._layer_from(first, stop)[z0 - first : z1 - first]
            else:
                part = self._unpacked(z0, z1)
        return np.ascontiguousarray(part, dtype=self.header.dtype)

    def close(self) -> None:
        """Do nothing: no file is kept open."""

    def _layer_from(self, first: int, stop: int) -> NDArray[Any]:
        if self._kept is None or self._kept[0] != first:
            self._kept = None  # two layers are never in memory
            self._kept = first, self._unpacked(first, stop)
        return self._kept[1]

    def _unpacked(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices as the array has them, turned to slices, rows, columns."""
        axes, every = self._level.axes, slice(None)
        picked = {"z": slice(z0, z1), "y": every, "x": every, "c": self._level.channel, "t": 0}
        part = np.asarray(self._array[tuple(picked[axis] for axis in axes)])
        kept = [axis for axis in axes if axis in "zyx"]
        return part.transpose([kept.index(axis) for axis in "zyx"])


def open_ome_zarr(path: Path, options: Mapping[str, Any]) -> ZarrVoxels:
    """The level ``options["dataset"]`` of an image, by default the finest."""
    attributes = _attributes(path)
    image = _image(attributes)
    axes, units = _axes(image)
    factors, unit = in_one_unit((1.0, 1.0, 1.0), [units[axis] for axis in "xyz"]) or ((1.0, 1.0, 1.0), None)
    factor = dict(zip("xyz", factors, strict=True))
    levels = [
        level
        for entry in _list(image.get("datasets"))[:MAX_LEVELS]
        for level in _levels(path, entry, axes, image, factor)
    ]
    if not levels:
        raise FileError(_NO_IMAGE)
    level = _chosen(levels, options.get("dataset"))
    header = VoxelHeader(
        three_dimensions(level.spatial),
        voxel_type(level.dtype),
        level.size,
        unit if level.size else None,
        "labels" if "image-label" in attributes else None,
        (*_notes(levels, level, options.get("dataset")), *hand_note(level.scale)),
        tuple(DatasetEntry(each.name, each.spatial[::-1], each.dtype.name, each.size) for each in levels),
        level.name,
    )
    return ZarrVoxels(_opened(path, level), level, header)


def _notes(levels: list[_Level], level: _Level, wanted: Any) -> tuple[str, ...]:
    """That one of several channels was read, where none was asked for."""
    channels = sum(each.path == level.path for each in levels)
    if channels == 1 or str(wanted or "").strip("/") == level.name:
        return ()
    template = N_("The file holds {count} volumes; {name} was read.")
    return (Message(template, count=channels, name=printable(level.name)[:60]),)


def _attributes(path: Path) -> dict[str, Any]:
    """The attributes of a group that describe an image."""
    if (path / "zarr.json").is_file():
        group = _json(path, "zarr.json").get("attributes")
        nested = group.get("ome") if isinstance(group, dict) else None
    else:
        nested = _json(path, ".zattrs") if (path / ".zattrs").is_file() else None
    if isinstance(nested, dict) and "bioformats2raw.layout" in nested:
        raise FileError("holds several images; open the folder of one of them, such as the folder 0 in it.")
    if not isinstance(nested, dict):
        raise FileError(_NO_IMAGE)
    return nested


def _json(folder: Path, name: str) -> dict[str, Any]:
    path = _checked(folder, name)
    try:
        data = path.read_bytes() if path.stat().st_size <= MAX_METADATA_BYTES else b""
        document = json.loads(data)
    except (ValueError, RecursionError):
        document = None
    if not isinstance(document, dict):
        raise FileError(f"is a broken Zarr: its file “{printable(name)[:60]}” holds no metadata.")
    return document


def _checked(folder: Path, name: str) -> Path:
    """A file of a hierarchy, which no link may lead out of."""
    path = folder / name
    if not path.resolve().is_relative_to(folder.resolve()):
        raise FileError(f"has a link out of its folder, “{printable(name)[:60]}”, which is not followed.")
    if not path.is_file():
        raise FileError(f"is a broken Zarr: its file “{printable(name)[:60]}” is not there.")
    return path


def _image(attributes: Mapping[str, Any]) -> dict[str, Any]:
    images = _list(attributes.get("multiscales"))
    if not images or not isinstance(images[0], dict):
        raise FileError(_NO_IMAGE)
    return images[0]


def _axes(image: Mapping[str, Any]) -> tuple[str, dict[str, str]]:
    """A letter for each axis, and the unit that each states."""
    # Axes are plain names in NGFF 0.3.
    entries = [each if isinstance(each, dict) else {"name": each} for each in _list(image.get("axes"))]
    letters = "".join(str(each.get("name", "?"))[:9] for each in entries).lower()
    if (
        len(letters) != len(entries)
        or len(set(letters)) != len(letters)
        or not set("zyx") <= set(letters) <= set("tczyx")
    ):
        raise FileError(
            f"has the axes “{printable(letters)[:20]}”; x, y and z, each once, and perhaps t and c are read."
        )
    units = [str(each.get("unit", ""))[:20] for each in entries]
    return letters, dict(zip(letters, units, strict=True))


def _levels(
    path: Path, entry: Any, axes: str, image: Mapping[str, Any], factor: Mapping[str, float]
) -> list[_Level]:
    """The channels of one array; the scale along each axis is multiplied by its factor."""
    name = str(entry.get("path", "")) if isinstance(entry, dict) else ""
    if not name or Path(name).is_absolute() or ".." in Path(name).parts:
        raise FileError("is a broken OME-Zarr: the place of one of its levels is invalid.")
    shape, dtype, chunks = _array_metadata(path, name)
    if len(shape) != len(axes):
        raise FileError(f"is a broken OME-Zarr: its level {printable(name)[:40]} has not the axes “{axes}”.")
    if math.prod(chunks) * dtype.itemsize > MAX_CHUNK_BYTES:
        raise FileError("is packed in chunks of more than 0.5 GiB; save it with smaller ones.")
    edges = dict(zip(axes, shape, strict=True))
    factors = np.array([factor.get(axis, 1.0) for axis in axes])
    # NGFF: the transformations of the whole image apply after those of a level.
    scale = tuple((_scale(entry, len(axes)) * _scale(image, len(axes)) * factors).tolist())
    channels = edges.get("c", 1)
    if edges.get("t", 1) != 1 or channels > MAX_CHANNELS:
        raise FileError("holds several times or very many channels; export one volume of it.")
    names = [name] if channels == 1 else [f"{name}[{channel}]" for channel in range(channels)]
    depth = chunks[axes.index("z")]
    return [_Level(each, name, k, axes, shape, dtype, scale, depth) for k, each in enumerate(names)]


def _scale(entry: Mapping[str, Any], dimensions: int) -> NDArray[np.float64]:
    """The product of the scales of the coordinate transformations, along all axes."""
    product = np.ones(dimensions)
    for each in _list(entry.get("coordinateTransformations")):
        if not isinstance(each, dict) or each.get("type") != "scale":
            continue
        factors = _list(each.get("scale"))
        if len(factors) != dimensions or not all(
            isinstance(f, int | float) and math.isfinite(f) for f in factors
        ):
            raise FileError("is a broken OME-Zarr: its scales are not a number for each axis.")
        product *= np.array(factors, float)
    return product


def _array_metadata(path: Path, name: str) -> tuple[tuple[int, ...], np.dtype[Any], tuple[int, ...]]:
    """Shape, type and chunks of an array whose codecs are all known; of shards the chunks in them."""
    try:
        if (path / name / "zarr.json").is_file():
            stated = _json(path, f"{name}/zarr.json")
            shape, kind = stated["shape"], str(stated["data_type"])
            codecs, chunks = stated["codecs"], stated["chunk_grid"]["configuration"]["chunk_shape"]
        else:
            stated = _json(path, f"{name}/.zarray")
            shape, kind, chunks = stated["shape"], str(stated["dtype"]), stated["chunks"]
            codecs = [
                *(stated.get("filters") or ()),
                *([stated["compressor"]] if stated.get("compressor") else []),
            ]
        inner = _check_codecs(codecs)
        edges = tuple(int(edge) for edge in shape)
        depths = tuple(int(edge) for edge in inner or chunks)
        if len(edges) != len(depths) or min(depths) < 1 or min(edges) < 1:
            raise ValueError("no chunks")
        return edges, np.dtype(kind), depths
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError):
        raise FileError(
            f"is a broken Zarr: the metadata of its level {printable(name)[:40]} are incomplete or wrong."
        ) from None


def _check_codecs(codecs: Any, nested: bool = False) -> Any:
    """Refuse codecs that are not known; returns the chunks in a shard, if there are shards."""
    inner = None
    for each in _list(codecs):
        name = str(each.get("id") or each.get("name") if isinstance(each, dict) else each)
        if name not in CODECS:
            raise FileError(
                f"is packed by “{printable(name)[:30]}”, which is not read; save it with zstd or blosc."
            )
        if name == "sharding_indexed":
            if nested:
                raise FileError("has shards in shards, which are not read.")
            within = each["configuration"]
            _check_codecs(within["codecs"], True)
            _check_codecs(within["index_codecs"], True)
            inner = within["chunk_shape"]
    return inner


def _chosen(levels: list[_Level], wanted: Any) -> _Level:
    if wanted is None:  # the finest, of several the first
        return max(levels, key=lambda level: math.prod(level.spatial))
    for each in levels:
        if str(wanted).strip("/") in (each.name, each.path):
            return each
    names = ", ".join(printable(each.name)[:40] for each in levels[:8])
    raise FileError(f"has no level “{printable(str(wanted))[:40]}”; it holds {names}.")


def _opened(path: Path, level: _Level) -> Any:
    """The array of a level, opened by zarr in a store that follows no link out of the folder."""
    import zarr
    from zarr.storage import LocalStore

    class LinkedStore(LocalStore):
        """A folder whose files are checked before they are read."""

        async def get(self, key: str, prototype: Any = None, byte_range: Any = None) -> Any:
            _check_link(self.root, key)
            return await super().get(key, prototype, byte_range)

        async def get_partial_values(self, prototype: Any, key_ranges: Any) -> Any:
            ranges = list(key_ranges)
            for key, _ in ranges:
                _check_link(self.root, key)
            return await super().get_partial_values(prototype, ranges)

    with any_fault("is a broken Zarr: its metadata are invalid; export it again."):
        array = zarr.open_array(LinkedStore(path, read_only=True), path=level.path, mode="r")
    if array.shape != level.shape or array.dtype.newbyteorder("=") != level.dtype.newbyteorder("="):
        raise FileError("is a broken Zarr: its metadata contradict each other; export it again.")
    return array


def _check_link(root: Path, key: str) -> None:
    """Refuse what is there and is no regular file below the folder; a chunk may be absent."""
    if (root / key).exists():
        _checked(root, key)


def _list(value: Any) -> list[Any]:
    return value if isinstance(value, list) else []


def _prepare() -> None:
    try:
        import zarr
    except ImportError:
        raise FileError('is Zarr, which needs zarr, an extra: pip install "regolith-studio[zarr]".') from None
    zarr.config.set({"async.concurrency": 1, "threading.max_workers": 1})
    zarr.zeros(shape=(1,), chunks=(1,))[:]  # its threads begin before a request limits the memory


FORMAT = VolumeFormat(
    "ome_zarr", "an OME-Zarr", (".zarr",), lambda _head: False, open_ome_zarr, _prepare, is_zarr
)
