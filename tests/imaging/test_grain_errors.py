"""Intervals of single grains: against the table that they come from, and balls whose size is known."""

import json

import numpy as np
import pytest

from regolith_studio.descriptors.describe import describe
from regolith_studio.imaging.extraction import extract_particles
from regolith_studio.imaging.grain_errors import KEYS, ScanOfGrain, follows_grey, intervals
from regolith_studio.imaging.segmentation.segment import segment
from regolith_studio.imaging.volume import Volume
from regolith_studio.resources import results_folder

ROUND = dict.fromkeys(KEYS, 1.0) | {"aspect_ratio": 1.05}
LONG, EDGED = ROUND | {"aspect_ratio": 1.6}, ROUND | {"sphericity": 0.88}


def row(kind: str, cell: str) -> np.ndarray:
    table = json.loads((results_folder() / "grain_errors.json").read_text(encoding="utf-8"))
    return np.reshape(table[kind]["rows"][cell], (-1, 3))[: len(KEYS)] / 100


@pytest.mark.parametrize(
    ("measured", "kind"), [(ROUND, "round, grey"), (LONG, "other, grey"), (EDGED, "other, grey")]
)
def test_that_the_interval_at_a_cell_of_the_table_undoes_its_errors(measured, kind) -> None:
    found = intervals(measured, ScanOfGrain(18.0, 0.1, follows_grey=True))
    for key, (_, low, high) in zip(KEYS, row(kind, "18 voxels, noise 10 %"), strict=True):
        assert found[key] == pytest.approx((measured[key] / (1 + high), measured[key] / (1 + low)))


def test_that_intervals_between_cells_lie_between_theirs_and_beyond_the_ends_stay() -> None:
    widths = [
        np.subtract(*reversed(intervals(LONG, ScanOfGrain(across, 0.0, True))["volume"]))
        for across in (12.0, 14.0, 18.0, 30.0, 300.0)
    ]
    assert widths[2] < widths[1] < widths[0]
    assert widths[4] == widths[3]


def test_that_extents_of_few_voxels_are_less_sure() -> None:
    """The direction of the box of a nearly round body is free: its longest side is several percent off."""
    few, many = (intervals(ROUND, ScanOfGrain(n, 0.1, True))["max_diameter"] for n in (10.0, 30.0))
    assert few[1] - few[0] > 0.04
    assert few[0] < 1 < few[1]
    assert many[1] - many[0] < few[1] - few[0] + 0.02


def test_that_noise_decides_what_a_surface_follows() -> None:
    assert follows_grey(20.0, 0.1)
    assert not follows_grey(30.0, 0.33)
    assert follows_grey(12.0, 0.2)


def test_that_nothing_is_stated_of_grains_that_are_mostly_lost() -> None:
    assert intervals(LONG, ScanOfGrain(8.0, 0.33, True)) == {}


@pytest.mark.slow
def test_that_the_intervals_of_a_ball_hold_its_volume_and_area() -> None:
    radius, rng = 9.0, np.random.default_rng(4)
    axis = np.arange(-16, 17)[:, None, None], np.arange(-16, 17)[:, None], np.arange(-16, 17)
    away = np.sqrt(sum(each**2 for each in axis))
    share = np.clip(radius - away + 0.5, 0, 1)
    grey = Volume(
        np.round(8000 + 6000 * share + 300 * rng.standard_normal(share.shape)).astype(np.uint16),
        np.ones(3),
        "grey",
        "ball",
    )
    [found] = extract_particles(segment(grey).labels, grey=grey).particles
    assert found.scan is not None
    assert found.scan.noise == pytest.approx(0.05, rel=0.2)
    stated = intervals(describe(found.mesh, (*KEYS, "aspect_ratio")), found.scan)
    for key, true in (("volume", 4 / 3 * np.pi * radius**3), ("surface_area", 4 * np.pi * radius**2)):
        assert stated[key][0] <= true <= stated[key][1]
