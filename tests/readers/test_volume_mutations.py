"""Volumes with bytes changed at random: every parser gives voxels or one sentence, nothing else.

The program's own parsers are asked directly, so that nothing but the error of a bad file passes for an
answer; TIFF and HDF5, whose libraries are compiled, through the sandbox, as users meet them.
"""

import gzip
import io
from collections.abc import Callable, Iterator
from pathlib import Path

import h5py
import numpy as np
import pytest
import tifffile

from regolith_studio.errors import FileError
from regolith_studio.readers.sandbox.tasks import open_volume_file, read_checked_slices
from regolith_studio.readers.volumes.read import describe_volume, open_slabs
from tests.readers.mutations import check_answers, check_sentence, folder_in_memory, mutated
from tests.readers.test_txm import txm

SLICES = np.random.default_rng(1).integers(0, 9, (4, 5, 6)).astype(np.uint16)
FOREIGN = Path(__file__).with_name("foreign_volumes")


def tiff(**options: object) -> bytes:
    file = io.BytesIO()
    tifffile.imwrite(file, SLICES, photometric="minisblack", **options)
    return file.getvalue()


def hdf5(**options: object) -> bytes:
    file = io.BytesIO()
    with h5py.File(file, "w") as stored:
        data = stored.create_dataset("exported_data", data=SLICES, **options)
        data.attrs["axistags"] = '{"axes": [{"key": "z"}, {"key": "y"}, {"key": "x"}]}'
        data.attrs["element_size_um"] = (3.0, 2.0, 1.0)
    return file.getvalue()


def npy() -> bytes:
    file = io.BytesIO()
    np.save(file, SLICES)
    return file.getvalue()


def foreign(name: str) -> Callable[[], bytes]:
    return (FOREIGN / name).read_bytes


def nii_gz() -> bytes:
    return gzip.compress((FOREIGN / "nib1.nii").read_bytes(), mtime=0)


OWN = {
    "a.npy": npy,
    "raw.nrrd": foreign("pynrrd-raw.nrrd"),
    "gzip.nrrd": foreign("pynrrd-gzip-be.nrrd"),
    "raw.mha": foreign("itk-raw.mha"),
    "zlib.mha": foreign("itk-zlib.mha"),
    "one.nii": foreign("nib1.nii"),
    "two.nii": foreign("nib2.nii"),
    "one.nii.gz": nii_gz,
    "small.txm": txm,
    "large.txm": lambda: txm((2, 40, 60)),
}
LIBRARIES = {
    "plain.tif": tiff,
    "lzw.tif": lambda: tiff(compression="lzw"),
    "zlib.tif": lambda: tiff(compression="zlib", predictor=True),
    "imagej.tif": lambda: tiff(imagej=True, metadata={"axes": "ZYX", "unit": "um", "spacing": 2.0}),
    "big.tif": lambda: tiff(bigtiff=True, tile=(16, 16), compression="packbits"),
    "plain.h5": hdf5,
    "gzip.h5": lambda: hdf5(chunks=(2, 3, 3), compression="gzip", shuffle=True),
}


def answer_of(path: Path) -> str:
    """What a parser says to a file, in this process: its sentence, or nothing if it gives voxels."""
    try:
        volume, _ = open_volume_file(path, {})
        try:
            header = volume.header
            read_checked_slices(volume, 0, min(header.shape[0], 2))
        finally:
            volume.close()
    except FileError as error:
        return str(error)
    return ""


def sandboxed_answer_of(path: Path) -> str:
    """The same through the child."""
    try:
        header = describe_volume(path)
        open_slabs(path, voxel_size=1.0, kind="grey").read(0, min(header.shape[2], 2))
    except FileError as error:
        sentence = str(error)
    else:
        sentence = f"{path.name}."
    assert sentence.startswith(path.name), sentence
    return sentence.removeprefix(f"{path.name}.")


def run_own(name: str, count: int, seed: int, path: Path) -> None:
    path.write_bytes(OWN[name]())
    check_answers(path, lambda: answer_of(path), seed, count)


def run_sandboxed(name: str, count: int, seed: int, path: Path) -> int:
    """How many files ended the child that read them."""
    rng = np.random.default_rng(seed)
    data = LIBRARIES[name]()
    path.write_bytes(data)
    assert sandboxed_answer_of(path) == ""
    ended = 0
    for _ in range(count):
        path.write_bytes(mutated(data, rng))
        sentence = sandboxed_answer_of(path)
        check_sentence(sentence)
        ended += "crashed the process" in sentence or "given up" in sentence
    path.write_bytes(data)
    assert sandboxed_answer_of(path) == ""
    return ended


@pytest.fixture
def folder() -> Iterator[Path]:
    with folder_in_memory() as made:
        yield made


@pytest.mark.parametrize(("count", "seed"), [(400, 21), pytest.param(40_000, 23, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", OWN)
def test_that_mutations_give_voxels_or_a_sentence(name, count, seed, folder) -> None:
    run_own(name, count, seed, folder / name)


@pytest.mark.parametrize(("count", "seed"), [(8, 22), pytest.param(40, 22, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", LIBRARIES)
def test_that_mutations_of_library_formats_give_voxels_or_a_sentence(name, count, seed, folder) -> None:
    assert run_sandboxed(name, count, seed, folder / name) <= 2


@pytest.mark.slow
@pytest.mark.parametrize("name", LIBRARIES)
def test_that_forty_thousand_mutations_of_a_library_format_give_voxels_or_a_sentence(name, folder) -> None:
    """Five kinds of TIFF and two of HDF5 share 40,000 each; few files may end the child that reads them."""
    count = 40_000 // sum(Path(other).suffix == Path(name).suffix for other in LIBRARIES)
    assert run_sandboxed(name, count, 24, folder / name) <= count // 500
