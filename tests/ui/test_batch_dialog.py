"""A batch from the window: what the dialog asks, and runs on real processes, on a cluster and into a wall."""

import contextlib
from pathlib import Path

import pytest

from regolith_studio.errors import InputError
from regolith_studio.jobs.executor import Executor, ExecutorSettings
from regolith_studio.jobs.runners import dask_cluster
from regolith_studio.session.recipe import Outputs, recipe_of
from regolith_studio.session.run_recipe import run_recipe
from regolith_studio.ui.batch_runs import BatchRuns
from regolith_studio.ui.dialogs.batch import BatchDialog

WISH = recipe_of(
    inputs=[],
    population={"sources": ["ma165"], "n": 9, "l_max": 5},
    target="particle",
    method="quadric",
    level=2,
    n_facets=12,
)


@pytest.fixture
def recipe(tmp_path):
    path = tmp_path / "recipe.json"
    path.write_text(WISH.to_json())
    return path


@pytest.fixture
def dialog(shown, tmp_path):
    return shown(BatchDialog(3, 1, tmp_path / "out"))


@pytest.fixture
def batches(dialog_runs):
    """Batches of an empty session."""
    return dialog_runs(BatchRuns)


def filled(batches, recipe, folder, place):
    batches.ask()
    dialog = batches._dialog
    dialog.source.kind.setCurrentIndex(1)
    dialog.source.file.setValue(recipe)
    dialog.folder.setValue(folder)
    dialog.workers.executor.setCurrentIndex(dialog.workers.executor.findData(place))
    dialog.workers.count.setValue(2)
    assert dialog.go.isEnabled(), dialog.state.text()
    return dialog


def digests(folder: Path):
    names = {path.relative_to(folder): path for path in folder.rglob("*") if path.is_file()}
    return {str(name): path.read_bytes() for name, path in names.items() if name.parts[0] != "journal"}


def alone(folder: Path):
    for _ in run_recipe(WISH, folder.parent, folder):
        pass
    return digests(folder)


def test_that_the_dialog_begins_with_the_open_files_and_processes_of_this_machine(dialog, tmp_path):
    order = dialog.value()
    assert order.recipe is None
    assert order.folder == tmp_path / "out"
    assert order.outputs == Outputs()
    assert order.executor.runner == "processes"
    assert "2 open particles" in dialog.source.kind.currentText()
    assert dialog.source.missing.isVisible()


def test_that_who_works_is_asked_for_as_needed(dialog):
    workers = dialog.workers
    workers.executor.setCurrentIndex(workers.executor.findData("address"))
    assert not workers.count.isVisible()
    assert not workers.tls.isVisible()
    workers.address.setText("login:8786")
    assert workers.value() == ExecutorSettings("dask", 0, "tcp://login:8786")
    workers.address.setText("tls://login:8786")
    assert workers.tls.isVisible()
    assert not dialog.go.isEnabled()
    assert "ca.pem" in dialog.state.text()


@pytest.mark.parametrize("address", ["", "login", "http://login:8787"])
def test_that_an_address_is_judged_while_it_is_typed(dialog, address):
    sentence = f"The address {address!r} has not the form tcp://HOST:8786"
    dialog.workers.executor.setCurrentIndex(2)
    dialog.workers.address.setText(address)
    assert sentence in dialog.state.text()
    assert not dialog.go.isEnabled()
    with pytest.raises(InputError, match=sentence):
        dialog.value()


def test_that_nothing_to_write_nowhere_to_write_and_no_recipe_are_said(dialog, tmp_path):
    for box in dialog.results.values():
        box.setChecked(False)
    assert "at least one result" in dialog.state.text()
    dialog.results["dataset"].setChecked(True)
    dialog.folder.setValue(None)
    assert "folder" in dialog.state.text()
    dialog.folder.setValue(tmp_path)
    dialog.source.kind.setCurrentIndex(1)
    assert "Choose a recipe file" in dialog.state.text()


def test_that_what_was_chosen_is_suggested_again(dialog, shown, tmp_path):
    dialog.results["fits"].setChecked(True)
    dialog.workers.executor.setCurrentIndex(2)
    dialog.workers.address.setText("tls://login:8786")
    again = shown(BatchDialog(1, 0, tmp_path))
    again.restore_fields(dialog.field_values())
    assert again.field_values() == dialog.field_values()
    again.restore_fields({"results": 7, "workers": ["?"]})


@pytest.mark.parametrize("workers", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_that_the_window_writes_what_one_thread_writes_and_tells_it(batches, recipe, tmp_path, wait, workers):
    dialog = filled(batches, recipe, tmp_path / "out", "processes")
    dialog.workers.count.setValue(workers)
    dialog.go.click()
    assert dialog.halt.isVisible()
    assert not dialog.source.isEnabled()
    wait(lambda: not batches._session.tasks)
    wait(lambda: dialog.state.text().startswith("Done"))
    assert dialog.results_button.isVisible()
    assert digests(tmp_path / "out") == alone(tmp_path / "alone" / "out")


def test_that_a_bad_address_is_one_sentence_and_the_dialog_asks_again(
    batches, recipe, tmp_path, wait, monkeypatch
):
    pytest.importorskip("distributed")
    monkeypatch.setattr(dask_cluster, "ANSWER_SECONDS", 0.3)
    dialog = filled_with_address(batches, recipe, tmp_path / "out", "tcp://127.0.0.1:9")
    dialog.go.click()
    wait(lambda: not batches._session.tasks)
    wait(lambda: "No cluster answers at tcp://127.0.0.1:9" in dialog.state.text())
    assert dialog.go.isEnabled()
    assert not dialog.halt.isVisible()
    assert not (tmp_path / "out").exists()


def filled_with_address(batches, recipe, folder, address):
    batches.ask()
    batches._dialog.workers.address.setText(address)
    return filled(batches, recipe, folder, "address")


@pytest.fixture(scope="module")
def cluster():
    """Two workers of this machine; Dask keeps two threads for good, which its first executor begins."""
    distributed = pytest.importorskip("distributed")
    place = {"host": "127.0.0.1", "dashboard_address": "127.0.0.1:0"}
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, **place) as made:
        with contextlib.closing(Executor.on_cluster(made.scheduler_address)) as executor:
            assert list(executor.map(abs, [-1, -2])) == [1, 2]
        yield made


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # Dask's own
def test_that_a_cluster_is_watched_stopped_and_gone_on_with(cluster, batches, recipe, tmp_path, wait):
    dialog = filled_with_address(batches, recipe, tmp_path / "out", cluster.scheduler_address)
    dialog.go.click()
    wait(lambda: dialog.bar.value() >= 1 or not batches._session.tasks)
    assert cluster.dashboard_link in dialog.dashboard.text()
    assert dialog.dashboard.text().startswith("2 workers")
    dialog.halt.click()
    wait(lambda: not batches._session.tasks)
    wait(lambda: dialog.state.text().startswith(("Stopped", "Done")))
    if dialog.state.text().startswith("Stopped"):
        assert dialog.resume.isVisible()
        assert dialog.resume.isChecked()
        dialog.go.click()
        wait(lambda: dialog.state.text().startswith("Done"))
    assert digests(tmp_path / "out") == alone(tmp_path / "alone" / "out")
