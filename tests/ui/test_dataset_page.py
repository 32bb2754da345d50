"""The page "Dataset": from open particles to scripts for DEM programs."""

import json

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QDesktopServices, QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog, QMessageBox, QPushButton

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.export import ExportResult
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.folder_io import read_dataset, write_dataset
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.session.recipe import Exports, Recipe, Representatives, read_recipe
from regolith_studio.session.run_recipe import run_recipe
from regolith_studio.ui.dialogs.files import FolderDialog
from regolith_studio.ui.pages.dataset import PAGE
from regolith_studio.ui.pages.dataset.export_panel import groups
from regolith_studio.ui.pages.dataset.views import GalleryItem, RepresentativesGallery
from regolith_studio.ui.result_card import ResultState
from regolith_studio.ui.theme import choose_font_size
from regolith_studio.ui.widgets.thumbnails import thumbnail
from tests.dataset.example import elbow_entry, entry


def grains(count=8, first=0):
    """Three kinds of ellipsoids in many sizes."""
    made = []
    for index in range(first, first + count):
        axes = ((1.0, 1.1, 1.3), (1.0, 1.6, 2.4), (0.5, 1.5, 1.6))[index % 3]
        mesh = icosphere(2).moved(rotation=np.diag(axes), scale=20.0 + 3 * index)
        made.append(Particle(f"grain-{index}", mesh))
    return made


@pytest.fixture
def page(page_of):
    made = page_of(PAGE, 1300, 900)
    made.session.choose(method="quadric", target="particle")
    return made


@pytest.fixture
def chosen(page, wait):
    """The page with representatives of eight grains."""
    page.session.adopt(grains())
    wait(lambda: page.representatives.start.isEnabled())
    page.representatives.count.setValue(3)
    QTest.mouseClick(page.representatives.start, Qt.MouseButton.LeftButton)
    wait(lambda: len(page.gallery.shown) == 3)
    return page


def slide(panel, value):
    """Move a slider as a user does."""
    panel.slider.setValue(value)
    QTest.qWait(80)


def test_that_the_button_of_the_export_is_seen_on_a_small_screen_without_scrolling(page, shown):
    page.resize(1160, 700)
    shown(page)
    button = page.targets.export
    assert button.visibleRegion().boundingRect() == button.rect()


def test_that_names_of_formats_are_whole_in_german_in_a_larger_font(page_of, speaking, app):
    speaking("de")
    choose_font_size(150)
    try:
        page = page_of(PAGE, 1900, 1000)
        app.processEvents()
        short = [box.text() for box in page.targets.boxes.values() if box.width() < box.sizeHint().width()]
    finally:
        choose_font_size(None)
    assert short == []


def test_that_a_new_user_gets_to_a_rocky_script_and_a_yade_run(chosen, wait, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(FolderDialog, "ask", lambda *_: str(tmp_path))
    chosen.folder.name.setText("my regolith/1")
    QTest.mouseClick(chosen.targets.export, Qt.MouseButton.LeftButton)
    folder = tmp_path / "my_regolith_1"
    wait(lambda: chosen._dataset is not None)
    assert validate_dataset(folder) == []
    assert len(read_dataset(folder)) == 3
    assert all(one.coarsened for one in chosen.gallery.shown)
    assert chosen.targets.chosen() == ("rocky", "yade")
    QTest.mouseClick(chosen.targets.export, Qt.MouseButton.LeftButton)
    wait(lambda: len(chosen.exports.exports) == 2)
    assert (tmp_path / "rocky" / "rocky_case.py").exists()
    assert (tmp_path / "yade" / "particles.csv").exists()
    copy = chosen.exports.findChild(QPushButton, "dataset_copy_yade")
    QTest.mouseClick(copy, Qt.MouseButton.LeftButton)
    assert QGuiApplication.clipboard().text() == f"yade -j1 {tmp_path / 'yade'}/yade_case.py"
    assert chosen.session.dataset_folder == folder
    origin = "8 particles, Quadric decimation, n = 20, target: particle, seed 0"
    assert chosen.result.sentence.text().startswith(origin)
    opened = []
    monkeypatch.setattr(QDesktopServices, "openUrl", lambda url: opened.append(url.toLocalFile()))
    assert chosen.result.button.text() == "Open the folder"
    chosen.result.button.click()
    assert opened == [str(tmp_path)]


@pytest.mark.slow
def test_that_building_finds_the_representatives_first(page, wait, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(FolderDialog, "ask", lambda *_: str(tmp_path))
    page.session.adopt(grains())
    wait(lambda: page.targets.export.isEnabled())
    page.representatives.count.setValue(3)
    page.sizes.set_text("classes:abc, -5")
    assert not page.targets.export.isEnabled()
    page.sizes.set_text("measured")
    cards, show = [], page.result.show_record
    monkeypatch.setattr(
        page.result, "show_record", lambda record: cards.append((show(record), page.result.record.state))
    )
    QTest.mouseClick(page.targets.export, Qt.MouseButton.LeftButton)
    assert cards[0] == (None, ResultState.RUNNING)
    wait(lambda: page._dataset is not None)
    assert len(read_dataset(tmp_path / "regolith")) == 3
    QTest.mouseClick(page.representatives.start, Qt.MouseButton.LeftButton)
    wait(lambda: not all(one.coarsened for one in page.gallery.shown))
    assert not list((tmp_path / "regolith").glob("*.tmp")), "finding them again builds nothing"


def test_that_the_curve_falls_and_the_slider_chooses_among_its_points(chosen, wait) -> None:
    means = [point.mean for point in chosen.quality.points]
    assert len(means) == 7
    assert means[-1] < means[0]
    slide(chosen.representatives.count, 5)
    wait(lambda: len(chosen.gallery.shown) == 5)
    slide(chosen.representatives.count, 7)
    wait(lambda: len(chosen.gallery.shown) == 7)
    shares = [float(one.caption.split()[0]) for one in chosen.gallery.shown]
    assert sum(shares) == pytest.approx(100, abs=0.5)
    assert shares == sorted(shares, reverse=True)
    assert chosen.representatives.count.slider.maximum() == 8
    listed = [chosen.gallery.list.item(row) for row in range(7)]
    wait(lambda: not any(item.icon().isNull() for item in listed))


def test_that_captions_of_representatives_are_whole_in_a_larger_font_too(shown) -> None:
    gallery = RepresentativesGallery()
    shown(gallery)
    words = "16,7 %, 20 Facetten\nagglutinate-1"
    gallery.show_shapes("one", [GalleryItem(icosphere(0), words, "")])
    for points in (9, 18, 27):
        font = gallery.font()
        font.setPointSize(points)
        gallery.setFont(font)
        cell, metrics = gallery.list.visualItemRect(gallery.list.item(0)), gallery.list.fontMetrics()
        assert metrics.size(0, words).width() + 8 <= cell.width()
        assert gallery.list.iconSize().height() + metrics.size(0, words).height() + 8 <= cell.height()
    gallery.release()


def test_that_sizes_are_drawn_as_they_are_typed_and_nonsense_is_explained(chosen, wait) -> None:
    sizes = chosen.sizes
    sizes.kind.setCurrentIndex(sizes.kind.findData("log-normal"))
    wait(lambda: chosen.distribution.classes[0].sizes.type == "log-normal")
    sizes.numbers.selectAll()
    QTest.keyClicks(sizes.numbers, "80,0.2")
    assert chosen.distribution.classes[0].sizes.median_um == 80.0
    named = [curve.label for curve in chosen.distribution.curves if curve.label]
    assert named == ["each class", "all classes, weighted by number"]
    QTest.keyClicks(sizes.numbers, "x")
    assert sizes.problem.isVisibleTo(chosen)
    assert "Numbers must be separated by commas" in sizes.problem.text()
    assert chosen.distribution.is_empty()


def test_that_shapes_are_changed_only_with_a_second_tick(chosen, tmp_path, wait) -> None:
    chosen.build_in(tmp_path / "set")
    wait(lambda: chosen._dataset is not None)
    chosen.targets.boxes["rockable"].setChecked(True)
    assert not chosen.targets.export.isEnabled()
    assert EXPORTERS["rockable"].alters in chosen.targets.export.toolTip()
    assert EXPORTERS["rockable"].alters in chosen.losses.label.text()
    chosen.targets.lossy.setChecked(True)
    assert chosen.targets.export.isEnabled()
    chosen.targets.setValue({"targets": []})
    assert chosen.targets.export.isEnabled(), "the dataset alone"


def test_that_a_format_of_convex_particles_says_why_it_does_not_take_compounds(page, tmp_path) -> None:
    dataset = build_dataset([elbow_entry()], name="elbows")
    page._take_dataset(write_dataset(tmp_path / "set", dataset), dataset)
    page.targets.setValue({"targets": ["mujoco", "gltf"]})
    assert page.targets.export.isEnabled()
    page.targets.boxes["hoomd"].setChecked(True)
    assert not page.targets.export.isEnabled()
    assert "GSD" in page.targets.export.toolTip()
    assert "Not for compounds" in page.losses.label.text()
    assert "Not for compounds" in page.targets.boxes["hoomd"].toolTip()
    assert "Not for compounds" not in page.targets.boxes["mujoco"].toolTip()
    page.targets.setValue({"targets": ["lammps", "pfc"]})
    assert "cannot hold the compounds" in page.targets.export.toolTip(), "what no consent changes comes first"
    page.targets.boxes["lammps"].setChecked(False)
    assert "overlapping spheres" in page.targets.export.toolTip()
    page.targets.setValue({"targets": ["mujoco", "hoomd"]})
    assert page.gallery.shown[0].caption.endswith("%, 2 parts, 12 facets\n" + dataset.representatives[0].name)
    convex = build_dataset([entry(1)], name="convex")
    page._take_dataset(write_dataset(tmp_path / "other", convex), convex)
    assert page.targets.export.isEnabled()
    assert "parts" not in page.gallery.shown[0].caption


def test_that_compounds_are_refused_where_they_are_built_and_not_before(chosen, tmp_path, wait) -> None:
    chosen.targets.setValue({"targets": ["rocky", "hoomd"]})
    chosen.session.choose(method="compound")
    wait(lambda: "ompound" in chosen.folder.shapes.text())
    assert chosen.targets.export.isEnabled(), "its polyhedra may be convex"
    assert chosen.targets.recipe_part() is not None
    dataset = build_dataset([elbow_entry()], name="elbows")
    chosen._take_dataset(write_dataset(tmp_path / "set", dataset), dataset)
    assert not chosen.targets.export.isEnabled()
    chosen.export_to(tmp_path / "out")  # as after a build
    wait(lambda: chosen.result.record.state is ResultState.FAILED)
    assert "HOOMD-blue (shape JSON) cannot hold" in chosen.result.record.note
    assert chosen._dataset is dataset
    assert not (tmp_path / "out").exists()
    chosen.targets.boxes["hoomd"].setChecked(False)
    assert chosen.targets.export.isEnabled()


def test_that_the_rows_of_many_exports_are_as_high_as_their_buttons(page, tmp_path) -> None:
    page.exports.show_exports([ExportResult(key, tmp_path, (), "load it") for key in EXPORTERS])
    page._lower.setCurrentIndex(1)
    QApplication.processEvents()
    button = page.findChild(QPushButton, f"dataset_copy_{list(EXPORTERS)[-1]}")
    assert button.height() >= button.minimumSizeHint().height()


def test_that_settings_reach_the_exports(chosen, tmp_path, wait) -> None:
    chosen.build_in(tmp_path / "set")
    wait(lambda: chosen._dataset is not None)
    settings = {"targets": ["rocky"], "coarse_graining": 4, "contact": {"density": 2900.0}}
    chosen.targets.setValue(settings | {"test": {"lift_speed": 0.05}})
    chosen.export_to(tmp_path / "out")
    wait(lambda: len(chosen.exports.exports) == 1)
    case = json.loads((tmp_path / "out" / "rocky" / "case.json").read_text())
    assert case["coarse_graining_factor"] == 4.0
    assert case["contact"]["density"] == 2900.0
    assert case["contact"]["youngs_modulus"] == 30e9
    assert case["test"]["lift_speed"] == 0.05


def test_that_a_dataset_is_replaced_only_when_asked(chosen, tmp_path, wait, monkeypatch) -> None:
    monkeypatch.setattr(FolderDialog, "ask", lambda *_: str(tmp_path))
    chosen.export()
    wait(lambda: (tmp_path / "regolith" / "dataset.json").exists())
    before = (tmp_path / "regolith" / "dataset.json").read_bytes()
    slide(chosen.representatives.count, 5)
    monkeypatch.setattr(QMessageBox, "question", lambda *_: QMessageBox.StandardButton.No)
    chosen.export()
    assert (tmp_path / "regolith" / "dataset.json").read_bytes() == before
    monkeypatch.setattr(QMessageBox, "question", lambda *_: QMessageBox.StandardButton.Yes)
    chosen.export()
    wait(lambda: len(read_dataset(tmp_path / "regolith")) == 5)


@pytest.mark.slow
def test_that_a_dataset_can_be_opened_without_any_particle(page, chosen, tmp_path, wait) -> None:
    chosen.build_in(tmp_path / "set")
    wait(lambda: chosen._dataset is not None)
    page.session.adopt(grains(4, first=20))
    wait(lambda: not page.gallery.shown)
    page.open_folder(tmp_path / "set")
    wait(lambda: len(page.gallery.shown) == 3)
    assert "3 shapes" in page.gallery.title.text()
    page.validate()


def test_that_the_dataset_of_other_particles_is_neither_shown_nor_exported(chosen, tmp_path, wait) -> None:
    chosen.build_in(tmp_path / "set")
    wait(lambda: chosen._dataset is not None)
    chosen.export_to(tmp_path / "out")
    wait(lambda: len(chosen.exports.exports) == 2)
    chosen.sizes.set_text("log-normal:50,0.4")
    assert not chosen.result.figures[0].isEnabled(), "the dataset on the disk has other sizes"
    assert "other settings" in chosen.result.sentence.text()
    chosen.sizes.set_text("measured")
    assert chosen.result.figures[0].isEnabled()
    chosen.session.adopt(grains(5, first=30))
    wait(lambda: not chosen.gallery.shown)
    assert [each.text() for each in chosen.result.figures] == ["–", "–"]
    assert chosen.exports.exports == ()
    assert chosen._folder is None, "the next export builds a dataset of these particles"


def test_that_a_failed_export_keeps_the_earlier_ones(chosen, tmp_path, wait) -> None:
    chosen.build_in(tmp_path / "set")
    wait(lambda: chosen._dataset is not None)
    chosen.export_to(tmp_path / "out")
    wait(lambda: len(chosen.exports.exports) == 2)
    (tmp_path / "file").write_text("not a folder")
    chosen.export_to(tmp_path / "file")
    wait(lambda: chosen.result.record.state is ResultState.FAILED)
    assert [each.text() for each in chosen.result.figures] == ["3", "2"]
    assert not chosen.result.figures[1].isEnabled()
    assert "there is a file of that name" in chosen.result.sentence.text()
    assert chosen.result.sentence.text().startswith("Failed: earlier result, 8 particles")
    assert [one.folder.parent for one in chosen.exports.exports] == [tmp_path / "out"] * 2


def test_that_a_stopped_build_keeps_the_earlier_dataset(chosen, tmp_path, wait, monkeypatch) -> None:
    chosen.build_in(tmp_path / "set")
    wait(lambda: chosen._dataset is not None)
    chosen.sizes.set_text("log-normal:50,0.4")
    started = []
    monkeypatch.setattr(type(chosen._context), "start", lambda *_, **given: started.append(given))
    chosen.build_in(tmp_path / "other")
    assert chosen.result.record.state is ResultState.RUNNING
    started[0]["stopped"]()
    assert chosen.result.record.state is ResultState.STALE
    assert chosen.result.figures[0].text() == "3"
    assert str(tmp_path / "set") in chosen.result.sentence.text()


def test_that_a_project_lists_its_exports_again_where_they_are_unchanged(chosen, tmp_path, wait) -> None:
    chosen.build_in(tmp_path / "set")
    wait(lambda: chosen._dataset is not None)
    chosen.export_to(tmp_path / "out")
    wait(lambda: len(chosen.exports.exports) == 2)
    kept = json.loads(json.dumps(chosen.state()))
    commands = [one.load_command for one in chosen.exports.exports]
    chosen._forget_dataset()
    chosen.resume(kept)
    wait(lambda: chosen.result.figures[1].text() == "2")
    assert [one.load_command for one in chosen.exports.exports] == commands
    (tmp_path / "out" / "yade" / "export.json").write_text("{}")
    chosen._forget_dataset()
    chosen.resume(kept)
    wait(lambda: chosen.result.figures[1].text() == "1")
    assert [one.key for one in chosen.exports.exports] == ["rocky"]


def test_that_the_card_shows_a_running_export_and_stops_it(chosen, tmp_path, wait, monkeypatch) -> None:
    assert chosen.result.button.text() == "Export …"
    chosen.build_in(tmp_path / "set")
    wait(lambda: chosen._dataset is not None)
    started, cancelled = [], []
    monkeypatch.setattr(type(chosen._context), "start", lambda *_, **given: started.append(given) or 7)
    monkeypatch.setattr(type(chosen.session), "cancel", lambda _, number: cancelled.append(number))
    chosen.export_to(tmp_path / "out")
    assert chosen.result.record.state is ResultState.RUNNING
    assert chosen.result.button.text() == "Stop"
    chosen.session.choose(seed=1)
    assert chosen.result.record.state is ResultState.RUNNING, "other choices do not hide that"
    chosen.result.button.click()
    assert cancelled == [7]
    started[0]["stopped"]()
    assert chosen.result.record.state is ResultState.STALE
    assert "Stopped before anything was written." in chosen.result.sentence.text()
    assert chosen.result.button.text() == "Export …", "the dataset is that of other choices"


@pytest.mark.slow
def test_that_the_number_of_simulated_particles_is_stated_before_the_export(
    page, tmp_path, wait, monkeypatch
) -> None:
    """15 g of spheres of 22 um and 3.1 g/cm3 are 868 million; a factor of 13 leaves 395,000."""
    sphere = icosphere(3)
    radius = 11.0 / (sphere.volume / (4 / 3 * np.pi)) ** (1 / 3)
    page.session.adopt([Particle(f"ball-{k}", sphere.moved(scale=radius)) for k in range(3)])
    wait(lambda: page.representatives.start.isEnabled())
    page.representatives.count.setValue(1)
    before = page.targets.preview.text()
    page.build_in(tmp_path / "set")
    wait(lambda: page._dataset is not None)
    assert page.targets.preview.text() == before, "stated for what will be built"
    density = page.targets.options().contact.density
    count = 0.015 / (density * np.pi / 6 * 22e-6**3)
    stated = int(page.targets.preview.text().split(": ")[1].split(" ")[0].replace(",", ""))
    assert stated == pytest.approx(count, rel=1e-6)
    assert "d50 22 µm" in page.targets.preview.text()
    monkeypatch.setattr(FolderDialog, "ask", lambda *_: str(tmp_path / "out"))
    assert page.targets.enlarge.text() == "Export with coarse graining 13 …"
    assert page.targets.options().coarse_graining_factor == 1, "none is taken before it is asked for"
    page.targets.enlarge.click()
    wait(lambda: page.exports.exports)
    case = json.loads((tmp_path / "out" / "rocky" / "case.json").read_text())
    assert case["coarse_graining_factor"] == 13
    assert "too many" not in page.targets.preview.text()
    assert page.targets.enlarge.isHidden()


def test_that_a_case_of_hundreds_of_particles_is_stated_too(page):
    ball = icosphere(0)
    page.targets.show_filling(None)
    page._particles = tuple(Particle(f"ball-{k}", ball.moved(scale=20.0 + 0.01 * k)) for k in range(300))
    page._show_sizes()
    assert page.targets.preview.text().startswith("ANSYS Rocky (script): ")
    assert len(page.distribution.classes) == 300


def test_that_the_proposed_factor_is_taken_with_its_decimals_and_suffices(page, monkeypatch) -> None:
    """A factor of 3.1 that was cut to 3 left 506,500 particles, and 3.1 was proposed again."""
    monkeypatch.setattr(FolderDialog, "ask", lambda *_: "")
    ball = icosphere(3).moved(scale=43.9)
    page._particles = (Particle("ball", ball), Particle("other", ball))
    page._show_sizes()
    assert "are too many" in page.targets.preview.text()
    assert page.targets.enlarge.text() == "Export with coarse graining 3.1 …"
    page.targets._take_sufficient_factor()
    assert page.targets.options().coarse_graining_factor == 3.1
    assert page.targets.coarse_graining.field.text() == "3.1"
    assert "are too many" not in page.targets.preview.text()
    assert page.targets.enlarge.isHidden()
    page.targets.coarse_graining.field.stepUp()
    assert page.targets.options().coarse_graining_factor == 4.1
    page.targets.setValue({"coarse_graining": 2.25})
    assert page.targets.value()["coarse_graining"] == 2.25
    assert page.targets.coarse_graining.field.text() == "2.25"


def test_that_a_choice_by_volume_does_not_change_the_number_stated_before_it_is_made(page) -> None:
    """All particles count as one each until there are classes with a share of the volume."""
    page._particles = tuple(Particle(f"ball-{k}", icosphere(0).moved(scale=20.0 + 10 * k)) for k in range(4))
    page._show_sizes()
    by_number = page.targets.preview.text()
    page.representatives.weighting.setValue("volume")
    page._show_sizes()
    assert page.representatives.request().weighting == "volume"
    assert page.targets.preview.text() == by_number


def test_that_a_page_without_particles_says_what_to_do(page) -> None:
    assert "No particles are open" in page.representatives.population.text()
    assert "open files, the sample, or draw some" in page.gallery.empty.text()
    assert not page.representatives.start.isEnabled()
    assert not page.targets.export.isEnabled()
    assert "open particles or a dataset" in page.targets.export.toolTip()
    page.find_representatives()
    page.export()
    page.export()
    page.validate()
    assert not page.targets.export.isEnabled()


def test_that_what_was_set_comes_back(page) -> None:
    page.representatives.setValue({"count": 33, "weighting": "volume"})
    page.sizes.set_text("sieve:20,30=1@volume")
    page.folder.name.setText("mare")
    page.targets.setValue(
        {
            "targets": ["yade"],
            "coarse_graining": 3,
            "particles": 77,
            "lossy": True,
            "contact": {"restitution": 0.4},
        }
    )
    state = json.loads(json.dumps(page.state()))
    page.restore({"sizes": "measured", "export": {}, "representatives": {}})
    assert page.state() != state
    page.restore(state)
    assert page.state() == state
    page.restore({"sizes": "gauss:3", "export": 5})
    assert page.state()["sizes"] == state["sizes"]


@pytest.mark.usefixtures("app")
def test_that_a_picture_shows_a_lit_solid_on_a_clear_ground() -> None:
    cube = grains(1)[0].mesh.hull
    image = thumbnail(cube, "#c08040", 64).toImage()
    assert (image.width(), image.height()) == (64, 64)
    assert image.pixelColor(1, 1).alpha() == 0
    assert image.pixelColor(32, 32).alpha() == 255
    tones = {image.pixelColor(x, y).rgb() for x in range(16, 48) for y in range(16, 48)}
    assert len(tones) > 5


def tree(folder):
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


@pytest.mark.slow
def test_that_a_saved_recipe_makes_the_dataset_and_the_exports_of_the_page(
    page, wait, tmp_path, monkeypatch
) -> None:
    for grain in grains():
        (tmp_path / f"{grain.name}.stl").write_bytes(stl_bytes(grain.mesh.triangles, "test"))
    page.session.open(sorted(tmp_path.glob("*.stl")), "um")
    saved = tmp_path / "recipe.json"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(saved), ""))
    commands = page._context.commands
    commands.save_recipe()
    assert read_recipe(saved).representatives is None
    assert read_recipe(saved).exports is None
    wait(lambda: page.representatives.start.isEnabled())
    page.representatives.setValue({"count": 3, "weighting": "volume"})
    page.find_representatives()
    wait(lambda: len(page.gallery.shown) == 3)
    page.sizes.set_text("classes:abc, -5")
    assert not page.targets.export.isEnabled()
    assert page.targets.export.toolTip() == page.sizes.problem.text() != ""
    assert page.targets.preview.text() == "", "without classes there is no filling"
    page.sizes.set_text("classes:30,60,120")
    assert page.targets.export.isEnabled()
    page.folder.name.setText("three")
    page.targets.setValue(
        {"targets": ["yade"], "coarse_graining": 4.0, "particles": 7, "contact": {"density": 2500.0}}
    )
    commands.save_recipe()
    page.build_in(tmp_path / "window" / "dataset")
    page.export_to(tmp_path / "window" / "exports")
    wait(lambda: page.exports.exports)
    for _ in run_recipe(read_recipe(saved), tmp_path, tmp_path / "run"):
        pass
    for part in ("dataset", "exports"):
        assert tree(tmp_path / "run" / part) == tree(tmp_path / "window" / part)
    assert len(read_dataset(tmp_path / "run" / "dataset")) == 3


def test_that_a_recipe_that_is_opened_sets_the_controls(page, wait, tmp_path) -> None:
    for grain in grains():
        (tmp_path / f"{grain.name}.stl").write_bytes(stl_bytes(grain.mesh.triangles, "test"))
    said = Recipe(
        inputs=sorted(str(path) for path in tmp_path.glob("*.stl")),
        representatives=Representatives(count=6, weighting="volume", sizes="classes:30,60", name="six"),
        exports=Exports(
            targets=["yade", "lammps"],
            coarse_graining_factor=4.0,
            n_particles=7,
            settings={"density": 2500.0, "gravity": 1.62},
        ),
    )
    path = tmp_path / "recipe.json"
    path.write_text(said.to_json())
    page._context.commands.open_paths([path])
    wait(lambda: len(page._particles) == 8)
    wait(lambda: page.folder.name.text() == "six")
    assert page.representatives.request().count == 6
    assert page.representatives.request().weighting == "volume"
    assert page.sizes.text() == "classes:30,60"
    assert page.targets.chosen() == ("lammps", "yade")
    options = page.targets.options()
    assert (options.coarse_graining_factor, options.n_particles) == (4.0, 7)
    assert (options.contact.density, options.test.gravity) == (2500.0, 1.62)
    page.folder.name.setText("mine")
    page.session.events.opened_request.emit()
    wait(lambda: page._context.bindings.idle)
    assert page.folder.name.text() == "mine", "a recipe is taken once"


@pytest.mark.slow
def test_that_a_format_that_may_not_change_shapes_is_in_no_recipe(chosen) -> None:
    altering = next(key for key, each in EXPORTERS.items() if each.alters)
    chosen.targets.setValue({"targets": [altering]})
    assert chosen.session.dataset_request.exports is None
    chosen.targets.setValue({"targets": [altering], "lossy": True})
    assert chosen.session.dataset_request.exports.targets == [altering]
    chosen.session.adopt(grains(first=3))
    chosen._show_particles()
    assert chosen.session.dataset_request is None


def test_that_all_open_particles_are_exported_by_one_click(page, wait, tmp_path, monkeypatch) -> None:
    """Without representatives: each particle is a shape of its own."""
    monkeypatch.setattr(FolderDialog, "ask", lambda *_: str(tmp_path))
    page.session.adopt(grains(4))
    wait(lambda: page.representatives.start.isEnabled())
    page.representatives.which.setCurrentIndex(1)
    assert not page.representatives.start.isEnabled()
    assert page.state()["representatives"]["count"] == 0
    QTest.mouseClick(page.targets.export, Qt.MouseButton.LeftButton)
    wait(lambda: len(page.exports.exports) == 2)
    assert len(read_dataset(tmp_path / "regolith")) == 4
    assert (tmp_path / "rocky" / "rocky_case.py").exists()
    assert page.session.dataset_request.representatives.count == 0


def test_that_formats_are_listed_as_exact_approximate_or_general() -> None:
    exact, approximate, general = groups().values()
    assert {"rocky", "yade"} <= set(exact)
    assert all(EXPORTERS[key].alters for key in approximate)
    assert set(general) == {"gltf", "half-spaces"}
    assert sorted((*exact, *approximate, *general)) == sorted(EXPORTERS)
