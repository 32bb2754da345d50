"""The controls of the page: representatives, sizes, folder, and the library of datasets."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from platformdirs import user_data_path
from PySide6.QtCore import QSignalBlocker, QSize, Qt, QUrl, Signal
from PySide6.QtGui import QDesktopServices, QIcon
from PySide6.QtWidgets import (
    QFileDialog,
    QLineEdit,
    QPushButton,
    QScrollArea,
    QTreeWidget,
    QTreeWidgetItem,
    QWidget,
)

from regolith_studio.dataset.catalog import CatalogEntry, provenance_tree
from regolith_studio.dataset.parameters import RepresentativesSettings
from regolith_studio.dataset.size_distributions import SizeRule, parse_sizes
from regolith_studio.errors import InputError
from regolith_studio.io.file_names import file_stem
from regolith_studio.jobs.dataset_jobs import RepresentativesRequest, list_library
from regolith_studio.jobs.events import Job
from regolith_studio.messages import N_
from regolith_studio.session.recipe import DatasetRequest, Representatives
from regolith_studio.settings import setting_of
from regolith_studio.ui.layout import hbox, named, side_by_side, vbox
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.dataset.export_panel import ExportPanel
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import inert, tr, tr_count
from regolith_studio.ui.widgets.fields import NumberSlider, NumbersLine, NumberSpec, choice
from regolith_studio.ui.widgets.labels import ElidedLabel, FixedHeightText, heading, hint_label
from regolith_studio.ui.widgets.thumbnails import thumbnail

MAX_REPRESENTATIVES = 200
COUNT = NumberSpec("N", N_("Number of representatives"), 1, MAX_REPRESENTATIVES, tip=N_("Usually 10."))
WEIGHTINGS = setting_of(RepresentativesSettings, "weighting").metadata["choices"]
SIZES = {
    "measured": (N_("As measured"), ""),
    "classes": (N_("In size classes"), "25,37,56,84,125"),
    "fitted:log-normal": (N_("Log-normal, fitted to each class"), ""),
    "log-normal": (N_("Log-normal, the same for all"), "50,0.4"),
    "rosin-rammler": (N_("Rosin-Rammler, the same for all"), "60,2,10,200"),
    "sieve": (N_("Sieve classes, the same for all"), "20,32,45,63=10,60,30"),
    "discrete": (N_("Single diameters, the same for all"), "25=85.5,37=12.6,56=1.7,84=0.23,125=0.03"),
}
HINTS = {
    "classes": N_("Diameters in µm; each particle moves to the nearest."),
    "log-normal": N_("Median in µm, deviation of ln d; @volume behind it counts volume."),
    "rosin-rammler": N_("Scale, shape, smallest, largest; @volume behind it counts volume."),
    "sieve": N_("Openings in µm = shares between them; @volume behind it counts volume."),
    "discrete": N_("Diameter in µm = share; @volume behind it counts volume."),
}


class RepresentativesPanel(QWidget):
    """Number and weighting of the representatives."""

    countChanged = Signal(int)  # noqa: N815
    orderChanged = Signal()  # noqa: N815
    findRequested = Signal()  # noqa: N815
    whichChanged = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("dataset_representatives")
        self._several = False
        self.population = hint_label()
        self.start = QPushButton(tr("Find representatives"))
        self.count = NumberSlider(COUNT)
        kinds = {True: N_("Representatives"), False: N_("All open particles")}
        self.which = choice("dataset_which", tr("Particles of the dataset"), kinds)
        spoken = tr("Weighting of the representatives")
        self.weighting = choice("dataset_weighting", spoken, WEIGHTINGS)
        self.start.setObjectName("dataset_find")
        self.count.field.setObjectName("dataset_count")
        vbox(
            heading(tr("1  Particles")),
            FixedHeightText((self.population,)),
            self.which,
            self.weighting,
            self.count,
            self.start,
            parent=self,
        )
        self._wanted = 10
        self.count.setValue(self._wanted)
        self.count.valueChanged.connect(self._count_changed)
        self.weighting.currentIndexChanged.connect(lambda _: self.orderChanged.emit())
        self.start.clicked.connect(self.findRequested)
        self.which.currentIndexChanged.connect(lambda _: self._show_which())

    @property
    def every(self) -> bool:
        """Whether each particle is its own representative."""
        return not self.which.currentData()

    def request(self) -> RepresentativesRequest:
        return RepresentativesRequest(int(self.count.value()), self.weighting.currentData())

    def recipe_part(self, sizes: str, name: str) -> Representatives:
        """The fields of a recipe for representatives and dataset."""
        count = {"count": 0} if self.every else {}
        return Representatives(**asdict(self.request()) | count | {"sizes": sizes, "name": name})

    def show_population(self, n_particles: int) -> None:
        """Set the number of open particles, the upper limit of representatives."""
        self.population.setText(
            tr_count(N_("1 particle is open."), N_("{count:,} particles are open."), n_particles)
            if n_particles
            else tr("No particles are open: open files, the sample, or draw some on the page Shape model.")
        )
        self._several = n_particles > 1
        self._enable()
        top = max(1, min(MAX_REPRESENTATIVES, n_particles or MAX_REPRESENTATIVES))
        self.count.slider.setMaximum(top)
        self.count.field.setMaximum(top)
        self.count.setValue(min(self._wanted, top))

    def value(self) -> dict[str, Any]:
        """Plain JSON."""
        count = 0 if self.every else int(self.count.value())
        return {"count": count, "weighting": self.weighting.currentData()}

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Show other choices without emitting a signal.

        A number above that of the open particles is remembered until there are more; 0 are all particles.
        """
        if count := int(value.get("count", 10)):
            self._wanted = count
            self.count.setValue(count)
        with QSignalBlocker(self.which):
            self.which.setCurrentIndex(0 if count else 1)
        self._enable()
        with QSignalBlocker(self.weighting):
            self.weighting.setCurrentIndex(max(0, self.weighting.findData(value.get("weighting"))))

    def _show_which(self) -> None:
        self._enable()
        self.whichChanged.emit()

    def _enable(self) -> None:
        self.start.setEnabled(self._several and not self.every)
        for each in (self.count, self.weighting):
            each.setEnabled(not self.every)

    def _count_changed(self, _value: object) -> None:
        self._wanted = int(self.count.value())
        self.countChanged.emit(self._wanted)


class SizesPanel(QWidget):
    """Edits the size distributions as one line of text, with a form for each kind."""

    sizesChanged = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("dataset_size_kinds")
        labels = {key: label for key, (label, _) in SIZES.items()}
        self.kind = choice("dataset_size_kind", tr("Kind of size distribution"), labels)
        self.numbers = named(NumbersLine(), "dataset_size_numbers", tr("Numbers of the size distribution"))
        self.hint, self.problem = hint_label(), hint_label(role="warning")
        texts = FixedHeightText((self.hint, self.problem))
        vbox(heading(tr("2  Sizes")), self.kind, self.numbers, texts, parent=self)
        self.kind.currentIndexChanged.connect(lambda _: self._show_kind())
        self.numbers.textEdited.connect(lambda _: self._emit_sizes())
        self._show_kind()

    def text(self) -> str:
        """As :mod:`regolith_studio.dataset.size_distributions` writes it."""
        key = self.kind.currentData()
        return f"{key}:{self.numbers.value().strip()}" if SIZES[key][1] else str(key)

    def set_text(self, text: str) -> None:
        """Show another distribution; an unknown one is ignored."""
        key = next((key for key in SIZES if text == key or text.startswith(f"{key}:")), "")
        if not key:
            return
        with QSignalBlocker(self.kind):
            self.kind.setCurrentIndex(self.kind.findData(key))
        self._show_kind()
        if SIZES[key][1]:
            self.numbers.setValue(text.removeprefix(f"{key}:"))
        self._emit_sizes()

    def sizing(self) -> SizeRule | None:
        """The mapping of measured to requested sizes; ``None`` while the text is invalid."""
        try:
            found = parse_sizes(self.text())
        except InputError as error:
            self.show_problem(str(error))
            return None
        self.show_problem("")
        return found

    def show_problem(self, sentence: str) -> None:
        self.problem.setText(sentence)
        self.problem.setVisible(bool(sentence))

    def reason(self) -> str:
        """Why the numbers are invalid; empty where they are not."""
        return "" if self.problem.isHidden() else self.problem.text()

    def _show_kind(self) -> None:
        key = self.kind.currentData()
        example = SIZES[key][1]
        self.numbers.setEnabled(bool(example))
        self.numbers.setValue(example)
        self.hint.setText(tr(HINTS.get(key, "")))
        self.hint.setVisible(key in HINTS)
        self._emit_sizes()

    def _emit_sizes(self) -> None:
        self.sizing()
        self.sizesChanged.emit()


class FolderPanel(QWidget):
    """Name of the dataset, its shapes, and the button that opens one."""

    openRequested = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("dataset_folder")
        self.name = named(QLineEdit("regolith"), "dataset_name", tr("Name of the dataset"))
        self.shapes, self.state = hint_label(), hint_label()
        self.open = named(QPushButton(tr("Open a dataset …")), "dataset_open")
        asked, there = FixedHeightText((self.shapes,)), FixedHeightText((self.state,))
        vbox(heading(tr("3  Dataset")), self.name, asked, self.open, there, parent=self)
        self.open.clicked.connect(self.openRequested)
        self.show_dataset("")

    def folder_name(self) -> str:
        """Folder name, after that of the dataset."""
        return file_stem("_".join(self.name.text().split()) or "dataset")

    def show_dataset(self, words: str) -> None:
        self.state.setText(words or tr("No dataset yet."))


@dataclass(frozen=True)
class DatasetControls:
    """The panels at the right of the page, set from a recipe and converted to one."""

    representatives: RepresentativesPanel
    sizes: SizesPanel
    folder: FolderPanel
    targets: ExportPanel

    def show_recipe(self, opened: DatasetRequest) -> None:
        if recipe := opened.representatives:
            self.representatives.setValue(recipe.model_dump())
            self.sizes.set_text(recipe.sizes)
            self.folder.name.setText(recipe.name or self.folder.name.text())
        if opened.exports:
            self.targets.show_recipe(opened.exports)

    def request(self) -> DatasetRequest:
        name = self.folder.name.text().strip()
        return DatasetRequest(
            self.representatives.recipe_part(self.sizes.text(), name), self.targets.recipe_part()
        )


PICTURE = 40
QUEUE = "library"
EMPTY = N_(
    "Choose a folder: the datasets below it are listed here, with what was exported and simulated from each."
)
ROLE = Qt.ItemDataRole.UserRole


class LibraryPanel(QWidget):
    """Lists a folder, which is remembered between sessions; a double click opens a dataset."""

    openRequested = Signal(object)  # noqa: N815

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("dataset_library")
        self._context, self._theme = context, current_theme()
        self._entries: tuple[CatalogEntry, ...] = ()
        self._pictures: dict[tuple[str, str], QIcon] = {}
        self.choose, self.again = QPushButton(tr("Folder …")), QPushButton(tr("Refresh"))
        self.place = ElidedLabel("", role="hint")
        self.words = QLineEdit(placeholderText=tr("Filter"), clearButtonEnabled=True)
        self.tree, self.facts = QTreeWidget(), hint_label(tr(EMPTY))
        self.use, self.look = QPushButton(tr("Use this dataset")), QPushButton(tr("Open folder"))
        self._configure()
        self._arrange()
        self.choose.clicked.connect(self.ask)
        self.again.clicked.connect(self.refresh)
        self.words.textChanged.connect(lambda _: self._show())
        self.tree.currentItemChanged.connect(lambda *_: self._show_facts())
        self.tree.itemDoubleClicked.connect(lambda *_: self._open())
        self.use.clicked.connect(self._open)
        self.look.clicked.connect(self._look)
        self._show_facts()

    @property
    def entries(self) -> tuple[CatalogEntry, ...]:
        """The listed entries, sorted by path."""
        return self._entries

    def ask(self) -> None:
        before = str(self._context.recall("library", str(Path.home())))
        name = QFileDialog.getExistingDirectory(self, tr("The folder of your datasets"), before)
        if name:
            self.show_folder(Path(name))

    def show_folder(self, root: Path) -> None:
        """List another folder and remember it."""
        self._context.remember("library", str(root))
        self.refresh()

    def refresh(self) -> None:
        root = self._context.recall("library")
        if root and Path(root).is_dir():
            self.place.setText(str(root))
            self._entries = ()
            job = Job(list_library, (Path(root), self._results()))
            self._context.start(tr("Searching for datasets"), job, self._take, queue=QUEUE, repeats=True)

    def suggest(self, root: Path) -> None:
        """List this folder if none has been chosen yet; else update the list."""
        if self._context.recall("library"):
            self.refresh()
        else:
            self.show_folder(root)

    def _results(self) -> Path:
        """The folder of runs of the page Angle of repose."""
        usual = user_data_path("regolith-studio") / "repose"
        return self._context.session.runs_folder or usual

    def selected(self) -> CatalogEntry | None:
        item = self.tree.currentItem()
        entry = item.data(0, ROLE) if item is not None else None
        return entry if isinstance(entry, CatalogEntry) else None

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        self._pictures.clear()
        self._show()

    def _take(self, entries: Sequence[CatalogEntry]) -> None:
        self._entries = tuple(entries)
        self._show()
        if not entries:
            self.facts.setText(tr("There is no dataset below this folder."))

    def _show(self) -> None:
        self.tree.clear()
        for top, below in provenance_tree(self._entries):
            kept = [entry for entry in below if entry.matches(self.words.text())]
            if not kept and not top.matches(self.words.text()):
                continue
            parent = self._item(top)
            for entry in kept:
                parent.addChild(self._item(entry))
            self.tree.addTopLevelItem(parent)
        self.tree.expandAll()
        self._show_facts()

    def _item(self, entry: CatalogEntry) -> QTreeWidgetItem:
        item = QTreeWidgetItem([entry.name, entry.problem or entry.detail])
        item.setData(0, ROLE, entry)
        item.setToolTip(0, inert(str(entry.folder)))
        item.setToolTip(1, inert(entry.problem or entry.detail))
        if entry.mesh is not None:
            key = (entry.sha256, self._theme.polyhedron)
            if key not in self._pictures:
                self._pictures[key] = QIcon(thumbnail(entry.mesh, self._theme.polyhedron, PICTURE))
            item.setIcon(0, self._pictures[key])
        return item

    def _show_facts(self) -> None:
        entry = self.selected()
        self.use.setEnabled(entry is not None and entry.kind == "dataset" and not entry.problem)
        self.look.setEnabled(entry is not None)
        if entry is None:
            self.facts.setText("" if self._entries else tr(EMPTY))
            return
        lines = [entry.name, entry.problem or entry.detail, str(entry.folder)]
        lines += [f"{label}: {text}" for label, text in entry.facts.items()]
        if entry.sha256:
            lines.append(tr("SHA-256 of the dataset: {hash} …", hash=entry.sha256[:16]))
        self.facts.setText("\n\n".join(lines))

    def _open(self) -> None:
        entry = self.selected()
        if entry is not None and entry.kind == "dataset" and not entry.problem:
            self.openRequested.emit(entry.folder)

    def _look(self) -> None:
        entry = self.selected()
        if entry is not None:
            QDesktopServices.openUrl(QUrl.fromLocalFile(str(entry.folder)))

    def _configure(self) -> None:
        for name in ("choose", "again", "words", "tree", "use", "look"):
            getattr(self, name).setObjectName(f"library_{name}")
        self.words.setAccessibleName(tr("Filter of the library"))
        self.tree.setAccessibleName(tr("Library"))
        self.tree.setHeaderLabels([tr("Name"), tr("Contents")])
        self.tree.setIconSize(QSize(PICTURE, PICTURE))
        self.tree.setColumnWidth(0, 300)
        self.tree.setFrameShape(self.tree.Shape.NoFrame)
        self.facts.setTextFormat(Qt.TextFormat.PlainText)
        self.facts.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.facts.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.facts.setContentsMargins(8, 4, 8, 4)

    def _arrange(self) -> None:
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setFrameShape(area.Shape.NoFrame)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setWidget(self.facts)
        right = QWidget()
        vbox((area, 1), hbox(self.use, self.look), parent=right)
        parts = side_by_side((self.tree, right), (640, 320), stretch=0)
        parts.setObjectName("library_parts")
        vbox(
            hbox(self.choose, self.again, (self.place, 1), self.words),
            (parts, 1),
            parent=self,
            margins=(8, 6, 8, 6),
        )
