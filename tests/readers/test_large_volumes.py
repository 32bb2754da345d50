"""Volumes larger than the memory that the program may use are read slab by slab."""

import os
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
import tifffile

from regolith_studio.errors import FileError
from regolith_studio.readers.volumes.read import open_slabs, read_volume

REPOSITORY = Path(__file__).resolve().parents[2]
EDGE = 1024
ALLOWED = 900 * 1024**2
"""Bytes of addresses for program and child each, less than the gibibyte of the volume."""

SCRIPT = f"""
import os, resource, sys
resource.setrlimit(resource.RLIMIT_AS, ({ALLOWED}, {ALLOWED}))
from regolith_studio.readers.volumes.read import open_slabs
total = count = 0
for z0, slab in open_slabs(sys.argv[1], voxel_size=1.0, kind="labels").slabs(64):
    total += int(slab.sum(dtype="u8")) * (z0 // 64 + 1)
    count += slab.size
from regolith_studio.readers.sandbox.parent import volume_sandbox
volume_sandbox().close()
own = next(line.split()[1] for line in open("/proc/self/status") if line.startswith("VmHWM"))
print(total, count, own, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


def layers() -> np.ndarray:
    """64 slices of labels in blocks; the slab number k holds them plus k."""
    steps = (np.arange(EDGE) // 64).astype(np.uint8)
    layer = steps[:, None] + steps[None, :]
    return np.repeat(layer[None], 64, axis=0)


def write_npy(path: Path) -> None:
    file = np.lib.format.open_memmap(path, "w+", np.uint8, (EDGE,) * 3)
    for k in range(EDGE // 64):
        file[64 * k : 64 * k + 64] = layers() + k
    file.flush()


def write_hdf5(path: Path) -> None:
    with h5py.File(path, "w") as file:
        data = file.create_dataset(
            "exported_data", (EDGE,) * 3, "u1", chunks=(64, 128, 128), compression="gzip", compression_opts=1
        )
        for k in range(EDGE // 64):
            data[64 * k : 64 * k + 64] = layers() + k


def write_tiff(path: Path) -> None:
    pages = (layers()[0] + z // 64 for z in range(EDGE))
    tifffile.imwrite(
        path, pages, shape=(EDGE,) * 3, dtype="u1", compression="zlib", photometric="minisblack",
        compressionargs={"level": 1},
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux limits the address space")
@pytest.mark.parametrize("write", [write_npy, write_hdf5, write_tiff], ids=["npy", "hdf5", "tiff"])
def test_that_a_gibibyte_of_voxels_is_read_with_less_memory_than_it_has(write, tmp_path) -> None:
    write(tmp_path / "large.file")
    single = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(tmp_path / "large.file")],
        capture_output=True, text=True, cwd=REPOSITORY, check=False, env={**os.environ, **single},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    total, count, own, childs = map(int, done.stdout.split())
    base = int(layers().sum(dtype="u8"))
    expected = sum((base + k * 64 * EDGE**2) * (k + 1) for k in range(EDGE // 64))
    assert (total, count) == (expected, EDGE**3)
    assert max(own, childs) * 1024 < ALLOWED / 2
    (tmp_path / "large.file").unlink()


def test_that_a_volume_of_more_than_half_the_memory_is_left_to_slabs(tmp_path, monkeypatch) -> None:
    """A file of a few kilobytes that would take a gibibyte, on a machine of half of that."""
    path = tmp_path / "bomb.h5"
    with h5py.File(path, "w") as file:
        file.create_dataset("a", (EDGE,) * 3, "u1", chunks=(16, 64, 64), compression="gzip")
    assert path.stat().st_size < 10_000
    monkeypatch.setattr("regolith_studio.readers.volumes.read.machine_memory", lambda: 512 * 1024**2)
    with pytest.raises(FileError, match=r"has 1 GiB of voxels, more than half of this machine's memory"):
        read_volume(path, voxel_size=1.0, kind="grey")
    part = read_volume(path, voxel_size=1.0, kind="grey", bounds=((0, 8), (0, 8), (1000, 1008)))
    assert part.shape == (8, 8, 8)
    assert open_slabs(path, voxel_size=1.0, kind="grey").read(500, 501).shape == (EDGE, EDGE, 1)
