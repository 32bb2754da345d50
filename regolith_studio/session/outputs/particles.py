"""Particles of a volume or of a shape model as files: STL, tables and the recipe."""

import io
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.dataset.build import software_versions
from regolith_studio.harmonics.coefficients import CONVENTION
from regolith_studio.imaging.extraction import ExtractedParticle
from regolith_studio.imaging.grain_errors import stated_intervals
from regolith_studio.imaging.volume_slabs import SliceSource
from regolith_studio.io.atomic import write_bytes, write_in_stage
from regolith_studio.io.file_names import file_stem
from regolith_studio.io.own_files import json_bytes
from regolith_studio.io.tables import Cell, Column, Table, csv_text
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.events import Steps
from regolith_studio.jobs.executor import Executor
from regolith_studio.jobs.extraction_jobs import ExtractedFile, extract_measured
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
from regolith_studio.jobs.model_jobs import GenerationRequest, particle_names
from regolith_studio.jobs.particle_jobs import MeasuredParticle
from regolith_studio.messages import N_
from regolith_studio.readers.shape_files import ShapeSource
from regolith_studio.session.outputs.measurements import (
    ParticleInfo,
    described,
    descriptor_table,
    interval_cells,
)
from regolith_studio.shape_models.chunked_sampling import RejectionSampler
from regolith_studio.shape_models.materials import MaterialCard
from regolith_studio.shape_models.protocol import FittedModel
from regolith_studio.shape_models.realizations import Realizations
from regolith_studio.shape_models.sample import Sample
from regolith_studio.studies.population_distances import DistributionComparison
from regolith_studio.version import __version__

STL_HEADER = "Regolith Studio, particle, micrometres"
RECIPE, LISTED = "extraction.json", "extract.sha256"
_LIBRARIES = ("scikit-image", "connected-components-3d", "vtk", "tifffile", "h5py")


@dataclass(frozen=True, eq=False)
class ParticleRecord:
    """What the tables say of a particle that was written: a row, and an entry of ``--json``."""

    label: int
    row: dict[Column, Cell]
    entry: dict[str, Any]


def write_particle(folder: Path, extracted: ExtractedParticle, facts: MeasuredParticle) -> ParticleRecord:
    """Write one particle's STL; returns its record."""
    particle = extracted.particle
    write_in_stage(folder, f"{file_stem(particle.name)}.stl", stl_bytes(particle.mesh.triangles, STL_HEADER))
    table = descriptor_table([particle], [facts])
    extra = {
        "label": extracted.label,
        "voxels": extracted.n_voxels,
        "weight": extracted.weight,
        "surface": extracted.surface,
    }
    stated = stated_intervals(particle, facts.descriptors)
    row = dict(zip(table.columns, table.rows[0], strict=True)) | {
        Column(name): value for name, value in (extra | {"notes": " ".join(particle.notes)}).items()
    }
    row |= interval_cells(stated)
    entry = (
        described(particle, facts) | extra | {"intervals": {key: list(ends) for key, ends in stated.items()}}
    )
    return ParticleRecord(extracted.label, row, entry)


class ExtractionFolder:
    """The particles of a volume as files; keeps only the rows of the tables in memory.

    ``folder``: exists already.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._records: list[ParticleRecord] = []

    def extract(
        self,
        volume: VolumeInput,
        recipe: GrainSettings,
        scratch: Path,
        workers: int | Executor = 1,
        labels_file: Path | None = None,
        unfinished: Path | None = None,
    ) -> Steps:
        """Write the particles of a volume, each where it is made; returns :class:`ExtractedFile`.

        The parameters are those of :func:`~regolith_studio.jobs.extraction_jobs.extract_measured`.
        """
        write = partial(write_particle, self._folder)
        return (
            yield from extract_measured(
                volume, recipe, scratch, write, self._records.append, workers, labels_file, unfinished
            )
        )

    def finish(self, volume: VolumeInput, recipe: GrainSettings, result: ExtractedFile) -> dict[str, Any]:
        """Write ``particles.csv`` and the recipe; returns what ``--json`` prints."""
        records = sorted(self._records, key=lambda each: each.label)
        rows = [record.row for record in records]
        columns = next(tuple(row) for row in rows if len(row) == max(map(len, rows)))
        table = Table(
            "Particles of a volume", columns, tuple(tuple(row.get(c) for c in columns) for row in rows)
        )
        write_bytes(self._folder / "particles.csv", csv_text(table).encode("utf-8"))
        document = recipe_document(volume, recipe, result)
        write_bytes(self._folder / RECIPE, json_bytes(document))
        return {"particles": [record.entry for record in records]} | document


def recipe_document(volume: VolumeInput, recipe: GrainSettings, result: ExtractedFile) -> dict[str, Any]:
    """Everything that is needed to make the same particles again, and what was left out."""
    document = input_document(volume, recipe, result.sha256, result) | {
        "n_particles": result.extraction.n_found,
        "border": list(result.extraction.border),
        "small": list(result.extraction.small),
        "notes": list(result.notes),
    }
    if result.facts is not None:
        document["segmented"] = asdict(result.facts)
    return document


def input_document(
    volume: VolumeInput, recipe: GrainSettings, sha256: str, voxels: ExtractedFile | SliceSource
) -> dict[str, Any]:
    """What the particles of a volume depend on: its voxels, the settings, and the versions of libraries."""
    settings = recipe.as_document()
    if voxels.kind == "labels":
        del settings["segmentation"]
    return settings | {
        "volume": {
            "path": str(volume.path),
            "dataset": volume.dataset,
            "axes": volume.axes,
            "sha256": sha256,
            "shape_xyz": list(voxels.shape),
            "dtype": str(voxels.dtype),
            "kind": voxels.kind,
            "voxel_size_um": [float(edge) for edge in np.ravel(np.asarray(voxels.voxel_size))],
        },
        "software": software_versions() | {name: version(name) for name in _LIBRARIES},
    }


FORMAT = "regolith-studio virtual particles"
ARRAYS = "particles.npz"
TABLE = "particles.csv"
DOCUMENT = "generation.json"


@dataclass(frozen=True, eq=False)
class GeneratedParticles:
    """Drawn particles with their source, request and model.

    - ``source``, ``request``, ``model``, ``draws``: source and request, the fitted model and the drawn
      particles.
    - ``groups``: name of the part of the mixture each came from, or empty.
    - ``comparison``: with the particles of the sample, where there are any.
    """

    source: ShapeSource
    request: GenerationRequest
    model: FittedModel
    draws: Realizations
    groups: tuple[str, ...]
    comparison: DistributionComparison | None = None


def write_table_of_meshes(
    folder: Path, generated: GeneratedParticles, facts: Sequence[MeasuredParticle]
) -> None:
    """Write ``particles.csv`` of particles whose meshes lie in `folder`: all descriptors, and the origin."""
    named = [
        ParticleInfo(*each)
        for each in zip(particle_names(len(generated.draws)), generated.groups, strict=True)
    ]
    _write_table(folder, descriptor_table(named, facts), generated.draws)


def write_coefficients(folder: Path, generated: GeneratedParticles) -> None:
    """Write ``particles.npz`` (coefficients of all particles) and ``particles.csv`` (name, group, size)."""
    names, radii = particle_names(len(generated.draws)), generated.draws.equivalent_radii()
    arrays = {
        "names": np.array(names),
        "coefficients": generated.draws.coefficients,
        "equivalent_radius": radii,
        "parents": np.asarray(generated.draws.parents),
        "components": np.asarray(generated.draws.components),
    }
    packed = io.BytesIO()
    np.savez(packed, **arrays)  # type: ignore[arg-type]
    write_bytes(folder / ARRAYS, packed.getvalue())
    columns = (Column("name"), Column("group"), Column("equivalent_radius", "um"))
    rows = tuple(zip(names, generated.groups, radii.tolist(), strict=True))
    _write_table(folder, Table(N_("Virtual particles"), columns, rows), generated.draws)


def write_document(folder: Path, generated: GeneratedParticles, extra: dict[str, Any]) -> dict[str, Any]:
    """Write ``generation.json`` and return what it holds."""
    document = generation_document(generated) | extra
    write_bytes(folder / DOCUMENT, json_bytes(document))
    return document


def generation_document(generated: GeneratedParticles) -> dict[str, Any]:
    """Source, model, settings, seed, and how many draws were thrown away."""
    draws, content = generated.draws, generated.source.content
    return {
        "format": FORMAT,
        "version": 1,
        "program": f"regolith-studio {__version__}",
        "source": {
            "name": generated.source.name,
            "sha256": generated.source.sha256 or None,
            "n_particles": len(content) if isinstance(content, Sample) else None,
            "notes": list(generated.source.notes),
        },
        "model": generated.model.key,
        "settings": dict(generated.request.settings),
        "l_max": draws.l_max,
        "n_particles": len(draws),
        "seed": draws.seed,
        "unit": draws.unit,
        "size_range": list(generated.request.size_range) if generated.request.size_range else None,
        "rejected": draws.rejected,
        "acceptance": draws.acceptance,
        "coefficients": f"of {'the radius' if draws.scale == 'radius' else 'ln radius'}; {CONVENTION}",
        "components": _components(generated),
        "rejection_bias": _rejection_bias(generated),
        "evaluation": content.evaluation if isinstance(content, MaterialCard) else None,
        "comparison": _comparison(generated.comparison),
    }


def _comparison(compared: DistributionComparison | None) -> dict[str, Any] | None:
    """The table and its assessment; nothing where there are too few particles."""
    if compared is None or not compared.comparable:
        return None
    return {
        "measured": len(compared.measured),
        "drawn": len(compared.drawn),
        "limit": compared.noise.limit,
        "assessment": str(compared.assessment()),
        "rows": compared.table().records,
    }


def _rejection_bias(generated: GeneratedParticles) -> dict[str, float] | None:
    """How kept draws differ from the model that rejects others; nothing where none was rejected."""
    if not generated.draws.rejected or not isinstance(generated.model, RejectionSampler):
        return None
    return asdict(generated.model.rejection_bias())


def _components(generated: GeneratedParticles) -> list[dict[str, Any]]:
    names = getattr(generated.model, "names", ())
    counts = np.bincount(np.asarray(generated.draws.components), minlength=len(names))
    return [{"name": name, "drawn": int(count)} for name, count in zip(names, counts, strict=False)]


def _write_table(folder: Path, table: Table, draws: Realizations) -> None:
    """The table with the number of the measured particle that each draw began with, where there is one."""
    parents: list[Cell] = [int(p) if p >= 0 else None for p in np.asarray(draws.parents)]
    if any(parent is not None for parent in parents):
        rows = tuple((*row, parent) for row, parent in zip(table.rows, parents, strict=True))
        table = Table(table.title, (*table.columns, Column("parent")), rows, table.notes)
    write_bytes(folder / TABLE, csv_text(table).encode("utf-8"))
