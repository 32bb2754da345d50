"""A slider and a field that always agree."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from regolith_studio.ui.widgets.fields import NumberSlider, NumberSpec

WHOLE = NumberSpec("n", "Number", 4, 60, limit=200)
BROKEN = NumberSpec("w", "Weight", 0.0, 2.0, 0.05, limit=100.0)


@pytest.fixture
def heard():
    return []


@pytest.mark.parametrize(("spec", "value"), [(WHOLE, 37), (WHOLE, 150), (BROKEN, 0.35), (BROKEN, 12.5)])
def test_that_a_written_value_is_read_back_and_announces_nothing(shown, spec, value, heard):
    slider = shown(NumberSlider(spec))
    slider.valueChanged.connect(heard.append)
    slider.setValue(value)
    assert slider.value() == pytest.approx(value)
    assert slider.slider.value() == min(round(value / spec.step), slider.slider.maximum())
    QTest.qWait(60)
    assert heard == []


def test_that_dragging_announces_some_values_and_always_the_last(shown, wait, heard):
    slider = shown(NumberSlider(WHOLE))
    slider.valueChanged.connect(heard.append)
    for position in range(5, 55):
        slider.slider.setValue(position)
        QTest.qWait(2)
    wait(lambda: heard and heard[-1] == 54)
    assert len(heard) < 25


def test_that_the_arrow_keys_move_it_by_one(shown, wait, heard):
    slider = shown(NumberSlider(WHOLE))
    slider.setValue(20)
    slider.valueChanged.connect(heard.append)
    QTest.keyClick(slider.slider, Qt.Key.Key_Right)
    wait(lambda: heard == [21])
    assert slider.field.value() == 21


def test_that_a_typed_number_beyond_the_slider_is_taken(shown, heard):
    slider = shown(NumberSlider(WHOLE))
    done = []
    slider.valueChanged.connect(heard.append)
    slider.editingFinished.connect(lambda: done.append(True))
    slider.field.selectAll()
    QTest.keyClicks(slider.field, "120")
    QTest.keyClick(slider.field, Qt.Key.Key_Return)
    assert heard == [120]
    assert done
    assert slider.slider.value() == 60


def test_that_letting_go_announces_at_once(shown, heard):
    slider = shown(NumberSlider(BROKEN))
    slider.valueChanged.connect(heard.append)
    slider.slider.setSliderDown(True)
    slider.slider.setValue(10)
    slider.slider.setSliderDown(False)
    assert heard == [pytest.approx(0.5)]
