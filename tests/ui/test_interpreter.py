"""Qt must not lose references: some versions of PySide6 abort the interpreter after 5,000 calls."""

import sys

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QLabel, QSlider


class _Emitter(QObject):
    said = Signal(object)


def test_that_thousands_of_calls_lose_no_reference_to_none(app, shown):
    label, slider, emitter = shown(QLabel()), shown(QSlider()), _Emitter()
    emitter.said.connect(label.setText)
    before = sys.getrefcount(None)
    for number in range(4000):
        label.setText(str(number))
        slider.setValue(number % 100)
        emitter.said.emit(str(number))
    app.processEvents()
    assert abs(sys.getrefcount(None) - before) < 200
