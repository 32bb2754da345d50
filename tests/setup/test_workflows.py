"""The workflows test what the package promises, by commands that are there."""

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
WORKFLOWS = {path.stem: path for path in sorted((ROOT / ".github" / "workflows").glob("*.yml"))}
SYSTEMS = {"ubuntu": "POSIX :: Linux", "windows": "Microsoft :: Windows", "macos": "MacOS"}


def jobs(name: str) -> dict[str, Any]:
    return dict(yaml.safe_load(WORKFLOWS[name].read_text(encoding="utf-8"))["jobs"])


def classifiers(topic: str) -> set[str]:
    return {line.removeprefix(topic) for line in PROJECT["classifiers"] if line.startswith(topic)}


def test_that_the_tests_run_on_every_system_and_on_the_oldest_and_newest_python() -> None:
    matrix = jobs("tests")["tests"]["strategy"]["matrix"]
    systems = {SYSTEMS[name.removesuffix("-latest")] for name in matrix["system"]}
    assert systems == classifiers("Operating System :: ")
    minors = {
        int(text[2:]) for text in classifiers("Programming Language :: Python :: ") if text[2:].isdigit()
    }
    assert matrix["python"] == [f"3.{min(minors)}", f"3.{max(minors)}"]
    assert PROJECT["requires-python"] == f">=3.{min(minors)}"


@pytest.mark.parametrize("name", WORKFLOWS)
def test_that_a_job_ends_by_itself_and_names_files_that_are_there(name: str) -> None:
    for job in jobs(name).values():
        assert job["timeout-minutes"] <= 90
        text = " ".join(step.get("run", "") for step in job["steps"])
        named = re.findall(r"[\w/.]+\.(?:py|txt)\b|resources/[\w/]+", text.replace("$GITHUB_WORKSPACE/", ""))
        assert named
        assert all((ROOT / each).exists() for each in named)
