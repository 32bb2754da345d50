"""The report on a sample: what stands in it, what fails in its place, and that it can be repeated."""

import base64
import json
import re
import shutil
import subprocess
from collections.abc import Callable, Mapping
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.io.tables import Column, Table
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.events import Progress, Steps
from regolith_studio.jobs.executor import Executor
from regolith_studio.readers.particles import sample_particles
from regolith_studio.resources import resource
from regolith_studio.session.batch.inputs import load_recipe_particles
from regolith_studio.session.choices import Choices
from regolith_studio.session.recipe import VolumeEntry, recipe_of
from regolith_studio.session.report import heap_sections, write
from regolith_studio.session.report.sections import (
    ReportDraft,
    ReportFigure,
    ReportSection,
    SectionSteps,
    error_table,
    interval_text,
)
from regolith_studio.session.report.settings import PAGE, ReportSettings
from regolith_studio.session.report.write import (
    DOCUMENT,
    MAX_TRIANGLES,
    WrittenReport,
    report_page,
    write_report,
)
from regolith_studio.settings import settings_of_kind
from regolith_studio.steps import result_of
from regolith_studio.studies.figures import write_figure
from tests.files import contents

NUMBERS = Table("Numbers", (Column("name"), Column("length", "um")), (("one", 1.5), ("<two>", None)))


def picture(draft: ReportDraft, title: str) -> SectionSteps:
    figure = Figure(figsize=(4, 3))
    figure.subplots().plot([0, 1], [1, 0])
    yield Progress(1, 1)
    file, _ = write_figure(figure, draft.folder / "small", "small")
    text = f"{len(draft.particles)} particles & more"
    return ReportSection(title, (text,), (ReportFigure(file, "A line."),), (NUMBERS,))


def fails(draft: ReportDraft, _title: str) -> SectionSteps:
    yield Progress(0, 1)
    raise InputError(f"Nothing in {draft.folder} can be drawn.")


SMALL: Mapping[str, Callable[[ReportDraft, str], SectionSteps]] = {"Fig. 1": fails, "Fig. 2": picture}


class Tags(HTMLParser):
    """The addresses that a page loads or links, and the text of its headings."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.addresses: list[str] = []
        self.headings: list[str] = []
        self._in_heading = False
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.addresses += [value or "" for name, value in attrs if name in ("src", "href", "srcset", "data")]
        self._in_heading = tag == "h2"

    def handle_data(self, data: str) -> None:
        if self._in_heading:
            self.headings.append(data)
            self._in_heading = False


@pytest.fixture(scope="module")
def particles() -> tuple[Particle, ...]:
    chosen = ("angular-1", "bead-1", "flat-1")
    return tuple(each for each in sample_particles() if each.name in chosen)


@pytest.fixture
def small(particles: tuple[Particle, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> WrittenReport:
    monkeypatch.setattr(write, "PARTS", SMALL)
    return result_of(write_report(particles, tmp_path / "report"))


def test_that_a_section_that_fails_says_so_in_its_place_and_stops_nothing(small: WrittenReport) -> None:
    text = (small.folder / PAGE).read_text(encoding="utf-8")
    assert Tags(text).headings == ["Fig. 1", "Fig. 2", "How it was made"]
    place = text.index("Nothing in report can be drawn.")
    assert text.index('id="section-0"') < place < text.index('id="section-1"')
    assert small.problems == ("Fig. 1: Nothing in report can be drawn.",)
    assert json.loads((small.folder / DOCUMENT).read_text())["problems"] == [*small.problems]


def test_that_the_page_needs_no_other_file(small: WrittenReport) -> None:
    text = (small.folder / PAGE).read_text(encoding="utf-8")
    addresses = Tags(text).addresses
    assert sum(each.startswith("data:image/png;base64,") for each in addresses) == 1
    assert all(each.startswith(("data:", "#section-")) for each in addresses)
    assert "url(" not in text
    assert "3 particles &amp; more" in text
    assert "&lt;two&gt;" in text


def test_that_page_and_document_name_settings_versions_and_hashes(
    small: WrittenReport, particles: tuple[Particle, ...]
) -> None:
    text = (small.folder / PAGE).read_text(encoding="utf-8")
    document = json.loads((small.folder / DOCUMENT).read_text())
    assert document["settings"]["l_max"] == 10
    assert document["software"]["numpy"] in text
    for particle, entry in zip(particles, document["particles"], strict=True):
        assert particle.source is not None
        assert entry["sha256"] == particle.source.sha256
        assert particle.source.sha256 in text


def test_that_the_same_sample_and_settings_give_the_same_bytes(
    small: WrittenReport, particles: tuple[Particle, ...], tmp_path: Path
) -> None:
    (tmp_path / "again").mkdir()
    again = result_of(write_report(particles, tmp_path / "again" / "report"))
    assert contents(again.folder) == contents(small.folder)


def test_that_a_table_of_errors_has_a_row_a_group_and_a_column_a_descriptor() -> None:
    names = ("group", "l_max", "descriptor", "rmsre", "rmsre_low", "rmsre_high")
    rows = (
        ("a", 9, "volume", 8.0, 7.0, 9.0),
        ("a", 10, "volume", 2.0, 1.0, 3.0),
        ("a", 10, "sphericity", None, None, None),
        ("", 10, "volume", 1e-7, 0.0, 0.25),
    )
    table = error_table(Table("all", tuple(map(Column, names)), rows), "group", "at 10", l_max=10)
    assert [column.header for column in table.columns] == ["group", "V [%]", "S [%]"]
    assert table.rows == (("a", "2 (1 to 3)", ""), ("all", "0 (0 to 0.25)", ""))
    assert interval_text(None, 1.0, 2.0) == ""


CUBE = Mesh(
    np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)]),
    np.array([*map(int, "013032467475045051237276026064157173")]).reshape(12, 3),
)


def canvases(text: str) -> list[tuple[str, str]]:
    """Points and triangles of each canvas, as the page encodes them."""
    return re.findall(r'data-points="([^"]*)" data-triangles="([^"]*)"', text)


def test_that_the_page_holds_the_meshes_that_can_be_turned() -> None:
    assert CUBE.volume == pytest.approx(8.0)
    text = report_page([ReportSection("Fig. 2", meshes={"a <cube>": CUBE})])
    ((points, triangles),) = canvases(text)
    np.testing.assert_array_equal(
        np.frombuffer(base64.b64decode(points), "<f4").reshape(-1, 3), CUBE.vertices
    )
    np.testing.assert_array_equal(
        np.frombuffer(base64.b64decode(triangles), "<u4").reshape(-1, 3), CUBE.faces
    )
    assert "a &lt;cube&gt;" in text
    assert "http" not in text
    assert text.count("<script>") == 1
    assert "<script>" not in report_page([ReportSection("Fig. 2")])


def test_that_on_paper_heads_stay_with_their_tables_and_nobody_is_told_to_drag() -> None:
    page = report_page([ReportSection("Fig. 2", meshes={"cube": CUBE})])
    printed = re.search(r"@media print \{(.*)\}\s*</style>", page, re.DOTALL)
    assert printed is not None
    rules = dict(re.findall(r"([^{}]+?) \{ ([^{}]+) \}", printed[1].replace("\n", " ")))
    rules = {names.strip(): rule for names, rule in rules.items()}
    assert rules[".screen"] == "display: none"
    assert 'class="screen">Drag to turn' in page
    assert rules["h1, h2, h3"] == "break-after: avoid"
    assert rules["figure, tr"] == "break-inside: avoid"


def test_that_fine_meshes_are_coarser_in_the_page() -> None:
    fine = icosphere(5)
    assert len(fine.faces) > MAX_TRIANGLES
    ((_, triangles),) = canvases(report_page([ReportSection("Fig. 2", meshes={"fine": fine})]))
    assert MAX_TRIANGLES / 2 < len(base64.b64decode(triangles)) / 12 <= MAX_TRIANGLES


DRAWN = """
const polygons = [], handlers = {}; let corners = [];
const pen = { clearRect() { polygons.length = 0 }, beginPath() { corners = [] }, closePath() {}, stroke() {},
  lineTo(x, y) { corners.push([x, y]) }, fill() { polygons.push(corners) } };
const canvas = { width: 200, height: 200, dataset: DATA, getContext: () => pen,
  addEventListener(name, handler) { handlers[name] = handler } };
globalThis.requestAnimationFrame = (job) => job();
globalThis.document = { querySelectorAll: () => [{ querySelectorAll: () => [canvas] }] };
VIEWER
const first = polygons.map((each) => each);
handlers.pointermove({ buttons: 1, movementX: 40, movementY: 25 });
const turned = polygons.map((each) => each);
handlers.dblclick();
console.log(JSON.stringify([first, turned, polygons]));
"""


@pytest.mark.skipif(shutil.which("node") is None, reason="needs node")
def test_that_a_cube_shows_three_faces_from_any_corner_and_comes_back() -> None:
    ((points, triangles),) = canvases(report_page([ReportSection("Fig. 2", meshes={"cube": CUBE})]))
    viewer = resource("report", "viewer.js").read_text(encoding="utf-8")
    data = json.dumps({"points": points, "triangles": triangles})
    program = DRAWN.replace("VIEWER", viewer).replace("DATA", data)
    done = subprocess.run(["node", "-e", program], capture_output=True, text=True, check=True, timeout=60)
    first, turned, again = (np.array(each) for each in json.loads(done.stdout))
    assert len(first) == len(turned) == 6
    assert np.abs(first - turned).max() > 10
    np.testing.assert_array_equal(first, again)
    assert first.min() >= 0
    assert first.max() <= 200


@pytest.mark.parametrize(
    ("changes", "wrong"),
    [({"heap": 10}, "too few for a heap"), ({"l_max": 31}, "l_max"), ({"method": "magic"}, "magic")],
)
def test_that_settings_that_cannot_work_are_refused_before_anything_is_computed(
    changes: dict[str, object], wrong: str
) -> None:
    with pytest.raises(InputError, match=wrong):
        ReportSettings(**changes)  # type: ignore[arg-type]


def test_that_defaults_and_upper_limits_are_those_of_the_window() -> None:
    ours = {each.name: each for each in settings_of_kind(ReportSettings)}
    theirs = {each.name: each for each in settings_of_kind(Choices)}
    for name, like in {
        "l_max": "l_max",
        "facets": "n_facets",
        "method": "method",
        "preset": "preset",
    }.items():
        assert ours[name].default == theirs[like].default
        assert ours[name].metadata.get("maximum") == theirs[like].metadata.get("maximum")


def test_that_a_sample_without_particles_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="at least one particle"):
        result_of(write_report((), tmp_path / "report"))
    assert not (tmp_path / "report").exists()


def test_that_tables_1_and_2_are_there_where_the_cylinder_is_too_narrow_for_the_particles(
    particles: tuple[Particle, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def narrow(*_: object) -> None:
        raise InputError("The cylinder is too narrow.")

    monkeypatch.setattr(heap_sections, "prepare", narrow)
    draft = ReportDraft(particles, ReportSettings(), tmp_path, Executor())
    draft.dataset = ("three", "shapes", "here")  # of which only the number is asked
    section = result_of(heap_sections.show_parameters(draft, "Tables"))
    assert section.paragraphs[-1] == "The cylinder is too narrow."
    first, second = (dict(zip(t.column("parameter"), t.column("used"), strict=True)) for t in section.tables)
    assert first["Particle density"] == "3.075"
    assert first["Number of particle geometries"] == "3"
    assert second["Cylinder diameter"] == "2"
    assert second["Number of particles"] == ""


def test_that_the_sample_of_a_recipe_is_read_where_it_lies(
    particles: tuple[Particle, ...], tmp_path: Path
) -> None:
    for particle in particles[:2]:
        (tmp_path / f"{particle.name}.stl").write_bytes(stl_bytes(particle.mesh.triangles, "test"))
    recipe = recipe_of(inputs=["angular-1.stl", "bead-1.stl", "missing.stl"])
    loaded = result_of(load_recipe_particles(recipe, tmp_path))
    assert [each.name for each in loaded.particles] == ["angular-1", "bead-1"]
    assert ["missing.stl" in problem.sentence for problem in loaded.problems] == [True]


@pytest.mark.slow
def test_that_the_grains_of_a_scan_are_a_sample() -> None:
    loaded = result_of(load_recipe_particles(recipe_of(volumes=[VolumeEntry(file="sample:labels")]), Path()))
    assert len(loaded.particles) > 20
    files = {Path(each.source.path).name for each in loaded.particles if each.source}
    assert files == {"synthetic-labels.tif"}


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_that_a_real_report_has_every_figure_or_says_why_not(
    particles: tuple[Particle, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def breaks(*_: object, **__: object) -> Steps:
        yield Progress(0, 1)
        raise InputError("The losses cannot be compared today.")

    monkeypatch.setattr(heap_sections, "study_coarsening", breaks)
    settings = ReportSettings(drawn=1, study_particles=2, representatives=2, heap=0)
    first = result_of(write_report(particles, tmp_path / "one", settings))
    text = (first.folder / PAGE).read_text(encoding="utf-8")
    assert Tags(text).headings == [*write.PARTS, "How it was made"]
    assert text.count("data:image/png") == 3  # Figs. 2, 3 and 7
    assert [each.partition(":")[0] for each in first.problems] == ["Figs. 4 to 6", "Fig. 8"]
    assert "at least 20 particles" in first.problems[0]
    assert "The losses cannot be compared today." in text
    assert "3.075" in text  # the density of Table 1
    (tmp_path / "other").mkdir()
    second = result_of(write_report(particles, tmp_path / "other" / "one", settings))
    assert contents(second.folder) == contents(first.folder)
