"""How long and how much memory it takes to get from volumes to particles, also where volumes are larger.

Run as ``python -m benchmarks.imaging [--edge 512] [--grey] [--memory GIB]``. Writes a volume of many grains
into a temporary folder (one grain a cell of 51 voxels: 1,000 grains at 512 voxels an edge, 8,000 at 1,024;
``--share 0.25`` fills every fourth cell only, ``--packed`` writes a compressed HDF5 file instead of NPY,
``--packed --chunk 64`` one of cubic chunks, ``--zarr`` an OME-Zarr of chunks of 64 voxels),
then makes, measures and writes its particles in a process of its own, whose private memory
(RLIMIT_DATA) may be limited. Reported are seconds by the clock and by the processor for each kind of
process, the peaks of private memory and of resident memory, in which mapped pages of files count too, and
the size of temporary files. With ``--jobs N`` the work is shared out among N processes, with ``--dask N``
among N workers of a Dask cluster on this machine; then the bytes of all tasks and of all their results are
reported, and a hash of the particles, which does not depend on N.
"""

import argparse
import hashlib
import json
import os
import pickle
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import psutil
from numpy.typing import NDArray
from scipy import ndimage

from regolith_studio.imaging.segmentation.segment import SegmentationSettings
from regolith_studio.imaging.settings import DenoiseSettings
from regolith_studio.imaging.volume import sample_volume
from regolith_studio.jobs.events import Started
from regolith_studio.jobs.executor import Executor
from regolith_studio.jobs.extraction_jobs import extract_measured
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
from regolith_studio.session.outputs.particles import ParticleRecord, write_particle

CELL = 51
GREY = (62, 150, 9.0)
"""Brightness of resin and grains, and the noise."""


def grain_masks() -> list[NDArray[np.bool_]]:
    """The whole grains of the shipped scan, each enlarged to fill a cell almost."""
    labels = sample_volume("labels").array
    masks = []
    for label, box in enumerate(ndimage.find_objects(labels), start=1):
        if all(side.start > 0 and side.stop < n for side, n in zip(box, labels.shape, strict=True)):
            mask = np.pad(labels[box] == label, 1)
            larger = ndimage.zoom(mask.astype(np.float32), (CELL - 6) / max(mask.shape), order=1) > 0.5
            masks.append(larger)
    return masks


def write_volume(
    path: Path, edge: int, grey: bool, share: float = 1.0, seed: int = 0, chunk: int | None = None
) -> int:
    """Write an NPY or HDF5 volume, slices first, layer of cells by layer; returns the number of grains."""
    shape, dtype = (edge, edge, edge), np.dtype(np.uint8 if grey else np.uint16)
    if path.suffix == ".npy":
        volume = np.lib.format.open_memmap(path, "w+", dtype, shape)
        count = _fill(volume, edge, grey, share, np.random.default_rng(seed))
        volume.flush()
        return count
    if path.suffix == ".zarr":
        return _write_zarr(path, edge, grey, share, seed)
    with h5py.File(path, "w") as file:
        data = file.create_dataset(
            "exported_data",
            shape,
            dtype,
            chunks=(chunk, chunk, chunk) if chunk else (8, 512, 512),
            compression="gzip",
            compression_opts=1,
        )
        return _fill(data, edge, grey, share, np.random.default_rng(seed))


def _write_zarr(path: Path, edge: int, grey: bool, share: float, seed: int) -> int:
    """An OME-Zarr of one level, as NGFF 0.4 has it, copied from an NPY file that is removed again."""
    import zarr

    plain = path.with_suffix(".npy")
    count = write_volume(plain, edge, grey, share, seed)
    volume = np.load(plain, mmap_mode="r")
    group = zarr.open_group(path, mode="w", zarr_format=2)
    array = group.create_array("0", shape=volume.shape, dtype=volume.dtype, chunks=(64,) * 3)
    for first in range(0, edge, 64):
        array[first : first + 64] = volume[first : first + 64]
    axes = [{"name": axis, "type": "space", "unit": "micrometer"} for axis in "zyx"]
    scale = [{"type": "scale", "scale": [2.3] * 3}]
    level = {"path": "0", "coordinateTransformations": scale}
    image: Any = {"version": "0.4", "axes": axes, "datasets": [level]}
    group.attrs["multiscales"] = [image]
    del volume
    plain.unlink()
    return count


def _fill(volume: Any, edge: int, grey: bool, share: float, generator: np.random.Generator) -> int:
    masks, count = grain_masks(), 0
    per_edge = edge // CELL
    for layer in range(-(-edge // CELL)):
        top = layer * CELL
        depth = min(CELL, edge - top)
        slab = np.zeros((CELL, edge, edge), dtype=np.uint16)
        for row, column in np.ndindex(per_edge, per_edge) if depth == CELL else ():
            if share < 1.0 and generator.random() >= share:
                continue
            mask = masks[generator.integers(len(masks))].transpose(generator.permutation(3))
            shift = [int(generator.integers(2, CELL - 1 - n)) for n in mask.shape]
            count += 1
            z, y, x = shift[0], row * CELL + shift[1], column * CELL + shift[2]
            target = slab[z : z + mask.shape[0], y : y + mask.shape[1], x : x + mask.shape[2]]
            target[mask] = count
        volume[top : top + depth] = _scanned(slab[:depth], generator) if grey else slab[:depth]
    return count


def _scanned(labels: NDArray[np.uint16], generator: np.random.Generator) -> NDArray[np.uint8]:
    resin, grain, noise = GREY
    blurred = ndimage.gaussian_filter(np.where(labels > 0, np.float32(grain), np.float32(resin)), 0.8)
    seen = blurred + noise * generator.standard_normal(labels.shape, dtype=np.float32)
    return np.asarray(np.clip(seen, 0, 255), dtype=np.uint8)


class ProcessWatch:
    """Seconds of processor time and peaks of memory of this process and those that it starts, by their kind.

    Polled every quarter of a second: processes that live shorter are missed.
    """

    def __init__(self) -> None:
        self._ended = threading.Event()
        self._seconds: dict[tuple[str, int], float] = {}
        self._private: dict[str, int] = defaultdict(int)
        self._resident: dict[str, int] = defaultdict(int)
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self._thread.start()

    def _watch(self) -> None:
        own = psutil.Process()
        while not self._ended.wait(0.25):
            for process in [own, *own.children(recursive=True)]:
                try:
                    kind = "main" if process.pid == own.pid else _kind_of(process.cmdline())
                    memory, times = process.memory_info(), process.cpu_times()
                except (psutil.NoSuchProcess, psutil.ZombieProcess, psutil.AccessDenied):
                    continue
                self._seconds[kind, process.pid] = times.user + times.system
                self._private[kind] = max(self._private[kind], memory.rss - memory.shared)
                self._resident[kind] = max(self._resident[kind], memory.rss)

    def end(self) -> dict[str, float]:
        """What was seen."""
        self._ended.set()
        self._thread.join()
        found: dict[str, float] = defaultdict(float)
        for (kind, _), seconds in self._seconds.items():
            found[f"{kind}: processor seconds"] += seconds
        for kind, size in self._private.items():
            found[f"{kind}: private GiB, peak of one"] = size / 2**30
            found[f"{kind}: resident GiB, peak of one"] = self._resident[kind] / 2**30
        return found


def _kind_of(command: list[str]) -> str:
    return "reader" if "regolith_studio.readers.sandbox.child" in command else "worker"


@contextmanager
def executor_of(jobs: int, dask: int) -> Iterator[tuple[Executor, dict[str, int]]]:
    """An executor, and the bytes of tasks and results that pass through it."""
    executor = Executor.on_cluster(workers=dask) if dask else Executor(jobs)
    moved = dict.fromkeys(("tasks", "bytes of tasks", "bytes of results"), 0)
    if not executor.in_this_thread:
        runner = executor._open_runner()
        submit = runner.submit

        def counted(job: Any, listener: Any, queue: str = "") -> Any:
            moved["tasks"] += 1
            moved["bytes of tasks"] += len(pickle.dumps(job))

            def listen(event: Any) -> None:
                moved["bytes of results"] += len(pickle.dumps(event))
                listener(event)

            return submit(job, listen, queue)

        runner.submit = counted  # type: ignore[method-assign]
    try:
        yield executor, moved
    finally:
        executor.close()


def extract(path: Path, grey: bool, memory: float, jobs: int, dask: int) -> dict[str, Any]:
    """Make all particles in this process, of limited memory, and those that it starts; say what it took."""
    if memory:
        limit = int(memory * 2**30)
        resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
    stages: dict[str, float] = defaultdict(float)
    watch, particles = ProcessWatch(), hashlib.sha256()
    begin = since = time.monotonic()
    stage, written = "", 0.0

    def keep(record: ParticleRecord) -> None:
        particles.update(repr(record.entry).encode())

    given = VolumeInput(path, 2.3, kind="grey" if grey else "labels")
    how = GrainSettings(SegmentationSettings(DenoiseSettings("gaussian")))
    with ExitStack() as scratch, executor_of(jobs, dask) as (executor, moved):
        folder = Path(scratch.enter_context(tempfile.TemporaryDirectory(dir=path.parent)))
        write = partial(write_particle, folder)
        steps = extract_measured(given, how, path.parent, write, keep, executor)
        while True:
            try:
                step = next(steps)
            except StopIteration as end:
                extraction = end.value.extraction
                break
            now = time.monotonic()
            stages[stage], since = stages[stage] + now - since, now
            if isinstance(step, Started):
                stage = str(step.title)
                written = max(written, _temporary_bytes(path.parent) / 2**30)
        seconds = time.monotonic() - begin
        seen = watch.end()
        for file in sorted(folder.glob("*.stl")):
            particles.update(file.read_bytes())
    return {
        "particles": extraction.n_found,
        "hash": particles.hexdigest()[:16],
        "seconds": seconds,
        "temporary GiB": written,
        **{f"seconds: {name or 'Starting'}": value for name, value in stages.items()},
        **seen,
        **moved,
    }


def _temporary_bytes(folder: Path) -> int:
    return sum(file.stat().st_size for file in folder.glob("regolith-*/*.raw"))


def main() -> int:
    """Write, extract in a child, print."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--edge", type=int, default=512)
    options.add_argument("--grey", action="store_true")
    options.add_argument("--share", type=float, default=1.0, help="of the cells that hold a grain")
    options.add_argument("--packed", action="store_true", help="compressed HDF5 instead of NPY")
    options.add_argument("--chunk", type=int, help="edge of a chunk of --packed, instead of 8 x 512 x 512")
    options.add_argument("--memory", type=float, default=0.0, help="limit of private memory, in GiB")
    options.add_argument("--zarr", action="store_true", help="OME-Zarr instead of NPY")
    options.add_argument("--jobs", type=int, default=1)
    options.add_argument("--dask", type=int, default=0, help="workers of a Dask cluster on this machine")
    options.add_argument("--volume", type=Path, help="take this volume, which an earlier --keep has left")
    options.add_argument("--keep", type=Path, help="copy the volume there")
    options.add_argument("--folder", type=Path, default=None)
    options.add_argument("--child", type=Path, help=argparse.SUPPRESS)
    wish = options.parse_args()
    if wish.child:
        print(json.dumps(extract(wish.child, wish.grey, wish.memory, wish.jobs, wish.dask)))
        return 0
    with tempfile.TemporaryDirectory(dir=wish.folder) as folder:
        path = wish.volume
        if path is None:
            path = Path(folder) / f"volume.{'h5' if wish.packed else 'zarr' if wish.zarr else 'npy'}"
            n_grains = write_volume(path, wish.edge, wish.grey, wish.share, chunk=wish.chunk)
            print(f"{wish.edge}^3 voxels, {n_grains} grains", flush=True)
        if wish.keep:
            (shutil.copytree if path.is_dir() else shutil.copy)(path, wish.keep)
        call = [sys.executable, "-m", "benchmarks.imaging", "--child", str(path)]
        call += ["--grey"] if wish.grey else []
        call += ["--memory", str(wish.memory), "--jobs", str(wish.jobs), "--dask", str(wish.dask)]
        done = subprocess.run(call, check=True, stdout=subprocess.PIPE, env=os.environ)
        for name, value in json.loads(done.stdout).items():
            print(f"  {name:<40}{value:>18.2f}" if isinstance(value, float) else f"  {name:<40}{value:>18}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
