"""The controls of the page: representatives, sizes and folder."""

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QLineEdit,
    QPushButton,
    QWidget,
)

from regolith_studio.dataset.parameters import RepresentativesSettings
from regolith_studio.dataset.size_distributions import SizeRule, parse_sizes
from regolith_studio.errors import InputError
from regolith_studio.io.file_names import file_stem
from regolith_studio.jobs.dataset_jobs import RepresentativesRequest
from regolith_studio.messages import N_
from regolith_studio.session.recipe import DatasetRequest, Representatives
from regolith_studio.settings import setting_of
from regolith_studio.ui.layout import STRETCH, hbox, named, scrolled_column, vbox
from regolith_studio.ui.pages.dataset.export_panel import ExportPanel
from regolith_studio.ui.translation import tr, tr_count
from regolith_studio.ui.widgets.fields import NumberSlider, NumbersLine, NumberSpec, choice
from regolith_studio.ui.widgets.labels import FixedHeightText, heading, hint_label

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
        self.population.setWordWrap(False)
        vbox(
            hbox(heading(tr("1  Particles")), STRETCH, self.population),
            self.which,
            self.weighting,
            self.count,
            self.start,
            parent=self,
        )
        self._wanted = 10
        self.count.setValue(self._wanted)
        self.count.valueChanged.connect(self._count_changed)
        self.which.currentIndexChanged.connect(lambda _: self._show_which())

    @property
    def every(self) -> bool:
        """Whether each particle is its own representative."""
        return not self.which.value()

    def request(self) -> RepresentativesRequest:
        return RepresentativesRequest(int(self.count.value()), self.weighting.value())

    def recipe_part(self, sizes: str, name: str) -> Representatives:
        """The fields of a recipe for representatives and dataset."""
        count = {"count": 0} if self.every else {}
        return Representatives(**asdict(self.request()) | count | {"sizes": sizes, "name": name})

    def show_population(self, n_particles: int) -> None:
        """Set the number of open particles, the upper limit of representatives."""
        self.population.setText(
            tr_count(N_("1 particle is open."), N_("{count:,} particles are open."), n_particles)
            if n_particles
            else tr("No particles are open.")
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
        return {"count": count, "weighting": self.weighting.value()}

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Show other choices without emitting a signal.

        A number above that of the open particles is remembered until there are more; 0 are all particles.
        """
        if count := int(value.get("count", 10)):
            self._wanted = count
            self.count.setValue(count)
        self.which.setValue(bool(count))
        self._enable()
        self.weighting.setValue(value.get("weighting"))

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
        key = self.kind.value()
        return f"{key}:{self.numbers.value().strip()}" if SIZES[key][1] else key

    def set_text(self, text: str) -> None:
        """Show another distribution; an unknown one is ignored."""
        key = next((key for key in SIZES if text == key or text.startswith(f"{key}:")), "")
        if not key:
            return
        self.kind.setValue(key)
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
        key = self.kind.value()
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

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("dataset_folder")
        self.name = named(QLineEdit("regolith"), "dataset_name", tr("Name of the dataset"))
        self.shapes = hint_label()
        self.open = named(QPushButton(tr("Open a dataset …")), "dataset_open")
        head = hbox(heading(tr("3  Dataset")), STRETCH, self.open)
        vbox(head, self.name, FixedHeightText((self.shapes,)), parent=self)

    def folder_name(self) -> str:
        """Folder name, after that of the dataset."""
        return file_stem("_".join(self.name.text().split()) or "dataset")


class DatasetControls(QWidget):
    """The panels at the right of the page, set from a recipe and converted to one."""

    def __init__(
        self,
        representatives: RepresentativesPanel,
        sizes: SizesPanel,
        folder: FolderPanel,
        targets: ExportPanel,
    ) -> None:
        super().__init__()
        self.representatives, self.sizes, self.folder, self.targets = representatives, sizes, folder, targets
        self._column = scrolled_column((representatives, sizes, folder, targets))
        vbox((self._column, 1), targets.foot, parent=self, spacing=0)

    def go_to_formats(self) -> None:
        """Give the focus to the first format."""
        self._column.ensureWidgetVisible(self.targets.first)
        self.targets.first.setFocus(Qt.FocusReason.ShortcutFocusReason)

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
