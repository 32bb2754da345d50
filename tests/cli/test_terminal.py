"""What a command says while it works."""

import pytest

from regolith_studio.cli import terminal
from regolith_studio.jobs.events import Progress, Started, Steps


def steps() -> Steps:
    yield Started("Counting", 2000)
    yield Progress(1500, 2000, "5 a second, 1 min 40 s left")
    return 7


def test_that_a_log_gets_a_line_now_and_then(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert terminal.run_with_progress(steps()) == 7
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(terminal, "_LINE_INTERVAL", -1.0)
    assert terminal.run_with_progress(steps()) == 7
    assert capsys.readouterr().err == ""
    assert terminal.run_with_progress(steps(), logged=True) == 7
    assert capsys.readouterr().err == "Counting: 1,500 of 2,000, 5 a second, 1 min 40 s left\n"
