"""Qt must not lose references, nor call what is gone.

Some versions of PySide6 abort the interpreter after 5,000 calls that lose one.
"""

import ast
import sys
from pathlib import Path

from PySide6.QtCore import QEvent, QObject, QTimer, Signal
from PySide6.QtWidgets import QLabel, QSlider

import regolith_studio.ui


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


def test_that_a_delayed_call_ends_with_the_widget_that_it_is_about(app, shown):
    called, label = [], QLabel(shown(QLabel()))
    QTimer.singleShot(0, label, lambda: called.append(label))
    label.deleteLater()
    app.sendPostedEvents(label, QEvent.Type.DeferredDelete)
    app.processEvents()
    assert called == []


def test_that_delayed_calls_of_the_window_name_what_they_are_about():
    for path in Path(regolith_studio.ui.__path__[0]).rglob("*.py"):
        calls = [node for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.Call)]
        delayed = [each for each in calls if getattr(each.func, "attr", "") == "singleShot"]
        without = [ast.unparse(each) for each in delayed if len(each.args) < 3]
        assert without in ([], ["QTimer.singleShot(0, app.quit)"]), path
