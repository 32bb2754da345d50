"""The controls at the left of the page: representatives, sizes, folder, and what a recipe says of them."""

import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLineEdit, QPushButton, QVBoxLayout, QWidget

from regolith_studio.dataset.size_parsing import SizeRule, parse_sizes
from regolith_studio.errors import InputError
from regolith_studio.jobs.representatives_jobs import RepresentativesRequest
from regolith_studio.session.recipe import DatasetRequest, Representatives
from regolith_studio.ui.pages.dataset.export_panel import ExportPanel
from regolith_studio.ui.translation import mark, tr, tr_count
from regolith_studio.ui.widgets.fixed_height_text import FixedHeightText
from regolith_studio.ui.widgets.labels import heading, remark
from regolith_studio.ui.widgets.number_slider import NumberSlider, NumberSpec

MOST = 200
POPULATION_LINES, SIZES_LINES, ASKED_LINES, STATE_LINES = (1, 2), (1, 3), (3, 3), (2, 3)
"""Of texts between the controls, that are seen without scrolling: in low windows, and in high ones."""
COUNT = NumberSpec("N", mark("Number of representatives"), 1, MOST, tip=mark("The paper has 10."))
WEIGHTINGS = {
    "number": mark("Each particle counts the same"),
    "volume": mark("Particles count by their volume"),
}
SIZES = {
    "measured": (mark("As measured"), ""),
    "classes": (mark("In size classes"), "25,37,56,84,125"),
    "fitted:log-normal": (mark("Log-normal, fitted to each class"), ""),
    "log-normal": (mark("Log-normal, the same for all"), "50,0.4"),
    "rosin-rammler": (mark("Rosin-Rammler, the same for all"), "60,2,10,200"),
    "sieve": (mark("Sieve classes, the same for all"), "20,32,45,63=10,60,30"),
    "discrete": (mark("Single diameters, the same for all"), "25=85.5,37=12.6,56=1.7,84=0.23,125=0.03"),
}
HINTS = {
    "classes": mark("Diameters in µm; each particle moves to the nearest (Table 1 of the paper)."),
    "log-normal": mark("Median in µm, deviation of ln d; @volume behind it counts volume."),
    "rosin-rammler": mark("Scale, shape, smallest, largest; @volume behind it counts volume."),
    "sieve": mark("Openings in µm = shares between them; @volume behind it counts volume."),
    "discrete": mark("Diameter in µm = share; @volume behind it counts volume."),
}


class RepresentativesPanel(QWidget):
    """Number and weighting of the representatives."""

    countChanged = Signal(int)  # noqa: N815
    orderChanged = Signal()  # noqa: N815
    findRequested = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("dataset_representatives")
        self.population = remark()
        self.start = QPushButton(tr("Find representatives"))
        self.count = NumberSlider(COUNT)
        self.weighting = QComboBox()
        for key, label in WEIGHTINGS.items():
            self.weighting.addItem(tr(label), key)
        self.start.setObjectName("dataset_find")
        self.count.field.setObjectName("dataset_count")
        self.weighting.setObjectName("dataset_weighting")
        self.weighting.setAccessibleName(tr("What representatives count"))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        for widget in (
            heading(tr("1  Representatives")),
            FixedHeightText((self.population,), *POPULATION_LINES),
            self.weighting,
            self.start,
            self.count,
        ):
            layout.addWidget(widget)
        self._wanted = 10
        self.count.setValue(self._wanted)
        self.count.valueChanged.connect(self._count_changed)
        self.weighting.currentIndexChanged.connect(lambda _: self.orderChanged.emit())
        self.start.clicked.connect(self.findRequested)

    def order(self) -> RepresentativesRequest:
        """What is asked for."""
        return RepresentativesRequest.of(int(self.count.value()), self.weighting.currentData())

    def wish(self, sizes: str, name: str) -> Representatives:
        """What a recipe says of them and of their dataset."""
        return Representatives(**asdict(self.order()), sizes=sizes, name=name)

    def show_population(self, n_particles: int) -> None:
        """Say how many particles there are to choose from."""
        self.population.setText(
            tr_count("1 particle is open.", "{count:,} particles are open.", n_particles)
            if n_particles
            else tr("No particles are open: open files, the sample, or draw some on the page Shape model.")
        )
        self.start.setEnabled(n_particles > 1)
        top = max(1, min(MOST, n_particles or MOST))
        self.count.slider.setMaximum(top)
        self.count.field.setMaximum(top)
        self.count.setValue(min(self._wanted, top))

    def value(self) -> dict[str, Any]:
        """Plain JSON."""
        return {"count": int(self.count.value()), "weighting": self.weighting.currentData()}

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Show other choices; announces nothing.

        A number that the open particles do not allow is remembered until there are more; 0 lets each stand
        for itself.
        """
        self._wanted = int(value.get("count", 10)) or MOST
        self.count.setValue(self._wanted)
        with QSignalBlocker(self.weighting):
            self.weighting.setCurrentIndex(max(0, self.weighting.findData(value.get("weighting"))))

    def _count_changed(self, _value: object) -> None:
        self._wanted = int(self.count.value())
        self.countChanged.emit(self._wanted)


class SizesPanel(QWidget):
    """Edits the size distributions as one line of text, with a form for each kind."""

    sizesChanged = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("dataset_size_kinds")
        self.kind, self.numbers = QComboBox(), QLineEdit()
        self.hint, self.problem = remark(), remark(role="warning")
        for key, (label, _) in SIZES.items():
            self.kind.addItem(tr(label), key)
        self.kind.setObjectName("dataset_size_kind")
        self.kind.setAccessibleName(tr("Kind of size distribution"))
        self.numbers.setObjectName("dataset_size_numbers")
        self.numbers.setAccessibleName(tr("Numbers of the size distribution"))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        texts = FixedHeightText((self.hint, self.problem), *SIZES_LINES)
        for widget in (heading(tr("2  Sizes")), self.kind, self.numbers, texts):
            layout.addWidget(widget)
        self.kind.currentIndexChanged.connect(lambda _: self._show_kind())
        self.numbers.textEdited.connect(lambda _: self._tell())
        self._show_kind()

    def text(self) -> str:
        """As :mod:`regolith_studio.dataset.size_parsing` writes it."""
        key = self.kind.currentData()
        return f"{key}:{self.numbers.text().strip()}" if SIZES[key][1] else str(key)

    def set_text(self, text: str) -> None:
        """Show another distribution; what is unknown is left out."""
        key = next((key for key in SIZES if text == key or text.startswith(f"{key}:")), "")
        if not key:
            return
        with QSignalBlocker(self.kind):
            self.kind.setCurrentIndex(self.kind.findData(key))
        self._show_kind()
        if SIZES[key][1]:
            self.numbers.setText(text.removeprefix(f"{key}:"))
        self._tell()

    def sizing(self) -> SizeRule | None:
        """From measured sizes to those that are wanted; ``None`` while the numbers make no sense."""
        try:
            found = parse_sizes(self.text())
        except InputError as error:
            self.show_problem(str(error))
            return None
        self.show_problem("")
        return found

    def show_problem(self, sentence: str) -> None:
        """Say what is wrong with the numbers."""
        self.problem.setText(sentence)
        self.problem.setVisible(bool(sentence))

    def _show_kind(self) -> None:
        key = self.kind.currentData()
        example = SIZES[key][1]
        self.numbers.setEnabled(bool(example))
        self.numbers.setText(example)
        self.numbers.setPlaceholderText("" if example else tr("needs no numbers"))
        self.hint.setText(tr(HINTS.get(key, "")))
        self.hint.setVisible(key in HINTS)
        self._tell()

    def _tell(self) -> None:
        self.sizing()
        self.sizesChanged.emit()


class FolderPanel(QWidget):
    """Name of the dataset, and where it is."""

    buildRequested = Signal()  # noqa: N815
    openRequested = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("dataset_folder")
        self.name = QLineEdit("regolith")
        self.name.setObjectName("dataset_name")
        self.name.setAccessibleName(tr("Name of the dataset"))
        self.shapes, self.state = remark(), remark()
        self.build, self.open = QPushButton(tr("Build the dataset …")), QPushButton(tr("Open a dataset …"))
        self.build.setObjectName("dataset_build")
        self.open.setObjectName("dataset_open")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        asked, there = (
            FixedHeightText((self.shapes,), *ASKED_LINES),
            FixedHeightText((self.state,), *STATE_LINES),
        )
        for widget in (heading(tr("3  Dataset")), self.name, asked):
            layout.addWidget(widget)
        buttons = QHBoxLayout()
        for button in (self.build, self.open):
            buttons.addWidget(button, 1)
        layout.addLayout(buttons)
        layout.addWidget(there)
        self.build.clicked.connect(self.buildRequested)
        self.open.clicked.connect(self.openRequested)
        self.show_dataset("")

    def folder_name(self) -> str:
        """Of the folder: the dataset's name without what a file system may not like."""
        return re.sub(r"[^\w.-]+", "_", self.name.text()).strip("._") or "dataset"

    def show_dataset(self, words: str) -> None:
        """Say which dataset is there."""
        self.state.setText(words or tr("No dataset yet."))


@dataclass(frozen=True)
class DatasetControls:
    """All panels at the left of the page, set from a recipe and read for one."""

    representatives: RepresentativesPanel
    sizes: SizesPanel
    folder: FolderPanel
    targets: ExportPanel

    def take(self, opened: DatasetRequest) -> None:
        """Set them as a recipe says."""
        if wish := opened.representatives:
            self.representatives.setValue(wish.model_dump())
            self.sizes.set_text(wish.sizes)
            self.folder.name.setText(wish.name or self.folder.name.text())
        if opened.exports:
            self.targets.take(opened.exports)

    def standing(self) -> DatasetRequest:
        """What a recipe would say."""
        name = self.folder.name.text().strip()
        return DatasetRequest(self.representatives.wish(self.sizes.text(), name), self.targets.wish())
