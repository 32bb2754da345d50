"""The preferences survive a restart, and a damaged file costs nothing but them."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from regolith_studio.session.preferences import RECENT_LIMIT, Preferences, UserPresets, preferences_path


def test_that_two_windows_keep_what_each_of_them_has_changed(tmp_path: Path) -> None:
    path = tmp_path / "preferences.json"
    Preferences(recent=("/old",), window={"theme": "dark", "page.scan": {"zoom": 1, "tool": "pen"}}).save(
        path
    )
    one, two = Preferences.load(path), Preferences.load(path)
    one.add_recent(tmp_path / "a" / "a.stl", "mm")
    one.window = {"theme": "light", "page.scan": {"zoom": 2}}
    two.add_recent(tmp_path / "b" / "b.stl", "um")
    two.window = {**two.window, "page.model": {"l_max": 8}, "tour": True}
    assert one.save(path)
    assert two.save(path)
    found = Preferences.load(path)
    assert [Path(each).name for each in found.recent] == ["b.stl", "old"]
    assert sorted(found.units.values()) == ["mm", "um"]
    assert found.window == {
        "theme": "light",
        "page.scan": {"zoom": 2},
        "page.model": {"l_max": 8},
        "tour": True,
    }
    assert [each.name for each in tmp_path.iterdir()] == ["preferences.json"]


@pytest.mark.slow
def test_that_presets_saved_by_two_processes_at_the_same_time_are_all_kept(tmp_path: Path) -> None:
    code = (
        "import sys; from pathlib import Path; from regolith_studio.session.preferences import UserPresets\n"
        "for k in range(40): UserPresets('weights', Path(sys.argv[1])).save(f'{sys.argv[2]}{k}', {'x': k})"
    )
    words = [sys.executable, "-c", code, str(tmp_path)]
    for process in [subprocess.Popen([*words, name]) for name in ("a", "b")]:
        assert process.wait(120) == 0
    assert len(UserPresets("weights", tmp_path).all()) == 80
    assert [path.name for path in tmp_path.iterdir()] == ["presets-weights.json"]


def test_that_preferences_read_back(tmp_path: Path) -> None:
    before = Preferences()
    before.add_recent(tmp_path / "grains" / "a.stl", "mm")
    before.window = {"theme": "dark", "splitter": [3, 4]}
    assert before.save(tmp_path / "p.json")
    after = Preferences.load(tmp_path / "p.json")
    assert after == before
    assert after.unit_for(tmp_path / "grains" / "b.stl") == "mm"
    assert after.unit_for(tmp_path / "elsewhere.stl") is None


@pytest.mark.parametrize("text", ["", "{", "[]", '{"recent": 3}', "\0\0", "[" * 100_000])
def test_that_a_damaged_file_gives_the_defaults(tmp_path: Path, text: str) -> None:
    path = tmp_path / "p.json"
    path.write_text(text)
    assert Preferences.load(path) == Preferences()


def test_that_a_missing_file_gives_the_defaults(tmp_path: Path) -> None:
    assert Preferences.load(tmp_path / "nothing.json") == Preferences()


def test_that_entries_of_a_newer_version_are_kept(tmp_path: Path) -> None:
    path = tmp_path / "p.json"
    path.write_text('{"hologram": true}')
    Preferences.load(path).save(path)
    assert '"hologram": true' in path.read_text()


def test_that_recent_files_are_few_and_each_stands_once(tmp_path: Path) -> None:
    preferences = Preferences()
    for number in [*range(20), 19]:
        preferences.add_recent(tmp_path / f"{number}.stl", "um")
    assert len(preferences.recent) == RECENT_LIMIT
    assert [Path(name).name for name in preferences.recent[:2]] == ["19.stl", "18.stl"]


def test_that_a_folder_that_cannot_be_written_is_no_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    assert not Preferences().save(tmp_path / "file" / "p.json")


@pytest.mark.skipif(os.name == "nt", reason="the limit of file sizes is one of POSIX")
def test_that_a_failed_save_keeps_the_file_and_leaves_no_other(tmp_path: Path) -> None:
    """Each save on a full disk had left a file of its own."""
    import resource

    path = tmp_path / "preferences.json"
    assert Preferences(window={"theme": "dark"}).save(path)
    kept, limits = path.read_bytes(), resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (8, limits[1]))
    try:
        saved = [Preferences(window={"theme": "light"}).save(path) for _ in range(3)]
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert saved == [False] * 3
    assert [(each.name, each.read_bytes()) for each in tmp_path.iterdir()] == [(path.name, kept)]


def test_that_the_environment_can_name_another_folder(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("REGOLITH_STUDIO_CONFIG", os.fspath(tmp_path))
    assert preferences_path() == tmp_path / "preferences.json"
