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


RUNTIME = """
import numpy, numba
import llvmlite.binding as llvm
from regolith_studio.jobs.thrift import load_runtime_of_kernels, pack_loaded_kernels
pack_loaded_kernels()
load_runtime_of_kernels()
passes = llvm.newpassmanagers.ModulePassManager
emitted, optimise = [], passes.run
passes.run = lambda self, *given: (emitted.append(1), optimise(self, *given))[1]
import allocating
assert allocating.doubled(numpy.arange(3.0)).tolist() == [0.0, 2.0, 4.0]
assert bool(emitted) == {compiles}, "the compiler was woken"
try:
    allocating.doubled(numpy.zeros(0))
except ValueError as error:
    assert str(error) == "nothing"
else:
    raise AssertionError("no error")
assert sum(allocating.doubled.stats.cache_hits.values()) == {hits}
assert allocating.quadrupled(numpy.arange(3.0)).tolist() == [0.0, 4.0, 8.0]
stats = numba.core.runtime.rtsys.get_allocation_stats
before = stats()
for _ in range(100):
    allocating.doubled(numpy.arange(3.0))
after = stats()
assert after.alloc - before.alloc == after.free - before.free, "memory is not freed"
"""
ALLOCATING = """
import numba, numpy

@numba.njit(cache=True)
def doubled(values):
    if not len(values):
        raise ValueError("nothing")
    made = numpy.empty(len(values))
    for place in range(len(values)):
        made[place] = 2.0 * values[place]
    return made

@numba.njit
def quadrupled(values):
    return doubled(doubled(values))
"""


def test_that_a_loaded_kernel_that_takes_memory_wakes_no_compiler_and_gives_it_back(tmp_path: Path) -> None:
    (tmp_path / "allocating.py").write_text(ALLOCATING)
    surroundings = os.environ | {"PYTHONPATH": str(tmp_path), "NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    surroundings["NUMBA_NRT_STATS"] = "1"
    for hits in (0, 1):
        play = [sys.executable, "-c", RUNTIME.format(hits=hits, compiles=not hits)]
        ended = subprocess.run(play, env=surroundings, capture_output=True, text=True, timeout=170)
        assert ended.returncode == 0, ended.stderr
