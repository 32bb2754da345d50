"""Names are shown as they are: no markup in them takes effect on any page, and asks for no file."""

import shutil

import pytest
from PySide6.QtCore import Qt as Core
from PySide6.QtGui import Qt, QTextDocument
from PySide6.QtWidgets import QAbstractItemView, QLabel, QWidget

from regolith_studio.resources import resource
from regolith_studio.session.project import Project
from regolith_studio.session.recipe import Recipe
from regolith_studio.ui.pages import PAGES
from regolith_studio.ui.startup import open_window
from regolith_studio.ui.translation import Markup, inert, rich, tr, translate
from regolith_studio.ui.widgets.labels import hint_label, with_subscripts

SECONDS = 240
PICTURE = '<img src="file:///red.png"><h1>TITLE'


class _Document(QTextDocument):
    """Notes what a text asks for."""

    def __init__(self):
        super().__init__()
        self.requests = []

    def loadResource(self, kind, url):  # noqa: ARG002, N802
        self.requests.append(url.toString())


def requests(text, form=Core.TextFormat.AutoText):
    """The files that Qt asks for to show a text."""
    if form != Core.TextFormat.RichText and not (
        form == Core.TextFormat.AutoText and Qt.mightBeRichText(text)
    ):
        return []
    document = _Document()
    document.setHtml(text)
    document.size()
    return document.requests


def plain(text):
    document = QTextDocument()
    document.setHtml(text) if Qt.mightBeRichText(text) else document.setPlainText(text)
    return document.toPlainText().replace("\N{WORD JOINER}", "")


def shown_texts(window):
    """Every text of a window that Qt may take for rich text, with its format."""
    for widget in window.findChildren(QWidget):
        yield widget.toolTip(), Core.TextFormat.AutoText
        yield widget.whatsThis(), Core.TextFormat.AutoText
        if isinstance(widget, QLabel):
            yield widget.text(), widget.textFormat()
        if isinstance(widget, QAbstractItemView) and widget.model() is not None:
            model = widget.model()
            for row in range(min(model.rowCount(), 50)):
                for column in range(model.columnCount()):
                    tip = model.index(row, column).data(Core.ItemDataRole.ToolTipRole)
                    yield str(tip or ""), Core.TextFormat.AutoText


@pytest.fixture
def hostile(tmp_path):
    """A project with a particle that is called like a picture and one that is called like a formula."""
    folder = tmp_path / "<img src=group.png>"
    folder.mkdir()
    for name in ("bead-1", "flat-1"):
        shutil.copy(resource("samples", "particles") / f"{name}.stl", folder)
    called = [{"name": "bead-1", "called": PICTURE}, {"name": "flat-1", "called": "=1+1"}]
    recipe = {"inputs": [folder.name], "particles": called, "method": "quadric", "l_max": 4, "level": 2}
    Project(recipe=Recipe.model_validate(recipe), selected=PICTURE).save(tmp_path / "p.regolith")
    return tmp_path / "p.regolith"


@pytest.mark.slow
def test_that_a_hostile_project_asks_for_no_file_on_any_page(hostile, shown, preferences, wait, settled):
    window = open_window(views="image", preferences=preferences)
    window.resize(1100, 720)
    shown(window)
    settled(window, SECONDS)
    window.projects.open(hostile)
    wait(lambda: [each.id for each in window.session.particles] == [PICTURE, "=1+1"], SECONDS)
    settled(window, SECONDS)
    asked = set()
    for key in PAGES:
        window.go(key)
        settled(window, SECONDS)
        asked |= {(key, text) for text, form in shown_texts(window) if requests(text, form)}
    assert not asked
    window.go("sample")
    settled(window, SECONDS)
    titles = [label.text() for label in window.findChildren(QLabel)]
    assert any(PICTURE in plain(title) for title in titles)


@pytest.mark.parametrize(
    "name", [PICTURE, "a<b>c</b>", "&lt;b&gt;", "<!doctype html>", "<?xml?>", "x &amp; y"]
)
def test_that_a_name_in_a_sentence_is_shown_as_it_is(app, name):  # noqa: ARG001
    for text in (tr("Saved {name}.", name=name), translate(name), inert(name), with_subscripts(inert(name))):
        assert not Qt.mightBeRichText(text)
        assert name in text.replace("\N{WORD JOINER}", "")
    mixed = tr("<b>{label}</b> does not contain: {lost}.", label=name, lost="D")
    assert not requests(mixed)
    assert plain(mixed) == f"{name} does not contain: D."
    label = hint_label(f"{name} (Fig. 3)")
    assert not requests(label.text())
    assert plain(label.text()) == f"{name} (Fig. 3)"


def test_that_the_markup_of_the_program_stays(app):  # noqa: ARG001
    degree = Markup("l<sub>max</sub>")
    assert tr("Fit, {degree}", degree=degree) == "Fit, l<sub>max</sub>"
    assert isinstance(tr("Fit, {degree}", degree=degree), Markup)
    assert rich("a < b") == "a &lt; b"
    assert inert("3 < 4 & 5") == "3 < 4 & 5"
