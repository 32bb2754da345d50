"""Dialog of the report on the open sample: its settings and folder, then its progress."""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

from PySide6.QtWidgets import QFormLayout, QLabel, QWidget

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.weights import presets
from regolith_studio.errors import InputError
from regolith_studio.jobs.runners.process_pool import cores
from regolith_studio.messages import N_
from regolith_studio.session.choices import Choices
from regolith_studio.session.report.settings import ReportSettings
from regolith_studio.session.report.write import PAGE, SectionBegun
from regolith_studio.ui.dialogs.batch import RunDialog
from regolith_studio.ui.layout import named
from regolith_studio.ui.translation import tr, tr_count
from regolith_studio.ui.widgets.fields import whole_field
from regolith_studio.ui.widgets.forms import SettingsForm
from regolith_studio.ui.widgets.labels import hint_label


@dataclass(frozen=True)
class ReportRequest:
    """The settings of the dialog.

    ``folder``: of the report. ``workers``: processes at a time.
    """

    folder: Path
    settings: ReportSettings
    workers: int


class ReportDialog(RunDialog):
    """Edits a :class:`ReportRequest` for so many particles; begins with what is chosen in the window."""

    def __init__(self, count: int, choices: Choices, folder: Path, parent: QWidget | None = None) -> None:
        super().__init__("report", tr("Report"), folder, PAGE, parent)
        self._count = count
        labels = {
            "method": {key: method.label for key, method in METHODS.items()},
            "preset": {key: preset.label for key, preset in presets().items()},
        }
        self.form = SettingsForm(ReportSettings, labels)
        self.form.setValue(
            {
                "l_max": choices.l_max,
                "facets": choices.facet_count,
                "method": choices.method,
                "preset": choices.preset,
                "seed": choices.seed,
            }
        )
        self.workers = whole_field("report_workers", tr("Number of processes"), 1, 1024, cores())
        self.section = named(QLabel(), "report_section")
        self.section.hide()
        self.form.valueChanged.connect(self.evaluate)
        self._place()
        self.evaluate()

    def value(self) -> ReportRequest:
        if not self._count:
            raise InputError(tr("No particle is open to report on: open one first."))
        folder = self.folder.value()
        if folder is None or folder.is_file():
            raise InputError(tr("Enter a folder for the results."))
        settings: dict[str, Any] = dict(self.form.value())
        return ReportRequest(folder, ReportSettings(**settings), self.workers.value())

    def field_values(self) -> dict[str, Any]:
        """What the next dialog may suggest, as plain JSON: what is not chosen in the window anyway."""
        kept = ("study_particles", "drawn", "splits", "representatives", "heap")
        return {name: value for name, value in self.form.value().items() if name in kept}

    def restore_fields(self, values: Mapping[str, Any]) -> None:
        """Suggest what was given before; what is not understood is left out."""
        known = {each.name: each for each in dataclasses.fields(ReportSettings)}
        numbers = {name: value for name, value in values.items() if type(value) is int and name in known}
        self.form.setValue(self.form.value() | numbers)
        self.evaluate()

    def show_partial(self, value: object) -> None:
        if isinstance(value, SectionBegun):
            place = tr("Section {number} of {total}", number=value.number, total=value.total)
            self.section.setText(f"{place}: {tr(value.title)}")
            self.section.show()

    def finish(self, sentence: str, done: bool = False) -> None:
        """The report is written, or the work has ended otherwise."""
        self.section.hide()
        super().finish(sentence, done)

    def _place(self) -> None:
        rows = cast(QFormLayout, self.form.layout())
        sample = tr_count(N_("1 open particle"), N_("{count:,} open particles"), self._count)
        rows.insertRow(0, tr("Sample"), QLabel(sample))
        rows.addRow(tr("Folder of the results"), self.folder)
        rows.addRow(tr("Number of processes"), self.workers)
        form = QFormLayout()
        form.addRow(self.form)
        contents = tr(
            "Figs. 2 to 9 and Tables 1 and 2 of the paper for the open particles, as one HTML page, PDF, and "
            "tables. The command “report” writes the same."
        )
        self.arrange(form, hint_label(contents), self.section, fields=(self.form,))
