"""A small dataset of simple bodies, in memory and on disk."""

from pathlib import Path

import pytest

from benchmarks.sliding_friction import box_dataset
from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.folder_io import write_dataset
from tests.dataset.example import elbow_entry, entry


@pytest.fixture(scope="session")
def boxes() -> Dataset:
    """The dataset in memory."""
    return box_dataset()


@pytest.fixture(scope="session")
def boxes_folder(boxes: Dataset, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same on disk."""
    return write_dataset(tmp_path_factory.mktemp("data") / "boxes", boxes)


@pytest.fixture(scope="session")
def elbows() -> Dataset:
    """A compound of two parts and a convex body."""
    return build_dataset([elbow_entry(), entry(1)], name="elbows")
