"""Preprocessing of a recipe's inputs: extract the grains of volumes, fit the model of a population.

Each lies in a folder of its own, named by a hash of all that it depends on, beside the journal: complete or
absent, so that a resumed run finds it.
"""

import hashlib
import json
import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.errors import FileError, InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle, Source
from regolith_studio.imaging.extraction import ExtractedParticle
from regolith_studio.imaging.segmentation.classifier_document import training_document
from regolith_studio.imaging.volume import SampleScan, SampleVolume, sample_file
from regolith_studio.io.atomic import staged_folder
from regolith_studio.io.file_names import path_inside
from regolith_studio.io.own_files import json_bytes, read_arrays, read_json
from regolith_studio.jobs.events import Steps
from regolith_studio.jobs.executor import Executor
from regolith_studio.jobs.extraction_jobs import extract_each, volume_sha256
from regolith_studio.jobs.extraction_settings import (
    GrainSettings,
    VolumeInput,
    read_classifier,
    read_grain_settings,
)
from regolith_studio.jobs.model_jobs import GenerationRequest, fit_model, fit_request_for, sample_of_meshes
from regolith_studio.jobs.particle_jobs import load_particles
from regolith_studio.readers.particles import FileProblem, find_files
from regolith_studio.readers.sandbox.parent import sha256_of
from regolith_studio.readers.settings import ReadingSettings
from regolith_studio.readers.shape_files import is_shape_source, read_shape_source
from regolith_studio.readers.volumes.header import RawLayout
from regolith_studio.session.outputs.particles import RECIPE, recipe_document
from regolith_studio.session.recipe import Population, RawVolume, Recipe, VolumeEntry
from regolith_studio.shape_models.materials import materials
from regolith_studio.shape_models.models import write_model

INDEX = "grains.json"
MODEL = "model.json"
SAMPLE_VOLUMES: dict[str, tuple[SampleVolume, SampleScan]] = {
    "sample:labels": ("labels", "synthetic"),
    "sample:grey": ("grey", "synthetic"),
    "sample:gradient": ("grey", "gradient"),
}
"""The scans that ship with the program, by the names that recipes know them by."""


@dataclass(frozen=True)
class PreparedInputs:
    """What the particles of a recipe are read or drawn from, besides its mesh files.

    - ``volumes``: folder of the grains of each volume.
    - ``model``: folder of the population's model; ``None`` where a shipped card is one.
    - ``problems``: files that could not be used for the model.
    """

    volumes: tuple[Path, ...] = ()
    model: Path | None = None
    problems: tuple[FileProblem, ...] = ()


def prepare_inputs(
    recipe: Recipe, base: Path, root: Path, executor: Executor, finished: bool = False
) -> Steps:
    """Extract the grains of all volumes and fit the population's model; returns :class:`PreparedInputs`.

    - ``base``: folder that relative files are relative to.
    - ``root``: where the folders are.
    - ``finished``: whether all grains are processed already, so that their index is enough.
    """
    volumes = []
    for entry in recipe.volumes:
        volumes.append((yield from _extract_grains(entry, base, root, finished, executor)))
    model, problems = None, ()
    if recipe.population is not None and not is_card(recipe.population, base):
        model, problems = yield from _fit_population_model(recipe, recipe.population, base, root, executor)
    return PreparedInputs(tuple(volumes), model, problems)


def is_card(population: Population, base: Path) -> bool:
    """Whether a shipped card, as it is, is the model."""
    (first, *more) = population.sources
    plain = not (more or population.model or population.settings)
    return plain and first in materials() and not (base / first).exists()


def resolved(entry: VolumeEntry, base: Path) -> VolumeEntry:
    """The same volume whatever folder a recipe lies in."""
    settings = None if entry.recipe is None else str(base / entry.recipe)
    classifier = None if entry.classifier is None else str(base / entry.classifier)
    file = entry.file if entry.file in SAMPLE_VOLUMES else str(base / entry.file)
    return entry.model_copy(update={"file": file, "recipe": settings, "classifier": classifier})


def entry_of(volume: VolumeInput, settings: GrainSettings) -> VolumeEntry:
    """What a recipe says of a volume and of the way from its voxels to particles."""
    sizes, raw = volume.voxel_size, volume.raw
    shipped = (name for name, which in SAMPLE_VOLUMES.items() if volume.path == sample_file(*which))
    return VolumeEntry(
        file=next(shipped, str(volume.path.absolute())),
        voxel_size=[float(e) for e in sizes] if isinstance(sizes, Sequence) else sizes,
        unit=volume.unit,
        kind=volume.kind,
        dataset=volume.dataset,
        axes=volume.axes,
        allow_gaps=volume.allow_gaps,
        raw=None if raw is None else RawVolume(**{**asdict(raw), "shape": list(raw.shape)}),
        **settings.as_document(),
    )


def read_index(folder: Path) -> list[dict[str, Any]]:
    """Entries of the grains of a volume, in order."""
    extracted: list[dict[str, Any]] = read_json(folder / INDEX)
    return extracted


def read_grain(folder: Path, entry: Mapping[str, Any]) -> Particle:
    """One of the grains of :func:`read_index`, bit for bit as it was extracted."""
    path = path_inside(folder, entry["file"])
    arrays = read_arrays(path, "grain")
    if not {"vertices", "faces"} <= set(arrays):
        raise FileError(f"{path} holds no grain of this program, or is damaged.")
    mesh = Mesh(arrays["vertices"], arrays["faces"])
    source, notes = entry["source"], tuple(entry["notes"])
    return Particle(
        entry["name"], mesh, entry["group"], Source(*source) if source else None, notes, entry["weight"]
    )


def clear_prepared_inputs(prepared: PreparedInputs) -> None:
    """Remove the grains of a run that has ended; what says which there were stays, and the model."""
    for folder in prepared.volumes:
        for path in folder.glob("*.npz"):
            path.unlink()


def _extract_grains(entry: VolumeEntry, base: Path, root: Path, finished: bool, executor: Executor) -> Steps:
    volume, settings = volume_input(entry, base), _settings(entry, base)
    if not volume.path.exists():
        raise InputError(f"There is no volume {volume.path}.")
    document = entry.model_dump(mode="json", exclude={"recipe", "classifier"})
    folder = root / f"volume-{_digest(document, settings.as_document(), volume_sha256(volume.path))}"
    if (folder / INDEX).is_file() and (finished or _is_whole(folder)):
        return folder
    with _removing_empty_folder(root), staged_folder(folder, "prepared") as stage:
        rows: list[dict[str, Any]] = []
        store = partial(_store_grain, stage)
        done = yield from extract_each(volume, settings, root.parent, store, rows.append, executor)
        (stage / RECIPE).write_bytes(json_bytes(recipe_document(volume, settings, done)))
        (stage / INDEX).write_bytes(json_bytes(rows))
    return folder


def _is_whole(folder: Path) -> bool:
    return all((folder / entry["file"]).is_file() for entry in read_index(folder))


def _store_grain(stage: Path, extracted: ExtractedParticle) -> dict[str, Any]:
    particle, name = extracted.particle, f"{extracted.label:08d}.npz"
    np.savez(stage / name, vertices=particle.mesh.vertices, faces=particle.mesh.faces)
    source = particle.source
    return {
        "name": particle.name,
        "group": particle.group,
        "file": name,
        "notes": list(particle.notes),
        "source": None if source is None else [source.path, source.sha256, source.unit],
        "weight": float(extracted.weight),
    }


def _fit_population_model(
    recipe: Recipe, population: Population, base: Path, root: Path, executor: Executor
) -> Steps:
    request = GenerationRequest(
        population.model,
        tuple(population.settings.items()),
        population.l_max,
        population.n,
        recipe.seed,
        population.bounds,
    )
    paths = [base / source for source in population.sources]
    sources = [_resolved_source(text, base) for text in population.sources]
    named = [text for text in sources if is_shape_source(text)]
    if named and len(population.sources) > 1:
        raise InputError(
            "A population is drawn from one card, fit or model, or from meshes and tables only, got "
            f"{', '.join(population.sources)}."
        )
    problems: list[FileProblem] = []
    if named:
        source = read_shape_source(named[0])
        marks: list[Any] = [named[0], source.sha256]
    else:
        _check_sources_exist(population, paths)
        marks = [
            sha256_of(file.path) if file.member is None else [str(file.path), *file.member.chain[-1]]
            for file in find_files(paths, problems)
        ]
    document = population.model_dump(mode="json", exclude={"n", "size_range"})
    reading = ReadingSettings.of(recipe)
    folder = root / f"model-{_digest(document, recipe.seed, asdict(reading), marks)}"
    if not (folder / MODEL).is_file():
        if not named:
            loaded = yield from load_particles(paths, reading)
            source = yield from sample_of_meshes(loaded.particles, fit_request_for(request), executor)
        fitted = yield from fit_model(source, request)
        with _removing_empty_folder(root), staged_folder(folder, "prepared") as stage:
            write_model(stage / MODEL, fitted, {"source": source.name, "notes": list(source.notes)})
    return folder, tuple(problems)


def _resolved_source(text: str, base: Path) -> str:
    """The path beside the recipe, but for the names of shipped cards."""
    return text if text in materials() and not (base / text).exists() else str(base / text)


def _check_sources_exist(population: Population, paths: list[Path]) -> None:
    for text, path in zip(population.sources, paths, strict=True):
        if not path.exists():
            raise InputError(
                f"There is no material card {text!r} and no file or folder of that name beside the recipe; "
                f"the cards are {', '.join(sorted(materials()))}."
            )


def volume_input(entry: VolumeEntry, base: Path) -> VolumeInput:
    """The volume that a recipe in `base` names."""
    raw = (
        None
        if entry.raw is None
        else RawLayout(**{**entry.raw.model_dump(), "shape": tuple(entry.raw.shape)})
    )
    return VolumeInput(
        sample_file(*SAMPLE_VOLUMES[entry.file]) if entry.file in SAMPLE_VOLUMES else base / entry.file,
        entry.voxel_size,
        entry.unit,
        entry.kind,
        entry.dataset,
        raw,
        **({} if entry.axes is None else {"axes": entry.axes}),
        allow_gaps=entry.allow_gaps,
    )


def _settings(entry: VolumeEntry, base: Path) -> GrainSettings:
    if entry.recipe is not None:
        return read_grain_settings(base / entry.recipe)
    segmentation = entry.segmentation
    if entry.classifier is not None:
        trained = training_document(read_classifier(base / entry.classifier))
        segmentation = {"threshold": {"method": "probability"}} | segmentation | {"classifier": trained}
    given = {"region": entry.region, "segmentation": segmentation, "extraction": entry.extraction}
    _check_names(given, GrainSettings().as_document(), "")
    return GrainSettings.from_document(given)


def _check_names(volume: Mapping[str, Any], allowed: Mapping[str, Any], prefix: str) -> None:
    for name, value in volume.items():
        if name not in allowed:
            raise InputError(f"There is no setting {prefix}{name}; there are {', '.join(allowed)}.")
        if isinstance(value, Mapping) and isinstance(allowed[name], Mapping):
            _check_names(value, allowed[name], f"{prefix}{name}.")


def _digest(*parts: Any) -> str:
    text = json.dumps(parts, sort_keys=True, default=str)
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()[:20]


@contextmanager
def _removing_empty_folder(root: Path) -> Iterator[None]:
    """If what is made inside fails, no empty folder is left behind."""
    try:
        yield
    except BaseException:
        for folder in (root, root.parent, root.parent.parent):
            if folder.is_dir() and not any(folder.iterdir()):
                shutil.rmtree(folder)
        raise
