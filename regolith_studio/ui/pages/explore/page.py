"""Page "Explore": particle list, three views with plots below, controls, and the dialog of pictures."""

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, QPoint, Qt, QTimer, Signal
from PySide6.QtGui import QImage
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QMainWindow,
    QMenu,
    QWidget,
)

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.progress import CoarseningProgress
from regolith_studio.errors import FileError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.file_names import file_stem
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.particle_jobs import FitRequest, check_fit, may_be_far
from regolith_studio.jobs.study_jobs import study_coarsening
from regolith_studio.messages import N_, join_messages
from regolith_studio.scene.animation import animate, draw_figure
from regolith_studio.scene.cameras import DIRECTIONS
from regolith_studio.scene.figure import view_titles
from regolith_studio.scene.shapes import FIT
from regolith_studio.session.assessment import redundant_planes
from regolith_studio.session.choices import PARTICLE_CHOICES, Choices
from regolith_studio.session.results import ParticleEntry, Results
from regolith_studio.session.study_requests import varied_rows
from regolith_studio.studies.coarsening import CoarseningStudy
from regolith_studio.studies.sweeps import GAIN, SWEEPS, sufficient_facets
from regolith_studio.ui.layout import (
    FoldingSplitter,
    dialog_buttons,
    hbox,
    named,
    padded,
    scrolled_column,
    side_by_side,
    stacked,
    vbox,
)
from regolith_studio.ui.page import PageContext, PageWidget
from regolith_studio.ui.pages.explore.panels import (
    AssessmentPanel,
    CoarseningPanel,
    FitPanel,
    LossPanel,
    OutcomeNote,
)
from regolith_studio.ui.pages.explore.plots import PlotArea
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.views.three_views import ThreeViews
from regolith_studio.ui.widgets.fields import ChoiceBox, whole_field
from regolith_studio.ui.widgets.labels import heading, hint_label
from regolith_studio.ui.widgets.plots.base import png_of_image
from regolith_studio.ui.widgets.table import ParticleTable, particle_columns

MAX_SCALE = 6
SCREENSHOT, FIGURE = "screenshot", "figure"
KINDS = {
    SCREENSHOT: N_("The views as they are seen"),
    FIGURE: N_("A figure on white, 1860 × 560 times the scale"),
}
ANIMATION_FILTERS = ("GIF (*.gif)", "WebP (*.webp)", N_("Sequence of PNG files (*.png)"))
SUFFIXES = (".gif", ".webp", ".png")
SAVED = {
    "figure": N_("The picture is in {path}."),
    "animation": N_("The animation is in {path}."),
}


class PictureExport(QObject):
    """Asks for a file and saves views or an animation.

    ``context``: of the page. ``three_views``: the views.
    """

    def __init__(self, context: PageContext, three_views: ThreeViews, parent: QWidget) -> None:
        super().__init__(parent)
        self._context, self._three_views, self._window = context, three_views, parent
        self._kind = ""

    def save_picture(self) -> None:
        """Ask for kind, scale and file, and write the three views."""
        results, entry = self._context.session.results, self._context.session.selected
        if entry is None or results.surface is None or results.coarsened is None:
            self._context.toast.problem(tr("Wait until the three views are drawn."))
            return
        dialog = PictureDialog(self._window)
        accepted = dialog.exec() == QDialog.DialogCode.Accepted
        kind, scale, transparent = dialog.value()
        dialog.deleteLater()
        kinds = tr("Pictures (*.png)")
        name = self._ask(tr("Save picture"), f"{file_stem(entry.id)}.png", kinds) if accepted else ""
        if not name:
            return
        path = Path(name).with_suffix(".png")
        if kind == SCREENSHOT:
            self._write(self._three_views.snapshot(scale, transparent), path)
            return
        titles = view_titles(entry.particle.name, results.surface_l_max, results.coarsened)
        pose = self._three_views.views["particle"].pose
        surfaces = (entry.particle.mesh, results.surface, results.coarsened)
        job = Job(draw_figure, (*surfaces, titles, path, scale, pose, transparent))
        self._context.start(tr("Drawing the figure"), job, self._saved_note("figure", path))

    def save_animation(self) -> None:
        """Ask for a file and save an animation of the fit from degree 0 on, in the background."""
        fit, entry = self._context.session.results.fit, self._context.session.selected
        if entry is None or fit is None:
            self._context.toast.problem(tr("Wait until the particle is fitted."))
            return
        name, suffix = self._ask_animation(tr("Save animation"), file_stem(entry.id))
        if name:
            path = Path(name).with_suffix(suffix)
            job = Job(animate, (entry.particle.mesh, fit, tuple(range(fit.l_max + 1)), path))
            title = tr("Drawing the animation")
            self._context.start(title, job, self._saved_note("animation", path), queue="animation")

    def _saved_note(self, what: str, path: Path) -> Callable[[object], None]:
        first = path.with_name(f"{path.stem}-000.png") if path.suffix == ".png" and what != "figure" else path
        return lambda _: self._context.toast.note(tr(SAVED[what], path=first))

    def _write(self, picture: QImage, path: Path) -> None:
        try:
            write_bytes(path, png_of_image(picture))
        except FileError as error:
            self._context.toast.problem(str(error))
        else:
            self._context.toast.note(tr(SAVED["figure"], path=path))

    def _ask_animation(self, title: str, name: str) -> tuple[str, str]:
        kinds = [tr(kind) for kind in ANIMATION_FILTERS]
        chosen = self._ask(title, f"{name}{SUFFIXES[0]}", ";;".join(kinds))
        return chosen, _suffix(chosen, kinds.index(self._kind) if self._kind in kinds else 0)

    def _ask(self, title: str, name: str, kinds: str) -> str:
        start = str(Path(str(self._context.recall("pictures", Path.home()))) / name)
        chosen, self._kind = QFileDialog.getSaveFileName(self._window, title, start, kinds)
        if chosen:
            self._context.remember("pictures", str(Path(chosen).parent))
        return chosen


def _suffix(name: str, kind: int) -> str:
    """The suffix that was typed or, if it is the suggested one, that of the selected filter."""
    typed = Path(name).suffix.lower()
    return typed if typed in SUFFIXES[1:] else SUFFIXES[kind]


class PictureDialog(QDialog):
    """Asks for the kind of picture, its scale, and whether the background is transparent."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Save picture"))
        self.setObjectName("picture_dialog")
        self.kind = ChoiceBox("picture_kind", tr("Kind of picture"), KINDS)
        self.kind.setMinimumContentsLength(30)
        self.scale = whole_field("picture_scale", tr("Scale of the picture"), 1, MAX_SCALE, 2)
        self.transparent = named(QCheckBox(tr("Transparent background")), "picture_transparent")
        form = QFormLayout(self)
        form.addRow(tr("Picture"), self.kind)
        form.addRow(tr("Scale"), self.scale)
        form.addRow("", self.transparent)
        form.addRow(dialog_buttons(self, QDialogButtonBox.StandardButton.Save))

    def value(self) -> tuple[str, int, bool]:
        """Kind of picture, scale, and whether the background is transparent."""
        return self.kind.value(), self.scale.value(), self.transparent.isChecked()


COLUMNS = ("name", "group", "volume", "sphericity", "aspect_ratio")


def _title(entries: Sequence[ParticleEntry]) -> str:
    if not entries:
        return tr("Particles")
    if all(entry.particle.is_synthetic for entry in entries):
        return tr("Synthetic particles ({count})", count=len(entries))
    return tr("Particles ({count})", count=len(entries))


class ParticleListPanel(QWidget):
    """Selects the current particle."""

    FIELDS = ("selected",)
    valueChanged = Signal(dict)  # noqa: N815
    editingFinished = Signal()  # noqa: N815
    unitRequested = Signal(str)  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("particle_list")
        table = ParticleTable(particle_columns(*COLUMNS), scrolls=False)
        self.table = named(table, "particle_table", spoken=tr("Particles"))
        self.table.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.table.customContextMenuRequested.connect(self._show_menu)
        self.table.currentChosen.connect(self._choose)
        self._selected = ""
        self.title = heading(tr("Particles"))
        self.hint = hint_label(tr("Drop mesh files or folders anywhere in the window to open them."))
        vbox(self.title, (self.table, 1), self.hint, parent=self)

    def value(self) -> dict[str, str]:
        return {"selected": self._selected}

    def setValue(self, value: Mapping[str, Any]) -> None:
        self._selected = value["selected"]
        self._mark()

    def entries(self) -> tuple[ParticleEntry, ...]:
        return self.table.particles.entries

    def set_entries(self, entries: Sequence[ParticleEntry]) -> None:
        """List other particles, or the same ones with new data."""
        if tuple(entries) != self.entries():
            self.table.set_entries(entries)
            self._mark()
            self.title.setText(_title(entries))

    def _show_menu(self, place: QPoint) -> None:
        index = self.table.indexAt(place)
        if not index.isValid():
            return
        name = self.table.particles.rows[index.row()].id
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.addAction(tr("Change length unit …"), lambda: self.unitRequested.emit(name))
        menu.popup(self.table.viewport().mapToGlobal(place))

    def _mark(self) -> None:
        if any(entry.id == self._selected for entry in self.entries()):
            self.table.choose([self._selected], self._selected)

    def _choose(self, name: str) -> None:
        self._selected = name
        self.valueChanged.emit(self.value())
        self.editingFinished.emit()


INTERVAL = 40
"""Milliseconds between two steps."""
FRAMES = 40
"""About as many steps are shown of those that wait, so that a long run is shown in two seconds too."""
REPLAYED = ("annealing",)
"""Methods whose steps are worth watching; the others come to their result in few."""


class RunReplay(QObject):
    """Collects the steps of a run and emits them at a steady pace."""

    shown = Signal(object)
    """A :class:`CoarseningProgress` with its polyhedron."""
    ended = Signal()
    """All steps that there are have been shown."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._waiting: deque[CoarseningProgress] = deque()
        self._last: CoarseningProgress | None = None
        self._timer = QTimer(self, interval=INTERVAL)
        self._timer.timeout.connect(self._show_next)

    @property
    def playing(self) -> bool:
        return self._timer.isActive()

    def follow(self, results: Results, method: str) -> None:
        """Take the newest steps of the results; forget the others where another run has begun."""
        newest = results.coarsening_progress
        if newest is None or method not in REPLAYED:
            self.stop()
            return
        for step in newest.recent:
            if self._last is None or step.step > self._last.step:
                self._add(step)
        if self._waiting and not self.playing:
            self._timer.start()
            self._show_next()

    def stop(self) -> None:
        self._waiting.clear()
        self._last = None
        self._timer.stop()

    def _add(self, step: CoarseningProgress) -> None:
        if step.polyhedron is None and self._last is not None:
            step = replace(step, polyhedron=self._last.polyhedron)
        self._last = step
        self._waiting.append(step)

    def _show_next(self) -> None:
        if self._waiting:
            for _ in range(len(self._waiting) // FRAMES):
                self._waiting.popleft()
            self.shown.emit(self._waiting.popleft())
        else:
            self._timer.stop()
            self.ended.emit()


QUEUE = "facets"


class FacetSearch(QObject):
    """Coarsens the particle at several numbers of facets, and offers the one that is enough.

    ``context``: of the page. ``panel``: has the button; shows the answer.
    """

    def __init__(self, context: PageContext, panel: CoarseningPanel, parent: QObject) -> None:
        super().__init__(parent)
        self._context, self._session, self._panel = context, context.session, panel
        self._found: tuple[Choices, int, bool] | None = None
        panel.searchRequested.connect(self.start)
        context.bindings.refresh("choices particles coarsening tasks", self._show)

    def start(self) -> None:
        particle, choices = self._session.selected, self._session.choices
        if particle is None:
            self._context.toast.problem(tr("No particle is open; open a mesh first."))
            return
        sweep = SWEEPS["facets"]
        rows = varied_rows("facets", choices, ", ".join(f"{value:g}" for value in sweep.values))
        options = {"rows": rows, "box_metric": choices.box_metric}
        job = Job(study_coarsening, ((particle.particle,), choices.coarsening_request), options)
        self._context.start(
            tr("Searching for the sufficient number of facets"),
            job,
            lambda study: self._take(choices, study),
            queue=QUEUE,
        )

    def _take(self, choices: Choices, study: CoarseningStudy) -> None:
        if study.names:
            enough = sufficient_facets(study)
            self._found = choices, enough, enough < max(row.n_facets for row in study.rows)
        self._show()

    def _show(self) -> None:
        """Show the answer while it belongs to the present choices."""
        choices, results = self._session.choices, self._session.results
        running = any(task.queue == f"{self._context.key}:{QUEUE}" for task in self._session.tasks)
        if self._found is not None and replace(self._found[0], n_facets=choices.n_facets) != choices:
            self._found = None
        if self._found is not None:
            _, enough, saturated = self._found
            why = (
                tr("With more facets no error falls by more than {gain:.1%}.", gain=GAIN) if saturated else ""
            )
            self._panel.show_sufficient(enough, saturated=saturated, now=choices.facet_count, reason=why)
        elif results.fewer_facets is not None:
            count, why = results.fewer_facets[0], tr("With these facets the loss was no larger.")
            self._panel.show_sufficient(count, saturated=True, now=choices.facet_count, reason=why)
        else:
            self._panel.show_search(running=running)


LIST_WIDTH, CONTROLS_WIDTH = 300, 330
"""Initial widths of the particle list and of the controls in pixels; sliders have 150 then."""
PLOTS_HEIGHT, PLOTS_LINES = 300, 15
"""Initial height of the plots in pixels, and its minimum in lines of text."""


class ExplorePage(PageWidget):
    """Places panels and views and connects them with the session."""

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self._start, self._context = context.start, context
        self.setObjectName("explore")
        self._session, self._commands = context.session, context.commands
        self.particles, self.fit = ParticleListPanel(), FitPanel()
        self.coarsening, self.loss, self.outcome = CoarseningPanel(), LossPanel(), OutcomeNote()
        self.three_views = ThreeViews(context.views, self._measure_distances)
        self.plots = PlotArea(self.three_views)
        self.assessment = AssessmentPanel()
        self.three_views.hovered.connect(self._show_status)
        self.pictures = PictureExport(context, self.three_views, self)
        self.replay = RunReplay(self)
        self.facet_search = FacetSearch(context, self.coarsening, self)
        self._listed: list[str] = []
        self._place()
        self._wire(context)

    def _measure_distances(
        self, job: Job, show: Callable[[FloatArray], None], refuse: Callable[[str], None]
    ) -> None:
        self._start(
            tr("Measuring distances"),
            job,
            show,
            failed=lambda failure: refuse(translate(failure.sentence)),
            queue="distances",
            repeats=True,
            after_running=True,
        )

    def commands(self) -> Mapping[str, Callable[..., object]]:
        views = self.three_views
        return {
            **{f"look_{key}": partial(views.link.look_from, key) for key in DIRECTIONS},
            "link": views.link.set_linked,
            "reset": views.reset_cameras,
            "wireframe": views.set_wireframe,
            "heat": views.set_heat,
            **{name: partial(views.set_extra, name) for name in ("box", "star_point")},
            "overlay": lambda on: views.comparison.set_mode(overlay=on),
            "wipe": lambda on: views.comparison.set_mode(wipe=on),
            "section": self._set_section,
            "list": self._list.setVisible,
            "change_unit": lambda: self._commands.change_unit(self._session.choices.selected),
            "enlarge": views.enlarge_next,
            "save_picture": self.pictures.save_picture,
            "save_animation": self.pictures.save_animation,
        }

    def on_close(self) -> None:
        self.replay.stop()
        self.three_views.release()

    def _place(self) -> None:
        high_enough = max(PLOTS_HEIGHT, PLOTS_LINES * self.fontMetrics().height())
        below = QWidget()
        vbox(self.assessment, (self.plots, 1), parent=below)
        middle = stacked([self.three_views, below], [480, max(400, high_enough)], stretch=0)
        middle.setStretchFactor(1, 1)  # views wider than high would leave their sides empty
        middle.setObjectName("explore_rows")
        weights = QWidget()
        vbox(self.loss, self.outcome, parent=weights, spacing=0)
        controls = scrolled_column([self.fit, self.coarsening, weights])
        self._list = padded(self.particles, 10, 10, 2, 8)
        results = side_by_side([self._list, padded(middle, 2, 10, 2, 8)], [LIST_WIDTH, 800], stretch=1)
        for part, share in enumerate((1, 4)):
            results.setStretchFactor(part, share)
        results.setObjectName("explore_results")
        columns = FoldingSplitter(results, controls, (LIST_WIDTH + 800, CONTROLS_WIDTH))
        columns.setObjectName("explore_columns")
        hbox(columns, parent=self)

    def _wire(self, context: PageContext) -> None:
        session, bindings = context.session, context.bindings
        for panel in (self.particles, self.fit, self.coarsening, self.loss):
            bindings.edit(panel)
        bindings.refresh("particles", self._list_particles, keeps_particles=True)
        bindings.refresh(
            "particles choices", lambda: self.three_views.show_particle(session.selected), PARTICLE_CHOICES
        )
        bindings.refresh(
            "choices",
            lambda: self.loss.set_keeps_terms(METHODS[session.choices.method].keeps_terms),
            ("method",),
        )
        bindings.refresh("fit", self._show_star_point)
        bindings.refresh("fit choices", self._show_findings, ("l_max",), slow=True)
        bindings.refresh("descriptors", self._check_fit, slow=True)
        bindings.refresh("surface", self._show_fit)
        bindings.listen("coarsening", lambda: self.replay.follow(session.results, session.choices.method))
        self.replay.shown.connect(self._show_step)
        self.replay.ended.connect(self._show_coarsening)
        bindings.refresh("coarsening", self._show_coarsening)
        bindings.refresh(
            "coarsening comparison", lambda: self.assessment.show_results(session.results, session.choices)
        )
        self.particles.unitRequested.connect(context.commands.change_unit)
        self.plots.wire(session, bindings)

    def _list_particles(self) -> None:
        """Fill the list; it has the focus after others were opened, so that arrows choose among them."""
        entries, focus = self._session.particles, self.window().focusWidget()
        ids = [entry.id for entry in entries]
        opened, self._listed = ids != self._listed, ids
        self.particles.set_entries(entries)
        if opened and ids and focus is not None and self.isVisible():
            self.particles.table.setFocus(Qt.FocusReason.OtherFocusReason)

    def _set_section(self, shown: bool) -> None:
        self.three_views.sections.set_shown(shown)
        if shown:
            self.three_views.cut_across(self.three_views.sections.direction)
        self.plots.show_section(shown)

    def _show_status(self, words: str) -> None:
        window = self.window()
        if isinstance(window, QMainWindow):
            window.statusBar().showMessage(words)

    def _show_findings(self, check: str = "") -> None:
        fit = self._session.results.fit
        self.fit.set_findings(fit.truncated(self._session.choices.l_max) if fit else None, check)

    def _check_fit(self) -> None:
        """Find out which degree would do, where descriptors of the fit are far from the particle's."""
        results, choices, entry = self._session.results, self._session.choices, self._session.selected
        fit, known, found = results.fit, results.particle_descriptors, results.fit_descriptors
        if fit is None or entry is None or known is None or found is None:
            return
        if results.surface_l_max != choices.l_max or not may_be_far(known, found):
            self._context.stop("check_fit")
            return
        request = FitRequest(fit_options=choices.fit_options)
        self._start(
            tr("Checking the fit"),
            Job(check_fit, (entry.particle.mesh, fit.truncated(choices.l_max), request)),
            lambda said: self._show_findings(said) if self._session.choices is choices else None,
            failed=lambda _: None,
            queue="check_fit",
            repeats=True,
        )

    def _show_star_point(self) -> None:
        fit = self._session.results.fit
        self.three_views.show_star_point(fit.star_point if fit else None)

    def _show_fit(self) -> None:
        results = self._session.results
        if results.surface is None and (failure := results.failures.get("surface")):
            self.three_views.show_failure(FIT, failure)
        self.three_views.show_fit(results.surface, results.surface_l_max)

    def _show_step(self, step: CoarseningProgress) -> None:
        """Show one step of a run, and where it stands in the curve of the loss."""
        self.three_views.show_polyhedron(Results(best=step))
        self.three_views.show_step(step)
        self.plots.loss_curve.plot.set_marker(float(step.step))

    def _show_coarsening(self) -> None:
        results = self._session.results
        if not self.replay.playing:
            self.three_views.show_polyhedron(results)
            self.plots.loss_curve.plot.set_marker(None)
        coarse = results.coarsened
        notes = (coarse.reason or redundant_planes(coarse), coarse.warning) if coarse else ()
        said = [each for each in (*notes, results.failures.get("coarsening")) if each]
        self.outcome.set_sentence(join_messages(said) if said else None)
