"""What bootstrap.py finds missing in the operating system, and what it does about it."""

import sys
from types import ModuleType

import pytest

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="speaks of Linux")


@linux
def test_that_libraries_are_found_by_their_sonames(bootstrap: ModuleType) -> None:
    assert bootstrap.library_loads("libc.so.6")
    assert not bootstrap.library_loads("libregolith-none-such.so.9")


@linux
@pytest.mark.usefixtures("lacks_opengl")
def test_that_a_missing_library_is_named_with_its_package(bootstrap: ModuleType) -> None:
    assert bootstrap.missing_from_system(needs_xvfb=False) == [("libgl1", "libGL.so.1")]


@linux
@pytest.mark.usefixtures("complete_system")
def test_that_another_vendors_opengl_is_as_good(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bootstrap, "library_loads", lambda soname: soname != "libGLX_mesa.so.0")
    assert bootstrap.missing_from_system(needs_xvfb=False) == []


@linux
@pytest.mark.usefixtures("complete_system")
@pytest.mark.parametrize("needed", [True, False])
def test_that_xvfb_is_asked_for_only_where_it_is_needed(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch, needed: bool
) -> None:
    monkeypatch.setattr(bootstrap.shutil, "which", lambda _name: None)
    assert bootstrap.missing_from_system(needed) == ([("xvfb", "Xvfb")] if needed else [])


@linux
@pytest.mark.usefixtures("complete_system")
def test_that_debians_python_without_ensurepip_is_noticed_until_there_is_a_venv(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bootstrap.importlib.util, "find_spec", lambda _name: None)
    assert bootstrap.missing_from_system(needs_xvfb=False) == [("python3-venv", "ensurepip")]
    bootstrap.VENV.mkdir()
    assert bootstrap.missing_from_system(needs_xvfb=False) == []


@pytest.mark.parametrize("platform", ["darwin", "win32"])
def test_that_macos_and_windows_need_no_packages_and_have_a_display(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch, platform: str
) -> None:
    monkeypatch.setattr(bootstrap.sys, "platform", platform)
    monkeypatch.delenv("DISPLAY", raising=False)
    assert bootstrap.missing_from_system(needs_xvfb=True) == []
    assert bootstrap.display_answers()


def recorded_apt(bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch, known: list[set[str]]) -> list[str]:
    """Replace apt by a recorder that knows one set of names after the other."""
    calls: list[str] = []
    monkeypatch.setattr(bootstrap, "known_packages", lambda: known.pop(0))

    def record(_prefix: list[str], *words: str) -> bool:
        calls.append(" ".join(word for word in words if not word.startswith("-")))
        return True

    monkeypatch.setattr(bootstrap, "apt_get", record)
    return calls


def test_that_lists_are_fetched_on_a_machine_that_has_none(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = recorded_apt(bootstrap, monkeypatch, [set(), {"libglib2.0-0t64"}])
    assert bootstrap.install_packages(["libglib2.0-0"], ["sudo"])
    assert calls == ["update", "install libglib2.0-0t64"]


@linux
@pytest.mark.usefixtures("lacks_opengl")
def test_that_a_user_who_may_not_install_is_told_what_to_ask_for(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(bootstrap, "privilege", lambda: None)
    with pytest.raises(bootstrap.SetupStopped, match="apt-get install libgl1`"):
        bootstrap.provide_system_packages(needs_xvfb=False, leave_alone=False)
    assert capsys.readouterr().err == "bootstrap: missing: libGL.so.1 (libgl1)\n"


@linux
@pytest.mark.usefixtures("lacks_opengl")
def test_that_a_system_without_apt_gets_the_list_and_one_sentence(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(bootstrap.shutil, "which", lambda _name: None)
    with pytest.raises(bootstrap.SetupStopped, match="--no-system"):
        bootstrap.provide_system_packages(needs_xvfb=False, leave_alone=False)
    assert "libGL.so.1 (libgl1)" in capsys.readouterr().err


@linux
@pytest.mark.usefixtures("lacks_opengl")
def test_that_no_system_names_what_is_missing_and_goes_on(
    bootstrap: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(bootstrap, "install_packages", lambda *_: pytest.fail("must not install"))
    bootstrap.provide_system_packages(needs_xvfb=False, leave_alone=True)
    assert "libGL.so.1" in capsys.readouterr().err
