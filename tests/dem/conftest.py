"""A small dataset of simple bodies, in memory and on disk."""

from pathlib import Path

import numpy as np
import pytest

from regolith_studio.dataset.alignment import Frame
from regolith_studio.dataset.dataset import Dataset, Representative
from regolith_studio.dataset.folder_io import write_dataset
from regolith_studio.dataset.size_distributions import DiscreteSizeDistribution
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces


def box(a: float, b: float, c: float) -> ConvexPolyhedron:
    """A cuboid of unit volume with these proportions."""
    half = np.array([a, b, c]) / (a * b * c) ** (1 / 3) / 2
    normals = np.concatenate([np.eye(3), -np.eye(3)])
    return ConvexPolyhedron.from_half_spaces(HalfSpaces(normals, np.concatenate([half, half])))


def box_dataset() -> Dataset:
    """Cubes and bricks with two sizes."""
    sizes = DiscreteSizeDistribution.of((80.0, 100.0), (1.0, 1.0))
    frame = Frame(np.eye(3), np.zeros(3), 100.0)
    shapes = {"cube": box(1, 1, 1), "brick": box(3, 2, 1.5)}
    return Dataset("boxes", tuple(Representative(k, v, 0.5, sizes, frame) for k, v in shapes.items()))


@pytest.fixture(scope="session")
def boxes() -> Dataset:
    """The dataset in memory."""
    return box_dataset()


@pytest.fixture(scope="session")
def boxes_folder(boxes: Dataset, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same on disk."""
    return write_dataset(tmp_path_factory.mktemp("data") / "boxes", boxes)
