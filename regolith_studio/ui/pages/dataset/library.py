"""The library: datasets below a folder with thumbnails, and their exports and simulations."""

from collections.abc import Sequence
from pathlib import Path

from platformdirs import user_data_path
from PySide6.QtCore import QSize, Qt, QUrl, Signal
from PySide6.QtGui import QDesktopServices, QIcon
from PySide6.QtWidgets import (
    QFileDialog,
    QHBoxLayout,
    QLineEdit,
    QPushButton,
    QScrollArea,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.dataset.catalog import CatalogEntry, provenance_tree
from regolith_studio.jobs.dataset_jobs import list_library
from regolith_studio.jobs.events import Job
from regolith_studio.messages import N_
from regolith_studio.ui.layout import side_by_side
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import inert, tr
from regolith_studio.ui.widgets.labels import ElidedLabel, hint_label
from regolith_studio.ui.widgets.thumbnails import thumbnail

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
        """Ask for the folder of the library."""
        before = str(self._context.recall("library", str(Path.home())))
        name = QFileDialog.getExistingDirectory(self, tr("The folder of your datasets"), before)
        if name:
            self.show_folder(Path(name))

    def show_folder(self, root: Path) -> None:
        """List another folder and remember it."""
        self._context.remember("library", str(root))
        self.refresh()

    def refresh(self) -> None:
        """List the folder again."""
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
        """The entry of the selected row."""
        item = self.tree.currentItem()
        entry = item.data(0, ROLE) if item is not None else None
        return entry if isinstance(entry, CatalogEntry) else None

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
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
        top = QHBoxLayout()
        top.addWidget(self.choose)
        top.addWidget(self.again)
        top.addWidget(self.place, 1)
        top.addWidget(self.words)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setFrameShape(area.Shape.NoFrame)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setWidget(self.facts)
        buttons = QHBoxLayout()
        buttons.addWidget(self.use)
        buttons.addWidget(self.look)
        right = QWidget()
        column = QVBoxLayout(right)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(area, 1)
        column.addLayout(buttons)
        parts = side_by_side((self.tree, right), (640, 320), stretch=0)
        parts.setObjectName("library_parts")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 6, 8, 6)
        layout.addLayout(top)
        layout.addWidget(parts, 1)
