"""Kinds offered by the entry points of another installed package work like those of the program."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.registry import Registry

ROOT = Path(__file__).resolve().parents[1]
ENTRY_POINTS = """
[regolith_studio.coarsening_methods]
lunar = lunar_kinds:METHOD
clashing = lunar_kinds:CLASHING
earlier = lunar_kinds:EARLIER
half = lunar_kinds:HalfAMethod
[regolith_studio.exporters]
lunar = lunar_kinds:EXPORTER
missing = lunar_code_that_is_not_there:EXPORTER
[regolith_studio.engines]
lunar = lunar_kinds:ENGINE
[regolith_studio.shape_models]
lunar = lunar_kinds:MODEL
[regolith_studio.readers]
lunar = lunar_kinds:FORMAT
[regolith_studio.pages]
lunar = lunar_kinds:PAGE
"""


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Environment of processes that find the package of ``tests/plugin`` installed."""
    site = tmp_path_factory.mktemp("site")
    shutil.copy(ROOT / "tests" / "plugin" / "lunar_kinds.py", site)
    record = site / "lunar_kinds-1.0.dist-info"
    record.mkdir()
    (record / "METADATA").write_text("Metadata-Version: 2.1\nName: lunar-kinds\nVersion: 1.0\n")
    (record / "entry_points.txt").write_text(ENTRY_POINTS)
    path = os.pathsep.join([str(site), str(ROOT)])
    return os.environ | {"PYTHONPATH": path, "QT_QPA_PLATFORM": "offscreen"}


def run(environment: dict[str, str], *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, *arguments]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=280, check=False)
    assert done.returncode == 0, done.stderr
    return done


@pytest.fixture(scope="module")
def lunar_mesh(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A box of 2 x 1 x 1 in a format that only the other package knows."""
    corners = [[x, y, z] for x in (0, 2) for y in (0, 1) for z in (0, 1)]
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = [[a, b, c] for a, b, c, _ in quads] + [[a, c, d] for a, _, c, d in quads]
    path = tmp_path_factory.mktemp("meshes") / "box.lunar"
    path.write_text(json.dumps({"lunar": 1, "vertices": corners, "faces": faces}))
    return path


@pytest.mark.slow
def test_that_a_reader_a_method_and_an_exporter_of_another_package_work_together(
    installed: dict[str, str], lunar_mesh: Path, tmp_path: Path
) -> None:
    program = ("-m", "regolith_studio")
    found = json.loads(run(installed, *program, "describe", str(lunar_mesh), "--json").stdout)
    assert found[0]["volume"] == pytest.approx(2.0)

    folder, exported = tmp_path / "dataset", tmp_path / "exported"
    options = ("--facets", "6", "--method", "lunar_method", "--target", "particle")
    done = run(installed, *program, "dataset", "build", str(lunar_mesh), "-o", str(folder), *options)
    assert "1 of 1 particles" in done.stdout
    run(installed, *program, "dataset", "export", str(folder), "-o", str(exported), "--to", "lunar_export")
    assert next(exported.rglob("lunar.txt")).read_text() == "1 shapes, 0\n"


def test_that_engine_model_and_page_of_another_package_are_offered(installed: dict[str, str]) -> None:
    script = """
import numpy as np
from PySide6.QtWidgets import QApplication
from regolith_studio.dem.engines import engine_rows
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.sample import Sample
from regolith_studio.ui.pages import PAGES
from regolith_studio.ui.page import Sidebar
assert [row["version"] for row in engine_rows() if row["key"] == "lunar_engine"] == ["1.0"]
rows = np.random.default_rng(0).normal(size=(20, 9)) * 0.01
rows[:, 0] += 3.5
model = MODELS["lunar_model"]
assert len(model.fit(Sample(rows), model.Settings(l_max=2)).draw(3, 0)) == 3
application = QApplication([])
bar = Sidebar(dict(PAGES))
assert list(bar.buttons)[-1] == "lunar_page"
"""
    run(installed, "-c", script)


@pytest.mark.slow
def test_that_a_broken_or_clashing_plug_in_costs_one_sentence_and_nothing_else(
    installed: dict[str, str],
) -> None:
    script = """
from regolith_studio.coarsening.methods import METHODS
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.registry import plugin_problems
assert "rocky" in EXPORTERS and "lunar_export" in EXPORTERS
assert type(METHODS["quadric"]).__module__ == "regolith_studio.coarsening.methods.quadric"
assert not {"half_a_method", "earlier_method"} & set(METHODS)
print(*plugin_problems(), sep="\\n")
"""
    done = run(installed, "-c", script)
    clashing, earlier, half, missing = sorted(done.stdout.splitlines())
    assert "'missing'" in missing
    assert "lunar_code_that_is_not_there" in missing
    assert "there is a METHOD 'quadric' already" in clashing
    assert "its 'run' must take 6 arguments" in earlier
    assert "(target, n_facets, weights, seed, settings, fewer)" in earlier
    assert "it has no 'Settings'" in half
    assert done.stderr.count("\n") == 4
    checked = run(installed, "-m", "regolith_studio", "check", "--json")
    assert "'missing'" in " ".join(json.loads(checked.stdout)["missing"])


def test_that_making_a_registry_imports_nothing() -> None:
    registry: Registry[object] = Registry("there.is.no.such.package", "ROW", "no_such_group")
    with pytest.raises(ModuleNotFoundError):
        list(registry)


def test_that_a_registry_is_a_mapping_in_the_order_asked_for() -> None:
    assert list(METHODS) == sorted(METHODS)
    assert "nothing" not in METHODS
    assert METHODS.get("nothing") is None
