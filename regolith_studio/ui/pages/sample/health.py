"""Report on the mesh of a particle: findings, repairs and remaining faults, with a coloured view."""

import html
from collections.abc import Mapping
from dataclasses import dataclass

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QScrollArea,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.geometry.mesh_health import MeshHealth
from regolith_studio.messages import N_
from regolith_studio.scene.overlays import FAULT_COLOURS
from regolith_studio.session.results import ParticleEntry
from regolith_studio.session.sample_table import health_sentences
from regolith_studio.ui.translation import localized, number_text, tr, translate
from regolith_studio.ui.widgets.labels import WrappedLabel, short_number
from regolith_studio.ui.widgets.table import FontRowHeight

FINDINGS = (
    ("bodies", N_("Connected parts"), N_("Connected parts of the surface; a particle has one")),
    ("watertight", N_("Closed"), N_("Every edge belongs to exactly two triangles")),
    (
        "consistent_winding",
        N_("Consistent orientation"),
        N_("Neighbouring triangles have normals on the same side"),
    ),
    ("volume", N_("V [µm³]"), N_("Negative where the mesh is inside out")),
    ("euler_number", N_("Euler number"), N_("2 for a closed body without tunnels")),
    ("handles", N_("Tunnels"), N_("Through the body, of a closed mesh")),
    ("open_edges", N_("Open edges"), N_("Edges of one triangle: the rims of holes")),
    ("self_intersections", N_("Intersecting pairs"), N_("Pairs of triangles that intersect each other")),
    ("degenerate_faces", N_("Faces without area"), N_("Triangles that are a line or a point")),
)
"""Fields of :class:`MeshHealth` with label and explanation."""
KINDS = {
    "filled": N_("closed holes"),
    "open": N_("rims of holes"),
    "crossing": N_("intersecting faces"),
    "turned": N_("reoriented faces"),
    "small bodies": N_("parts left out"),
    "non-manifold": N_("edges of more than two faces"),
    "double": N_("duplicate faces"),
    "degenerate": N_("faces without area"),
    "hidden": N_("hidden from the star point"),
}
"""Labels of the faults, in the order of :data:`FAULT_COLOURS`."""
NOW = ("filled", "hidden")
"""Kinds that are looked for in the repaired mesh."""
DASH = "–"


@dataclass(frozen=True)
class _Row:
    name: str
    tip: str
    before: str
    now: str


class HealthPanel(QWidget):
    """Two columns of findings, texts, and the legend of the coloured faults."""

    showChanged = Signal(bool)  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("health_report")
        self._repaired = False
        self.table = self._make_table()
        self.words = WrappedLabel()
        self.words.setObjectName("health_words")
        self.words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.where = QCheckBox(tr("Show in the view"))
        self.where.setObjectName("health_where")
        self.where.setToolTip(
            tr("Colours the faults in the picture, as they were before the mesh was repaired")
        )
        self.where.setChecked(True)
        self.legend = QLabel()
        self.legend.setObjectName("health_legend")
        self.legend.setTextFormat(Qt.TextFormat.RichText)
        self.legend.setWordWrap(True)
        self._place()
        self.where.toggled.connect(self.showChanged)

    def show_entry(self, entry: ParticleEntry | None) -> None:
        """Show the report of a particle; the legend follows when its faults are located."""
        self.legend.clear()
        self._repaired = entry is not None and entry.particle.repair is not None
        rows = () if entry is None or entry.health is None else _rows(entry, entry.health)
        self.table.setRowCount(len(rows))
        for at, row in enumerate(rows):
            for column, text in enumerate((row.name, row.before, row.now)):
                item = QTableWidgetItem(text)
                item.setToolTip(row.tip)
                if column:
                    item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
                self.table.setItem(at, column, item)
        self.words.setText("" if entry is None else _words(entry))

    def show_legend(self, counts: Mapping[str, int]) -> None:
        """Show the legend of the faults with their numbers of triangles."""
        found = [kind for kind in FAULT_COLOURS if counts.get(kind)]
        repaired = [kind for kind in found if self._repaired and kind not in NOW]
        groups = [
            (tr("Before the repair:") + " ", repaired),
            ("", [kind for kind in found if kind not in repaired]),
        ]
        lines = [
            html.escape(title) + "&nbsp; ".join(_legend_entry(kind, counts[kind]) for kind in kinds)
            for title, kinds in groups
            if kinds
        ]
        self.legend.setText("<br>".join(lines) or tr("Nothing to show in the view."))

    def _make_table(self) -> QTableWidget:
        table = QTableWidget(0, 3)
        table.setAccessibleName(tr("Health of the mesh"))
        table.setHorizontalHeaderLabels([tr("Mesh"), tr("in the file"), tr("repaired")])
        table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        table.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        table.setShowGrid(False)
        table.verticalHeader().hide()
        FontRowHeight(table, 5)
        header = table.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        return table

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        words, bar = self._right.minimumSizeHint(), self._scrolled.verticalScrollBar().sizeHint()
        self._scrolled.setMinimumWidth(min(words.width() + bar.width(), self.width() // 2))

    def _place(self) -> None:
        right = self._right = QWidget()
        column = QVBoxLayout(right)
        column.setContentsMargins(8, 4, 4, 4)
        for widget in (self.where, self.legend, self.words):
            column.addWidget(widget)
        column.addStretch(1)
        scrolled = self._scrolled = QScrollArea()
        scrolled.setWidgetResizable(True)
        scrolled.setProperty("role", "texts")
        scrolled.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scrolled.setWidget(right)
        for ground in (scrolled.viewport(), right):
            ground.setAutoFillBackground(False)  # that of the tab is seen
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.table, 3)
        layout.addWidget(scrolled, 2)


def _legend_entry(kind: str, count: int) -> str:
    mark = f'<span style="color:{FAULT_COLOURS[kind]}">&#9632;</span>&nbsp;'
    return mark + html.escape(f"{tr(KINDS[kind])} ({number_text(count, ',')})")


def translated_health(entry: ParticleEntry) -> list[str]:
    """The report as text in the language of the window."""
    return [translate(sentence) for sentence in health_sentences(entry)]


def _rows(entry: ParticleEntry, now: MeshHealth) -> tuple[_Row, ...]:
    done = entry.particle.repair
    before = now if done is None else done.health_before
    rows = [
        _Row(tr(name), tr(tip), _text(getattr(before, key)), _text(getattr(now, key)))
        for key, name, tip in FINDINGS
    ]
    if done is not None and done.holes:
        filled = f"{short_number(done.filled_area)} ({_percent(done.filled_share)})"
        rows.append(_Row(tr("Filled [µm²]"), tr("Area of the triangles that close holes"), "", filled))
    if done is not None and done.dropped_bodies:
        share = _percent(1.0 - done.kept_volume_share)
        rows.append(_Row(tr("Left out"), tr("Share of the volume in bodies that were left out"), "", share))
    seen = entry.visibility
    hidden = ("", "") if seen is None else (seen.hidden_surface_share, seen.unrepresentable_volume_share)
    about = tr("Hidden from the star point, so that no radius function can represent it")
    names = (tr("Hidden surface"), tr("Hidden volume"))
    rows += [
        _Row(name, about, "", _percent(share) if isinstance(share, float) else DASH)
        for name, share in zip(names, hidden, strict=True)
    ]
    return tuple(rows)


def _text(value: object) -> str:
    match value:
        case bool():
            return tr("yes") if value else tr("no")
        case int():
            return number_text(value, ",")
        case float():
            return short_number(value)
    return DASH


def _percent(share: float) -> str:
    if share == 0.0:
        return "0 %"
    return localized("< 0.01 %" if 0.0 < share < 1e-4 else f"{100 * share:.2g} %")


def _words(entry: ParticleEntry) -> str:
    return "\n".join(f"• {sentence}" for sentence in translated_health(entry))
