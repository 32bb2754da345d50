"""Settings of the coarsening: size of the polyhedron, target, method and its settings, seed."""

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import QEvent, QSignalBlocker, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QFormLayout,
    QHBoxLayout,
    QPushButton,
    QSpinBox,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.coarsening.coarsen import FACETS_LIMITS
from regolith_studio.coarsening.methods import METHODS
from regolith_studio.messages import N_
from regolith_studio.ui.icons import icon
from regolith_studio.ui.layout import Collapsible
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.widgets.combo_box import ChoiceBox
from regolith_studio.ui.widgets.fixed_height_text import FixedHeightText
from regolith_studio.ui.widgets.forms import SettingsForm
from regolith_studio.ui.widgets.labels import heading, remark
from regolith_studio.ui.widgets.numbers import NumberSlider, NumberSpec

STOPS = {
    "facets": N_("Facets n"),
    "triangles": N_("Triangles"),
    "vertices": N_("Vertices"),
    "error": N_("Error ≤"),
}
FACETS = NumberSpec(
    "",
    N_("Number of facets"),
    FACETS_LIMITS[0],
    60,
    limit=FACETS_LIMITS[1],
    tip=N_("n facets in general position have 2n−4 vertices and 4n−12 triangles."),
)
TRIANGLES = NumberSpec(
    "",
    N_("Maximum number of triangles"),
    4 * FACETS_LIMITS[0] - 12,
    228,
    limit=4 * FACETS_LIMITS[1] - 12,
    tip=N_("The number of facets follows from it: n facets have at most 4n−12 triangles."),
)
VERTICES = NumberSpec(
    "",
    N_("Maximum number of vertices"),
    2 * FACETS_LIMITS[0] - 4,
    128,
    limit=2 * FACETS_LIMITS[1] - 4,
    tip=N_("The number of facets follows from it: n facets have at most 2n−4 vertices."),
)
ERROR = NumberSpec(
    "",
    N_("Largest error"),
    0.05,
    10.0,
    0.05,
    limit=50.0,
    suffix=" %",
    tip=N_(
        "The smallest number of facets is sought at which no weighted descriptor has a larger error. V and CH"
        " cannot both be met: of their errors only what exceeds the lower bound counts."
    ),
)
TARGET_LABELS = {"fit": N_("Spherical-harmonics fit"), "particle": N_("Particle")}
SEED_LIMIT = 2**31 - 1


class CoarseningPanel(QWidget):
    """Edits the choices of the coarsening, apart from the weights of its loss."""

    FIELDS = (
        *("stop_at", "n_facets", "n_triangles", "n_vertices", "largest_error"),
        *("target", "method", "settings", "seed"),
    )
    valueChanged = Signal(dict)  # noqa: N815
    editingFinished = Signal()  # noqa: N815
    searchRequested = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("coarsening")
        self._sufficient = 0
        self.enough = QPushButton()
        self.enough.setObjectName("sufficient_facets")
        self.stop_at = ChoiceBox("stop_at", tr("Stopping criterion"), STOPS)
        self.stop_at.setToolTip(self.stop_at.accessibleName())
        self.stop_at.setMinimumContentsLength(max(len(tr(label)) for label in STOPS.values()))
        self.n_facets = _amount(FACETS, "n_facets")
        self.n_triangles = _amount(TRIANGLES, "n_triangles")
        self.largest_error = _amount(ERROR, "largest_error")
        self.n_vertices = _amount(VERTICES, "n_vertices")
        self._amounts = {
            "facets": self.n_facets,
            "triangles": self.n_triangles,
            "vertices": self.n_vertices,
            "error": self.largest_error,
        }
        self.target = ChoiceBox("target", tr("Target of the coarsening"), TARGET_LABELS)
        self.method = ChoiceBox("method", tr("Coarsening method"), {k: m.label for k, m in METHODS.items()})
        self.seed = _seed_field()
        self.dice = QToolButton()
        self.dice.setObjectName("next_seed")
        self.dice.setToolTip(tr("Next seed: the same method with other random numbers"))
        self.dice.setAccessibleName(tr("Next seed"))
        self._forms: dict[str, SettingsForm] = {}
        inside = QWidget()
        self._settings = QVBoxLayout(inside)
        self._settings.setContentsMargins(14, 0, 0, 0)
        self.more = Collapsible(tr("Settings of the method"), inside)
        self.more.button.setObjectName("method_settings")
        self.outcome = remark(role="warning")
        self.outcome.hide()
        self.set_theme(current_theme())
        self._arrange()
        self._connect()
        self._show_settings()
        self._show_amount()
        self.show_search(running=False)

    def value(self) -> dict[str, Any]:
        """The edited choices."""
        form = self._forms.get(self.method.value())
        settings = form.value() if form else {}
        return {
            "stop_at": self.stop_at.value(),
            "n_facets": int(self.n_facets.value()),
            "n_triangles": int(self.n_triangles.value()),
            "n_vertices": int(self.n_vertices.value()),
            "largest_error": _share(self.largest_error.value()),
            "target": self.target.value(),
            "method": self.method.value(),
            "settings": tuple(sorted(settings.items())),
            "seed": self.seed.value(),
        }

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Show other choices without emitting a signal."""
        self.stop_at.setValue(value["stop_at"])
        self.n_facets.setValue(value["n_facets"])
        self.n_triangles.setValue(value["n_triangles"])
        self.n_vertices.setValue(value["n_vertices"])
        self.largest_error.setValue(100.0 * value["largest_error"])
        self._show_amount()
        self.target.setValue(value["target"])
        self.method.setValue(value["method"])
        with QSignalBlocker(self.seed):
            self.seed.setValue(value["seed"])
        self._show_settings()
        if form := self._forms.get(value["method"]):
            form.setValue(dict(value["settings"]))

    def set_outcome(self, sentence: str | None) -> None:
        """Show why a request could not be met, what meeting it costs, or nothing."""
        self.outcome.setText(translate(sentence) if sentence else "")
        self.outcome.setVisible(bool(sentence))

    def show_search(self, *, running: bool) -> None:
        """Offer to search the number of facets from which on nothing is gained."""
        self._sufficient = 0
        self.enough.setText(tr("Searching …") if running else tr("Find the sufficient number"))
        self.enough.setToolTip(tr("Coarsens this particle at several numbers of facets."))
        self.enough.setEnabled(not running)

    def show_sufficient(self, count: int, *, saturated: bool, now: int, reason: str) -> None:
        """Show the number of facets from which on nothing is gained, and offer it.

        Parameters
        ----------
        saturated
            Whether more facets than `count` were tried in vain; else the errors still fall there.
        now
            The chosen number.
        reason
            Why more are not needed; the tool tip.
        """
        self._sufficient = count
        if not saturated:
            words = tr("Errors still fall at {count} facets", count=count)
        elif now == count:
            words = tr("Nothing is gained beyond {count} facets", count=count)
        else:
            words = tr("Use {count} facets: more do not help", count=count)
        self.enough.setText(words)
        self.enough.setToolTip(reason)
        self.enough.setEnabled(now != count)

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
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
        labels = [self._form.labelForField(box) for box in (self.method, self.target)]
        beside = max(label.sizeHint().width() for label in labels) + self._form.horizontalSpacing()
        narrow = self.width() < beside + max(box.whole_width() for box in (self.method, self.target))
        wrap = QFormLayout.RowWrapPolicy
        self._form.setRowWrapPolicy(wrap.WrapAllRows if narrow else wrap.DontWrapRows)

    def _arrange(self) -> None:
        amount = QHBoxLayout()
        for slider in self._amounts.values():
            amount.addWidget(slider, 1)
        seed = QHBoxLayout()
        seed.addWidget(self.seed, 1)
        seed.addWidget(self.dice)
        form = self._form = QFormLayout()
        form.setContentsMargins(0, 0, 0, 0)
        form.addRow(tr("Method"), self.method)
        form.addRow(tr("Target"), self.target)
        form.addRow(tr("Seed"), seed)
        form.addRow(tr("Stop at"), self.stop_at)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(heading(tr("Coarsened polyhedron")))
        layout.addLayout(form)
        layout.addLayout(amount)
        layout.addWidget(self.enough)
        layout.addWidget(self.more)
        layout.addWidget(FixedHeightText((self.outcome,)))

    def _connect(self) -> None:
        self.n_facets.valueChanged.connect(lambda n: self.valueChanged.emit({"n_facets": int(n)}))
        self.n_triangles.valueChanged.connect(lambda n: self.valueChanged.emit({"n_triangles": int(n)}))
        self.n_vertices.valueChanged.connect(lambda n: self.valueChanged.emit({"n_vertices": int(n)}))
        self.largest_error.valueChanged.connect(
            lambda percent: self.valueChanged.emit({"largest_error": _share(percent)})
        )
        for slider in self._amounts.values():
            slider.editingFinished.connect(self.editingFinished)
        self.stop_at.activated.connect(self._change_stop)
        self.enough.clicked.connect(self._take_or_search)
        self.target.activated.connect(lambda _: self._announce("target"))
        self.method.activated.connect(self._change_method)
        self.seed.valueChanged.connect(lambda _: self._announce("seed"))
        self.dice.clicked.connect(lambda: self.seed.setValue((self.seed.value() + 1) % SEED_LIMIT))

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

    def _change_stop(self) -> None:
        self._show_amount()
        self._announce("stop_at")

    def _show_amount(self) -> None:
        for key, slider in self._amounts.items():
            slider.setVisible(key == self.stop_at.value())
        self.enough.setVisible(self.stop_at.value() == "facets")

    def _change_method(self) -> None:
        self._show_settings()
        self._announce("method", "settings")

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


def _amount(spec: NumberSpec, name: str) -> NumberSlider:
    slider = NumberSlider(spec)
    slider.slider.setObjectName(f"{name}_slider")
    slider.field.setObjectName(name)
    return slider


def _share(percent: float) -> float:
    """A percentage as a fraction, rounded so that it has a short decimal form."""
    return round(percent / 100.0, 9)


def _seed_field() -> QSpinBox:
    field = QSpinBox()
    field.setObjectName("seed")
    field.setAccessibleName(tr("Seed"))
    field.setToolTip(tr("Seed of the random numbers: the same seed gives the same polyhedron."))
    field.setRange(0, SEED_LIMIT)
    field.setKeyboardTracking(False)
    return field
