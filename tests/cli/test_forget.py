"""What the program keeps in the home folder can be removed."""

from collections.abc import Callable
from pathlib import Path

import numba
import pytest

from tests.cli.conftest import Said

CODE = "core-0123456789abcdef"


def test_that_forget_removes_preferences_and_compiled_code_and_nothing_else(
    command: Callable[..., Said], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("REGOLITH_STUDIO_CONFIG", str(tmp_path / "config"))
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    for name in (
        "config/preferences.json",
        "config/recovered.json",
        f"cache/{CODE}/a.nbi",
        "cache/mine/b.nbi",
    ):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("{}")
    said = command("forget", "--json")
    assert said.json == {
        "removed": [str(tmp_path / "config" / "preferences.json"), str(tmp_path / "cache" / CODE)]
    }
    assert sorted(path.name for path in tmp_path.rglob("*") if path.is_file()) == [
        "b.nbi",
        "recovered.json",
    ]
    assert command("forget").out == "There is nothing to remove.\n"
