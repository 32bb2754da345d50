"""Page "Sample": table with filter, statistics and health, view of the particle, scatter plot."""

import html
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QApplication,
    QCheckBox,
    QFileDialog,
    QHeaderView,
    QLabel,
    QLineEdit,
    QScrollArea,
    QSizePolicy,
    QTableWidget,
    QTableWidgetItem,
    QWidget,
)

from regolith_studio.errors import RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.mesh_health import MeshHealth
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.tables import csv_text
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.particle_jobs import find_faults
from regolith_studio.messages import N_
from regolith_studio.scene import overlays, surfaces
from regolith_studio.scene.overlays import FAULT_COLOURS
from regolith_studio.session.choices import PARTICLE_CHOICES
from regolith_studio.session.results import ParticleEntry
from regolith_studio.session.sample_table import filter_of, health_sentences, sample_table
from regolith_studio.ui.layout import STRETCH, FoldingSplitter, equal_parts, hbox, named, stacked, tabs, vbox
from regolith_studio.ui.page import PageContext, PageWidget
from regolith_studio.ui.pages.sample.plots import MatchPanel, ScatterPanel, StatisticsPanel
from regolith_studio.ui.translation import localized, number_text, rich, tr, translate, with_decimal_point
from regolith_studio.ui.views.image_view import make_view
from regolith_studio.ui.views.view import CameraLink, ViewFrame
from regolith_studio.ui.widgets.labels import FixedHeightText, WrappedLabel, heading, hint_label, short_number
from regolith_studio.ui.widgets.table import FORM_WORDS, HEALTH_WORDS, ParticleTable, particle_columns
from regolith_studio.ui.widgets.text_table import FontRowHeight

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
        self.words = named(WrappedLabel(), "health_words")
        self.words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.where = named(
            QCheckBox(tr("Show in the view")),
            "health_where",
            tip=tr("Colours the faults in the picture, as they were before the mesh was repaired"),
        )
        self.where.setChecked(True)
        self.legend = named(QLabel(), "health_legend")
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
        table = named(QTableWidget(0, 3), spoken=tr("Health of the mesh"))
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

    def minimumSizeHint(self) -> QSize:
        """As narrow as two tables: the texts beside the table take half of what there is."""
        return QSize(2 * self.table.minimumSizeHint().width(), super().minimumSizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        words, bar = self._right.minimumSizeHint(), self._scrolled.verticalScrollBar().sizeHint()
        self._scrolled.setMinimumWidth(min(words.width() + bar.width(), self.width() // 2))

    def _place(self) -> None:
        right = self._right = QWidget()
        vbox(self.where, self.legend, self.words, STRETCH, parent=right, margins=(8, 4, 4, 4))
        scrolled = self._scrolled = QScrollArea()
        scrolled.setWidgetResizable(True)
        scrolled.setProperty("role", "texts")
        scrolled.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scrolled.setWidget(right)
        for ground in (scrolled.viewport(), right):
            ground.setAutoFillBackground(False)  # that of the tab is seen
        hbox((self.table, 3), (scrolled, 2), parent=self)


def _legend_entry(kind: str, count: int) -> str:
    mark = f'<span style="color:{FAULT_COLOURS[kind]}">&#9632;</span>&nbsp;'
    return mark + html.escape(_counted(kind, count))


def _counted(kind: str, count: int) -> str:
    return f"{tr(KINDS[kind])} ({number_text(count, ',')})"


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


class SamplePage(PageWidget):
    """Connects the selections of table, plot and view."""

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("sample")
        self._context, self._session = context, context.session
        self.title = heading(tr("Sample"))
        self.filter = QLineEdit()
        self._shown: Mesh | None = None
        self._reported: ParticleEntry | None = None
        self._faults: dict[str, FloatArray] = {}

    def build(self) -> None:
        bindings = self._context.bindings
        self.filter.setObjectName("sample_filter")
        self.filter.setAccessibleName(tr("Filter of the table"))
        self.filter.setPlaceholderText(tr("Filter: words and comparisons, such as  flat S<0.8 AR>1.5"))
        self.filter.setClearButtonEnabled(True)
        self._problem = ""
        self.assessment = hint_label(role="warning")
        self.assessment.hide()
        self.table = named(ParticleTable(particle_columns()), "sample_table", tr("All particles"))
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.statistics = StatisticsPanel()
        self.scatter, self.match = ScatterPanel(), MatchPanel(self._context)
        self.health = HealthPanel()
        self.frame = ViewFrame(make_view(self._context.views), "sample_view", colour="particle")
        self._camera = CameraLink([self.frame.view])
        self._place()
        self._connect()
        bindings.refresh("particles", self._show_particles, slow=True, keeps_particles=True)
        bindings.refresh("choices", self._show_current, PARTICLE_CHOICES)

    def commands(self) -> Mapping[str, Callable[..., object]]:
        return {
            "export_table": self.export_table,
            "copy_table": self.copy_table,
            "explore": lambda: self._context.go("explore"),
            "keep": self.keep_selected_particles,
            "match": self.match_materials,
            "clear_filter": self.filter.clear,
        }

    def state(self) -> dict[str, Any]:
        axes, statistics = list(self.scatter.axes()), self.statistics.choices()
        return {"filter": self.filter.text(), "axes": axes, "statistics": statistics}

    def restore(self, state: Mapping[str, Any]) -> None:
        self.filter.setText(str(state.get("filter", "")))
        axes = state.get("axes")
        if isinstance(axes, list) and len(axes) == 2:
            self.scatter.set_axes(str(axes[0]), str(axes[1]))
        if isinstance(statistics := state.get("statistics"), Mapping):
            self.statistics.choose(statistics)

    def on_close(self) -> None:
        self.frame.view.release()

    def export_table(self) -> None:
        """Ask for a file and write the visible rows, every descriptor with its unit."""
        start = str(Path.home() / "particles.csv")
        name, _ = QFileDialog.getSaveFileName(self, tr("Export table"), start, tr("Tables (*.csv)"))
        if not name:
            return
        entries = self.table.particles.rows
        with self._context.toast.reporting():
            write_bytes(Path(name), csv_text(sample_table(entries)).encode("utf-8"))
            self._context.toast.note(tr("{count} particles are in {name}.", count=len(entries), name=name))

    def copy_table(self) -> None:
        """Copy the visible rows to the clipboard, separated by tabs."""
        text = csv_text(sample_table(self.table.particles.rows), separator="\t")
        QApplication.clipboard().setText(text)
        self._context.toast.note(tr("The table is on the clipboard."))

    def keep_selected_particles(self) -> None:
        chosen = set(self.table.chosen())
        if not any(entry.id in chosen for entry in self._session.particles):
            self._context.toast.problem(tr("Choose the rows to keep first."))
            return
        self._session.keep(chosen)

    def match_materials(self) -> None:
        """Show the comparison with other materials, and ask for them."""
        self.plots.setCurrentWidget(self.match)
        self.match.ask_files()

    def _place(self) -> None:
        left = QWidget()
        column = vbox(
            self.title,
            self.filter,
            FixedHeightText((self.assessment,), 1),
            parent=left,
            margins=(10, 10, 2, 8),
        )
        self.reports = tabs(
            "sample_tabs", [(self.statistics, tr("Statistics")), (self.health, tr("Health of the mesh"))]
        )
        self.reports.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Preferred)
        self.reports.setMinimumHeight(0)  # figures and sentence of the statistics are whole
        parts = stacked([self.table, self.reports], [490, 300], stretch=0)
        parts.setObjectName("sample_rows")
        column.addWidget(parts, 1)
        plots = [
            (self.statistics.distribution, tr("Distribution")),
            (self.scatter, tr("Scatter plot")),
            (self.match, tr("Match")),
        ]
        self.plots = tabs("sample_plots", plots)
        right = equal_parts(Qt.Orientation.Vertical, [self.frame, self.plots])
        right.setObjectName("sample_pictures")
        right.setContentsMargins(2, 10, 10, 8)
        columns = FoldingSplitter(left, right, (1150, 600))
        columns.setObjectName("sample_columns")
        hbox(columns, parent=self)

    def _connect(self) -> None:
        self.filter.textChanged.connect(self._filter)
        self.table.chosenChanged.connect(lambda _ids: self._show_pictures())
        self.table.currentChosen.connect(self._select)
        self.table.horizontalHeader().sortIndicatorChanged.connect(self._show_column)
        self.table.doubleClicked.connect(lambda _index: self._context.go("explore"))
        self.scatter.pointChosen.connect(self._choose_point)
        self.health.showChanged.connect(lambda _on: self._draw_faults())

    def _show_column(self, column: int, _order: Qt.SortOrder) -> None:
        """Show the distribution of the column by which the table is sorted."""
        self.statistics.choose({"key": self.table.particles.columns[column].key})

    def _filter(self, text: str) -> None:
        keeps, self._problem = None, ""
        try:
            keeps = filter_of(in_english(with_decimal_point(text))) if text.strip() else None
        except RegolithError as error:
            self._problem = tr("{problem} All particles are shown.", problem=translate(str(error)))
        self._assess()
        self.table.set_filter(keeps)
        self._count()

    def _show_particles(self) -> None:
        self.table.set_entries(self._session.particles)
        self._assess()
        self._count()
        self._show_pictures()
        self._show_current()

    def _assess(self) -> None:
        """Say what is wrong with the filter, or what was not opened."""
        words = self._problem or " ".join(translate(each) for each in self._session.left_out)
        self.assessment.setText(words)
        self.assessment.setVisible(bool(words))

    def _count(self) -> None:
        seen, total = len(self.table.particles.rows), len(self._session.particles)
        self.title.setText(
            tr("Sample ({total})", total=total)
            if seen == total
            else tr("Sample ({seen} of {total})", seen=seen, total=total)
        )

    def _show_pictures(self) -> None:
        seen = self.table.particles.rows
        chosen = self.table.chosen()
        self.scatter.show_entries(seen, chosen)
        several = [entry for entry in seen if entry.id in set(chosen)]
        self.statistics.show_entries(several if len(several) > 1 else seen)

    def _show_current(self) -> None:
        entry = self._session.selected
        if entry is None:
            return
        chosen = self.table.chosen()
        if entry.id not in chosen:
            self.table.choose([entry.id], entry.id)
            self._show_pictures()
        mesh = entry.particle.mesh
        if mesh is not self._shown:
            self._shown = mesh
            self._faults = {}
            self.frame.view.draw(self._draw_particle)
            self._camera.frame(mesh.vertices)
        self.frame.set_texts(rich(entry.id), self._detail(mesh))
        if entry is not self._reported:
            self._reported = entry
            self.health.show_entry(entry)
            if entry.health is None:
                return
            job = Job(find_faults, (entry.particle, entry.visibility))
            self._context.start(tr("Checking the mesh"), job, self._take_faults, queue="faults", repeats=True)

    def _take_faults(self, found: dict[str, FloatArray]) -> None:
        self._faults = found
        self.health.show_legend({kind: len(triangles) for kind, triangles in found.items()})
        self._draw_faults()

    def _draw_faults(self) -> None:
        self.frame.view.draw(self._draw_particle)
        if self._shown is not None:
            self.frame.set_detail(self._detail(self._shown))

    def _draw_particle(self, plotter: Any) -> None:
        if self._shown is not None:
            surfaces.show_particle(plotter, self._shown)
        overlays.show_faults(plotter, self._marked)

    @property
    def _marked(self) -> dict[str, FloatArray]:
        """Triangles that the view colours, by their kind of fault."""
        return self._faults if self.health.where.isChecked() else {}

    def _detail(self, mesh: Mesh) -> str:
        """The quiet line of the view: its triangles, and what the colours on them mean."""
        marked = [_counted(kind, len(found)) for kind, found in self._marked.items() if len(found)]
        return " · ".join([tr("{count:,} triangles", count=len(mesh.faces)), *marked])

    def _select(self, name: str) -> None:
        if any(entry.id == name for entry in self._session.particles):
            self._session.select(name)

    def _choose_point(self, name: str, adding: bool) -> None:
        self.table.choose([*self.table.chosen(), name] if adding else [name], name)
        self._show_pictures()
        self._select(name)


def in_english(text: str) -> str:
    """A filter with its translated words of form and health replaced by the English ones."""
    known = {tr(word).lower(): word for word in (*HEALTH_WORDS, *FORM_WORDS)}
    return " ".join(known.get(word.lower(), word) for word in text.split())
