"""Bodies parted tile by tile: whoever does it, and in whichever order."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np
import pytest
from scipy import ndimage

from regolith_studio.imaging.connected_components import ConnectedComponents, components_of_slab
from regolith_studio.imaging.segmentation.splitting import GrainSplitter
from regolith_studio.imaging.settings import SplittingSettings, TileSettings
from regolith_studio.imaging.volume_slabs import ParallelMap, SharedArray

SPONGE = ndimage.gaussian_filter(np.random.default_rng(7).standard_normal((44, 46, 48)), 2.0) > -0.02
"""Some large bodies with pores, and bodies within pores."""


def backwards(function: Callable[[Any], Any], items: Iterable[Any]) -> Iterator[Any]:
    """As ``map``, but everything is asked for first, and done from the end."""
    given = list(items)
    return reversed([function(item) for item in reversed(given)])


def parted(run: ParallelMap, fill_pores: bool) -> tuple[np.ndarray, int]:
    numbers, slab = components_of_slab(SPONGE, 0)
    bodies = ConnectedComponents(slab.sizes, slab.low, slab.high)
    labels = np.zeros(SPONGE.shape, np.int32)
    tiles = TileSettings(largest=1000, core=20, margin=4)
    splitter = GrainSplitter(
        SharedArray(numbers), labels, bodies, np.ones(3), SplittingSettings(), fill_pores, tiles
    )
    for _ in splitter.steps(run=run):
        pass
    assert np.array_equal(splitter.sizes, np.bincount(-labels.ravel(), minlength=splitter.n_grains + 1)[1:])
    return labels, splitter.n_grains


@pytest.mark.parametrize("fill_pores", [True, False])
def test_that_grains_do_not_depend_on_the_order_in_which_tiles_are_parted(fill_pores: bool) -> None:
    numbers, n_grains = parted(map, fill_pores)
    again, count = parted(backwards, fill_pores)
    assert n_grains == count > 20
    assert np.array_equal(numbers, again)


def test_that_every_voxel_of_a_body_gets_a_grain_and_filled_pores_do_too() -> None:
    numbers, _ = parted(map, fill_pores=False)
    assert np.array_equal(numbers < 0, SPONGE)
    filled, _ = parted(map, fill_pores=True)
    pores = (filled < 0) & ~SPONGE
    assert ((filled < 0) | ~SPONGE).all()
    assert pores.any()
    assert not (pores & ~ndimage.binary_fill_holes(SPONGE)).any()
