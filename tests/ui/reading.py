"""Everything that can be read on a widget: what was never translated, and what has too little room."""

import re

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractSpinBox,
    QComboBox,
    QDialogButtonBox,
    QLabel,
    QListWidget,
    QTableView,
    QTableWidget,
    QTabWidget,
    QTreeWidget,
    QWidget,
)

from regolith_studio.ui.views.view import ViewFrame
from regolith_studio.ui.widgets.fields import text_room
from regolith_studio.ui.widgets.plots.base import Plot, plain_text

SAME_EVERYWHERE = re.compile(
    "|".join(
        (
            r"Regolith Studio|Jaccard|English|Deutsch|KiB|CSF|lmax|Dmin|Dmax|[lDF](ₘᵢₙ|ₘₐₓ|ᵢₙₜ)|RMSRE|Zingg",
            r"PySide6-Essentials|pyqtgraph|pyvista|numba|numpy|vtk",
            r"sample:ct/[a-z-]+|(agglutinate|angular|bead|flat|elongated|subangular)-\d|r_eq",
            r"Ctrl|Shift|Alt|PgUp|PgDown|Return|Space|auto",
            r"MuJoCo|LAMMPS|YADE|Aspherix|ANSYS Rocky|Chrono|DEM-Engine|glTF|Blender",
            r"GSD|HOOMD-blue|Rockable|exaDEM",
            r"\((script|convex templates|shape JSON|body rounded/polyhedron|MJCF)\)|JSON|CSV|OBJ",
            r"µm[²³⁵]?|/[-\w./]*|(GIF|WebP) \(\*\.\w+\)",
        )
    )
)
"""Names, symbols, keys, libraries, programs and their formats, paths."""
NO_WORDS = ("SizesPanel",)
"""Their ``text`` is not what is read."""
OF_PYQTGRAPH = ("Export...", "Export")
"""In menus that nobody can open."""
POINT = re.compile(r"\b0\.\d|\d\.(\d{1,2}|\d{4,})(?!\d)")
"""A decimal point; three digits behind a point may be thousands."""
OTHER_POINTS = re.compile(r"Abschnitt \d\.\d|\d+(\.\d+){2,}|\b20\d\d\.\d\d[a-z]?\b")
"""Sections of the paper, and versions, also those named after a month (YADE 2023.02a)."""
WORD = re.compile(r"[^\W\d_]{3,}")


def texts_of(root):
    """Everything that is read on a widget and on all within it, with the name of the widget."""
    for widget in (root, *root.findChildren(QWidget)):
        if type(widget).__name__ in NO_WORDS:
            continue
        name = f"{type(widget).__name__} {widget.objectName()}"
        if widget.objectName().startswith("qt_"):
            continue  # Qt's own parts speak by Qt's own translation
        if widget.objectName().startswith("Scroll") or isinstance(widget.parent(), QDialogButtonBox):
            continue
        for kind in ("text", "title", "placeholderText", "label", "prefix", "suffix"):
            read = getattr(widget, kind, None)
            if callable(read) and not (kind == "text" and isinstance(widget, QAbstractSpinBox)):
                yield name, str(read())
        yield name, widget.windowTitle()
        yield name, widget.toolTip()
        yield name, widget.accessibleName()
        match widget:
            case QComboBox():
                yield from ((name, widget.itemText(row)) for row in range(widget.count()))
                tips = (widget.itemData(row, Qt.ItemDataRole.ToolTipRole) for row in range(widget.count()))
                yield from ((name, str(tip)) for tip in tips if tip)
            case QTabWidget():
                yield from ((name, widget.tabText(at)) for at in range(widget.count()))
            case QDialogButtonBox():
                made = [each for each in widget.buttons() if not widget.standardButton(each).value]
                yield from ((name, each.text()) for each in made)
            case QListWidget():
                yield from ((name, widget.item(row).text()) for row in range(widget.count()))
            case QTreeWidget():
                yield from ((name, widget.headerItem().text(at)) for at in range(widget.columnCount()))
            case QTableWidget():
                yield from ((name, text) for text in _cells(widget))
            case QTableView():
                yield from ((name, text) for text in _heads(widget.model()))
            case Plot():
                yield from ((name, plain_text(text)) for text in (*widget._labels, widget.legend.text()))
                yield from ((name, each.text()) for each in _plot_menu(widget))
    for action in root.findChildren(QAction):
        if action.text() in OF_PYQTGRAPH:
            continue
        yield "QAction " + action.objectName(), action.text()
        yield "QAction " + action.objectName(), action.toolTip()


def _heads(model):
    for at in range(model.columnCount()):
        for role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.ToolTipRole):
            yield str(model.headerData(at, Qt.Orientation.Horizontal, role) or "")


def _cells(table):
    heads = [(table.horizontalHeaderItem(at), at) for at in range(table.columnCount())]
    sides = [(table.verticalHeaderItem(at), at) for at in range(table.rowCount())]
    for item, _ in (*heads, *sides):
        if item is not None:
            yield item.text()
            yield item.toolTip()


def _plot_menu(plot):
    menu = plot.menu()
    found = menu.actions()
    yield from found
    menu.deleteLater()


def english_left(root):
    """Texts with words that were never given to the translation."""
    found = []
    for name, text in texts_of(root):
        rest = plain_text(text) if re.search(r"</?[a-z]|&nbsp;", text) else text
        rest = re.sub(r"⟦[^⟦⟧]*…$", " ", rest)
        while "⟦" in rest and (shorter := re.sub(r"⟦[^⟦⟧]*⟧", " ", rest)) != rest:
            rest = shorter
        rest = SAME_EVERYWHERE.sub(" ", rest)
        if WORD.search(rest):
            found.append((name, text))
    return found


def points_left(root):
    """Numbers with a decimal point, in texts, cells and at axes, beside those of sections and versions."""
    found = [*texts_of(root)]
    for table in root.findChildren(QTableView):
        model, name = table.model(), f"{type(table).__name__} {table.objectName()}"
        places = ((row, column) for row in range(model.rowCount()) for column in range(model.columnCount()))
        for place in places:
            at = model.index(*place)
            found += [(name, str(at.data(role) or "")) for role in (Qt.DisplayRole, Qt.ToolTipRole)]
    for plot in root.findChildren(Plot):
        for side, axis in plot.axes.items():
            low, high = axis.range
            levels = axis.tickValues(low, high, 300.0)
            found += [
                (f"{side} {type(plot).__name__}", text)
                for s, v in levels
                for text in axis.tickStrings(v, 1.0, s)
            ]
    return [(name, text) for name, text in found if POINT.search(OTHER_POINTS.sub(" ", text))]


def cut_off(root):
    """Visible texts that have less room than they need."""
    found = []
    for widget in root.findChildren(QWidget):
        if not widget.isVisible() or widget.visibleRegion().isEmpty():
            continue
        name, wanted = f"{type(widget).__name__} {widget.objectName()}", None
        match widget:
            case QLabel() if widget.text() and not isinstance(widget.parent(), ViewFrame):
                wanted, text = widget.sizeHint().width(), widget.text()
                if widget.wordWrap():
                    longest = max(plain_text(text).split() or [""], key=len)
                    wanted = widget.fontMetrics().horizontalAdvance(longest)
                    if widget.heightForWidth(widget.width()) > widget.height() + 1:
                        found.append((name, text, "too low"))
            case QComboBox() if widget.currentText():
                text = widget.currentText()
                wanted = widget.fontMetrics().horizontalAdvance(text) + widget.width() - text_room(widget)
            case QAbstractButton() if widget.text():
                text = widget.text()
                letters = widget.fontMetrics().horizontalAdvance(text.replace("&", "")) + 12
                wanted = min(widget.minimumSizeHint().width(), letters + widget.iconSize().width())
                if widget.icon().isNull():
                    wanted = min(wanted, letters)
            case _:
                continue
        if wanted > widget.width() + 1:
            found.append((name, text, wanted, widget.width()))
    return found
