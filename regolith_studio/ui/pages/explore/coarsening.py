"""Settings of the coarsening: size of the polyhedron, target, method and its settings, seed."""

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import QEvent, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QFormLayout, QPushButton, QSpinBox, QToolButton, QVBoxLayout, QWidget

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.settings import CoarseningSettings
from regolith_studio.ui.layout import Collapsible, hbox, named, vbox
from regolith_studio.ui.theme import Theme, current_theme, icon
from regolith_studio.ui.translation import inert, tr, translate
from regolith_studio.ui.widgets.fields import ChoiceBox, NumberSlider
from regolith_studio.ui.widgets.forms import LARGEST_NUMBER, SettingsForm
from regolith_studio.ui.widgets.labels import FixedHeightText, heading, hint_label

AMOUNTS = {
    "facets": "n_facets",
    "triangles": "n_triangles",
    "vertices": "n_vertices",
    "error": "largest_error",
}
"""Setting of each stopping criterion."""
NOTES, LEAST_NOTES = 5, 2
"""Lines for what a search and the result say, whole where one descriptor is missed; and in low windows."""


class CoarseningPanel(QWidget):
    """Edits the choices of the coarsening, apart from the weights of its loss."""

    FIELDS = (*AMOUNTS.values(), "stop_at", "target", "method", "settings", "seed")
    valueChanged = Signal(dict)  # noqa: N815
    editingFinished = Signal()  # noqa: N815
    searchRequested = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("coarsening")
        self._sufficient = 0
        self.enough = named(QPushButton(), "sufficient_facets")
        self.finding = hint_label()
        self.finding.hide()
        methods = {"method": {key: method.label for key, method in METHODS.items()}}
        names = ("method", "target", "seed", "stop_at")
        self._form = SettingsForm(CoarseningSettings, methods, names, "")
        self._sizes = SettingsForm(CoarseningSettings, None, AMOUNTS.values(), "")
        self.method: ChoiceBox = self._form.editors["method"]
        self.target: ChoiceBox = self._form.editors["target"]
        self.stop_at: ChoiceBox = self._form.editors["stop_at"]
        self.seed: QSpinBox = self._form.editors["seed"]
        self.n_facets: NumberSlider = self._sizes.editors["n_facets"]
        self._amounts: dict[str, NumberSlider] = {
            key: self._sizes.editors[name] for key, name in AMOUNTS.items()
        }
        self.dice = QToolButton()
        self.dice.setObjectName("next_seed")
        self.dice.setAccessibleName(tr("Next seed"))
        self.dice.setToolTip(tr("Next seed: the same method with other random numbers"))
        self._forms: dict[str, SettingsForm] = {}
        inside = QWidget()
        self._settings = QVBoxLayout(inside)
        self._settings.setContentsMargins(14, 0, 0, 0)
        self.more = Collapsible(tr("Settings of the method"), inside)
        self.more.button.setObjectName("method_settings")
        self.outcome = hint_label(role="warning")
        self.outcome.hide()
        self.set_theme(current_theme())
        self._arrange()
        self._connect()
        self._show_settings()
        self._show_amount()
        self.show_search(running=False)

    def value(self) -> dict[str, Any]:
        form = self._forms.get(self.method.value())
        settings = tuple(sorted(form.value().items())) if form else ()
        return self._form.values() | self._sizes.values() | {"settings": settings}

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Show other choices without emitting a signal."""
        self._form.setValue(value)
        self._sizes.setValue(value)
        self._show_amount()
        self._show_settings()
        if form := self._forms.get(value["method"]):
            form.setValue(dict(value["settings"]))

    def set_outcome(self, sentence: str | None) -> None:
        """Show why a request could not be met, what meeting it costs, or nothing."""
        words = translate(sentence) if sentence else ""
        self.outcome.setText(words)
        self.outcome.setToolTip(inert(words))
        self.outcome.setVisible(bool(sentence))

    def show_search(self, *, running: bool) -> None:
        """Offer to search the number of facets from which on nothing is gained."""
        self._sufficient = 0
        self.enough.setText(tr("Find the sufficient number"))
        self.enough.setToolTip(tr("Coarsens this particle at several numbers of facets."))
        self.enough.setEnabled(not running)
        self._show_finding(tr("Searching …") if running else "")

    def show_sufficient(self, count: int, *, saturated: bool, now: int, reason: str) -> None:
        """Show the number of facets from which on nothing is gained below the button, which takes it.

        - ``saturated``: whether more facets than `count` were tried in vain; else the errors still fall
          there.
        - ``now``: the chosen number.
        - ``reason``: why more are not needed; the tool tip.
        """
        self._sufficient = count
        found = (
            tr("Nothing is gained beyond {count} facets.", count=count)
            if saturated
            else tr("Errors still fall at {count} facets.", count=count)
        )
        self._show_finding(found)
        self.enough.setText(tr("Use {count} facets", count=count))
        self.enough.setToolTip(reason)
        self.enough.setEnabled(now != count)

    def _show_finding(self, words: str) -> None:
        self.finding.setText(words)
        self.finding.setVisible(bool(words) and self.stop_at.value() == "facets")

    def set_theme(self, theme: Theme) -> None:
        self.dice.setIcon(icon("dice", theme.text, theme.muted))

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._wrap_rows()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._wrap_rows()

    def _wrap_rows(self) -> None:
        """Wrap the rows of the form where combo boxes would elide their labels."""
        rows, boxes = self._form.rows, (self.method, self.target)
        beside = max(rows.labelForField(box).sizeHint().width() for box in boxes) + rows.horizontalSpacing()
        narrow = self.width() < beside + max(box.whole_width() for box in boxes)
        wrap = QFormLayout.RowWrapPolicy
        rows.setRowWrapPolicy(wrap.WrapAllRows if narrow else wrap.DontWrapRows)

    def _arrange(self) -> None:
        row = self._form.rows.getWidgetPosition(self.seed)[0]  # type: ignore[index]  # a pair, says Qt
        seed = hbox((self.seed, 1), self.dice)
        self._form.rows.setLayout(row, QFormLayout.ItemRole.FieldRole, seed)
        for slider in self._amounts.values():  # the stopping criterion above is their label
            self._sizes.rows.labelForField(slider).hide()
        vbox(
            heading(tr("Coarsened polyhedron")),
            self._form,
            self._sizes,
            self.enough,
            FixedHeightText((self.finding, self.outcome), NOTES, LEAST_NOTES),
            self.more,
            parent=self,
        )

    def _connect(self) -> None:
        for form in (self._form, self._sizes):
            form.edited.connect(self._change)
            form.editingFinished.connect(self.editingFinished)
        self.enough.clicked.connect(self._take_or_search)
        self.dice.clicked.connect(lambda: self.seed.setValue((self.seed.value() + 1) % LARGEST_NUMBER))

    def _change(self, changes: dict[str, Any]) -> None:
        if "stop_at" in changes:
            self._show_amount()
        if "method" in changes:
            self._show_settings()
            changes["settings"] = self.value()["settings"]
        self.valueChanged.emit(changes)

    def _announce(self, *names: str) -> None:
        now = self.value()
        self.valueChanged.emit({name: now[name] for name in names})
        self.editingFinished.emit()

    def _take_or_search(self) -> None:
        if not self._sufficient:
            self.searchRequested.emit()
            return
        self.n_facets.setValue(self._sufficient)
        self._announce("n_facets")

    def _show_amount(self) -> None:
        for key, slider in self._amounts.items():
            slider.setVisible(key == self.stop_at.value())
        by_number = self.stop_at.value() == "facets"
        self.enough.setVisible(by_number)
        self.finding.setVisible(by_number and bool(self.finding.text()))

    def _show_settings(self) -> None:
        key = self.method.value()
        if key and key not in self._forms:
            form = self._forms[key] = SettingsForm(METHODS[key].Settings)
            form.valueChanged.connect(lambda _: self._announce("settings"))
            self._settings.addWidget(form)
        for name, form in self._forms.items():
            form.setVisible(name == key)
        settable = bool(key) and not self._forms[key].is_empty()
        self.more.setEnabled(settable)
        if not settable:
            self.more.set_open(False)
