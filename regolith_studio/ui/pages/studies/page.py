"""Fig. 3 and Fig. 8 above, Fig. 7 below, each with its own start, progress and stop."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QTabWidget, QVBoxLayout, QWidget

from regolith_studio.jobs.events import Job, Progress, Started, Steps
from regolith_studio.session.outputs.studies import STUDIES
from regolith_studio.session.plan import STUDIES as KINDS
from regolith_studio.session.plan import Kind
from regolith_studio.session.solids import draw_solids
from regolith_studio.ui.layout import side_by_side, stacked
from regolith_studio.ui.page import PageContext, PageWidget
from regolith_studio.ui.pages.studies.gallery import COLUMNS, SolidGallery
from regolith_studio.ui.panels.coarsening_study import CoarseningStudyPanel
from regolith_studio.ui.panels.lmax_study import LmaxStudyPanel
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.widgets.labels import heading

TITLES = {
    Kind.LMAX_STUDY: "Error against l_max (Fig. 3)",
    Kind.COARSENING_STUDY: "Error for each loss function (Fig. 8)",
}


class StudiesPage(PageWidget):
    """Two studies and a gallery."""

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("studies")
        self._context, self._session = context, context.session
        self.lmax_study, self.coarsening_study = LmaxStudyPanel(), CoarseningStudyPanel()
        self.gallery = SolidGallery()
        self._place()
        self._wire(Kind.LMAX_STUDY, self.lmax_study)
        self._wire(Kind.COARSENING_STUDY, self.coarsening_study)
        self.gallery.frame.startRequested.connect(self.draw_gallery)
        self.gallery.frame.cancelRequested.connect(self._session.cancel)
        context.wiring.refresh("tasks", self._show_gallery_task, slow=True)
        context.wiring.refresh("particles", self._name_gallery_button)
        context.wiring.refresh("choices", self._show_l_max, slow=True)

    def set_theme(self, theme: Theme) -> None:
        for part in (self.lmax_study, self.coarsening_study, self.gallery):
            part.set_theme(theme)

    def commands(self) -> Mapping[str, Callable[..., object]]:
        return {"run_all": self.run_all, "save": self.save}

    def run_all(self) -> None:
        """Start both studies and the gallery."""
        for kind in KINDS:
            self._context.commands.start_study(kind)
        self.draw_gallery()

    def draw_gallery(self) -> None:
        """Coarsen the particle on screen and those after it once for each loss function."""
        entries = self._session.particles
        if not entries:
            self._context.toast.problem("No particle is open; open a mesh first.")
            return
        ids = [entry.id for entry in entries]
        first = ids.index(self._session.choices.selected) if self._session.choices.selected in ids else 0
        shown = [*entries[first:], *entries[:first]][:COLUMNS]
        self.gallery.begin([entry.id for entry in shown])
        job = Job(draw_solids, (tuple(entry.particle for entry in shown), self._session.choices.order))
        show = self.gallery.show_solids
        self._context.start("Coarsening for the gallery", job, show, partial=show, lane="gallery")

    def save(self) -> None:
        """Ask for a folder and write tables and figures of the studies that are there."""
        done = {kind: getattr(self._session.results, kind.value) for kind in KINDS}
        done = {kind: study for kind, study in done.items() if study is not None}
        if not done:
            self._context.toast.problem("Compute a study first.")
            return
        start = str(self._context.recall("folder", str(Path.home())))
        name = QFileDialog.getExistingDirectory(self, "Folder of figures and tables", start)
        if not name:
            return
        self._context.remember("folder", name)
        job = Job(write_studies, (tuple((kind.value, study) for kind, study in done.items()), Path(name)))
        self._context.start("Writing figures", job, self._tell_written, lane="save")

    def _tell_written(self, paths: tuple[Path, ...]) -> None:
        listed = "\n".join(str(path) for path in paths)
        self._context.toast.note(f"{len(paths)} files were written to {paths[0].parent}.", listed)

    def _wire(self, kind: Kind, panel: LmaxStudyPanel | CoarseningStudyPanel) -> None:
        session, wiring = self._session, self._context.wiring

        def show() -> None:
            panel.show_study(getattr(session.results, kind.value), kind.value in session.results.outdated)

        def tasks() -> None:
            panel.frame.show_task(next((task for task in session.tasks if task.lane == kind), None))

        panel.frame.startRequested.connect(partial(self._context.commands.start_study, kind))
        panel.frame.cancelRequested.connect(session.cancel)
        wiring.refresh(kind.value, show, slow=True)
        wiring.refresh("tasks", tasks, slow=True)
        wiring.refresh("particles", lambda: panel.frame.set_count(len(session.particles)))

    def _show_l_max(self) -> None:
        self.lmax_study.show_l_max(self._session.choices.l_max)

    def _show_gallery_task(self) -> None:
        mine = [task for task in self._session.tasks if task.lane == f"{self._context.key}:gallery"]
        self.gallery.frame.show_task(mine[0] if mine else None)

    def _name_gallery_button(self) -> None:
        count = len(self._session.particles)
        self.gallery.frame.set_count(count)
        self.gallery.frame.start.setText(f"Draw the polyhedra of {min(count, COLUMNS)} particles")

    def _place(self) -> None:
        above = side_by_side(
            [
                _titled(TITLES[Kind.LMAX_STUDY], self.lmax_study),
                _titled(TITLES[Kind.COARSENING_STUDY], self.coarsening_study),
            ],
            [700, 700],
            stretch=0,
        )
        above.setObjectName("studies_figures")
        below = _titled("What the polyhedra look like (Fig. 7)", self.gallery)
        rows = stacked([above, below], [380, 480], stretch=1)
        rows.setObjectName("studies_rows")
        layout = QHBoxLayout(self)
        layout.setContentsMargins(10, 10, 10, 8)
        layout.addWidget(rows)


def write_studies(studies: tuple[tuple[str, object], ...], folder: Path) -> Steps:
    """Write tables and figures; returns their paths. A job."""
    yield Started("Writing figures", len(studies))
    written: tuple[Path, ...] = ()
    for number, (kind, study) in enumerate(studies, start=1):
        written += tuple(STUDIES[kind].write(study, folder))
        yield Progress(number, len(studies), STUDIES[kind].title)
    return written


def _titled(title: str, part: QWidget) -> QWidget:
    frame = QWidget()
    column = QVBoxLayout(frame)
    column.setContentsMargins(0, 0, 0, 0)
    column.addWidget(heading(title))
    box = QTabWidget()  # for its border and ground
    box.tabBar().hide()
    for bare in (box, box.tabBar()):
        bare.setFocusPolicy(Qt.FocusPolicy.NoFocus)  # a hidden bar would hold Tab back
    box.addTab(part, "")
    column.addWidget(box, 1)
    return frame
