"""HDF5 as ilastik, Fiji and beamlines write it; links and mappings to other files are not followed."""

import os
from collections.abc import Mapping
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import printable
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.hdf5 import (
    Candidate,
    ChunkLayers,
    candidates_in,
    check_storage,
    element_size,
    shown_names,
)
from regolith_studio.readers.voxels.header import (
    DatasetEntry,
    VoxelHeader,
    stated_axes,
    three_dimensions,
    voxel_type,
)

LARGEST_CHUNK = 1 << 29


class Hdf5Voxels:
    """A dataset whose slices are read layer of chunks by layer of chunks."""

    def __init__(self, file: Any, dataset: Any, candidate: Candidate, header: VoxelHeader) -> None:
        self.header = header
        self._file, self._layers = file, ChunkLayers(dataset, candidate.axes, candidate.channel)
        self.layer = self._layers.depth

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1, shape (z1 - z0, ny, nx)."""
        try:
            part = self._layers.read(z0, z1)
        except (OSError, ValueError, RuntimeError):
            raise FileError(f"is damaged: its slices {z0 + 1} to {z1} cannot be unpacked.") from None
        return np.ascontiguousarray(part, dtype=self.header.dtype)

    def close(self) -> None:
        """Let go of the file."""
        self._file.close()


def open_hdf5(path: Path, options: Mapping[str, Any]) -> Hdf5Voxels:
    """The volume ``options["dataset"]`` of a file, by default the likeliest, with its ``options["axes"]``.

    Raises
    ------
    FileError
        If the file is broken, holds no volume, or its voxels lie in other files.
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
    candidates = candidates_in(file, axes)
    if not candidates:
        raise FileError(
            "holds no volume: none of its arrays has three dimensions of numbers (links are not followed)."
        )
    candidate = _candidate(candidates, wanted)
    dataset = file[candidate.path]
    if axes:
        stated_axes(axes, len(candidate.shape))
    check_storage(dataset)
    _check_chunks(dataset)
    size = element_size(dataset, candidate)
    notes: tuple[str, ...] = ()
    if wanted is None and len(candidates) > 1:
        notes = (f"The file holds {len(candidates)} volumes; {printable(candidate.name)[:60]} was read.",)
    header = VoxelHeader(
        three_dimensions(candidate.spatial),
        voxel_type(dataset.dtype),
        size,
        "um" if size else None,
        None,
        notes,
        tuple(DatasetEntry(each.name, each.spatial[::-1], each.dtype) for each in candidates),
        candidate.name,
    )
    return Hdf5Voxels(file, dataset, candidate, header)


def _candidate(candidates: list[Candidate], wanted: Any) -> Candidate:
    if wanted is None:
        return candidates[0]
    name = str(wanted).strip("/")
    for each in candidates:
        if name in (each.name, each.path):
            return each
    raise FileError(f"has no volume “{printable(name)[:40]}”; it holds {shown_names(candidates)}.")


def _check_chunks(dataset: Any) -> None:
    if dataset.chunks and prod(dataset.chunks) * dataset.dtype.itemsize > LARGEST_CHUNK:
        raise FileError("is packed in chunks of more than 0.5 GiB; save it with smaller ones.")


def _prepare() -> None:
    os.environ["HDF5_PLUGIN_PRELOAD"] = "::"  # no shared libraries for filters that a file asks for
    import h5py  # noqa: F401


FORMAT = VolumeFormat(
    "hdf5",
    "an HDF5 file",
    (".h5", ".hdf5", ".hdf", ".nxs"),
    lambda head: head.startswith(b"\x89HDF\r\n\x1a\n"),
    open_hdf5,
    _prepare,
)
