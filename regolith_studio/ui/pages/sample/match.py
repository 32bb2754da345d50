"""Tab "Match" of the sample: how near other materials, and the best mixture of them, are to it."""

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QPixmap, QResizeEvent
from PySide6.QtWidgets import QFileDialog, QLabel, QListWidget, QPushButton, QWidget

from regolith_studio.jobs.events import Job
from regolith_studio.jobs.matching_jobs import DrawnMatch, MatchRequest, draw_match
from regolith_studio.messages import N_
from regolith_studio.readers.settings import UNITS
from regolith_studio.shape_models.materials import materials
from regolith_studio.studies.matching import MatchedPart
from regolith_studio.ui.dialogs.files import FolderDialog
from regolith_studio.ui.layout import control_row, named, side_by_side, stacked, vbox
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.result_card import ResultRecord, ResultView, RunController
from regolith_studio.ui.translation import number_text, tr
from regolith_studio.ui.widgets.fields import ElidedComboBox
from regolith_studio.ui.widgets.table import TextTable

FILTER = N_("Meshes and tables (*.stl *.ply *.obj *.zip *.csv *.tsv *.txt)")
HEADINGS = (N_("Material"), N_("Particles"), N_("In floors"), N_("g in 100 g"))


class MatchPanel(QWidget):
    """Candidates in a list, the card of the comparison with its button, a table and a picture."""

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("match")
        self._context = context
        self._found: DrawnMatch | None = None
        self._picture = QPixmap()
        self.card = ResultView(
            "match_card", (tr("Nearest"), tr("Mixture")), start=tr("Match"), again=tr("Match again"), lines=2
        )
        spoken = tr("Materials that are compared with the sample")
        self.candidates = named(QListWidget(), "match_candidates", spoken)
        self.cards = named(ElidedComboBox(), "match_cards", tr("Add a material card"))
        spoken = tr("Length unit of files without one")
        self.unit = named(ElidedComboBox(), "match_unit", spoken, spoken)
        self.table = TextTable("match_table", tr("Distances and masses"), [tr(each) for each in HEADINGS])
        self.picture = QLabel(alignment=Qt.AlignmentFlag.AlignCenter)
        self.picture.setMinimumSize(QSize(120, 60))
        self.picture.setAccessibleName(tr("Distances, masses of the mixture, and sizes"))
        self._place()
        self.run = RunController(context, self.card, "match", self.start)
        context.bindings.refresh("particles", lambda: self.run.set_outdated(True))

    @property
    def found(self) -> DrawnMatch | None:
        """The last comparison."""
        return self._found

    def names(self) -> list[str]:
        """Paths, or names of material cards."""
        return [self.candidates.item(row).text() for row in range(self.candidates.count())]

    def add(self, names: Sequence[str]) -> None:
        """Add candidates that the list does not hold yet."""
        self.candidates.addItems([name for name in names if name and name not in self.names()])
        self.card.set_startable("" if self.names() else tr("Add the materials to compare with first."))

    def ask_files(self) -> None:
        """Ask for files of meshes, archives and tables."""
        start = str(self._context.recall("folder", str(Path.home())))
        self.add(QFileDialog.getOpenFileNames(self, tr("Materials to compare with"), start, tr(FILTER))[0])

    def start(self) -> None:
        """Compare the open sample with the candidates."""
        sample = tuple(self._context.session.open_particles)
        request = MatchRequest(self.unit.currentText())
        self.run.start(tr("Match"), Job(draw_match, (sample, self.names(), request)), self._show)

    def save(self) -> None:
        """Ask for a folder and write table and picture."""
        if self._found is None:
            self._context.toast.problem(tr("Compare the sample with other materials first."))
            return
        start = str(self._context.recall("folder", str(Path.home())))
        if name := FolderDialog.ask(self, tr("Folder of table and picture"), start):
            self._context.remember("folder", name)
            self._context.start(tr("Saving"), Job(self._found.written, (Path(name),)), self._saved)

    def _saved(self, folder: Path) -> None:
        self._context.toast.note(tr("Table and picture are in {folder}.", folder=folder))

    def _show(self, found: DrawnMatch) -> ResultRecord:
        self._found = found
        match = found.match
        self.table.set_rows([_cells(part) for part in (*match.parts, match.mixture)], _tips(found))
        self._picture.loadFromData(found.picture)
        self._scale()
        for problem in found.problems:
            self._context.toast.problem(problem.with_path)
        values = tuple(_in_floors(part) for part in (match.nearest, match.mixture))
        note = tr("Distances in floors; 1 is the scatter of the sample itself.")
        return ResultRecord(values, match.nearest.name, note=note)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._scale()

    def _scale(self) -> None:
        if not self._picture.isNull():
            modes = Qt.AspectRatioMode.KeepAspectRatio, Qt.TransformationMode.SmoothTransformation
            self.picture.setPixmap(self._picture.scaled(self.picture.size(), *modes))

    def _place(self) -> None:
        self.cards.addItem(tr("Add a card"), "")
        for name, card in materials().items():
            self.cards.addItem(tr(card.label), name)
        self.cards.activated.connect(lambda _row: self.add([str(self.cards.currentData())]))
        self.unit.addItems([unit for unit in UNITS if unit != "voxel"])
        buttons = []
        for name, text, act in (
            ("match_files", tr("Add files …"), self.ask_files),
            ("match_folder", tr("Add folder …"), self._ask_folder),
            ("match_remove", tr("Remove"), self._remove),
            ("match_save", tr("Save …"), self.save),
        ):
            buttons.append(named(QPushButton(text), name))
            buttons[-1].clicked.connect(act)
        lists = QWidget()
        rows = control_row(self.cards, self.unit), control_row(*buttons[:3])
        vbox((self.candidates, 1), *rows, parent=lists)
        upper = side_by_side([lists, self.table], [260, 340], stretch=1)
        results = stacked([upper, self.picture], [160, 160], stretch=1)
        vbox(self.card, (results, 1), parent=self, margins=(4, 4, 4, 4))
        self.card.add(buttons[3])
        self.add([])

    def _ask_folder(self) -> None:
        start = str(self._context.recall("folder", str(Path.home())))
        self.add([QFileDialog.getExistingDirectory(self, tr("Folder of meshes"), start)])

    def _remove(self) -> None:
        for item in self.candidates.selectedItems():
            self.candidates.takeItem(self.candidates.row(item))
        self.add([])


def _in_floors(part: MatchedPart) -> str:
    return number_text(part.energy / part.energy_floor, ".2f")


def _cells(part: MatchedPart) -> tuple[str, ...]:
    low, high = part.mass_interval
    mass, *ends = (number_text(100 * share, ".1f") for share in (part.mass_share, low, high))
    return part.name, f"{part.n_particles}", _in_floors(part), f"{mass} ({ends[0]} – {ends[1]})"


def _tips(found: DrawnMatch) -> list[str]:
    """Distances in each descriptor, in percent of the mean of the sample."""
    return [
        "\n".join(f"{key}: {number_text(100 * value, '.1f')} %" for key, value in part.wasserstein.items())
        for part in (*found.match.parts, found.match.mixture)
    ]
