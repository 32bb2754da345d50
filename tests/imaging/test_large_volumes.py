"""Volumes that are larger than the memory: extracted in a process that may not hold them."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs RLIMIT_DATA")

SPACING, RADIUS = 128, 13

WORK = """
import json, resource, sys
from pathlib import Path
import numpy as np
from regolith_studio.imaging.extraction import extraction_steps
from regolith_studio.imaging.settings import DenoiseSettings
from regolith_studio.imaging.segmentation.segment import SegmentationSettings, segmentation_steps
from regolith_studio.imaging.settings import ThresholdSettings
from regolith_studio.imaging.volume_slabs import ScratchArrays, unpacked
from regolith_studio.steps import result_of
from regolith_studio.jobs.extraction_settings import VolumeInput

path, kind, limit = Path(sys.argv[1]), sys.argv[2], int(sys.argv[3])
resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
try:
    np.ones(limit, dtype=np.uint8)
    sys.exit("the limit does not hold")
except MemoryError:
    pass
volumes = []
with ScratchArrays(path.parent) as scratch:
    source = VolumeInput(path, 1.0, kind=kind).opened()
    if kind == "labels":
        source = result_of(unpacked(source, scratch))
    if kind == "grey":
        settings = SegmentationSettings(DenoiseSettings("none"), ThresholdSettings("manual", 100.0))
        source = result_of(segmentation_steps(source, settings, scratch)).labels
    for step in extraction_steps(source, make=lambda made: made.particle.mesh.volume):
        volumes.append(step.made)
print(json.dumps(volumes))
"""


def write_balls(path: Path, shape: tuple[int, int, int], dtype: type, first: int) -> int:
    """A sparse NPY file (slices first) of balls valued `first`, `first` + 1, ...; returns how many."""
    volume = np.lib.format.open_memmap(path, "w+", dtype, shape)
    z, y, x = np.mgrid[-RADIUS : RADIUS + 1, -RADIUS : RADIUS + 1, -RADIUS : RADIUS + 1]
    ball = x**2 + y**2 + z**2 <= RADIUS**2
    corners = list(np.ndindex(*(edge // SPACING for edge in shape)))
    for number, corner in enumerate(corners):
        low = [index * SPACING + 50 for index in corner]
        volume[tuple(slice(start, start + 2 * RADIUS + 1) for start in low)][ball] = first + number
    volume.flush()
    return len(corners)


def volumes_under_limit(path: Path, kind: str, limit: int) -> np.ndarray:
    call = [sys.executable, "-c", WORK, str(path), kind, str(limit)]
    done = subprocess.run(call, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    return np.array(json.loads(done.stdout))


BALL = 4 / 3 * np.pi * RADIUS**3


@pytest.mark.slow
def test_that_two_gibibytes_of_labels_are_extracted_within_one(tmp_path: Path) -> None:
    """1,024 x 1,024 x 1,024 voxels of 16 bits; the limit is on all private memory of the process."""
    count = write_balls(tmp_path / "labels.npy", (1024, 1024, 1024), np.uint16, 1)
    found = volumes_under_limit(tmp_path / "labels.npy", "labels", 2**30)
    assert len(found) == count == 512
    assert found == pytest.approx(BALL, rel=0.01)


@pytest.mark.slow
def test_that_grey_values_are_segmented_in_less_memory_than_their_labels_take(tmp_path: Path) -> None:
    """512 x 512 x 1,024 voxels: the numbers of their bodies alone are 1 GiB."""
    count = write_balls(tmp_path / "grey.npy", (1024, 512, 512), np.uint8, 120)
    found = volumes_under_limit(tmp_path / "grey.npy", "grey", 900 * 2**20)
    assert len(found) == count == 128
    assert found == pytest.approx(BALL, rel=0.01)
