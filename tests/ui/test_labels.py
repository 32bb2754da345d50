"""Labels that show all that they say."""

import pytest
from PySide6.QtCore import QPoint, QUrl
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import QDialog, QLabel, QVBoxLayout, QWhatsThis, QWidget

from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.session.session import Session
from regolith_studio.ui.layout import STRETCH, vbox
from regolith_studio.ui.main_window import MainWindow
from regolith_studio.ui.result_card import ResultRecord, ResultView
from regolith_studio.ui.widgets.labels import (
    CITATION,
    ElidedLabel,
    FixedHeightText,
    WrappedLabel,
    heading,
    hint_label,
    plain_symbol,
    with_citations,
    with_subscripts,
)

WORDS = "In each step one plane is moved at random, and the move is accepted or rejected. " * 3


def test_that_a_whole_label_has_all_its_lines_where_there_is_no_room_for_them(app, wait):
    label, below = WrappedLabel(WORDS), QWidget()
    below.setMinimumHeight(40)
    around = QWidget()
    column = QVBoxLayout(around)
    column.addWidget(label)
    column.addWidget(below)
    around.resize(240, 60)
    around.show()
    app.processEvents()
    wait(
        lambda: label.height() >= label.heightForWidth(label.width()) > 4 * label.fontMetrics().height(), 10.0
    )
    label.setText(3 * WORDS)
    wait(
        lambda: label.height() >= label.heightForWidth(label.width()) > 12 * label.fontMetrics().height(),
        10.0,
    )
    around.deleteLater()


def test_that_a_sentence_gets_real_subscripts_and_is_left_alone_without_symbols():
    assert with_subscripts("a higher l_max comes closer") == "a higher l<sub>max</sub> comes closer"
    assert with_subscripts("D_min < 2 & l_max") == "D<sub>min</sub> &lt; 2 &amp; l<sub>max</sub>"
    assert with_subscripts("flat S<0.8, file sand_max_3.stl") == "flat S<0.8, file sand_max_3.stl"


def test_that_plain_symbols_have_the_subscripts_that_unicode_has():
    assert plain_symbol("D_max / D_min") == "Dₘₐₓ / Dₘᵢₙ"
    assert plain_symbol("I_3, r_eq, Ψ_K") == "I₃, r_eq, Ψ_K"


@pytest.mark.usefixtures("app")
def test_that_a_detail_leaves_out_whole_parts_where_there_is_no_room():
    label = ElidedLabel("30.5 × 22.8 × 29 µm, 5,120 triangles", by_parts=True)
    width = label.fontMetrics().horizontalAdvance
    for room, shown in ((len(label.text()), label.text()), (25, "30.5 × 22.8 × 29 µm"), (10, None)):
        label.resize(width(label.text()[:room]) + 4, 20)
        assert label.shown_text() == shown or (shown is None and label.shown_text().endswith("…"))
    assert label.toolTip() == label.text()
    label.deleteLater()


SIZES = [(1000, 900, False), (500, 900, True), (500, 400, False)]


@pytest.mark.parametrize(("width", "height", "below"), SIZES)
def test_that_a_sentence_goes_below_its_figures_where_it_is_narrow_and_high(width, height, below, shown, app):
    window = QWidget()
    column = QVBoxLayout(window)
    card = ResultView("answer", ("Loss", "RMSRE", "Jaccard distance"))
    column.addWidget(card)
    column.addStretch(1)
    card.show_record(ResultRecord())
    window.resize(width, height)
    shown(window)
    app.processEvents()
    tops = [each.mapTo(window, QPoint()).y() for each in (card.sentence, card.captions[0])]
    assert (tops[0] > tops[1]) == below
    before = card.height()
    card.show_record(
        ResultRecord(
            ("0.4583", "9.32 %", "23.0 %"), note="Exact except CH (22.8 %, the least possible). " * 4
        )
    )
    app.processEvents()
    assert card.height() == before


def test_that_references_to_the_paper_are_links_to_its_citation(shown, preferences, wait):
    window = shown(MainWindow(Session(InlineRunner()), preferences, "image"))
    for words in ("Weights of the loss (Eq. 9)", "Bild 8: jeder Term", "not given in the paper"):
        assert with_citations(words).count(f'href="{CITATION}"') == 1
    assert with_citations("no reference & none") == "no reference & none"
    label = shown(heading("Weights of the loss (Eq. 9)"))
    assert label.openExternalLinks()
    QDesktopServices.openUrl(QUrl(CITATION))
    wait(lambda: window.findChild(QDialog, "about_dialog") is not None)
    dialog = window.findChild(QDialog, "about_dialog")
    assert any("Geometry-Preserving" in each.text() for each in dialog.findChildren(QLabel))
    dialog.close()


def test_that_a_note_whose_font_becomes_large_gets_the_height_of_their_lines(shown, app):
    text, panel = hint_label("Short."), QWidget()
    note = FixedHeightText((text,), 2)
    vbox(note, STRETCH, parent=panel)
    shown(panel).resize(400, 300)
    app.processEvents()
    for pixels in (40, 12):
        panel.setStyleSheet(f"QLabel {{ font-size: {pixels}px }}")
        app.processEvents()
        whole_lines = divmod(note.viewport().height(), text.fontMetrics().lineSpacing())
        assert whole_lines == (2, 0)


def test_that_a_note_longer_than_its_place_is_shown_in_full_by_a_button_and_scrolls_nothing(shown, app, wait):
    text = hint_label("Short.")
    note = shown(FixedHeightText((text,), 2))
    note.resize(200, note.sizeHint().height())
    app.processEvents()
    assert not note.more.isVisible()
    text.setText("A sentence with a number at its end. " * 8 + "See Eq. 9.")
    wait(note.more.isVisible)
    whole_lines = divmod(note.viewport().height(), text.fontMetrics().lineSpacing())
    assert whole_lines == (2, 0), "no tops of a third line"
    assert not note.verticalScrollBar().isVisible()
    note.more.click()
    popup = next(each for each in app.topLevelWidgets() if each.metaObject().className() == "QWhatsThat")
    assert popup.width() > 100
    QWhatsThis.hideText()
