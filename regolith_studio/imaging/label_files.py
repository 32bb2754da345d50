"""Volumes of labels or probabilities for other programs: TIFF, NRRD, HDF5, written slab by slab.

Each holds the edges of a voxel in micrometres and is compressed without loss; equal values give equal bytes.
"""

import gzip
import uuid
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.imaging.volume_slabs import SliceSource, slab_ranges
from regolith_studio.io.atomic import staged_file

DATASETS = {"labels": "labels", "grey": "probability"}
"""The name of the volume in an HDF5 file, by its kind."""
_BIG_TIFF_BYTES = 2**31
_CHUNK = (8, 128, 128)
_LEVEL = 1
"""Of zlib: labels are constant over wide areas, where higher levels gain little."""

_Slabs = Iterator[NDArray[Any]]


def write_label_file(path: Path, labels: SliceSource, highest: int) -> Iterator[tuple[int, int]]:
    """Write a label volume, as its suffix says, telling after each slab how many are done, of how many.

    ``path``: a name that ends in one of :data:`LABEL_SUFFIXES`; the file appears when it is complete.
    ``highest``: the highest label, by which voxels have 16 or 32 bits.

    Raises InputError if the suffix is another. Raises FileError if the file cannot be written.
    """
    stored = np.dtype(np.uint16 if highest < 2**16 else np.uint32)
    return _write(path, labels, stored)


def write_probability_file(path: Path, probabilities: SliceSource) -> Iterator[tuple[int, int]]:
    """As :func:`write_label_file`, of probabilities from 0 to 255 in 8 bits."""
    return _write(path, probabilities, np.dtype(np.uint8))


def _write(path: Path, labels: SliceSource, stored: np.dtype[Any]) -> Iterator[tuple[int, int]]:
    suffix, ranges = label_suffix(path), slab_ranges(labels.shape)

    def slabs() -> _Slabs:
        for first, stop in ranges:
            slab = labels.read(first, stop)
            yield np.ascontiguousarray(np.maximum(slab, 0).astype(stored, copy=False).T)

    with staged_file(path) as stream:
        for done, _ in enumerate(_WRITERS[suffix](stream, slabs(), labels, stored), start=1):
            yield done, len(ranges)


def label_suffix(path: Path) -> str:
    """The suffix of a label file in lower case.

    Raises InputError if it is none of :data:`LABEL_SUFFIXES`.
    """
    suffix = path.suffix.lower()
    if suffix not in LABEL_SUFFIXES:
        raise InputError(f"Labels are written as {', '.join(LABEL_SUFFIXES)}, not as {path.name}.")
    return suffix


def _write_tiff(
    stream: IO[bytes], slabs: _Slabs, labels: SliceSource, stored: np.dtype[Any]
) -> Iterator[None]:
    """OME-TIFF, a page a slice."""
    import tifffile

    nx, ny, nz = labels.shape
    edges = zip("XYZ", np.asarray(labels.voxel_size, float).tolist(), strict=True)
    sizes = {name: value for axis, edge in edges for name, value in (
        (f"PhysicalSize{axis}", edge), (f"PhysicalSize{axis}Unit", "µm"),
    )}  # fmt: skip
    # tifffile's own identifier holds the time, so that equal volumes would differ.
    ome = tifffile.OmeXml(UUID=str(uuid.uuid5(uuid.NAMESPACE_OID, f"{labels.name} {labels.shape}")))
    ome.addimage(stored, (nz, ny, nx), (nz, 1, 1, ny, nx, 1), axes="ZYX", Name=DATASETS[labels.kind], **sizes)
    options: dict[str, Any] = {"description": ome.tostring(declaration=True).encode()}
    big = nx * ny * nz * stored.itemsize > _BIG_TIFF_BYTES
    with tifffile.TiffWriter(stream, bigtiff=big) as file:
        for slab in slabs:
            for page in slab:
                file.write(
                    page,
                    photometric="minisblack",
                    compression="zlib",
                    compressionargs={"level": _LEVEL},
                    metadata=None,
                    **options,
                )
                # The XML of OME-TIFF stands in the first page alone.
                options = {}
            yield


def _write_nrrd(
    stream: IO[bytes], slabs: _Slabs, labels: SliceSource, stored: np.dtype[Any]
) -> Iterator[None]:
    """NRRD with a gzip stream; the origin is that of the region in the whole volume."""
    edges = np.asarray(labels.voxel_size, float)
    directions = " ".join(f"({','.join(repr(float(x)) for x in row)})" for row in np.diag(edges))
    origin = ",".join(repr(float(x)) for x in np.array(labels.origin) * edges)
    lines = (
        "NRRD0004",
        f"type: {stored.name}",
        "dimension: 3",
        "space dimension: 3",
        "sizes: " + " ".join(map(str, labels.shape)),
        f"space directions: {directions}",
        'space units: "um" "um" "um"',
        f"space origin: ({origin})",
        "kinds: domain domain domain",
        "endian: little",
        "encoding: gzip",
    )
    stream.write("\n".join((*lines, "", "")).encode("ascii"))
    with gzip.GzipFile("", "wb", _LEVEL, stream, mtime=0) as packed:
        for slab in slabs:
            packed.write(slab.astype(stored.newbyteorder("<"), copy=False).data.cast("B"))
            yield


def _write_hdf5(
    stream: IO[bytes], slabs: _Slabs, labels: SliceSource, stored: np.dtype[Any]
) -> Iterator[None]:
    """A dataset of slices, rows and columns with ``element_size_um``, as Fiji and ilastik read it."""
    import h5py

    shape = labels.shape[::-1]
    chunks = tuple(min(edge, chunk) for edge, chunk in zip(shape, _CHUNK, strict=True))
    edges = np.asarray(labels.voxel_size, float)[::-1]
    with h5py.File(stream.name, "w", locking=False) as file:
        dataset = file.create_dataset(
            DATASETS[labels.kind], shape, stored,
            chunks=chunks, compression="gzip", compression_opts=_LEVEL, shuffle=True,
        )  # fmt: skip
        dataset.attrs["element_size_um"] = edges
        at = 0
        for slab in slabs:
            dataset[at : at + len(slab)] = slab
            at += len(slab)
            yield


_WRITERS: dict[str, Callable[[IO[bytes], _Slabs, SliceSource, np.dtype[Any]], Iterator[None]]] = {
    ".tif": _write_tiff,
    ".tiff": _write_tiff,
    ".nrrd": _write_nrrd,
    ".h5": _write_hdf5,
    ".hdf5": _write_hdf5,
}
LABEL_SUFFIXES = tuple(_WRITERS)
