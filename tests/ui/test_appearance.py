"""Theme and letters: applied when they change, and only then."""

import itertools
import time

import pytest
from PySide6.QtCore import QEvent, QObject, QPoint
from PySide6.QtGui import QColor, QFont, QFontMetrics
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFrame,
    QLabel,
    QProgressBar,
    QRadioButton,
    QSplitter,
    QStyle,
    QStyleOptionButton,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.session.session import Session
from regolith_studio.ui.appearance import FONT_SIZE
from regolith_studio.ui.layout import restore_borders
from regolith_studio.ui.main_window import MainWindow
from regolith_studio.ui.result_card import MAGNIFICATION, ResultView
from regolith_studio.ui.startup import open_window
from regolith_studio.ui.theme import (
    DARK,
    LIGHT,
    apply_theme,
    choose_font_size,
    choose_theme,
    pixmap,
)
from regolith_studio.ui.widgets.fields import ElidedComboBox


@pytest.fixture
def usual_looks(app):
    font = app.font()
    yield
    choose_theme("system")
    choose_font_size(None)
    app.setFont(font)


def sizes_of_letters(window):
    """In points, of all that is in a window, neither a large figure nor on a canvas of pyqtgraph."""
    large = {figure for card in window.findChildren(ResultView) for figure in card.figures}
    return {round(each.font().pointSizeF(), 1) for each in window.findChildren(QWidget) if each not in large}


@pytest.mark.usefixtures("usual_looks")
@pytest.mark.parametrize("first", [100, 200])
@pytest.mark.slow
def test_that_letters_of_another_size_reach_every_widget_at_the_start_and_later(
    shown, preferences, app, first
):
    usual, of_system = app.font(), app.property("system_letters") or app.font().pointSizeF()
    preferences.window = preferences.window | {FONT_SIZE: first}
    window = shown(MainWindow(Session(InlineRunner()), preferences, "image"))
    assert sizes_of_letters(window) == {round(of_system * first / 100, 1)}
    slider = window.page.loss.sliders["min_diameter"]
    figure = window.findChild(ResultView).figures[0]
    for percent in (200, 80, 150):
        window.appearance.choose(**{FONT_SIZE: percent})
        app.processEvents()
        assert sizes_of_letters(window) == {round(of_system * percent / 100, 1)}
        assert figure.font().pointSizeF() == pytest.approx(
            MAGNIFICATION * of_system * percent / 100, rel=0.02
        )
        letters = QFontMetrics(app.font())
        assert window.tasks.text.height() >= letters.height()
        assert window.page.particles.table.rowHeight(0) in (0, letters.height() + 9)
        assert slider.field.width() > letters.horizontalAdvance("-100.00")
        assert slider.label.width() >= slider.label.sizeHint().width()
    window.appearance.choose(**{FONT_SIZE: 100})
    app.setFont(usual)


@pytest.mark.usefixtures("usual_looks")
@pytest.mark.slow
def test_that_large_letters_leave_the_views_their_room(shown, preferences, app, settled):
    usual = app.font()
    preferences.window = {FONT_SIZE: 200}
    window = shown(open_window(views="image", preferences=preferences))
    window.resize(1920, 1080)
    settled(window)
    page = window.page
    assert page.particles.width() < 1920 / 5
    assert page.three_views.width() > 1920 / 3
    for box in (page.coarsening.method, page.coarsening.target):
        assert box.width() >= box.sizeHint().width() - 2, box.objectName()
    window.appearance.choose(**{FONT_SIZE: 100})
    app.setFont(usual)


@pytest.mark.usefixtures("usual_looks")
def test_that_smaller_letters_give_the_borders_of_the_pages_their_places_back(shown, preferences, wait):
    window = shown(MainWindow(Session(InlineRunner()), preferences, "image"))
    window.resize(1480, 900)
    columns = window.findChild(QSplitter, "explore_columns")
    restore_borders(window)
    standard, least = columns.sizes(), columns.widget(1).minimumSizeHint().width()
    window.appearance.choose(**{FONT_SIZE: 200})
    wait(lambda: columns.sizes()[1] > standard[1], 10.0)
    columns.setSizes([800, 600])
    assert columns.sizes() != standard
    window.appearance.choose(**{FONT_SIZE: 100})
    wait(lambda: columns.sizes() == standard, 10.0)
    wait(lambda: columns.widget(1).minimumSizeHint().width() == least, 10.0)


def test_that_a_theme_reaches_dialogs_of_the_window(app, shown):
    window = shown(QWidget())
    apply_theme(app, LIGHT, window)
    dialog = QDialog(window)
    buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, parent=dialog)
    hint_label = QLabel("1")
    hint_label.setProperty("role", "hint")
    column = QVBoxLayout(dialog)
    column.addWidget(hint_label)
    column.addWidget(buttons)
    shown(dialog)
    for theme in (DARK, LIGHT):
        apply_theme(app, theme, window)
        app.processEvents()
        assert hint_label.palette().windowText().color() == QColor(theme.muted)
        assert window.palette().window().color() == QColor(theme.window)
    assert all(button.icon().isNull() for button in buttons.buttons())


def test_that_what_is_written_into_can_be_seen_on_the_ground_of_plots(app, shown):
    """By its fill in the dark: the edge that the style draws is darker than any ground."""
    window = shown(QWidget())
    card, field = QFrame(), QDoubleSpinBox()
    card.setProperty("role", "card")
    QVBoxLayout(card).addWidget(field)
    QVBoxLayout(window).addWidget(card)
    for theme, least in ((DARK, 15), (LIGHT, 60), (DARK, 15)):
        apply_theme(app, theme, window)
        app.processEvents()
        picture = window.grab().toImage()
        corner = field.mapTo(window, QPoint(0, 0))
        ground = picture.pixelColor(corner - QPoint(3, 3)).lightness()
        edge = picture.pixelColor(corner + QPoint(0, field.height() // 2)).lightness()
        fill = picture.pixelColor(corner + QPoint(3, 3)).lightness()
        assert max(fill - ground, ground - edge) >= least, theme.dark


def pictures_of_pages(window, keys, wait, settled):
    """What is seen on pages, once they have taken their theme."""
    found = {}
    for key in keys:
        window.go(key)
        settled(window)
        seen = [None, window.grab().toImage()]
        while seen[-1] != seen[-2]:  # what a visit has set off goes on for some turns
            end = time.monotonic() + 0.2
            wait(lambda end=end: time.monotonic() > end)
            seen.append(window.grab().toImage())
        found[key] = seen[-1]
    return found


@pytest.mark.usefixtures("usual_looks")
@pytest.mark.slow
def test_that_a_theme_chosen_later_looks_as_one_from_the_start(shown, preferences, wait, settled):
    keys = ("explore", "studies")

    def opened(theme):
        preferences.window = {"theme": theme}
        window = open_window(views="image", preferences=preferences)
        window.resize(1100, 720)
        shown(window)
        wait(lambda: window.session.results.coarsened is not None)
        return window

    changed = opened("light")
    light = pictures_of_pages(changed, keys, wait, settled)
    changed.appearance.choose(theme="dark")
    later = pictures_of_pages(changed, keys, wait, settled)
    dark = pictures_of_pages(opened("dark"), keys, wait, settled)
    for key in keys:
        assert later[key] == dark[key], key
        assert later[key] != light[key]


@pytest.mark.usefixtures("usual_looks")
def test_that_another_theme_gives_no_widget_another_style(shown, preferences, wait):
    """Qt polishes every widget of the window again when its sheet is another: a quarter of a second."""
    window = shown(MainWindow(Session(InlineRunner()), preferences, "image"))
    window.appearance.choose(theme="light")
    told = []

    class Ear(QObject):
        def eventFilter(self, watched, event):  # noqa: N802
            if event.type() == QEvent.Type.StyleChange:
                told.append(watched.objectName())
            return False

    ear = Ear()
    for widget in (window, *window.findChildren(QWidget)):
        widget.installEventFilter(ear)
    window.appearance.choose(theme="dark")
    wait(lambda: window.palette().window().color() == QColor(DARK.window))
    assert told == []


def test_that_an_icon_is_drawn_in_the_colour_that_is_asked_for():
    for colour in ("#ff0000", "#0000ff"):
        image = pixmap("open", colour, 24).toImage()
        seen = [image.pixelColor(x, y) for x in range(24) for y in range(24)]
        assert {each.name() for each in seen if each.alpha() == 255} == {colour}
        assert any(each.alpha() == 0 for each in seen)


def luminance(colour):
    """Relative luminance of sRGB, as WCAG 2.2 defines it."""
    parts = [value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4 for value in colour]
    return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]


def contrast(one, other):
    """WCAG's ratio of two colours, 1 to 21."""
    high, low = sorted((luminance(one), luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("theme", [LIGHT, DARK])
@pytest.mark.parametrize("name", ["text", "muted", "good", "doubtful", "bad"])
def test_that_coloured_text_can_be_read_on_every_ground(theme, name):
    """WCAG 2.2, 1.4.3: text has a contrast of at least 4.5."""
    ink = QColor(getattr(theme, name)).getRgbF()[:3]
    grounds = [QColor(each).getRgbF()[:3] for each in (theme.window, theme.base, theme.raised)]
    assert min(contrast(ink, ground) for ground in grounds) >= 4.5


@pytest.mark.parametrize("theme", [LIGHT, DARK])
@pytest.mark.parametrize("checked", [False, True])
@pytest.mark.parametrize("kind", [QCheckBox, QRadioButton])
def test_that_a_box_or_circle_to_check_stands_out_as_controls_must(app, shown, theme, kind, checked):
    """WCAG 2.2, 1.4.11: what shows a control and its state has a contrast of at least 3."""
    window = QWidget()
    box = kind(window)
    box.setChecked(checked)
    QVBoxLayout(window).addWidget(box)
    apply_theme(app, theme, shown(window))
    app.processEvents()
    image = box.grab().toImage()
    seen = {image.pixelColor(x, y).getRgbF()[:3] for x in range(image.width()) for y in range(image.height())}
    ground = QColor(theme.window).getRgbF()[:3]
    assert max(contrast(colour, ground) for colour in seen) >= 3.0


def test_that_the_dot_of_a_radio_button_is_in_the_middle_of_its_circle(app, shown):
    window = QWidget()
    button = QRadioButton(window)
    button.setChecked(True)
    QVBoxLayout(window).addWidget(button)
    apply_theme(app, LIGHT, shown(window))
    app.processEvents()
    option = QStyleOptionButton()
    button.initStyleOption(option)
    middle = button.style().subElementRect(QStyle.SubElement.SE_RadioButtonIndicator, option, button).center()
    image, colour = button.grab().toImage(), QColor(LIGHT.accent)
    for x, y in ((0, 0), (2, 2), (-1, 2), (2, -1), (-1, -1)):
        assert image.pixelColor(middle + QPoint(x, y)) == colour


def test_that_a_combo_box_becomes_as_small_as_its_letters_again(shown):
    box = shown(ElidedComboBox())
    box.addItem("Exact descriptors")
    before, usual = box.minimumSizeHint(), box.font()
    large = QFont(usual)
    large.setPointSizeF(2.0 * usual.pointSizeF())
    box.setFont(large)
    assert box.minimumSizeHint().height() > before.height()
    box.setFont(usual)
    assert box.minimumSizeHint() == before


@pytest.mark.usefixtures("usual_looks")
@pytest.mark.parametrize("theme", [LIGHT, DARK])
@pytest.mark.parametrize("text", [False, True])
def test_that_a_bar_of_unknown_length_is_not_full(app, shown, theme, text):
    panel = shown(QWidget())
    bar, column = QProgressBar(), QVBoxLayout(panel)
    bar.setTextVisible(text)
    bar.setRange(0, 0)
    column.addWidget(bar)
    apply_theme(app, theme, panel)
    panel.resize(240, 50)
    app.processEvents()
    picture = bar.grab().toImage()
    row = [picture.pixelColor(x, picture.height() // 2).name() for x in range(4, picture.width() - 4)]
    filled = theme.selected if text else theme.accent
    assert 0.2 < row.count(QColor(filled).name()) / len(row) < 0.8
    bar.setRange(0, 4)
    bar.setValue(4)
    picture = bar.grab().toImage()
    assert picture.pixelColor(picture.width() - 8, picture.height() // 2) == QColor(filled)


@pytest.mark.usefixtures("usual_looks")
@pytest.mark.parametrize("percent", [100, 150, 200, 80])
def test_that_a_line_of_text_is_as_high_as_its_font_in_a_spin_box(app, shown, percent):
    panel = shown(QWidget())
    field, column = QDoubleSpinBox(), QVBoxLayout(panel)
    field.setSuffix(" g")
    column.addWidget(field)
    choose_font_size(percent)
    apply_theme(app, LIGHT, panel)
    panel.resize(200, panel.minimumSizeHint().height())
    app.processEvents()
    assert field.lineEdit().height() >= field.fontMetrics().height()


@pytest.mark.usefixtures("usual_looks")
def test_that_a_tool_bar_without_room_shows_where_the_rest_of_it_is(shown, preferences, app):
    preferences.window = preferences.window | {FONT_SIZE: 150}
    window = shown(MainWindow(Session(InlineRunner()), preferences, "image"))
    window.resize(1000, 700)
    more = window.menus.bar.findChild(QToolButton, "qt_toolbar_ext_button")
    app.processEvents()
    assert more.isVisible()
    for theme in (LIGHT, DARK):
        apply_theme(app, theme, window)
        window.menus.set_theme(theme)
        app.processEvents()
        image = more.grab().toImage()
        places = itertools.product(range(image.width()), range(image.height()))
        shades = {image.pixelColor(*place).lightness() for place in places}
        assert max(shades) - min(shades) > 100
