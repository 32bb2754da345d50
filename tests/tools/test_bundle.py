"""The bundle's start file does what the program asks of ``sys.executable``."""

import subprocess
import sys
from pathlib import Path

import pytest

from regolith_studio import __version__

ROOT = Path(__file__).resolve().parents[2]
START = ROOT / "tools" / "bundle" / "start.py"


def start(*words: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        [sys.executable, START, *words], capture_output=True, text=True, check=False, cwd=ROOT, timeout=60
    )


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--version",), __version__),
        (("-P", "-B", "-m", "platform", "terse"), "Linux" if sys.platform == "linux" else ""),
        (("-c", "import sys; print(sys.argv)", "one"), "['-c', 'one']"),
    ],
)
def test_that_the_bundle_runs_the_program_a_module_and_a_text(words: tuple[str, ...], said: str) -> None:
    done = start(*words)
    assert done.returncode == 0, done.stderr
    assert said in done.stdout


def test_that_the_notice_goes_with_the_text_of_the_licence_that_it_names() -> None:
    folder = ROOT / "tools" / "bundle"
    notice, text = ((folder / name).read_text(encoding="utf-8") for name in ("NOTICE.txt", "GPL-3.0.txt"))
    assert "GPL-3.0.txt" in notice
    assert text.split()[:6] == ["GNU", "GENERAL", "PUBLIC", "LICENSE", "Version", "3,"]
    assert "END OF TERMS AND CONDITIONS" in text
