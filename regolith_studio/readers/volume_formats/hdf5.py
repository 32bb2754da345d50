"""HDF5 as ilastik, Fiji and beamlines write it; links and mappings to other files are not followed."""

import os
from collections.abc import Mapping
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.messages import N_, Message
from regolith_studio.readers.error_messages import printable
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.hdf5 import (
    Hdf5Volume,
    check_storage,
    element_size,
    find_volumes,
    format_names,
)
from regolith_studio.readers.voxels.header import (
    MAX_CACHED_BYTES,
    DatasetEntry,
    VoxelHeader,
    stated_axes,
    three_dimensions,
    voxel_type,
)

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
    """The volume ``options["dataset"]`` of a file, by default the likeliest, with its ``options["axes"]``.

    Raises FileError if the file is broken, holds no volume, or its voxels lie in other files.
    """
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
