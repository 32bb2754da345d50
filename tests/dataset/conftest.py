"""Small datasets to write, read and break."""

from collections.abc import Callable

import pytest

from regolith_studio.dataset.dataset import Dataset
from tests.dataset.example import example_dataset


@pytest.fixture
def make_dataset() -> Callable[..., Dataset]:
    return example_dataset
