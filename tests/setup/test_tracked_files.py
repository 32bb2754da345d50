"""What must not be in the repository: addresses of registries, paths of a machine, pins that say more."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PRIVATE = re.compile(
    r"pypi\.|pythonhosted|anaconda\.(?:org|com)|index[-_]url|find[-_]links|trusted[-_]host"
    r"|(?:^|[\s\"'=(`])/(?:root|work|home/\w+|Users/\w+|opt/(?:wheels|pypi))/",
    re.IGNORECASE,
)
TERM = r"[a-z_]+ (?:<|>=|==|!=) '[A-Za-z0-9._*]+'"
PIN = re.compile(
    rf"[a-z0-9]+(?:[.-][a-z0-9]+)*==[0-9][0-9a-z.]*(?: ; {TERM}(?: (?:and|or) {TERM})*)?",
)


def tracked_files() -> list[Path]:
    if not shutil.which("git") or not (ROOT / ".git").exists():
        pytest.skip("this is not a checkout")
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout
    return [ROOT / name for name in listed.decode().split("\0") if name and (ROOT / name).is_file()]


def text_of(path: Path) -> str:
    """The file's text; empty for a binary one."""
    content = path.read_bytes()
    return "" if b"\0" in content[:4096] else content.decode("utf-8", "replace")


def test_that_no_file_names_a_registry_or_a_path_of_somebodys_machine() -> None:
    found = [
        f"{path.relative_to(ROOT)}:{number}: {line.strip()}"
        for path in tracked_files()
        if path != Path(__file__)
        for number, line in enumerate(text_of(path).splitlines(), 1)
        if PRIVATE.search(line)
    ]
    assert not found


@pytest.mark.parametrize(
    "line",
    ["extra-index-url = x", "--find-links /x", "https://pypi.example/simple", 'open("/work/main/a.stl")'],
)
def test_that_such_a_line_would_be_noticed(line: str) -> None:
    assert PRIVATE.search(line)


@pytest.mark.parametrize("line", ["see /usr/share/fonts", "https://doi.org/10.1/x", "benchmarks/work/a"])
def test_that_a_harmless_line_would_not(line: str) -> None:
    assert not PRIVATE.search(line)


def test_that_the_constraints_are_sorted_pins_and_nothing_else() -> None:
    lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    assert [line for line in lines if not PIN.fullmatch(line)] == []
    names = [line.split("==")[0] for line in lines]
    assert names == sorted(names)


def test_that_no_tracked_file_is_made_by_running_the_program_or_left_by_a_merge() -> None:
    suffixes = {".pyc", ".nbc", ".nbi", ".log", ".egg-info", ".orig", ".rej"}
    assert not [path for path in tracked_files() if suffixes & set(path.suffixes)]
