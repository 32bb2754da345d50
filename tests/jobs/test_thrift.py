"""Kernels that are loaded from disk work, and can be called by new ones, when their code is kept packed."""

import os
import subprocess
import sys
from pathlib import Path

KERNELS = """
import numba

@numba.njit(cache=True)
def power(x, n):
    value = 1.0
    for _ in range(n):
        value *= x
    return value

@numba.njit
def powers(x):
    return power(x, 2) + power(x, 3)
"""
PLAY = """
from regolith_studio.jobs.thrift import pack_loaded_kernels
pack_loaded_kernels()
import kernels
assert kernels.power(3.0, 4) == 81.0
assert sum(kernels.power.stats.cache_hits.values()) == {hits}
library = kernels.power.overloads[kernels.power.signatures[0]].library
assert (library._shared_module is None) == bool({hits})
assert kernels.powers(2.0) == 12.0
"""


def test_that_new_kernels_can_call_those_that_were_loaded_and_packed(tmp_path: Path) -> None:
    (tmp_path / "kernels.py").write_text(KERNELS)
    surroundings = os.environ | {"PYTHONPATH": str(tmp_path), "NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    for hits in (0, 1):
        play = [sys.executable, "-c", PLAY.format(hits=hits)]
        ended = subprocess.run(play, env=surroundings, capture_output=True, text=True, timeout=170)
        assert ended.returncode == 0, ended.stderr
