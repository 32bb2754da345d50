"""The weights of the loss (Eq. 9): one slider and number field a term, presets with a modified mark."""

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import QComboBox, QGridLayout, QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from regolith_studio.coarsening.weights import JACCARD, WEIGHT_KEYS, LossWeights, presets
from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.ui.widgets.labels import heading, remark, rich_symbol
from regolith_studio.ui.widgets.number_slider import NumberSlider, NumberSpec

SLIDER_END = 2.0
LARGEST = 100.0


def weight_spec(key: str) -> NumberSpec:
    """The slider of one term; the catalogue knows its symbol and formula."""
    if key == JACCARD:
        label, name, formula = "Jaccard", "Jaccard distance", "Jaccard distance, Eq. 7 (paper: IoU)"
    else:
        row = CATALOGUE[key]
        label, name = rich_symbol(row.symbol), row.label
        formula = f"Relative error of {row.symbol}, Eq. 8: {row.label.lower()}, {row.formula}"
    return NumberSpec(label, f"Weight of {name}", 0.0, SLIDER_END, 0.05, limit=LARGEST, tip=formula)


class LossPanel(QWidget):
    """Edits the weights, and the preset that they come from."""

    FIELDS = ("weights", "preset")
    valueChanged = Signal(dict)  # noqa: N815
    editingFinished = Signal()  # noqa: N815

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("loss")
        self.preset = QComboBox()
        self.preset.setObjectName("preset")
        self.preset.setAccessibleName("Preset of weights")
        self.preset.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.preset.setMinimumContentsLength(12)
        for name, preset in presets().items():
            self.preset.addItem(preset.label, name)
            self.preset.setItemData(self.preset.count() - 1, preset.origin, 3)
        self.reset = QPushButton("Reset")
        self.reset.setObjectName("reset_weights")
        self.reset.setToolTip("Back to the weights of the preset")
        self.sliders = {key: NumberSlider(weight_spec(key)) for key in WEIGHT_KEYS}
        self.origin = remark()
        self._arrange()
        self._connect()
        self._show_mark()

    def value(self) -> dict[str, Any]:
        """Weights and preset."""
        weights = LossWeights.of(**{key: float(each.value()) for key, each in self.sliders.items()})
        return {"weights": weights, "preset": self.preset.currentData()}

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Show other weights."""
        for key, slider in self.sliders.items():
            slider.setValue(value["weights"][key])
        with QSignalBlocker(self.preset):
            self.preset.setCurrentIndex(self.preset.findData(value["preset"]))
        self._show_mark()

    def is_modified(self) -> bool:
        """Whether the weights are no longer those of the preset."""
        now = self.value()
        return bool(now["weights"] != presets()[now["preset"]].weights)

    def _arrange(self) -> None:
        top = QHBoxLayout()
        top.addWidget(self.preset, 1)
        top.addWidget(self.reset)
        grid = QGridLayout()
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setVerticalSpacing(3)
        widest = max(each.label.sizeHint().width() for each in self.sliders.values())
        for row, (key, slider) in enumerate(self.sliders.items()):
            slider.slider.setObjectName(f"weight_{key}_slider")
            slider.field.setObjectName(f"weight_{key}")
            slider.label.setFixedWidth(widest)
            grid.addWidget(slider, row, 0)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(heading("Weights of the loss (Eq. 9)"))
        layout.addLayout(top)
        layout.addLayout(grid)
        layout.addWidget(self.origin)

    def _connect(self) -> None:
        self.preset.activated.connect(self._take_preset)
        self.reset.clicked.connect(self._take_preset)
        for slider in self.sliders.values():
            slider.valueChanged.connect(self._announce)
            slider.editingFinished.connect(self.editingFinished)

    def _take_preset(self) -> None:
        name = self.preset.currentData()
        self.setValue({"weights": presets()[name].weights, "preset": name})
        self.valueChanged.emit(self.value())
        self.editingFinished.emit()

    def _announce(self) -> None:
        self._show_mark()
        self.valueChanged.emit({"weights": self.value()["weights"]})

    def _show_mark(self) -> None:
        modified = self.is_modified()
        for row in range(self.preset.count()):
            label = presets()[self.preset.itemData(row)].label
            mark = " (modified)" if modified and row == self.preset.currentIndex() else ""
            self.preset.setItemText(row, label + mark)
        self.reset.setEnabled(modified)
        self.origin.setText(presets()[self.preset.currentData()].origin + ".")
