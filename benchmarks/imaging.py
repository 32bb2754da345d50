"""How long and how much memory it takes to get from volumes to particles, also where volumes are larger.

Run as ``python -m benchmarks.imaging [--edge 512] [--grey] [--memory GIB]``. Writes a volume of many grains
into a temporary folder (one grain a cell of 51 voxels: 1,000 grains at 512 voxels an edge, 8,000 at 1,024;
``--share 0.25`` fills every fourth cell only, ``--packed`` writes a compressed HDF5 file instead of NPY,
``--packed --chunk 64`` one of cubic chunks),
then makes its particles, each forgotten once it is made, in a process of its own whose private memory
(RLIMIT_DATA) is limited. Reported are seconds by the clock and by the processor, and the peak of resident
memory; pages of files count in the latter. With ``--jobs N`` the work is shared out among N processes, whose
seconds together and largest peak are reported too.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Generator
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from regolith_studio.imaging.extraction import ExtractionSettings, extraction_steps
from regolith_studio.imaging.sample_volumes import sample_volume
from regolith_studio.imaging.segmentation.denoising import DenoiseSettings
from regolith_studio.imaging.segmentation.segment import SegmentationSettings, segmentation_steps
from regolith_studio.imaging.volume_slabs import ScratchArrays
from regolith_studio.jobs.executor import open_executor
from regolith_studio.jobs.extraction_settings import VolumeInput

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


def extract(path: Path, grey: bool, memory: float, jobs: int) -> dict[str, float]:
    """Make all particles in this process, of limited memory, and those that it starts; say what it took."""
    if memory:
        limit = int(memory * 2**30)
        resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
    stages: dict[str, float] = {}
    begin, values = time.monotonic(), None
    volume = VolumeInput(path, 2.3, kind="grey" if grey else "labels").opened()
    with ScratchArrays(path.parent) as scratch, open_executor(jobs) as executor:
        run = executor.map
        if grey:
            how = SegmentationSettings(DenoiseSettings("gaussian"))
            volume, values = _timed(segmentation_steps(volume, how, scratch, run), stages).labels, volume
        made = extraction_steps(volume, ExtractionSettings(), collect=False, grey=values, run=run)
        extraction = _timed(made, stages)
        seconds = time.monotonic() - begin
    others = resource.getrusage(resource.RUSAGE_CHILDREN)
    return {
        "particles": extraction.n_found,
        "seconds": seconds,
        "processor_seconds": time.process_time(),
        "peak_gib": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20,
        "processor_seconds_of_others": others.ru_utime + others.ru_stime,
        "peak_gib_of_others": others.ru_maxrss / 2**20,
        **{f"seconds: {name}": value for name, value in stages.items()},
    }


def _timed(steps: Generator[Any, None, Any], stages: dict[str, float]) -> Any:
    """Drive a generator to its end; adds the seconds of each stage."""
    since = time.monotonic()
    while True:
        try:
            step = next(steps)
        except StopIteration as end:
            return end.value
        stage = getattr(step, "stage", "Extracting particles")
        now = time.monotonic()
        stages[stage], since = stages.get(stage, 0.0) + now - since, now


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
    options.add_argument("--jobs", type=int, default=1)
    options.add_argument("--folder", type=Path, default=None)
    options.add_argument("--child", type=Path, help=argparse.SUPPRESS)
    wish = options.parse_args()
    if wish.child:
        print(json.dumps(extract(wish.child, wish.grey, wish.memory, wish.jobs)))
        return 0
    with tempfile.TemporaryDirectory(dir=wish.folder) as folder:
        path = Path(folder) / ("volume.h5" if wish.packed else "volume.npy")
        n_grains = write_volume(path, wish.edge, wish.grey, wish.share, chunk=wish.chunk)
        size = path.stat().st_size / 2**30
        print(f"{wish.edge}^3 voxels, {n_grains} grains, {size:.2f} GiB", flush=True)
        call = [sys.executable, "-m", "benchmarks.imaging", "--child", str(path)]
        call += ["--grey"] if wish.grey else []
        done = subprocess.run(
            [*call, "--memory", str(wish.memory), "--jobs", str(wish.jobs)],
            check=True,
            stdout=subprocess.PIPE,
            env=os.environ,
        )
        for name, value in json.loads(done.stdout).items():
            print(f"  {name:<36}{value:>10.2f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
