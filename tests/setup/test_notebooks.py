"""The notebooks of the guide run from the first cell to the last, and are kept without outputs."""

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


def outputs(notebook: nbformat.NotebookNode, mime: str) -> str:
    """All that the cells have displayed of one type."""
    shown = [each for cell in notebook.cells for each in cell.get("outputs", ())]
    return "\n".join(each["data"][mime] for each in shown if mime in each.get("data", {}))


@pytest.fixture(scope="module")
def executed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, nbformat.NotebookNode]:
    folder = tmp_path_factory.mktemp("notebooks")
    read = {path.stem: nbformat.read(path, as_version=4) for path in NOTEBOOKS}
    for notebook in read.values():
        NotebookClient(notebook, timeout=280, resources={"metadata": {"path": str(folder)}}).execute()
    return read


def test_that_the_page_links_every_notebook() -> None:
    page = (FOLDER.parent / "window.md").read_text(encoding="utf-8")
    assert len(NOTEBOOKS) == 5
    assert all(f"<notebooks/{path.name}>" in page for path in NOTEBOOKS)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_that_a_notebook_is_valid_and_kept_without_outputs(path: Path) -> None:
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    assert not any(cell.get("outputs") or cell.get("execution_count") for cell in notebook.cells)


@pytest.mark.slow
def test_that_the_first_notebook_shows_the_views_and_an_exact_polyhedron(executed) -> None:
    assert "<iframe src=" in outputs(executed["first_steps"], "text/html")
    assert "'aspect_ratio': '0.00%'" in outputs(executed["first_steps"], "text/plain")


@pytest.mark.slow
def test_that_the_notebook_of_the_heap_finds_the_angle_of_the_cone(executed) -> None:
    text = outputs(executed["angle_of_repose"], "text/plain")
    assert float(text.partition(" degrees")[0].split("'")[-1]) == pytest.approx(27.0, abs=0.3)


@pytest.mark.slow
def test_that_the_notebook_of_the_paper_goes_from_scan_to_angle_in_thirty_lines(executed) -> None:
    code = [cell for cell in executed["paper"].cells if cell.cell_type == "code"]
    assert sum(bool(line) for cell in code for line in cell.source.splitlines()) <= 30
    angle = float(code[-1]["outputs"][-1]["data"]["text/plain"])
    assert 10.0 < angle < 50.0


@pytest.mark.slow
def test_that_the_other_notebooks_end_with_a_result(executed) -> None:
    for name in ("population", "coarsening"):
        last = [cell for cell in executed[name].cells if cell.cell_type == "code"][-1]
        assert last["outputs"]
