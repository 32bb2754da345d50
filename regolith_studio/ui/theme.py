"""The theme of the window: palette, style sheet and icons, light or dark as the system."""

from collections.abc import Callable, Container
from dataclasses import dataclass
from functools import lru_cache

from PySide6.QtCore import QByteArray, QObject, QRectF, Qt
from PySide6.QtGui import QColor, QGuiApplication, QIcon, QImage, QPainter, QPalette, QPixmap
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import QApplication, QWidget

from regolith_studio.resources import resource
from regolith_studio.scene import palette
from regolith_studio.scene.palette import ThemeColors

GAP = 8
"""Space between neighbours, in pixels; half of it inside a group."""


@dataclass(frozen=True)
class Theme:
    """Colours of the window and of its plots.

    - ``dark``: whether letters are lighter than the ground.
    - ``window``, ``base``, ``raised``, ``border``: grounds of the window, of lists and plots, of buttons;
      lines between them.
    - ``text``, ``muted``, ``accent``, ``selected``: letters, hints, what can be used, what is
      selected in a list.
    - ``particle``, ``fit``, ``polyhedron``: the same three things in every plot and title.
    - ``good``, ``doubtful``, ``bad``: health of a mesh.
    - ``surroundings``: of the three-dimensional views.
    """

    dark: bool
    window: str
    base: str
    raised: str
    border: str
    text: str
    muted: str
    accent: str
    selected: str
    particle: str
    fit: str
    polyhedron: str
    good: str
    doubtful: str
    bad: str
    surroundings: ThemeColors


LIGHT = Theme(
    dark=False,
    window="#f3f4f6",
    base="#ffffff",
    raised="#fbfbfc",
    border="#d3d7dd",
    text="#1f242b",
    muted="#66707d",
    accent="#0067a3",
    selected="#d3e6f4",
    particle="#8d8a84",
    fit=palette.FIT,
    polyhedron=palette.POLYHEDRON,
    good="#007c5c",
    doubtful="#9c5d00",
    bad="#c23b00",
    surroundings=palette.LIGHT,
)
DARK = Theme(
    dark=True,
    window="#23272d",
    base="#1b1e23",
    raised="#2e343b",
    border="#3d444d",
    text="#e4e7eb",
    muted="#9aa4b0",
    accent="#3d9be0",
    selected="#25455f",
    particle="#a9a59d",
    fit="#56b4e9",
    polyhedron="#f0b13a",
    good="#2fbf96",
    doubtful="#e6a23c",
    bad="#ff7a45",
    surroundings=palette.DARK,
)

THEMES = {"light": LIGHT, "dark": DARK}

STYLE = "fusion"

SMALLEST, USUAL, LARGEST = 80.0, 100.0, 200.0
"""Font sizes in percent."""

OWN_FONTS = ("QMenuBar", "QMenu", "QToolButton", "QStatusBar", "QMessageBox", "QTipLabel", "QDockWidgetTitle")
"""Widgets to which a desktop may have given fonts of their own."""

_chosen: list[str] = ["system"]
_font_scale: list[float] = [USUAL]


def choose_theme(name: str) -> None:
    """From now on ``light``, ``dark``, or whatever the system asks for: ``system``."""
    _chosen[0] = name if name in THEMES else "system"


def current_theme() -> Theme:
    """The theme that was chosen, or that the system asks for at the moment."""
    dark = QGuiApplication.styleHints().colorScheme() == Qt.ColorScheme.Dark
    return THEMES.get(_chosen[0], DARK if dark else LIGHT)


def choose_font_size(percent: object) -> None:
    """From now on a font size in percent of what the system asks for."""
    known = isinstance(percent, int | float) and not isinstance(percent, bool)
    _font_scale[0] = min(max(float(percent), SMALLEST), LARGEST) if known else USUAL  # type: ignore[arg-type]


def font_size() -> float:
    """The chosen font size in percent of what the system asks for."""
    return _font_scale[0]


def apply_theme(app: QApplication, theme: Theme, window: QWidget, later: Container[QObject] = ()) -> None:
    """Give the whole application a theme, and the chosen font size.

    The style sheet is the window's, and the application has none: one of the application takes five times as
    long to reach all widgets, and while it has one every part that is put into another takes its style again.
    A font of the application does not reach widgets under a style sheet that is there already: the sheet
    follows it, and names the size so that it is another one. While that stays the sheet does, and widgets
    only look up its colours again; those in `later` when :func:`restyle` is called for them.
    """
    size = apply_font_size(app)
    app.setPalette(_palette(theme))
    sheet = f"/* {size:.2f} pt */\n{_style_sheet()}"
    if sheet == window.styleSheet():
        restyle(window, later)
    else:
        window.setStyleSheet(sheet)


def pass_theme(widget: QWidget, theme: Theme) -> None:
    """Call ``set_theme`` of a widget and of all within it that have one, parts before their owners."""
    for part in (*reversed(widget.findChildren(QWidget)), widget):
        set_theme: Callable[[Theme], None] | None = getattr(part, "set_theme", None)
        if set_theme is not None:
            set_theme(theme)


def restyle(widget: QWidget, later: Container[QObject] = ()) -> None:
    """Let a widget and all in it, without those in `later`, look up the colours of their style sheet.

    Qt takes them from the palette only when it polishes a widget.
    """
    widget.style().polish(widget)
    for part in widget.children():
        if isinstance(part, QWidget) and part not in later:
            restyle(part, later)


def ensure_polished(widget: QWidget) -> None:
    """Give a widget that has not been shown, and all in it, their style and font."""
    for part in (widget, *widget.findChildren(QWidget)):
        part.ensurePolished()


def font_share() -> float:
    """Font size in units of what the system asks for, at least 1."""
    return max(1.0, _font_scale[0] / USUAL)


def apply_font_size(app: QApplication) -> float:
    """Give the application its style, and the chosen font size; returns that in points.

    Best before any widget is made: one that is there and has no window yet may keep the font that it had.
    """
    if app.style().name() != STYLE:
        app.setStyle(STYLE)
    font = app.font()
    of_system = float(app.property("system_letters") or font.pointSizeF())
    app.setProperty("system_letters", of_system)
    font.setPointSizeF(of_system * _font_scale[0] / USUAL)
    if font != app.font() or _font_scale[0] != USUAL:  # a style may take back fonts of its widgets
        app.setFont(font)
        for name in OWN_FONTS:
            app.setFont(font, name)  # type: ignore[arg-type]  # bytes would not do, whatever the stubs say
    return font.pointSizeF()


def _palette(theme: Theme) -> QPalette:
    colours = QPalette()
    role = QPalette.ColorRole
    for target, colour in {
        role.Window: theme.window,
        role.WindowText: theme.text,
        role.Base: theme.base,
        role.AlternateBase: theme.window,
        role.Text: theme.text,
        role.Button: theme.raised,
        role.ButtonText: theme.text,
        role.ToolTipBase: theme.raised,
        role.ToolTipText: theme.text,
        role.PlaceholderText: theme.muted,
        role.Highlight: theme.accent,
        role.HighlightedText: "#ffffff",
        role.Link: theme.accent,
        role.Accent: theme.accent,
        role.Mid: theme.border,
        role.Midlight: theme.selected,
        role.LinkVisited: theme.doubtful,
        role.BrightText: theme.bad,
    }.items():
        colours.setColor(target, QColor(colour))
    for target in (role.WindowText, role.Text, role.ButtonText):
        colours.setColor(QPalette.ColorGroup.Disabled, target, QColor(theme.muted))
    return colours


def _style_sheet() -> str:
    """Colours are named by their role in the palette, so that the sheet is the same in every theme.

    Under any sheet Qt makes spin boxes lower than a line of text, so their height is set.
    """
    return f"""
QDialogButtonBox {{ dialogbuttonbox-buttons-have-icons: 0; }}
QToolTip {{ color: palette(text); background: palette(button); border: 1px solid palette(mid);
    padding: 4px; }}
QMainWindow::separator {{ width: 1px; height: 1px; background: palette(mid); }}
QProgressBar {{ background: palette(base); border: 1px solid palette(mid); border-radius: 3px;
    text-align: center; }}
QProgressBar::chunk {{ background: palette(midlight); }}
QProgressBar[textVisible="false"]::chunk {{ background: palette(highlight); }}
QSplitter::handle {{ background: transparent; }}
QSplitter::handle:hover {{ background: palette(highlight); }}
QStatusBar {{ border-top: 1px solid palette(mid); }}
QStatusBar::item {{ border: none; }}
QToolBar {{ border: none; border-bottom: 1px solid palette(mid); spacing: 2px; padding: 3px 6px; }}
QToolBar QToolButton {{ padding: 3px 5px; border-radius: 4px; border: 1px solid transparent; }}
QToolBar QToolBarExtension {{ padding: 0; }}
QToolBar QToolButton:hover {{ background: palette(button); border-color: palette(mid); }}
QToolBar QToolButton:checked {{ background: palette(base); border-color: palette(mid); }}
QFrame[role="sidebar"] {{ background: palette(base); border-right: 1px solid palette(mid); }}
QFrame[role="sidebar"] QToolButton {{ padding: 6px 2px 4px 2px; border-radius: 5px;
    color: palette(placeholder-text); border: 1px solid transparent; }}
QFrame[role="sidebar"] QToolButton:hover {{ background: palette(window); color: palette(text); }}
QFrame[role="sidebar"] QToolButton[focused="true"] {{ border-color: palette(highlight); }}
QFrame[role="sidebar"] QToolButton:checked {{ background: palette(midlight); color: palette(text); }}
*[role="heading"] {{ font-weight: 600; }}
*[role="hint"] {{ color: palette(placeholder-text); }}
*[role="warning"] {{ color: palette(link-visited); }}
QFrame[role="card"] {{ background: palette(base); border: 1px solid palette(mid); border-radius: 5px; }}
QFrame[role="card"][focused="true"] {{ border-color: palette(highlight); }}
QFrame[role="card"] QAbstractSpinBox, QFrame[role="card"] QLineEdit, QTabWidget QAbstractSpinBox,
QTabWidget QLineEdit {{ background-color: palette(button); }}
QAbstractSpinBox {{ min-height: 1em; }}
QFrame[role="toast"] {{ background: palette(button); border: 1px solid palette(bright-text);
    border-radius: 6px; }}
QFrame[role="toast"][kind="note"] {{ border-color: palette(highlight); }}
QTableView {{ border: 1px solid palette(mid); border-radius: 5px; gridline-color: transparent;
    selection-background-color: palette(midlight); selection-color: palette(text); }}
QTableView[focused="true"] {{ border-color: palette(highlight); }}
QListWidget {{ background: palette(base); border: 1px solid palette(mid); border-radius: 5px;
    padding: 3px; }}
QListWidget[focused="true"] {{ border-color: palette(highlight); }}
QTableCornerButton::section {{ background: palette(window); border: none;
    border-bottom: 1px solid palette(mid); }}
QHeaderView::section {{ background: palette(window); color: palette(placeholder-text); border: none;
    border-bottom: 1px solid palette(mid); padding: 4px 3px; }}
QTabWidget::pane {{ border: 1px solid palette(mid); border-radius: 5px; background: palette(base);
    top: -1px; }}
QTabBar::tab {{ padding: 5px 11px; color: palette(placeholder-text); border: 1px solid transparent;
    border-bottom: none; border-top-left-radius: 5px; border-top-right-radius: 5px; }}
QTabBar::tab:selected {{ color: palette(text); background: palette(base); border-color: palette(mid); }}
QTabBar::tab:hover {{ color: palette(text); }}
QTabBar[focused="true"]::tab:focus {{ color: palette(highlight); border-color: palette(highlight); }}
QToolButton[role="fold"] {{ border: 1px solid transparent; border-radius: 4px; padding: 1px 3px; }}
QToolButton[role="fold"][focused="true"] {{ border-color: palette(highlight); }}
QScrollArea {{ border: none; }}
QScrollArea[role="texts"] {{ border: 1px solid transparent; border-radius: 4px; }}
QScrollArea[role="texts"][focused="true"] {{ border-color: palette(highlight); }}
QCheckBox::indicator, QRadioButton::indicator {{ width: 1.05em; height: 1.05em; border-radius: 3px;
    border: 1px solid palette(placeholder-text); background: palette(base); }}
QCheckBox::indicator:hover, QRadioButton::indicator:hover {{ border-color: palette(highlight); }}
QRadioButton::indicator {{ border-radius: 0.55em; }}
QRadioButton::indicator:checked {{ border-color: palette(highlight); background: qradialgradient(
    cx: 0.5, cy: 0.5, fx: 0.5, fy: 0.5, radius: 0.5,
    stop: 0.5 palette(highlight), stop: 0.6 palette(base)); }}
QCheckBox::indicator:checked {{ background: palette(highlight); border-color: palette(highlight);
    image: url("{resource("icons", "tick.svg").as_posix()}"); }}
QCheckBox::indicator:disabled, QRadioButton::indicator:disabled {{ border-color: palette(mid); }}
QCheckBox::indicator:checked:disabled {{ background: palette(mid); }}
"""


SIZES = (16, 20, 24, 32, 48)


def icon(name: str, colour: str, faint: str | None = None) -> QIcon:
    """The icon ``resources/icons/<name>.svg`` drawn in one colour, and in a fainter one when disabled."""
    made = QIcon()
    for size in SIZES:
        made.addPixmap(pixmap(name, colour, size))
        if faint:
            made.addPixmap(pixmap(name, faint, size), QIcon.Mode.Disabled)
    return made


def pixmap(name: str, colour: str, size: int) -> QPixmap:
    """The icon as a square picture of `size` pixels."""
    coloured, drawing = _drawing(name, size)
    picture = QImage(drawing)
    if not coloured:
        painter = QPainter(picture)
        painter.setCompositionMode(QPainter.CompositionMode.CompositionMode_SourceIn)
        painter.fillRect(0, 0, size, size, QColor(colour))
        painter.end()
    return QPixmap.fromImage(picture)


@lru_cache(maxsize=512)
def _drawing(name: str, size: int) -> tuple[bool, QImage]:
    """Whether the icon has colours of its own, and its picture; in black where it has not."""
    words = resource("icons", f"{name}.svg").read_text(encoding="utf-8")
    picture = QImage(size, size, QImage.Format.Format_ARGB32_Premultiplied)
    picture.fill(Qt.GlobalColor.transparent)
    painter = QPainter(picture)
    QSvgRenderer(QByteArray(words.encode())).render(painter, QRectF(0, 0, size, size))
    painter.end()
    return "currentColor" not in words, picture
