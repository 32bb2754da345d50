"""The jobs from volumes to particles: their story, their result, and that large ones go by files."""

import json
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.imaging.extraction import ExtractedParticle
from regolith_studio.imaging.segmentation.segment import SegmentationSettings
from regolith_studio.imaging.settings import DenoiseSettings, ExtractionSettings, ThresholdSettings
from regolith_studio.imaging.volume import sample_volume
from regolith_studio.jobs import scan_jobs
from regolith_studio.jobs.events import Progress, Started
from regolith_studio.jobs.extraction_jobs import extract_file, extract_measured, volume_sha256
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput, read_grain_settings
from regolith_studio.jobs.particle_jobs import MeasuredParticle
from regolith_studio.jobs.scan_jobs import preview_heights, preview_part, scan_of
from regolith_studio.readers.sandbox.parent import sha256_of
from regolith_studio.resources import resource
from tests.jobs.small_jobs import name_and_numbers
from tests.steps import played

GREY = resource("samples", "ct", "synthetic-grey.tif")
PART = (slice(0, 80), slice(0, 80), slice(0, 80))
QUICK = GrainSettings(SegmentationSettings(DenoiseSettings("none")))


def pair_of(extracted: ExtractedParticle, measured: MeasuredParticle) -> object:
    return extracted, measured


def test_that_the_heights_of_a_part_give_the_grains_of_its_preview() -> None:
    scan = scan_of(sample_volume("grey"))
    level = scan.level(QUICK.segmentation)
    received, found = played(preview_heights(scan, PART, QUICK.segmentation, level, (0.8, 30.0)))
    _, part = played(preview_part(scan, PART, QUICK.segmentation))
    assert found[0].n_grains == part.n_grains > found[1].n_grains
    assert isinstance(received[0], Started)


@pytest.mark.slow
def test_that_a_grey_file_tells_its_stages_and_gives_particles() -> None:
    received, done = played(extract_file(VolumeInput(GREY), QUICK))
    titles = [step.title for step in received if isinstance(step, Started)]
    assert titles[0] == "Reading synthetic-grey.tif"
    assert titles[1:] == [
        "Denoising",
        "Finding connected bodies",
        "Separating touching grains",
        "Numbering grains",
        "Extracting particles",
    ]
    assert received[-1] == Progress(done.extraction.n_found, done.extraction.n_found, received[-1].message)
    assert done.facts.n_grains == 60
    assert done.kind == "grey"
    assert len(done.extraction.particles) == done.extraction.n_found
    assert done.sha256 == sha256_of(GREY)


@pytest.fixture
def part(tmp_path: Path) -> VolumeInput:
    """A corner of the shipped grey scan, and an empty folder ``scratch`` beside it."""
    np.save(tmp_path / "part.npy", np.ascontiguousarray(sample_volume("grey").array[PART].T))
    (tmp_path / "scratch").mkdir()
    return VolumeInput(tmp_path / "part.npy", 2.3, kind="grey")


def test_that_temporary_files_give_the_same_particles_and_vanish(
    part: VolumeInput, monkeypatch: pytest.MonkeyPatch
) -> None:
    scratch = part.path.parent / "scratch"
    _, memory = played(extract_file(part, QUICK))
    monkeypatch.setattr(scan_jobs, "IN_MEMORY", 0)
    steps = extract_file(part, QUICK, scratch)
    while next(steps) != Started("Extracting particles"):
        pass
    assert list(scratch.iterdir())
    _, files = played(steps)
    assert not list(scratch.iterdir())
    hashes = [[p.mesh.content_hash for p in done.extraction.particles] for done in (memory, files)]
    assert hashes[0] == hashes[1]
    assert len(hashes[0]) > 3


def test_that_a_cancelled_run_leaves_no_temporary_files(
    part: VolumeInput, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scan_jobs, "IN_MEMORY", 0)
    steps = extract_file(part, QUICK, part.path.parent / "scratch")
    for _ in range(4):
        next(steps)
    assert list((part.path.parent / "scratch").iterdir())
    steps.close()
    assert not list((part.path.parent / "scratch").iterdir())


def test_that_measured_particles_are_handed_over_and_not_kept(part: VolumeInput) -> None:
    seen = []
    _, kept = played(extract_file(part, QUICK))
    _, done = played(extract_measured(part, QUICK, None, pair_of, seen.append))
    assert done.extraction.n_found == len(seen) == len(kept.extraction.found)
    assert done.extraction.found == ()
    for found, facts in seen:
        assert facts.descriptors["volume"] == pytest.approx(found.particle.mesh.volume)
        assert facts.health.sound


@pytest.mark.slow
def test_that_two_processes_make_the_particles_that_one_makes(part: VolumeInput) -> None:
    seen: dict[int, list[tuple[str, str, object]]] = {1: [], 2: []}
    for workers, found in seen.items():
        played(extract_measured(part, QUICK, None, name_and_numbers, found.append, workers=workers))
    assert len(seen[1]) > 3
    assert seen[1] == seen[2]


def test_that_a_volume_without_whole_grains_says_what_to_do(tmp_path: Path) -> None:
    np.save(tmp_path / "full.npy", np.ones((20, 20, 20), dtype=np.uint8))
    with pytest.raises(InputError, match="keep grains at the border"):
        played(extract_file(VolumeInput(tmp_path / "full.npy", 1.0, kind="labels"), QUICK))


def test_that_the_fingerprint_of_a_folder_depends_on_every_slice(tmp_path: Path) -> None:
    tifffile = pytest.importorskip("tifffile")
    for number in range(4):
        tifffile.imwrite(tmp_path / f"slice_{number}.tif", np.full((5, 5), number, dtype=np.uint8))
    before = volume_sha256(tmp_path)
    tifffile.imwrite(tmp_path / "slice_2.tif", np.full((5, 5), 9, dtype=np.uint8))
    assert volume_sha256(tmp_path) != before


def test_that_a_recipe_survives_being_written_and_read(tmp_path: Path) -> None:
    recipe = GrainSettings(
        SegmentationSettings(
            DenoiseSettings("non-local-means", reach=4),
            ThresholdSettings("multi-otsu", classes=4, boundary=3),
        ),
        ExtractionSettings(exclude_border=False, min_voxels=7),
    )
    (tmp_path / "r.json").write_text(json.dumps(recipe.as_document() | {"software": {}}))
    assert read_grain_settings(tmp_path / "r.json") == recipe
    assert GrainSettings.from_document({"extraction": {"unknown": 3}}) == GrainSettings()


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("nothing", "no JSON"),
        ("[1]", "holds no group of settings"),
        ("{}", "names neither"),
        ('{"extraction": 3}', "group of settings"),
        ('{"extraction": {"min_voxels": "many"}}', "of the kind of 268"),
        ('{"extraction": {"min_voxels": true}}', "of the kind of 268"),
        ('{"segmentation": {"denoise": {"method": "wavelets"}}}', "method must be one of"),
    ],
)
def test_that_a_bad_recipe_is_one_sentence(tmp_path: Path, text: str, sentence: str) -> None:
    (tmp_path / "r.json").write_text(text)
    with pytest.raises(InputError, match=sentence):
        read_grain_settings(tmp_path / "r.json")
