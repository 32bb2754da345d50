"""Panels beside the views: harmonic fit, coarsening, loss, and the result in one sentence."""

import math
from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from PySide6.QtCore import QEvent, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QFormLayout,
    QGridLayout,
    QPushButton,
    QSizePolicy,
    QSpinBox,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.progress import CoarseningProgress
from regolith_studio.coarsening.reasons import kept_sentence
from regolith_studio.coarsening.settings import CoarseningSettings
from regolith_studio.coarsening.weights import JACCARD, WEIGHT_KEYS, LossWeights, Preset, presets
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.errors import InputError
from regolith_studio.harmonics.fit_options import FitOptions, FitSurfaceSettings
from regolith_studio.messages import N_
from regolith_studio.session.assessment import PolyhedronAssessment, assess_polyhedron, assess_step
from regolith_studio.session.choices import Choices
from regolith_studio.session.preferences import UserPresets
from regolith_studio.session.results import Results
from regolith_studio.ui.layout import Collapsible, hbox, named, vbox
from regolith_studio.ui.result_card import ResultRecord, ResultState, ResultView
from regolith_studio.ui.theme import Theme, current_theme, icon
from regolith_studio.ui.translation import inert, number_text, tr, translate
from regolith_studio.ui.widgets.fields import ChoiceBox, NumberSlider, NumberSpec, align_labels
from regolith_studio.ui.widgets.forms import LARGEST_NUMBER, SettingsForm
from regolith_studio.ui.widgets.labels import (
    NOTE_LINES,
    FixedHeightText,
    heading,
    hint_label,
    rich_symbol,
    with_subscripts,
)
from regolith_studio.ui.widgets.presets import PresetBar, PresetEntry
from regolith_studio.ui.widgets.table import definition

DIGITS_OF_NAME = 19
"""Width of most names of methods and presets in digits."""


class FitPanel(QWidget):
    """Edits l_max and the options of the fit."""

    FIELDS = ("l_max", *(each.name for each in fields(FitOptions)))
    valueChanged = Signal(dict)  # noqa: N815
    editingFinished = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("fit")
        self._degree = SettingsForm(FitSurfaceSettings, None, ("l_max",), "")
        self._ways = SettingsForm(FitOptions, prefix="")
        self.l_max: NumberSlider = self._degree.editors["l_max"]
        self.ways = self._ways.editors
        self._ways.rows.setContentsMargins(14, 0, 0, 0)
        self.more = Collapsible(tr("Radius function"), self._ways)
        self.more.button.setObjectName("radius_settings")
        self.findings = hint_label()
        self.warnings = hint_label(role="warning")
        vbox(
            heading(tr("Spherical-harmonics fit")),
            self._degree,
            self.more,
            FixedHeightText((self.warnings, self.findings), 5, NOTE_LINES),
            parent=self,
        )
        self.set_findings(None)
        for form in (self._degree, self._ways):
            form.edited.connect(self.valueChanged)
            form.editingFinished.connect(self.editingFinished)

    def value(self) -> dict[str, Any]:
        return self._degree.values() | self._ways.values()

    def setValue(self, value: Mapping[str, Any]) -> None:
        self._degree.setValue(value)
        self._ways.setValue(value)

    def set_findings(self, fit: Any | None, check: str = "") -> None:
        """Show what the radius function of a ``HarmonicFit`` cannot represent, and what a check found."""
        if fit is None:
            self.findings.setText(tr("Not fitted yet."))
            self.findings.show()
            self.warnings.hide()
            return
        warnings = [each for each in (check, *fit.warnings) if each]
        self.findings.setVisible(not warnings)
        if fit.star_shaped:
            self.findings.setText(tr("Star-shaped: no part of the surface is hidden from the star point."))
        else:
            self.findings.setText(
                tr(
                    "{surface:.2%} of the surface is hidden from the star point; "
                    "{volume:.2%} of the volume cannot be represented.",
                    surface=fit.hidden_surface_share,
                    volume=fit.unrepresentable_volume_share,
                )
            )
        words = with_subscripts(" ".join(map(translate, warnings)))
        self.warnings.setText(words)
        self.warnings.setToolTip(inert(words))
        self.warnings.setVisible(bool(warnings))


OWN = "own:"
"""Prefix of the keys of own presets."""
SLIDER_END = 2.0
LARGEST = 100.0


def weight_spec(key: str) -> NumberSpec:
    """Label, range and tool tip of the weight of a term."""
    if key == JACCARD:
        label, name, tip = "Jaccard", tr("Jaccard distance"), definition(key)
    else:
        row = CATALOGUE[key]
        label, name = rich_symbol(row.symbol), tr(row.label)
        tip = tr("Relative error (Eq. 8) of {definition}", definition=definition(key))
    words = tr("Weight of {name}", name=name)
    return NumberSpec(label, words, 0.0, SLIDER_END, 0.05, limit=LARGEST, tip=tip)


def lock_of(key: str) -> QToolButton:
    """The button that keeps a descriptor exactly."""
    name = tr(CATALOGUE[key].label)
    lock = named(
        QToolButton(),
        f"keep_{key}",
        tr("Keep {name} exactly", name=name),
        tip=tr("Keep {name} exactly. Without, an error costs its weight; only exact methods can.", name=name),
    )
    lock.setText("=")
    lock.setCheckable(True)
    lock.setAutoRaise(True)
    lock.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Ignored)  # as high as its slider
    return lock


class LossPanel(QWidget):
    """Edits the weights, which descriptors are kept exactly, and the shipped preset that they come from.

    An own preset is a set of weights with the shipped preset that it is derived from. The rest of the program
    sees that preset with modified weights, so that recipes and projects do not depend on own presets.
    """

    FIELDS = ("weights", "preset")
    valueChanged = Signal(dict)  # noqa: N815
    editingFinished = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("loss")
        self._own = UserPresets("weights")
        losses = (key for key, each in presets().items() if not each.weights.all_zero)
        self._preset = self._chosen = next(losses)
        self._known: dict[str, Preset] = {}
        self._keep: frozenset[str] | None = None
        self.bar = PresetBar("preset", tr("Preset of weights"), heading(tr("Weights of the loss (Eq. 9)")))
        self.preset, self.reset = self.bar.box, self.bar.reset
        self.preset.setMinimumContentsLength(DIGITS_OF_NAME)
        self.reset.setObjectName("reset_weights")
        self.sliders = {key: NumberSlider(weight_spec(key)) for key in WEIGHT_KEYS}
        self.locks = {key: lock_of(key) for key in LOSS_KEYS}
        self._keeps_terms = True
        self.origin = hint_label()
        self._arrange()
        self._connect()
        self._list()
        self._show_mark()

    def value(self) -> dict[str, Any]:
        weights = LossWeights.of(**{key: float(each.value()) for key, each in self.sliders.items()})
        return {"weights": weights.keeping(self._keep), "preset": self._preset}

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Show other weights without emitting a signal."""
        for key, slider in self.sliders.items():
            slider.setValue(value["weights"][key])
        self._keep = value["weights"].keep
        self._preset = value["preset"]
        if self.bar.box.findData(self._preset) < 0:
            self._list()
        self._chosen = self._source(value["weights"])
        self._show_mark()

    def set_keeps_terms(self, able: bool) -> None:
        """Whether the method can keep descriptors exactly, or knows their weights only."""
        self._keeps_terms = able
        for lock in self.locks.values():
            lock.setEnabled(able)
        self._show_mark()

    def is_modified(self) -> bool:
        """Whether the weights differ from those of the selected preset."""
        return bool(self.value()["weights"] != self._known[self._chosen].weights)

    def save_as(self, name: str) -> None:
        now = self.value()
        self._own.save(name, {"preset": now["preset"], "weights": dict(now["weights"])})
        self._list()
        self._chosen = OWN + name
        self._show_mark()

    def delete(self, key: str) -> None:
        """Delete an own preset; the weights stay."""
        self._own.remove(key.removeprefix(OWN))
        self._list()
        self._chosen = self._source(self.value()["weights"])
        self._show_mark()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            align_labels(self.sliders.values())

    def _list(self) -> None:
        found = dict(presets())
        for name, values in self._own.all().items():
            try:
                weights = LossWeights.of(**values["weights"])
            except (InputError, KeyError, TypeError, ValueError):
                continue  # of another version, or edited by hand
            if values.get("preset") in presets():
                found[OWN + name] = Preset(values["preset"], name, weights, N_("Own preset"))
        self._known = found
        self.bar.set_entries(
            [
                PresetEntry(key, each.label if key.startswith(OWN) else tr(each.label), tr(each.origin), own)
                for key, each in found.items()
                for own in (key.startswith(OWN),)
                if not each.weights.all_zero or key == self._preset  # a method without a loss
            ]
        )

    def _source(self, weights: LossWeights) -> str:
        """Key of the preset with these weights, or else of the one that was selected last."""
        known = self._known
        now = [key for key, each in known.items() if each.name == self._preset and each.weights == weights]
        if self._chosen in now or (not now and self._chosen in known):
            return self._chosen if known[self._chosen].name == self._preset else self._preset
        return now[0] if now else self._preset

    def _arrange(self) -> None:
        grid = QGridLayout()
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setVerticalSpacing(3)
        for row, (key, slider) in enumerate(self.sliders.items()):
            slider.slider.setObjectName(f"weight_{key}_slider")
            slider.field.setObjectName(f"weight_{key}")
            grid.addWidget(slider, row, 0)
            if key in self.locks:
                grid.addWidget(self.locks[key], row, 1)
        align_labels(self.sliders.values())
        vbox(self.bar, grid, FixedHeightText((self.origin,)), parent=self)

    def _connect(self) -> None:
        self.bar.chosen.connect(self._take)
        self.bar.resetRequested.connect(lambda: self._take(self._chosen))
        self.bar.saveRequested.connect(self.save_as)
        self.bar.deleteRequested.connect(self.delete)
        for slider in self.sliders.values():
            slider.valueChanged.connect(self._announce)
            slider.editingFinished.connect(self.editingFinished)
        for lock in self.locks.values():
            lock.clicked.connect(self._take_locks)

    def _take(self, key: str) -> None:
        preset = self._known[key]
        self._chosen = key
        self.setValue({"weights": preset.weights, "preset": preset.name})
        self.valueChanged.emit(self.value())
        self.editingFinished.emit()

    def _take_locks(self) -> None:
        locked = frozenset(key for key, lock in self.locks.items() if lock.isChecked())
        usual = self.value()["weights"].keeping(None).kept
        self._keep = None if locked == usual else locked
        self._announce()
        self.editingFinished.emit()

    def _announce(self) -> None:
        self._show_mark()
        self.valueChanged.emit({"weights": self.value()["weights"]})

    def _show_mark(self) -> None:
        self.bar.show_state(self._chosen, self.is_modified())
        preset = self._known[self._chosen]
        own = self._chosen.startswith(OWN)
        origin = (
            tr("Changed from {preset}.", preset=preset.label if own else tr(preset.label))
            if self.is_modified()
            else tr(preset.origin) + "."
        )
        weights = self.value()["weights"]
        self.origin.setText(origin)
        self.origin.setToolTip(inert(translate(kept_sentence(weights))) if self._keeps_terms else "")
        for key, lock in self.locks.items():
            lock.setChecked(self._keeps_terms and key in weights.kept)


class AssessmentPanel(ResultView):
    """The result of the page Explore; dimmed while the polyhedron is being replaced."""

    def __init__(self) -> None:
        super().__init__("assessment", (tr("Loss"), "RMSRE", tr("Jaccard distance")))
        tips = (
            tr("Weighted sum of the Jaccard distance and the relative errors (Eq. 9)"),
            tr("Root mean squared relative error over the descriptors that have a weight (Eq. 10)"),
            tr("1 - shared volume / united volume (Eq. 7)"),
        )
        for place, tip in enumerate(tips):
            self.caption(place, self.captions[place].text(), tip)
        self._shown: PolyhedronAssessment | None = None
        self._particle = ""

    def show_results(self, results: Results, choices: Choices) -> None:
        """Show the assessment on the finished polyhedron."""
        done = results.coarsened
        if done is not None:
            self._particle = choices.selected
            self._shown = assess_polyhedron(
                done, choices.weights, results.against_particle, results.fewer_facets
            )
        elif results.best is None or choices.selected != self._particle:
            self._particle, self._shown = choices.selected, None
        elif isinstance(results.best, CoarseningProgress):
            self._shown = assess_step(results.best, choices.weights) or self._shown
        found = self._shown
        if found is None:
            why = translate(results.failures.get("coarsening", ""))
            state = ResultState.FAILED if why else ResultState.NONE
            missing = (
                tr("The polyhedron is not finished yet.")
                if choices.selected
                else tr("Open a particle first.")
            )
            note = why or missing
            self.show_record(ResultRecord(state=state, note=note))
            return
        shares = ((found.rmsre, ".2%"), (found.jaccard_distance, ".1%"))
        figures = (
            number_text(found.loss, "#.4g"),
            *("–" if math.isnan(share) else number_text(share, form) for share, form in shares),
        )
        state = ResultState.NONE if done is None else ResultState.CURRENT
        self.show_record(ResultRecord(figures, state=state, note=translate(found.sentence)))


AMOUNTS = {
    "facets": "n_facets",
    "triangles": "n_triangles",
    "vertices": "n_vertices",
    "error": "largest_error",
}
"""Setting of each stopping criterion."""
NOTES, LEAST_NOTES = 5, 1
"""Lines for what the result says, whole where one descriptor is missed; and in low windows."""


class OutcomeNote(FixedHeightText):
    """Why a request could not be met, or what meeting it costs; below the controls, which stay in place."""

    def __init__(self) -> None:
        self.words = hint_label(role="warning")
        super().__init__((self.words,), NOTES, LEAST_NOTES)

    def set_sentence(self, sentence: str | None) -> None:
        words = translate(sentence) if sentence else ""
        self.words.setText(words)
        self.words.setToolTip(inert(words))


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
        self._found = FixedHeightText((self.finding,), NOTE_LINES, LEAST_NOTES)
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

    def show_search(self, *, running: bool) -> None:
        """Offer to search the number of facets from which on nothing is gained."""
        self._sufficient = 0
        self.enough.setText(tr("Suggest n"))
        self.enough.setToolTip("")
        self.enough.setEnabled(not running)
        idle = tr("Coarsens this particle at several numbers of facets.")
        self.finding.setText(tr("Searching …") if running else idle)

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
        self.finding.setText(found)
        self.enough.setText(tr("Use {count} facets", count=count))
        self.enough.setToolTip(reason)
        self.enough.setEnabled(now != count)

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
            self._found,
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
        self._found.setVisible(by_number)

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
