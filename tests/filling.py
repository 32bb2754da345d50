"""Kernels fill arrays that they are given; here these are made and returned."""

from collections.abc import Callable
from typing import Any

import numpy as np


def filled(function: Callable[..., Any], arguments: tuple[Any, ...], *arrays: Any) -> list[Any]:
    """Copies of `arrays`, which are the last arguments of `function`, after a call; last what it returns."""
    copies = [np.array(array) for array in arrays]
    returned = function(*arguments, *copies)
    return [*copies, returned]
