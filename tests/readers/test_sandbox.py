"""The reading child: warm, limited, replaced when it dies, gone when its parent goes."""

import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import psutil
import pytest

from regolith_studio.errors import FileError
from regolith_studio.readers.particles import read_mesh
from regolith_studio.readers.sandbox import SandboxMessage, receive, send
from regolith_studio.readers.sandbox.parent import Sandbox, shared_sandbox

REPOSITORY = Path(__file__).resolve().parents[2]


@pytest.fixture
def sandbox():
    made = Sandbox(seconds=5.0)
    yield made
    made.close()


@pytest.fixture
def stl(tmp_path, cube):
    path = tmp_path / "cube.stl"
    path.write_bytes(cube.binary_stl())
    return path


def child_of(sandbox):
    """The process id of the sandbox's child."""
    return sandbox._process.pid


def test_that_the_child_is_kept_from_one_request_to_the_next(sandbox, stl):
    sandbox.request("mesh", stl)
    first = child_of(sandbox)
    sandbox.request("mesh", stl)
    assert child_of(sandbox) == first


def test_that_a_refused_file_leaves_the_child_alive(sandbox, stl, tmp_path):
    sandbox.request("mesh", stl)
    first = child_of(sandbox)
    (tmp_path / "bad.stl").write_bytes(b"bad")
    with pytest.raises(FileError, match=r"^bad\.stl is too short"):
        sandbox.request("mesh", tmp_path / "bad.stl")
    assert child_of(sandbox) == first


def test_that_a_child_that_was_killed_is_replaced(sandbox, stl):
    sandbox.request("mesh", stl)
    first = psutil.Process(child_of(sandbox))
    first.kill()
    time.sleep(0.1)
    assert sandbox.request("mesh", stl).arrays[1].shape == (12, 3)
    assert not psutil.pid_exists(first.pid)


def test_that_a_file_that_kills_its_reader_is_refused_and_the_next_one_read(sandbox, stl):
    sandbox.start()
    threading.Timer(0.3, psutil.Process(child_of(sandbox)).kill).start()
    with pytest.raises(FileError, match=r"cube\.stl is damaged: it crashed the process"):
        sandbox.request("sleep", stl)
    assert sandbox.request("mesh", stl).arrays[1].shape == (12, 3)


def test_that_a_file_that_takes_too_long_is_given_up(stl):
    sandbox = Sandbox(seconds=0.3)
    with pytest.raises(FileError, match=r"cube\.stl was given up after 0\.3 s"):
        sandbox.request("sleep", stl)
    assert sandbox.request("mesh", stl).arrays[1].shape == (12, 3)
    sandbox.close()


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGPROF"), reason="this system does not count a process's work")
def test_that_a_file_that_keeps_the_processor_busy_is_given_up_long_before_it_is_late(stl):
    sandbox = Sandbox(seconds=60.0)
    with pytest.raises(FileError, match=r"cube\.stl was given up after 1\.5 s of work"):
        sandbox.request("spin", stl)
    assert sandbox.request("mesh", stl).arrays[1].shape == (12, 3)
    sandbox.close()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux limits the address space")
def test_that_a_file_that_needs_too_much_memory_is_refused(tmp_path, stl):
    sandbox = Sandbox(memory=700 * 1024**2)
    large = tmp_path / "large.obj"
    large.write_bytes(b"v 0 0 0\n" * 6_000_000)
    with pytest.raises(FileError, match=r"large\.obj needs more than the 0\.684 GiB of memory"):
        sandbox.request("mesh", large)
    assert sandbox.request("mesh", stl).arrays[1].shape == (12, 3)
    sandbox.close()


def test_that_a_file_above_two_gibibytes_is_refused_before_it_is_read(tmp_path, sandbox):
    path = tmp_path / "huge.stl"
    with path.open("wb") as file:
        file.truncate(2 * 1024**3 + 1)
    with pytest.raises(FileError, match=r"huge\.stl has 2\.0 GiB; at most 2 GiB are read\."):
        sandbox.request("mesh", path)


def test_that_closing_ends_the_child_at_once(stl):
    sandbox = Sandbox()
    sandbox.request("mesh", stl)
    pid = child_of(sandbox)
    sandbox.close()
    assert not psutil.pid_exists(pid)


def test_that_threads_can_share_the_child(sandbox, stl):
    shapes = []
    threads = [
        threading.Thread(target=lambda: shapes.append(sandbox.request("mesh", stl).arrays[1].shape))
        for _ in range(8)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert shapes == [(12, 3)] * 8


@pytest.mark.slow
@pytest.mark.parametrize("start", ["spawn", "fork"])
def test_that_workers_of_a_process_pool_have_children_of_their_own(start, stl):
    read_mesh(stl)
    own = child_of(shared_sandbox())
    if start == "fork" and not hasattr(os, "fork"):
        pytest.skip("this system does not fork")
    with ProcessPoolExecutor(1, mp_context=get_context(start)) as pool:
        volumes = [particle.mesh.volume for particle in pool.map(read_mesh, [stl] * 2)]
    assert volumes == pytest.approx([1.0] * 2)
    assert child_of(shared_sandbox()) == own
    assert read_mesh(stl).mesh.volume == pytest.approx(1.0)


SCRIPT = """
import os, sys, threading, time
from pathlib import Path
from regolith_studio.readers.sandbox.parent import Sandbox, shared_sandbox
sandbox = GUARD
sandbox.request("mesh", Path(sys.argv[1]))
print(sandbox._process.pid, flush=True)
ENDING
"""


def _left_behind(ending, stl, sandbox="shared_sandbox()"):
    """Run a script that reads and then ends in some way; the id of its child."""
    script = SCRIPT.replace("ENDING", ending).replace("GUARD", sandbox)
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", script, str(stl)],
        capture_output=True,
        text=True,
        cwd=REPOSITORY,
        check=False,
    )
    assert done.stderr == ""
    return int(done.stdout)


@pytest.mark.parametrize(
    "ending",
    [
        "",
        "raise SystemExit(3)",
        "os._exit(0)",
        "os.kill(os.getpid(), 9)",
    ],
    ids=["an ordinary end", "an exit", "a hard exit", "a kill"],
)
def test_that_the_child_goes_when_its_parent_goes(ending, stl):
    _wait_until_gone(_left_behind(ending, stl))


@pytest.mark.slow
def test_that_a_hanging_child_ends_itself_after_its_parent_has_gone(stl):
    hang = (
        "threading.Thread(target=lambda: sandbox.request('sleep', Path(sys.argv[1])), daemon=True).start()\n"
    )
    _wait_until_gone(_left_behind(hang + "time.sleep(0.3); os._exit(0)", stl, "Sandbox(seconds=0.5)"))


def _wait_until_gone(pid):
    deadline = time.monotonic() + 20.0
    while psutil.pid_exists(pid) and psutil.Process(pid).status() != psutil.STATUS_ZOMBIE:
        assert time.monotonic() < deadline
        time.sleep(0.05)


@pytest.mark.slow
def test_that_the_child_imports_nothing_heavier_than_numpy():
    script = "import sys, regolith_studio.readers.sandbox.child; print(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, cwd=REPOSITORY, check=True
    )
    assert not {"scipy", "numba", "trimesh", "matplotlib", "vtk"} & set(done.stdout.split())


def test_that_modules_in_the_working_folder_are_not_run(tmp_path, stl, monkeypatch):
    (tmp_path / "numpy.py").write_text("raise SystemExit('taken over')")
    monkeypatch.chdir(tmp_path)
    sandbox = Sandbox()
    assert sandbox.request("mesh", stl).arrays[1].shape == (12, 3)
    sandbox.close()


class Pipe:
    """Bytes that are read in small pieces, as a pipe gives them."""

    def __init__(self):
        self.data = bytearray()

    def write(self, data):
        self.data += data[:7]
        return min(len(data), 7)

    def readinto(self, view):
        part = self.data[: min(len(view), 5)]
        view[: len(part)] = part
        del self.data[: len(part)]
        return len(part)


def test_that_a_message_survives_a_pipe_of_small_pieces():
    pipe, message = (
        Pipe(),
        SandboxMessage({"status": "read"}, (np.arange(12.0).reshape(4, 3), np.zeros((0, 3), "<i8"))),
    )
    send(pipe, message)
    received = receive(pipe)
    assert received.header == message.header
    assert all(
        np.array_equal(a, b) and a.shape == b.shape
        for a, b in zip(received.arrays, message.arrays, strict=True)
    )


@pytest.mark.parametrize("data", [b"", b"\1", bytes(8) + b"x", b"\xff" * 8, b"\2\0\0\0\0\0\0\0{}"])
def test_that_what_is_no_message_does_not_pass_for_one(data):
    pipe = Pipe()
    pipe.data += data
    with pytest.raises((EOFError, ValueError, KeyError)):
        receive(pipe)


def test_that_the_successor_of_a_child_that_a_file_has_ended_starts_at_once(sandbox, stl):
    sandbox.request("mesh", stl)
    first = child_of(sandbox)
    with pytest.raises(FileError, match="was given up"):
        sandbox.request_within("spin", stl, seconds=5.0, work=0.2)
    second = child_of(sandbox)
    assert second != first
    assert psutil.pid_exists(second)
    sandbox.request("mesh", stl)
    assert child_of(sandbox) == second


def test_that_a_sandbox_that_is_closed_has_no_successor(sandbox, stl):
    sandbox.request("mesh", stl)
    sandbox.close()
    assert sandbox._process is None
