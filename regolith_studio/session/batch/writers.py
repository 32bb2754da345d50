"""Writers of the files of a batch, which take the records one by one and hold only fits in memory."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.dataset.dataset import Provenance
from regolith_studio.dataset.export import ExportOptions, check_loss_accepted
from regolith_studio.dataset.folder_io import StoredShape, dataset_hash, write_stored
from regolith_studio.dataset.parameters import ExportSettings, RepresentativesSettings
from regolith_studio.dataset.size_distributions import parse_sizes
from regolith_studio.errors import DatasetError, InputError
from regolith_studio.geometry.particle import Source
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.io import fits_from
from regolith_studio.io.atomic import staged_file, staged_folder, write_bytes, write_in_stage
from regolith_studio.io.checkpoint import CheckpointRecord
from regolith_studio.io.file_names import file_stem, unique_name
from regolith_studio.io.own_files import JsonListWriter, json_bytes
from regolith_studio.io.tables import csv_bytes
from regolith_studio.jobs.batch import LOST, Batch
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest
from regolith_studio.jobs.dataset_jobs import RepresentativesRequest, chosen_exporters
from regolith_studio.readers.particles import FileProblem
from regolith_studio.session.batch.particle_task import COEFFICIENTS, CUT, MESH, STAGES, shape_blob
from regolith_studio.session.outputs.coarsening import document_head
from regolith_studio.session.outputs.measurements import (
    FittedSample,
    ParticleInfo,
    table_columns,
    table_row,
    write_fits,
)
from regolith_studio.session.recipe import Exports, Recipe, Representatives
from regolith_studio.settings import settings_in


def check_dataset_request(recipe: Recipe, n_particles: int) -> None:
    """Check before the work what would fail after it."""
    if (request := recipe.representatives) is not None:
        parse_sizes(request.sizes)
        if request.count > n_particles:
            raise InputError(
                f"The recipe asks for {request.count} representatives of {n_particles} particles; "
                "there cannot be more of them than particles."
            )
    if recipe.exports is not None:
        for exporter in chosen_exporters(recipe.exports.targets):
            check_loss_accepted(exporter, recipe.exports.lossy)
        export_options(recipe.exports, recipe.seed)


def representatives_request(request: Representatives, seed: int) -> RepresentativesRequest | None:
    """How representatives are chosen; ``None`` where each particle represents itself."""
    if not request.count:
        return None
    chosen = seed if request.seed is None else request.seed
    return RepresentativesRequest(**settings_in(RepresentativesSettings, request), seed=chosen)


def export_options(request: Exports, seed: int) -> ExportOptions:
    """The export options of a recipe."""
    chosen = seed if request.seed is None else request.seed
    return ExportOptions(**settings_in(ExportSettings, request), seed=chosen).replaced(**request.settings)


Write = Callable[[CheckpointRecord], None]
"""Writes the results of one particle."""


@contextmanager
def descriptor_writer(folder: Path, keys: Sequence[str]) -> Iterator[Write]:
    """Writes ``descriptors.json`` and ``descriptors.csv``, with a column for each of `keys`."""
    with (
        staged_file(folder / "descriptors.json") as stream,
        staged_file(folder / "descriptors.csv") as table,
    ):
        entries = JsonListWriter(stream)
        table.write(csv_bytes([[column.header for column in table_columns(keys)]]))

        def write(record: CheckpointRecord) -> None:
            if (entry := record.values.get("described")) is not None:
                entries.add(entry)
                table.write(csv_bytes([table_row(entry, keys)]))

        yield write
        entries.close()


@contextmanager
def mesh_writer(folder: Path, request: CoarseningRequest) -> Iterator[Write]:
    """Writes one STL a polyhedron, and ``coarsening.json``."""
    failed: list[dict[str, str]] = []
    with staged_folder(folder, "coarsen") as stage, (stage / "coarsening.json").open("wb") as stream:
        entries = JsonListWriter(stream, document_head(request), "particles")

        def write(record: CheckpointRecord) -> None:
            if entry := record.values.get("coarse"):
                entries.add(entry)
                write_in_stage(stage, entry["file"], record.blobs[MESH])
                for part in entry.get("parts", ()):
                    write_in_stage(stage, part["file"], record.blobs[part["file"]])
            elif reason := reason_of(record):
                failed.append({"name": record.values["name"], "reason": reason})

        yield write
        entries.close({"failed": failed})


@contextmanager
def fit_writer(path: Path) -> Iterator[Write]:
    """Writes the coefficients of all particles: nine kilobytes of memory each."""
    origins: list[ParticleInfo] = []
    fits: list[HarmonicFit] = []
    failed: list[tuple[str, str]] = []

    def write(record: CheckpointRecord) -> None:
        values = record.values
        if entry := values.get("fit"):
            source = None if values["source"] is None else Source(*values["source"])
            origins.append(ParticleInfo(values["name"], values["group"], source, tuple(values["notes"])))
            fits.append(_fit(entry, record.blobs[COEFFICIENTS]))
        elif reason := reason_of(record, "fitting"):
            failed.append((values["name"], reason))

    yield write
    write_fits(path, FittedSample(tuple(origins), tuple(fits), tuple(failed)))


@contextmanager
def failure_writer(folder: Path, unread: Sequence[FileProblem] = ()) -> Iterator[Write]:
    """Writes ``failed.csv`` with everything that went wrong, if anything did, and `unread` files."""
    rows = [[each.path, "reading", each.sentence] for each in unread]

    def write(record: CheckpointRecord) -> None:
        values = record.values
        rows.extend([values["name"], each["stage"], each["reason"]] for each in values["failures"])

    yield write
    if rows:
        write_bytes(folder / "failed.csv", csv_bytes([["name", "stage", "reason"], *rows]))


@contextmanager
def time_writer(path: Path) -> Iterator[Write]:
    """Writes how long each stage took for each particle, as CSV."""
    with staged_file(path) as stream:
        stream.write(csv_bytes([["name", *[f"{stage} [s]" for stage in STAGES]]]))

        def write(record: CheckpointRecord) -> None:
            seconds = record.values.get("seconds", {})
            stream.write(csv_bytes([[record.values["name"], *[seconds.get(stage) for stage in STAGES]]]))

        yield write


@dataclass
class RunStatistics:
    """Sums and lists over all particles.

    - ``unread``: one sentence for each particle that could not be read or drawn.
    - ``problems``: one sentence for each particle that could not be fitted or coarsened.
    - ``fitted``: coefficients of the coarsened particles at the degree that was coarsened.
    - ``first_coarse``: index of the first particle that could be coarsened.
    """

    n_read: int = 0
    n_coarse: int = 0
    unread: list[str] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    fitted: list[ShCoefficients] = field(default_factory=list)
    first_coarse: int | None = None

    def add(self, record: CheckpointRecord) -> None:
        """Add the record of one particle."""
        values = record.values
        if reason := reason_of(record, "reading"):
            self.unread.append(reason)
            return
        self.n_read += 1
        reasons = dict.fromkeys(each["reason"] for each in values["failures"])
        self.problems += [f"{values['name']}: {reason}" for reason in reasons]
        if "coarse" in values:
            self.n_coarse += 1
            self.first_coarse = record.index if self.first_coarse is None else self.first_coarse
            if CUT in record.blobs:
                self.fitted.append(ShCoefficients(np.frombuffer(record.blobs[CUT], dtype="<f8")))


def shapes_of(batch: Batch, indices: Sequence[int] | None = None) -> Iterator[StoredShape]:
    """The shapes of a dataset, one at a time; of all particles or of those at ascending indices."""
    for record in batch.checkpoint.records() if indices is None else batch.checkpoint.records_at(indices):
        if shape := record.values.get("shape"):
            parts = shape["compound"]["parts"] if shape["compound"] else ()
            meshes = [record.blobs[shape_blob(part)] for part in range(1 + len(parts))]
            yield StoredShape(shape, tuple(meshes))


MANIFEST = "manifest.json"


def write_library(folder: Path, batch: Batch, name: str, provenance: Provenance) -> None:
    """Write a dataset for each group, and ``manifest.json`` with the hash of each one's document."""
    members: dict[str, list[int]] = {}
    for record in batch.checkpoint.records(blobs=False):
        if record.values.get("shape"):
            members.setdefault(record.values["group"], []).append(record.index)
    if not members:
        raise DatasetError("A library needs at least one particle.")
    entries, taken = [], dict[str, int]()
    for group, indices in members.items():
        inner = file_stem(unique_name(group.replace("/", "_") or name, "", taken))
        place, shapes = folder / inner, partial(shapes_of, batch, indices)
        write_stored(place, shapes, len(indices), name=inner, provenance=provenance)
        entry = {"group": group, "folder": inner, "particles": len(indices), "sha256": dataset_hash(place)}
        entries.append(entry)
    write_bytes(folder / MANIFEST, json_bytes({"name": name, "datasets": entries}))


def reason_of(record: CheckpointRecord, stage: str = "") -> str:
    """Why a stage failed, or the last one that did; empty if none has."""
    failures = record.values["failures"]
    return next((each["reason"] for each in reversed(failures) if stage in ("", each["stage"])), "")


def n_failures(record: CheckpointRecord) -> int:
    """1 if anything has failed."""
    return int(bool(record.values.get("failures") or LOST in record.values))


def _fit(entry: dict[str, Any], content: bytes) -> HarmonicFit:
    row = np.frombuffer(content, dtype="<f8")
    point = np.array(entry["star_point"])
    (fit,) = fits_from(
        {"particles": [entry]}, {"coefficients": row[None], "star_points": point[None]}
    ).values()
    return fit
