"""How bootstrap.py starts the program: display, words, exit codes, signals."""

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType

import pytest

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="speaks of Linux")
posix = pytest.mark.skipif(os.name == "nt", reason="the stand-in for Python is a shell script")


@linux
@pytest.mark.parametrize(("display", "answers"), [("", False), (":54321", False), ("far-away:10.0", True)])
def test_that_a_local_display_must_answer_and_a_distant_one_is_believed(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch, display: str, answers: bool
) -> None:
    monkeypatch.setenv("DISPLAY", display)
    assert bootstrap.display_answers() is answers


@linux
@pytest.mark.skipif(not shutil.which("Xvfb"), reason="Xvfb is not installed")
def test_that_a_screen_in_memory_lives_as_long_as_it_is_needed(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    with bootstrap.virtual_display() as display:
        monkeypatch.setenv("DISPLAY", display)
        assert bootstrap.display_answers()
    assert not bootstrap.display_answers()


@pytest.mark.parametrize(
    ("words", "in_memory"),
    [(["test"], True), (["demo", "-o", "x"], False), ([], False), (["open"], False), (["describe"], False)],
)
def test_that_only_tests_need_a_screen_in_memory(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch, words: list[str], in_memory: bool
) -> None:
    monkeypatch.setattr(bootstrap, "display_answers", lambda: False)
    assert bootstrap.draws_in_memory(words) is in_memory
    monkeypatch.setattr(bootstrap, "display_answers", lambda: True)
    assert not bootstrap.draws_in_memory(words)


@linux
@pytest.mark.parametrize("words", [[], ["open", "grain.stl"]])
def test_that_the_window_without_a_display_offers_the_demo_before_setting_up(
    bootstrap: ModuleType,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    words: list[str],
) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert bootstrap.main(words) == 1
    said = capsys.readouterr().err
    assert "no display" in said
    assert "python3 bootstrap.py demo -o out" in said
    assert said.count("\n") == 1
    assert not bootstrap.VENV.exists()


class Replaced(Exception):
    """This process would now be the program."""


@posix
@pytest.mark.parametrize(
    ("words", "module", "folder"),
    [
        (
            ["test", "-k", "mesh"],
            ["-m", "pytest", "-n", "logical", "--maxprocesses", "4", "--dist", "loadfile", "-k", "mesh"],
            "checkout",
        ),
        (["test", "tests/io/test_stl.py"], ["-m", "pytest", "tests/io/test_stl.py"], "checkout"),
        (["describe", "a.stl", "--json"], ["-m", "regolith_studio", "describe", "a.stl", "--json"], "user"),
        ([], ["-m", "regolith_studio"], "user"),
    ],
)
@pytest.mark.parametrize("threads", [None, "4"])
def test_that_words_go_through_to_the_program_and_blas_gets_one_thread(
    bootstrap: ModuleType,
    checkout: Path,
    tmp_path_factory: pytest.TempPathFactory,
    monkeypatch: pytest.MonkeyPatch,
    words: list[str],
    module: list[str],
    folder: str,
    threads: str | None,
) -> None:
    user = tmp_path_factory.mktemp("user").resolve()
    monkeypatch.chdir(user)
    monkeypatch.setattr(bootstrap, "draws_in_memory", lambda _words: False)
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")
    if threads:
        monkeypatch.setenv("OPENBLAS_NUM_THREADS", threads)

    def replace(path: str, command: list[str], environment: dict[str, str]) -> None:
        assert path == command[0] == str(bootstrap.venv_python())
        assert command[1:] == module
        assert environment["OPENBLAS_NUM_THREADS"] == (threads or "1")
        assert ("PYTHONDONTWRITEBYTECODE" in environment) == (words[:1] != ["test"])
        assert Path.cwd() == (checkout if folder == "checkout" else user)
        raise Replaced

    monkeypatch.setattr(bootstrap.os, "execve", replace)
    with pytest.raises(Replaced):
        bootstrap.start(words)


@posix
def test_that_the_second_call_sets_nothing_up_and_hands_on_words_and_exit_code(
    checkout: Path, finish_venv: Callable[..., None]
) -> None:
    finish_venv('echo "$@"; exit 7')
    done = subprocess.run(
        [sys.executable, "bootstrap.py", "--no-system", "describe", "two words.stl"],
        cwd=checkout,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 7
    assert done.stdout == "-m regolith_studio describe two words.stl\n"
    assert done.stderr == ""


@linux
@pytest.mark.parametrize(("answers", "display"), [(False, None), (True, ":54321")])
def test_that_the_demo_asks_no_x_server_that_does_not_answer(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch, answers: bool, display: str | None
) -> None:
    monkeypatch.chdir(Path.cwd())
    monkeypatch.setenv("DISPLAY", ":54321")
    monkeypatch.setattr(bootstrap, "display_answers", lambda: answers)

    def replace(_path: str, _command: list[str], environment: dict[str, str]) -> None:
        assert environment.get("DISPLAY") == display
        raise Replaced

    monkeypatch.setattr(bootstrap.os, "execve", replace)
    with pytest.raises(Replaced):
        bootstrap.start(["demo", "-o", "x"])


def start_child(bootstrap: ModuleType, code: str) -> "subprocess.Popen[str]":
    """A process of its own group that runs a child through run_program."""
    driver = (
        "import importlib.util as u, sys; "
        f"s = u.spec_from_file_location('bootstrap', {bootstrap.__file__!r}); "
        "m = u.module_from_spec(s); s.loader.exec_module(m); "
        f"sys.exit(m.run_program([sys.executable, '-c', {code!r}], {{}}, '.'))"
    )
    return subprocess.Popen(
        [sys.executable, "-c", driver], stdout=subprocess.PIPE, text=True, start_new_session=True
    )


@pytest.fixture
def waiting_child(bootstrap: ModuleType) -> Iterator["subprocess.Popen[str]"]:
    code = (
        "import sys, time\n"
        "try:\n    print('up', flush=True)\n    time.sleep(60)\nexcept KeyboardInterrupt:\n    sys.exit(42)"
    )
    with start_child(bootstrap, code) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "up\n"
        yield process
        process.kill()


@pytest.mark.parametrize("code", [0, 1, 2, 5])
def test_that_exit_codes_pass_through(bootstrap: ModuleType, code: int) -> None:
    with start_child(bootstrap, f"raise SystemExit({code})") as process:
        assert process.wait(30) == code


@posix
def test_that_ctrl_c_reaches_the_program_and_its_answer_comes_back(
    waiting_child: "subprocess.Popen[str]",
) -> None:
    os.killpg(waiting_child.pid, signal.SIGINT)
    assert waiting_child.wait(30) == 42


@posix
def test_that_termination_is_handed_on_and_told_as_a_shell_tells_it(
    waiting_child: "subprocess.Popen[str]",
) -> None:
    waiting_child.send_signal(signal.SIGTERM)
    assert waiting_child.wait(30) == 128 + signal.SIGTERM
