"""The task of one particle of a recipe, run in any process; its result is a record on disk."""

import json
import time
from collections.abc import Generator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from regolith_studio.dataset.folder_io import stored_shape
from regolith_studio.descriptors.catalogue import DEFAULT_KEYS
from regolith_studio.errors import JobCancelled
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.fit_options import DEFAULT_FIT_OPTIONS, FitOptions
from regolith_studio.harmonics.io import fits_document
from regolith_studio.io.checkpoint import CheckpointRecord
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.coarsening_jobs import CoarsenedParticle, CoarseningRequest, coarsen_particle
from regolith_studio.jobs.events import Failed, Finished, Job, JobResult, Progress, Started, Step, Steps
from regolith_studio.jobs.executor import call
from regolith_studio.jobs.particle_jobs import FitRequest, MeasuredParticle, fit_one, measure_particle
from regolith_studio.jobs.runners import iterate_job
from regolith_studio.messages import N_
from regolith_studio.session.batch.inputs import BatchInput
from regolith_studio.session.outputs.coarsening import STL_HEADER, coarsening_entry, meshes_of
from regolith_studio.session.outputs.measurements import described

MESH, SHAPE, COEFFICIENTS, CUT = "mesh.stl", "shape.stl", "coefficients.f8", "cut.f8"
"""Names of the byte strings of a record: polyhedron in place, polyhedron of the dataset, coefficients
at the degree of all fits, and those at the degree that was coarsened (little-endian float64)."""

STAGES = ("reading", "measuring", "fitting", "coarsening", "writing")
"""What is done to a particle, in order; virtual ones are drawn instead of read."""


@dataclass(frozen=True)
class ParticleTask:
    """What is computed of each particle.

    - ``coarsening``: settings of the coarsening; ``None`` for none.
    - ``shapes``: whether the polyhedra become a dataset.
    - ``keys``: of the descriptors that are measured.
    - ``fit_options``: how fits are made.
    """

    measure: bool
    fit: bool
    coarsening: CoarseningRequest | None
    shapes: bool
    box_metric: str
    fit_options: FitOptions = DEFAULT_FIT_OPTIONS
    keys: tuple[str, ...] = DEFAULT_KEYS


@dataclass
class _RecordBuilder:
    """The record of a particle while it is processed."""

    index: int
    values: dict[str, Any]
    blobs: dict[str, bytes] = field(default_factory=dict)
    failures: list[dict[str, str]] = field(default_factory=list)

    def attempt(self, stage: str, job: Job) -> Generator[Step, None, Any]:
        """What the job returns, or ``None`` with its sentence noted; the time that it took is noted too."""
        begun = time.perf_counter()
        result: JobResult = yield from iterate_job(job)
        self.values["seconds"][stage] = round(time.perf_counter() - begun, 4)
        match result:
            case Finished(value):
                return value
            case Failed(sentence):
                self.failures.append({"stage": stage, "reason": sentence})
                return None
            case _:
                raise JobCancelled("The work was stopped.")


def process_particles(items: Sequence[tuple[int, BatchInput]], task: ParticleTask) -> Steps:
    """Read, measure, fit and coarsen particles; returns a tuple of :class:`CheckpointRecord`, one an item.

    Failures of a particle are listed in its record, under ``failures``, and do not stop the others.
    """
    yield Started(N_("Working on particles"), len(items))
    records = []
    for index, item in items:
        records.append((yield from _process(index, item, task)))
        yield Progress(len(records), len(items), item.name)
    return tuple(records)


def _process(index: int, item: BatchInput, task: ParticleTask) -> Generator[Step, None, CheckpointRecord]:
    entry = _RecordBuilder(index, {"name": item.name, "group": "", "seconds": {}})
    particle = yield from entry.attempt("reading", Job(call, (_read, item)))
    if particle is not None:
        entry.values |= {"group": particle.group, "notes": list(particle.notes)}
        yield from _process_particle(entry, particle, task)
    entry.values["failures"] = entry.failures
    return CheckpointRecord(index, entry.values, entry.blobs)


def _process_particle(
    entry: _RecordBuilder, particle: Particle, task: ParticleTask
) -> Generator[Step, None, None]:
    if task.measure:
        facts = yield from entry.attempt("measuring", Job(_measure, (particle, task)))
        if facts is not None:
            entry.values["described"] = facts
    fit = None
    if task.fit or (task.coarsening and task.coarsening.target == "fit"):
        fit = yield from entry.attempt(
            "fitting", Job(fit_one, (particle.mesh, FitRequest(fit_options=task.fit_options)))
        )
        if fit is not None and task.fit:
            _store_fit(entry, particle, fit)
        if fit is None and task.coarsening and task.coarsening.target == "fit":
            return
    if task.coarsening:
        outcome = yield from entry.attempt(
            "coarsening", Job(coarsen_particle, (particle, task.coarsening, entry.index, fit))
        )
        if outcome is not None:
            yield from entry.attempt(
                "writing", Job(_store_polyhedron, (entry, particle, outcome, task.shapes))
            )


def _read(item: BatchInput) -> Particle:
    return item.particle()


def _measure(particle: Particle, task: ParticleTask) -> Steps:
    """What ``descriptors.json`` says of the particle; a number that is not finite is a mistake here."""
    yield Started(N_("Measuring"))
    facts: MeasuredParticle = measure_particle(particle, task.box_metric, task.keys)
    return _finite(described(particle, facts))


def _store_fit(entry: _RecordBuilder, particle: Particle, fit: HarmonicFit) -> None:
    (document,) = fits_document([particle.name], [fit])["particles"]
    source = particle.source
    entry.values["fit"] = _finite(document)
    entry.values["source"] = None if source is None else [source.path, source.sha256, source.unit]
    entry.blobs[COEFFICIENTS] = _bytes(fit.coefficients.values)


def _store_polyhedron(
    entry: _RecordBuilder, particle: Particle, outcome: CoarsenedParticle, shapes: bool
) -> Steps:
    yield Started("Keeping the polyhedron")
    coarse = outcome.coarsened
    assert coarse is not None
    values: dict[str, Any] = {"coarse": _finite(coarsening_entry(outcome, coarse))}
    meshes = meshes_of(particle.name, coarse)
    blobs = {file: stl_bytes(mesh.triangles, STL_HEADER) for file, mesh in meshes.items()}
    blobs[MESH] = blobs.pop(values["coarse"]["file"])
    if shapes:
        shape = stored_shape(particle, coarse)
        values["shape"] = _finite(shape.record)
        blobs |= {shape_blob(part): content for part, content in enumerate(shape.meshes)}
    if outcome.coefficients is not None:
        blobs[CUT] = _bytes(outcome.coefficients.values)
    entry.values.update(values)
    entry.blobs.update(blobs)


def shape_blob(part: int) -> str:
    """Name of the STL of a dataset's shape (0), or of a part of it."""
    return f"part{part}.{SHAPE}" if part else SHAPE


def _bytes(values: Any) -> bytes:
    return np.ascontiguousarray(values, dtype="<f8").tobytes()


def _finite(values: Any) -> Any:
    """Plain values as they are read back from JSON."""
    return json.loads(json.dumps(values, allow_nan=False))
