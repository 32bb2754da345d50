"""How kernels are called, and what is kept of compiled ones on disk."""

import ast
import errno
import importlib
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numba
import numpy as np
import pytest
from numba.core.caching import IndexDataCacheFile

from regolith_studio.geometry import kernels
from regolith_studio.geometry.arrays import FloatArray

CALLEE = """
from regolith_studio.geometry.kernels import kernel

@kernel
def constant():
    return {}
"""
CALLER = """
from {package}.callee import constant
from regolith_studio.geometry.kernels import kernel

@kernel
def doubled():
    return 2 * constant()
"""


@pytest.fixture(autouse=True)
def cache_below(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The folder that NUMBA_CACHE_DIR names."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    forget()
    yield tmp_path / "cache"
    forget()


def forget() -> None:
    """Forget what one process looks up once."""
    for each in (kernels.kernel_sources, kernels._cache_folder, kernels._cache_base, kernels._report):
        each.cache_clear()


def doubled(name: str) -> int:
    """Import the package afresh, as a new process does, and call the kernel."""
    for module in [key for key in sys.modules if key.startswith(name)]:
        del sys.modules[module]
    importlib.invalidate_caches()
    forget()
    return int(importlib.import_module(f"{name}.caller").doubled())


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package named ``part`` with two kernels; the outer one answers 42."""
    package = tmp_path / "studio" / "part"
    package.mkdir(parents=True)
    (package / "__init__.py").touch()
    (package / "caller.py").write_text(CALLER.format(package="part"))
    (package / "callee.py").write_text(CALLEE.format(21))
    monkeypatch.syspath_prepend(str(tmp_path / "studio"))
    monkeypatch.setattr(kernels, "_PACKAGE", tmp_path / "studio")
    return package


def test_that_compiled_code_does_not_survive_an_edit_of_a_kernel_that_it_calls(package: Path) -> None:
    assert doubled("part") == 42
    (package / "callee.py").write_text(CALLEE.format(1000))
    assert doubled("part") == 2000


@pytest.mark.parametrize(("kind", "kept"), [("nbi", 0.0), ("nbi", 0.5), ("nbc", 0.99)])
@pytest.mark.usefixtures("package")
def test_that_damaged_compiled_code_is_made_again_with_one_line(
    kind: str, kept: float, cache_below: Path, caplog: pytest.LogCaptureFixture
) -> None:
    assert doubled("part") == 42
    for path in cache_below.rglob(f"caller*.{kind}"):
        content = path.read_bytes()
        path.write_bytes(content[: int(kept * len(content))])
    assert doubled("part") == 42
    assert [each.getMessage().split(" in ")[0] for each in caplog.records] == ["Compiled code"]
    assert doubled("part") == 42
    assert len(caplog.records) == 1


@pytest.mark.usefixtures("package")
def test_that_a_full_disk_costs_the_cache_and_not_the_result(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def write(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(IndexDataCacheFile, "_save_data", write)
    assert doubled("part") == 42
    assert "No space left" in caplog.text


def test_that_another_checkout_or_date_has_code_of_its_own(tmp_path: Path) -> None:
    """Numba takes none of another: marks that it is there made the window compile without a word."""
    places = [tmp_path / "one", tmp_path / "two"]
    for folder in places:
        folder.mkdir()
        (folder / "fast.py").write_text("@kernel")
        os.utime(folder / "fast.py", (1e9, 1e9))
    one, two = map(kernels.kernel_sources, places)
    assert one != two
    kernels.kernel_sources.cache_clear()
    assert kernels.kernel_sources(places[0]) == one
    kernels.kernel_sources.cache_clear()
    os.utime(places[0] / "fast.py", (1e9, 2e9))
    assert kernels.kernel_sources(places[0]) != one


def test_that_folders_of_other_versions_go_when_nobody_has_used_them_for_long(cache_below: Path) -> None:
    old, other, strange = (cache_below / name for name in ("core-" + "a" * 16, "core-" + "b" * 16, "mine"))
    for folder in (old, other, strange):
        folder.mkdir(parents=True)
    long_ago = time.time() - (kernels.UNUSED_DAYS + 1) * 86_400
    for folder in (old, strange):
        os.utime(folder, (long_ago, long_ago))
    kernels._cache_folder(None)
    assert not old.exists()
    assert other.exists()
    assert strange.exists()


def test_that_code_is_kept_in_a_temporary_folder_where_the_cache_cannot_be_written(
    cache_below: Path, caplog: pytest.LogCaptureFixture
) -> None:
    cache_below.touch()
    kept = kernels._cache_folder(None)
    assert kept is not None
    assert kept.is_relative_to(tempfile.gettempdir())
    assert os.environ["NUMBA_CACHE_DIR"] == str(kept.parent)
    assert [each.getMessage().split(";")[0] for each in caplog.records] == [
        f"The folder {cache_below} cannot be written"
    ]


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="temporary folders are the user's own on Windows")
def test_that_code_is_compiled_each_time_where_the_temporary_folder_may_be_another_users(
    cache_below: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    cache_below.touch()
    (tmp_path / f"regolith-studio-{os.getuid()}").mkdir()
    (tmp_path / f"regolith-studio-{os.getuid()}").chmod(0o777)
    assert kernels._cache_folder(None) is None

    @kernels.kernel
    def two() -> int:
        return 2

    assert two() == 2
    assert len(caplog.records) == 1


ROOT = Path(kernels.__file__).resolve().parents[2]
NUMBERS = re.compile(r"None|(int|float|bool)|tuple\[(int|float|bool)(, (int|float|bool))*\]")


@kernels.inner_kernel
def inverse(x: float) -> float:
    """One over a number."""
    return 1.0 / x


@kernels.kernel
def inverse_of_difference(x: float, y: float) -> float:
    """One over a difference."""
    return inverse(x - y)


def test_that_a_kernel_without_an_entry_is_compiled_for_kernels_and_runs_as_written_for_python() -> None:
    assert inverse_of_difference(2.0, 2.0) == np.inf
    assert inverse(4.0) == 0.25
    with pytest.raises(ZeroDivisionError):
        inverse(0.0)


@pytest.mark.slow
def test_that_kernels_called_by_python_return_numbers_only_and_have_an_entry() -> None:
    """See :func:`regolith_studio.geometry.kernels.kernel`; kernels called by kernels may return anything."""
    trees = {
        ".".join(path.relative_to(ROOT).with_suffix("").parts): ast.parse(path.read_text("utf-8"))
        for path in sorted((ROOT / "regolith_studio").rglob("*.py"))
    }
    returned = {
        (module, each.name): ast.unparse(each.returns) if each.returns else "nothing said"
        for module, tree in trees.items()
        for each in tree.body
        if isinstance(each, ast.FunctionDef) and is_kernel(each)
    }
    assert len(returned) > 100
    called = {
        known[each.id]
        for module, tree in trees.items()
        for known in [kernels_known_in(module, tree, returned)]
        for part in tree.body
        if not (isinstance(part, ast.FunctionDef) and is_kernel(part))
        for own in [own_names(part)]
        for each in ast.walk(part)
        if isinstance(each, ast.Name) and each.id in known and each.id not in own
    }
    assert {key: returned[key] for key in called if not NUMBERS.fullmatch(returned[key])} == {}
    slow = {
        key
        for key in called
        if type(getattr(importlib.import_module(key[0]), key[1])) is kernels._InnerKernel
    }
    assert slow == set()


def is_kernel(function: ast.FunctionDef) -> bool:
    """Whether a function is compiled."""
    names = {ast.unparse(each) for each in function.decorator_list}
    return bool(names & {"kernel", "kernel_noalloc", "inner_kernel"})


def own_names(part: ast.stmt) -> set[str]:
    """Parameters and variables, which may be called as a kernel is."""
    stored = {
        each.id for each in ast.walk(part) if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store)
    }
    return stored | {each.arg for each in ast.walk(part) if isinstance(each, ast.arg)}


def kernels_known_in(
    module: str, tree: ast.Module, kernels: dict[tuple[str, str], str]
) -> dict[str, tuple[str, str]]:
    """Kernels by the name that they have in a module: its own and imported ones."""
    known = {name: (where, name) for where, name in kernels if where == module}
    for each in ast.walk(tree):
        if isinstance(each, ast.ImportFrom):
            found = {one.asname or one.name: (str(each.module), one.name) for one in each.names}
            known |= {name: key for name, key in found.items() if key in kernels}
    return known


@kernels.kernel
def add_sines(n: int, sums: FloatArray) -> float:
    """Work for some time."""
    for i in range(n):
        sums[0] += np.sin(float(i))
    return float(sums[0])


INTERRUPTED = """
import signal
import numpy as np
from tests.geometry.test_kernels import add_sines

def late(*_):
    raise TimeoutError

sums = np.zeros(3)
add_sines(1, sums)
signal.signal(signal.SIGALRM, late)
for _ in range(10):
    signal.setitimer(signal.ITIMER_REAL, 0.01)
    try:
        add_sines(5_000_000, sums)
    except TimeoutError:
        print("raised")
"""


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="this system has no such signal")
@pytest.mark.slow
def test_that_a_signal_during_a_kernel_raises_where_it_was_called() -> None:
    command = [sys.executable, "-c", INTERRUPTED]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=200)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["raised"] * 10


def test_that_threads_have_scratch_memory_of_their_own_and_use_it_again() -> None:
    memory = kernels.kept_in_thread(np.empty)
    assert memory(3) is memory(3)
    assert memory(3).shape == (3,)
    assert memory(4).shape == (4,)
    with ThreadPoolExecutor(1) as other:
        assert other.submit(memory, 3).result() is not memory(3)
