"""CITATION.cff has the keys of the Citation File Format 1.2.0, and says what the program says of itself."""

import tomllib
from pathlib import Path

import yaml

from regolith_studio import __version__
from regolith_studio.ui.dialogs.help import PAPER

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
CITATION = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))


def test_that_the_citation_is_of_this_version_under_its_licence() -> None:
    assert CITATION["version"] == PROJECT["version"] == __version__
    assert CITATION["license"] == PROJECT["license"]
    assert CITATION["authors"] == PROJECT["authors"]
    assert CITATION["keywords"] == PROJECT["keywords"]


def test_that_the_article_is_the_one_that_the_window_names() -> None:
    (article,) = CITATION["references"]
    assert (article["type"], article["title"]) == ("article", PAPER)
