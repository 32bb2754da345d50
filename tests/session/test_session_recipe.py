"""What is open in a session, saved as a recipe and run, gives the dataset of the session byte by byte."""

from collections.abc import Callable
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.imaging.segmentation.segment import SegmentationSettings
from regolith_studio.imaging.settings import SplittingSettings
from regolith_studio.io.atomic import write_files
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.dataset_jobs import DatasetOptions, build_dataset_folder
from regolith_studio.jobs.extraction_jobs import extract_file, extract_labels
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
from regolith_studio.jobs.model_jobs import GenerationRequest, draw_shapes, fit_shapes, make_particles
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.jobs.scan_jobs import find_grains, read_scan
from regolith_studio.readers.shape_files import ShapeSource
from regolith_studio.session.batch.preprocessing import entry_of
from regolith_studio.session.choices import Choices
from regolith_studio.session.project import Project, SessionRecipe, read_project
from regolith_studio.session.provenance import VirtualSource, VolumeSource
from regolith_studio.session.recipe import Outputs, read_recipe
from regolith_studio.session.run_recipe import run_recipe
from regolith_studio.session.session import Session
from regolith_studio.shape_models.materials import materials
from regolith_studio.steps import result_of
from tests.files import contents

CHOICES = Choices(
    method="annealing", target="fit", settings=(("iterations", 12),), level=2, l_max=4, n_facets=12, seed=3
)
ONLY_DATASET = Outputs(descriptors=False, meshes=False, summary=False)
LEVEL = 2


@pytest.mark.slow
def test_that_a_random_part_of_an_archive_is_opened_and_saved_as_a_recipe(
    session: Session, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("regolith_studio.session.session.MOST_SHOWN", 3)
    folder = write_grains(tmp_path / "meshes", *(f"g{number}.stl" for number in range(6)))
    with ZipFile(tmp_path / "library.zip", "w") as archive:
        for fraction in ("75m", "300p"):
            for path in sorted(folder.iterdir()):
                archive.write(path, f"{fraction}/{path.name}")
    notes: list[str] = []
    session.events.left_out.connect(notes.extend)
    session.open([tmp_path / "library.zip"])
    assert notes == ["Shown is a random part of the archive: 3 of 12, seed 3."]
    assert len({entry.id for entry in session.particles}) == 3
    assert_that_a_run_gives_the_dataset_of(session, tmp_path)


def assert_that_a_run_gives_the_dataset_of(session: Session, place: Path) -> SessionRecipe:
    """By way of the recipe on disk; the dataset of the session has the name of the run's folder."""
    particles, choices = [entry.particle for entry in session.particles], session.choices
    options = DatasetOptions(preset=None if choices.preset_modified else choices.preset)
    result_of(
        build_dataset_folder(particles, choices.coarsening_request, place / "window" / "grains", options)
    )
    session_recipe = SessionRecipe.of(session.particles, session.choices, ONLY_DATASET)
    saved = place / "recipe.json"
    recipe, models = session_recipe.files_for(saved)
    write_files({**models, saved: recipe.to_json().encode()})
    done = result_of(run_recipe(read_recipe(saved), saved.parent, place / "run" / "grains"))
    assert not done.problems
    assert contents(place / "run" / "grains" / "dataset") == contents(place / "window" / "grains")
    return session_recipe


def write_grains(folder: Path, *names: str, size: float = 12.0) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    sphere = icosphere(3)
    for index, name in enumerate(names):
        axes = np.random.default_rng(len(folder.name) + index).uniform(size, 2 * size, 3)
        (folder / name).write_bytes(stl_bytes(Mesh(sphere.vertices * axes, sphere.faces).triangles, "test"))
    return folder


@pytest.fixture
def session() -> Session:
    return Session(InlineRunner(), CHOICES)


def test_that_meshes_of_folders_in_two_units_with_broken_files_are_the_same_in_a_run(
    session: Session, tmp_path: Path
) -> None:
    inner = write_grains(tmp_path / "scans" / "coarse", "a.stl", "b.stl")
    write_grains(tmp_path / "scans" / "fine", "a.stl", "c.stl")
    (inner / "aa.stl").write_bytes(b"solid nothing")
    session.open([tmp_path / "scans"], "um")
    session.open([write_grains(tmp_path / "more", "a.stl", size=0.01)], "mm", add=True)
    assert [entry.id for entry in session.particles] == ["a", "b", "fine_a", "c", "more_a"]
    session_recipe = assert_that_a_run_gives_the_dataset_of(session, tmp_path)
    assert session_recipe.without_source == ()
    assert session_recipe.recipe.unit == "um"
    assert session_recipe.recipe.openings[1].unit == "mm"


def test_that_meshes_mended_and_left_as_they_are_are_the_same_in_a_run(
    session: Session, tmp_path: Path
) -> None:
    two = np.vstack([icosphere(2).vertices, 0.2 * icosphere(2).vertices + [2.0, 0.0, 0.0]])
    faces = np.vstack([icosphere(2).faces, icosphere(2).faces + len(icosphere(2).vertices)])
    path = tmp_path / "two.stl"
    path.write_bytes(stl_bytes(Mesh(two, faces).triangles, "test"))
    session.open([path])
    session.choose(repair=False)
    session.open([path], add=True)
    repaired, as_it_is = [entry.particle.mesh.volume for entry in session.particles]
    assert as_it_is == pytest.approx(1.008 * repaired, rel=1e-4)  # the second ball has a fifth of the size
    session_recipe = assert_that_a_run_gives_the_dataset_of(session, tmp_path)
    assert [each.repair for each in session_recipe.recipe.openings] == [True, False]


def test_that_the_sample_and_a_file_beside_it_are_the_same_in_a_run(session: Session, tmp_path: Path) -> None:
    session.open_sample()
    session.keep({"angular-2", "flat-1"})
    session.open([write_grains(tmp_path / "more", "flat-1.stl") / "flat-1.stl"], add=True)
    assert_that_a_run_gives_the_dataset_of(session, tmp_path)


def test_that_a_closed_particle_gives_its_name_free_and_the_run_knows(
    session: Session, tmp_path: Path
) -> None:
    session.open([write_grains(tmp_path / "one", "a.stl", "b.stl")])
    session.keep({"b"})
    session.open([write_grains(tmp_path / "two", "a.stl")], add=True)
    assert [entry.id for entry in session.particles] == ["b", "a"]
    session_recipe = assert_that_a_run_gives_the_dataset_of(session, tmp_path)
    options = session_recipe.recipe.particles
    assert options is not None
    assert options[0] == "b"


def test_that_a_table_of_coefficients_is_the_same_in_a_run(session: Session, tmp_path: Path) -> None:
    (tmp_path / "grain.sh").write_text("0, 0, 9.0, 0.0\n1, 0, 0.2, 0\n1, 1, 0.1, 0\n2, 0, 0.8, 0\n")
    session.open([tmp_path / "grain.sh"], "um")
    assert_that_a_run_gives_the_dataset_of(session, tmp_path)


@pytest.fixture
def labels(tmp_path: Path) -> Path:
    """Three labelled ellipsoids."""
    z, y, x = np.indices((30, 44, 44), dtype=float)
    volume = np.zeros(x.shape, dtype=np.uint16)
    for number, ((a, b, c), radius) in enumerate(
        [((12, 12, 14), 9), ((32, 12, 15), 8), ((12, 32, 15), 7)], 1
    ):
        volume[((x - a) / radius) ** 2 + ((y - b) / (radius - 1)) ** 2 + ((z - c) / radius) ** 2 < 1] = number
    np.save(tmp_path / "labels.npy", volume)
    return tmp_path / "labels.npy"


def extracted(session: Session, given: VolumeInput, settings: GrainSettings) -> None:
    """What the page of scans does."""
    scan = result_of(read_scan(given))
    found, grey = scan.volume, None
    if found.kind == "grey":
        found, grey = result_of(find_grains(scan, settings.segmentation)).segmentation.labels, found
    made = result_of(extract_labels(found, settings.extraction, given.path, grey))
    session.adopt(made.particles, origin=VolumeSource.of(entry_of(given, settings), made.particles))


def test_that_chosen_grains_and_a_mesh_beside_them_are_the_same_in_a_run(
    session: Session, tmp_path: Path, labels: Path
) -> None:
    extracted(session, VolumeInput(labels, (2.0, 2.0, 2.5), "um"), GrainSettings())
    session.keep({entry.id for entry in session.particles[1:]})
    session.open([write_grains(tmp_path / "more", "a.stl")], add=True)
    session_recipe = assert_that_a_run_gives_the_dataset_of(session, tmp_path)
    assert len(session_recipe.recipe.particles or ()) == 3


@pytest.mark.slow
def test_that_grains_of_the_shipped_scan_are_the_same_in_a_run(session: Session, tmp_path: Path) -> None:
    from regolith_studio.imaging.volume import sample_file

    settings = GrainSettings(SegmentationSettings(splitting=SplittingSettings(h_maxima=1.0)))
    extracted(session, VolumeInput(sample_file("grey")), settings)
    session.keep({entry.id for entry in session.particles[:6]})
    session_recipe = assert_that_a_run_gives_the_dataset_of(session, tmp_path)
    assert session_recipe.recipe.volumes[0].file == "sample:grey"
    found = result_of(extract_file(VolumeInput(sample_file("grey")), settings)).extraction.particles
    assert [entry.id for entry in session.particles] == [each.name for each in found[:6]]


def drawn(
    session: Session,
    source: ShapeSource | tuple[Particle, ...],
    order: GenerationRequest,
    edit: Callable[[Any], Any] = lambda model: model,
) -> None:
    """What the page of models does."""
    fitted = result_of(fit_shapes(source, order))
    made = result_of(draw_shapes(edit(fitted.model), order))
    origin = VirtualSource.of(made, fitted, LEVEL)
    particles = result_of(make_particles(made.draws, made.model, origin.population.name, LEVEL))
    session.adopt(particles, origin=origin)


def rougher(model: Any) -> Any:
    return model.with_amplitudes(model.relative_amplitudes() * 1.3)


def of_card() -> ShapeSource:
    return ShapeSource(materials()["ma165"], "ma165")


def test_that_particles_of_a_card_are_the_same_in_a_run(session: Session, tmp_path: Path) -> None:
    drawn(session, of_card(), GenerationRequest(l_max=6, n=4, seed=8, size_range=(20.0, 60.0)))
    session_recipe = assert_that_a_run_gives_the_dataset_of(session, tmp_path)
    assert session_recipe.model is None
    assert not list(tmp_path.glob("recipe-model*"))


def test_that_particles_of_an_edited_card_are_the_same_in_a_run(session: Session, tmp_path: Path) -> None:
    drawn(session, of_card(), GenerationRequest(l_max=5, n=3, seed=8), rougher)
    assert_that_a_run_gives_the_dataset_of(session, tmp_path)
    assert len([*tmp_path.glob("recipe-model-*.json")]) == 1


@pytest.mark.parametrize(
    "model",
    [
        pytest.param("recombined", marks=pytest.mark.slow),
        pytest.param("sample_matched", marks=pytest.mark.slow),
        "gaussian_field",
    ],
)
def test_that_particles_of_a_fitted_model_are_the_same_in_a_run(
    session: Session, tmp_path: Path, model: str
) -> None:
    session.open([write_grains(tmp_path / "measured", *(f"{i}.stl" for i in range(8)))])
    measured = tuple(entry.particle for entry in session.particles)
    drawn(session, measured, GenerationRequest(model, l_max=4, n=4, seed=2))
    session.open([tmp_path / "measured" / "3.stl"], add=True)
    assert_that_a_run_gives_the_dataset_of(session, tmp_path)


def test_that_a_project_brings_grains_and_drawn_particles_back(
    session: Session, tmp_path: Path, labels: Path
) -> None:
    def virtual() -> None:
        drawn(
            session,
            of_card(),
            GenerationRequest(l_max=6, n=3, seed=8),
            rougher,
        )

    def grains() -> None:
        extracted(session, VolumeInput(labels, 2.0, "um"), GrainSettings())

    begin: Callable[[], None]
    for number, begin in enumerate((virtual, grains)):
        begin()
        session.open([write_grains(tmp_path / "more", "a.stl")], add=True)
        session.keep({entry.id for entry in session.particles[1:]})
        session_recipe = SessionRecipe.of(session.particles, session.choices)
        Project.of(session).save(tmp_path / f"{number}.regolith", session_recipe.model)
        again = Session(InlineRunner())
        read_project(tmp_path / f"{number}.regolith").open_in(again, tmp_path)
        assert [entry.id for entry in again.particles] == [entry.id for entry in session.particles]
        for old, new in zip(session.particles, again.particles, strict=True):
            assert np.array_equal(old.particle.mesh.vertices, new.particle.mesh.vertices)
            assert old.particle.group == new.particle.group
        third = SessionRecipe.of(again.particles, again.choices).recipe
        assert third.particles == session_recipe.recipe.particles
        assert third.volumes == session_recipe.recipe.volumes


def test_that_what_was_made_by_hand_is_named(session: Session, tmp_path: Path) -> None:
    session.open([write_grains(tmp_path / "one", "a.stl", "b.stl")])
    session.adopt([Particle("mine", icosphere(2))], add=True)
    session_recipe = SessionRecipe.of(session.particles, session.choices)
    assert session_recipe.without_source == ("mine",)
    (tmp_path / "one" / "a.stl").unlink()
    assert SessionRecipe.of(session.particles, session.choices).without_source == ("a", "mine")
    with pytest.raises(InputError, match="no particles to keep"):
        session.keep(set())


def open_together(session: Session, folder: Path) -> None:
    session.open([folder / f"g{number}.stl" for number in range(4)])


def open_in_turn(session: Session, folder: Path) -> None:
    session.open([folder / "g0.stl", folder / "g1.stl"])
    session.open([folder / "g2.stl", folder / "g3.stl"], add=True)


def open_and_close_some(session: Session, folder: Path) -> None:
    open_in_turn(session, folder)
    session.keep(["g0", "g1", "g2"])


def open_beside_the_sample(session: Session, folder: Path) -> None:
    session.open_sample()
    open_together(session, folder)
    session.open([folder / "g0.stl"], add=True)


@pytest.mark.parametrize(
    "open_some", [open_together, open_in_turn, open_and_close_some, open_beside_the_sample]
)
def test_that_a_project_keeps_particles_whose_files_are_missing_when_it_is_saved(
    session: Session, tmp_path: Path, open_some: Callable[[Session, Path], None]
) -> None:
    folder, project = (
        write_grains(tmp_path, *(f"g{number}.stl" for number in range(4))),
        tmp_path / "p.regolith",
    )
    missing = ("g0", "g1")
    open_some(session, folder)
    ids = [entry.id for entry in session.particles]
    Project.of(session).save(project)
    for name in missing:
        (folder / f"{name}.stl").rename(folder / f"{name}.moved")
    read_project(project).open_in(session, tmp_path)
    assert [entry.id for entry in session.particles] == [name for name in ids if name[:2] not in missing]
    assert {each.id[:2] for each in session.unread} == set(missing)
    Project.of(session).save(project)
    session.open([folder / "g2.stl"], add=True)
    added = Project.of(session)
    for name in missing:
        (folder / f"{name}.moved").rename(folder / f"{name}.stl")
    read_project(project).open_in(session, tmp_path)
    assert [entry.id for entry in session.particles] == ids
    assert not session.unread
    added.open_in(session, tmp_path)
    assert {*ids, "g2_2"} == {entry.id for entry in session.particles}


def test_that_what_was_never_a_particle_of_a_project_is_not_kept_as_one(
    session: Session, tmp_path: Path
) -> None:
    folder = write_grains(tmp_path, "g0.stl", "g1.stl")
    (folder / "broken.stl").write_bytes(b"solid of nothing")
    session.open([folder])
    assert not session.unread
    session.open_recipe(SessionRecipe.of(session.particles, session.choices).recipe, tmp_path)
    assert [entry.id for entry in session.particles] == ["g0", "g1"]
    assert not session.unread
