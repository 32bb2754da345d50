"""Presets: the shipped ones, a mark where values have moved, the way back, and those that a user saves."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QInputDialog, QLineEdit

from regolith_studio.coarsening.weights import LossWeights, presets
from regolith_studio.dataset.parameters import ContactParameters
from regolith_studio.errors import InputError
from regolith_studio.session.preferences import UserPresets
from regolith_studio.session.recipe import Recipe
from regolith_studio.ui.pages.explore.panels import LossPanel
from regolith_studio.ui.widgets.fields import text_room
from regolith_studio.ui.widgets.presets import PresetBar, PresetEntry, PresetForm

MINE = LossWeights.of(volume=0.5, sphericity=1.25, jaccard_distance=7.0)


pytestmark = pytest.mark.usefixtures("preferences")


@pytest.fixture
def panel(shown):
    return shown(LossPanel())


def labels(box):
    return [box.itemText(row) for row in range(box.count())]


def take(box, label):
    box.setCurrentIndex(box.findText(label))
    box.activated.emit(box.currentIndex())


def test_that_own_weights_are_saved_by_name_and_there_in_the_next_window(panel, shown):
    panel.setValue({"weights": MINE, "preset": "all"})
    assert panel.preset.currentText().endswith("(modified)")
    panel.bar.save.trigger()
    dialog = panel.findChild(QInputDialog, "preset_name")
    line = dialog.findChild(QLineEdit)
    QTest.keyClicks(line, "Mare")
    QTest.keyClick(line, Qt.Key.Key_Return)
    assert panel.preset.currentText() == "Mare"
    assert not panel.reset.isEnabled()
    again, heard = shown(LossPanel()), []
    again.valueChanged.connect(heard.append)
    again.setValue({"weights": presets()["all"].weights, "preset": "all"})
    take(again.preset, "Mare")
    assert heard == [{"weights": MINE, "preset": "all"}]


def test_that_an_own_preset_is_marked_when_a_weight_moves_and_reset_brings_it_back(panel, wait):
    panel.setValue({"weights": MINE, "preset": "all"})
    panel.save_as("Mare")
    heard = []
    panel.valueChanged.connect(heard.append)
    QTest.keyClick(panel.sliders["volume"].slider, Qt.Key.Key_Right)
    wait(lambda: heard)
    panel.setValue({"weights": heard[-1]["weights"], "preset": "all"})  # as the session answers
    assert panel.preset.currentText() == "Mare (modified)"
    QTest.mouseClick(panel.reset, Qt.MouseButton.LeftButton)
    assert heard[-1] == {"weights": MINE, "preset": "all"}
    assert panel.preset.currentText() == "Mare"
    panel.setValue({"weights": presets()["all"].weights, "preset": "all"})  # undone
    assert panel.preset.currentText() == presets()["all"].label
    panel.setValue({"weights": presets()["hull"].weights, "preset": "hull"})
    assert panel.preset.currentText() == presets()["hull"].label
    assert not panel.bar.delete.isEnabled()


def test_that_an_own_preset_can_be_deleted_and_the_shipped_ones_cannot(panel):
    panel.setValue({"weights": MINE, "preset": "all"})
    panel.save_as("Mare")
    assert panel.bar.delete.isEnabled()
    panel.bar.delete.trigger()
    assert labels(panel.preset) == [
        each.label + (" (modified)" if key == "all" else "")
        for key, each in presets().items()
        if key != "quadric"
    ]
    assert panel.value()["weights"] == MINE
    assert not panel.bar.delete.isEnabled()


def test_that_a_recipe_needs_nobodys_own_presets(panel):
    from regolith_studio.session.choices import Choices

    panel.setValue({"weights": MINE, "preset": "all"})
    panel.save_as("Mare")
    recipe = Recipe.from_choices(Choices().replaced(**panel.value()), ["sample:all"])
    assert recipe.preset == "all"
    assert recipe.choices().weights == MINE


def test_that_damaged_and_foreign_presets_are_left_out(shown):
    store = UserPresets("weights")
    store.save("good", {"preset": "all", "weights": {"volume": 2.0}})
    store.save("bad", {"preset": "all", "weights": {"colour": 2.0}})
    store.save("worse", {"weights": 3})
    assert "good" in labels(shown(LossPanel()).preset)
    assert not {"bad", "worse"} & set(labels(shown(LossPanel()).preset))
    store.path.write_text("{")
    assert store.all() == {}


def test_that_a_preset_without_a_name_is_refused(panel):
    with pytest.raises(InputError, match="needs a name"):
        panel.save_as("")
    with pytest.raises(InputError, match="40 characters"):
        panel.save_as("x" * 41)


def test_that_materials_have_the_papers_preset_and_own_ones(shown):
    form, heard = shown(PresetForm(ContactParameters, "contact", "Table 1")), []
    form.valueChanged.connect(lambda: heard.append(form.value()))
    assert form.bar.current() == "paper"
    assert not form.is_modified()
    form.restore({"restitution": 0.25})
    assert form.bar.box.currentText() == "Table 1 (modified)"
    form.save_as("Glass")
    other = shown(PresetForm(ContactParameters, "export", "Table 1"))
    take(other.bar.box, "Glass")
    assert other.value() == ContactParameters(restitution=0.25)
    take(form.bar.box, "Table 1")
    assert heard[-1] == ContactParameters()
    form.delete("own:Glass")
    assert labels(form.bar.box) == ["Table 1"]


def test_that_a_preset_with_little_room_still_shows_that_it_was_modified(shown, app):
    """The same dots are drawn behind letters that have room for all of it."""
    bar = PresetBar("test", "Preset")
    bar.set_entries([PresetEntry("one", "All descriptors and the overlap of both bodies")])
    bar.show_state("one", True)
    bar.resize(200, 70)
    shown(bar)
    app.processEvents()
    room = text_room(bar.box)
    shortened = bar.box.fontMetrics().elidedText(bar.box.currentText(), Qt.TextElideMode.ElideMiddle, room)
    assert shortened.endswith("ified)")
    assert "…" in shortened
    drawn = bar.box.grab().toImage()
    bar.set_entries([PresetEntry("one", shortened)])
    assert bar.box.grab().toImage() == drawn
