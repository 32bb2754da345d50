"""Page "Sample": table with filter and statistics, view of the particle, scatter plot."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QAbstractItemView,
    QApplication,
    QFileDialog,
    QHBoxLayout,
    QLineEdit,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.errors import RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.tables import csv_text
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.particle_jobs import find_faults
from regolith_studio.scene import overlays, surfaces
from regolith_studio.session.choices import PARTICLE_CHOICES
from regolith_studio.session.results import ParticleEntry
from regolith_studio.session.sample_table import filter_of, sample_table
from regolith_studio.ui.layout import equal_parts, side_by_side, stacked, tabs
from regolith_studio.ui.page import PageContext, PageWidget
from regolith_studio.ui.pages.sample.health import HealthPanel
from regolith_studio.ui.pages.sample.plots import ScatterPanel, StatisticsPanel
from regolith_studio.ui.theme import current_theme
from regolith_studio.ui.translation import rich, tr, translate, with_decimal_point
from regolith_studio.ui.views.factory import make_view
from regolith_studio.ui.views.view import CameraLink
from regolith_studio.ui.views.view_frame import ViewFrame
from regolith_studio.ui.widgets.labels import FixedHeightText, heading, hint_label
from regolith_studio.ui.widgets.table import FORM_WORDS, HEALTH_WORDS, ParticleTable, particle_columns


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
        self.assessment = hint_label(role="warning")
        self.assessment.hide()
        self.table = ParticleTable(particle_columns())
        self.table.setObjectName("sample_table")
        self.table.setAccessibleName(tr("All particles"))
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.statistics = StatisticsPanel()
        self.scatter = ScatterPanel()
        self.health = HealthPanel()
        self.frame = ViewFrame(
            make_view(self._context.views, current_theme().surroundings), "sample_view", colour="particle"
        )
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
        try:
            write_bytes(Path(name), csv_text(sample_table(entries)).encode("utf-8"))
        except RegolithError as error:
            self._context.toast.problem(str(error))
            return
        self._context.toast.note(tr("{count} particles are in {name}.", count=len(entries), name=name))

    def copy_table(self) -> None:
        """Copy the visible rows to the clipboard, separated by tabs."""
        text = csv_text(sample_table(self.table.particles.rows), separator="\t")
        QApplication.clipboard().setText(text)
        self._context.toast.note(tr("The table is on the clipboard."))

    def keep_selected_particles(self) -> None:
        """Close all particles but the selected ones."""
        chosen = set(self.table.chosen())
        if not any(entry.id in chosen for entry in self._session.particles):
            self._context.toast.problem(tr("Choose the rows to keep first."))
            return
        self._session.keep(chosen)

    def _place(self) -> None:
        left = QWidget()
        column = QVBoxLayout(left)
        column.setContentsMargins(10, 10, 2, 8)
        for widget in (self.title, self.filter, FixedHeightText((self.assessment,), 1)):
            column.addWidget(widget)
        self.reports = tabs(
            "sample_tabs", [(self.statistics, tr("Statistics")), (self.health, tr("Health of the mesh"))]
        )
        parts = stacked([self.table, self.reports], [490, 300], stretch=0)
        parts.setObjectName("sample_rows")
        column.addWidget(parts, 1)
        plots = [(self.statistics.distribution, tr("Distribution")), (self.scatter, tr("Scatter plot"))]
        self.plots = tabs("sample_plots", plots)
        right = equal_parts(Qt.Orientation.Vertical, [self.frame, self.plots])
        right.setObjectName("sample_pictures")
        right.setContentsMargins(2, 10, 10, 8)
        columns = side_by_side([left, right], [1150, 600], stretch=0)
        columns.setObjectName("sample_columns")
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(columns)

    def _connect(self) -> None:
        self.filter.textChanged.connect(self._filter)
        self.table.chosenChanged.connect(lambda _ids: self._show_pictures())
        self.table.currentChosen.connect(self._select)
        self.table.horizontalHeader().sectionClicked.connect(self._show_column)
        self.table.doubleClicked.connect(lambda _index: self._context.go("explore"))
        self.scatter.pointChosen.connect(self._choose_point)
        self.health.showChanged.connect(lambda _on: self._draw_faults())

    def _show_column(self, column: int) -> None:
        """Show the distribution of the column that was clicked."""
        self.statistics.choose({"key": self.table.particles.columns[column].key})

    def _filter(self, text: str) -> None:
        try:
            keeps = filter_of(in_english(with_decimal_point(text))) if text.strip() else None
        except RegolithError as error:
            self.assessment.setText(tr("{problem} All particles are shown.", problem=translate(str(error))))
            keeps = None
            self.assessment.show()
        else:
            self.assessment.hide()
        self.table.set_filter(keeps)
        self._count()

    def _show_particles(self) -> None:
        self.table.set_entries(self._session.particles)
        self._count()
        self._show_pictures()
        self._show_current()

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
        title = f"{tr(entry.particle.title)}, {rich(entry.id)}"
        self.frame.set_texts(title, tr("{count:,} triangles", count=len(mesh.faces)))
        if mesh is not self._shown:
            self._shown = mesh
            self._faults = {}
            self.frame.view.draw(self._draw_particle)
            self._camera.frame(mesh.vertices)
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

    def _draw_particle(self, plotter: Any) -> None:
        if self._shown is not None:
            surfaces.show_particle(plotter, self._shown)
        overlays.show_faults(plotter, self._faults if self.health.where.isChecked() else {})

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
