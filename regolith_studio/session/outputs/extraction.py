"""Particles out of a volume as files, written one by one: STL, ``particles.csv`` and the recipe."""

from collections.abc import Mapping
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import Any

from regolith_studio.dataset.build import software_versions
from regolith_studio.imaging.extraction import ExtractedParticle
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.json_text import json_bytes
from regolith_studio.io.stl import stl_bytes
from regolith_studio.io.tables import Cell, Column, Table, csv_text
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
from regolith_studio.jobs.particle_jobs import MeasuredParticle
from regolith_studio.jobs.volume_jobs import ExtractedFile
from regolith_studio.session.outputs.descriptors import described, descriptor_table

STL_HEADER = "Regolith Studio, particle, micrometres"
RECIPE = "extraction.json"
_LIBRARIES = ("scikit-image", "connected-components-3d", "vtk", "tifffile", "h5py")


class ExtractionFolder:
    """Takes particles as they come and keeps only what the tables need.

    Parameters
    ----------
    folder
        Exists already.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._rows: dict[int, dict[Column, Cell]] = {}
        self._entries: dict[int, dict[str, Any]] = {}

    def add(self, found: ExtractedParticle, facts: MeasuredParticle) -> None:
        """Write one particle's STL and remember its row."""
        particle = found.particle
        write_bytes(self._folder / f"{particle.name}.stl", stl_bytes(particle.mesh.triangles, STL_HEADER))
        table = descriptor_table([particle], [facts])
        extra: Mapping[Column, Cell] = {
            Column("label"): found.label,
            Column("voxels"): found.n_voxels,
            Column("weight"): found.weight,
            Column("surface"): found.surface,
            Column("notes"): " ".join(particle.notes),
        }
        self._rows[found.label] = dict(zip(table.columns, table.rows[0], strict=True)) | dict(extra)
        self._entries[found.label] = described(particle, facts) | {
            "label": found.label,
            "voxels": found.n_voxels,
            "weight": found.weight,
            "surface": found.surface,
        }

    def finish(self, given: VolumeInput, recipe: GrainSettings, done: ExtractedFile) -> dict[str, Any]:
        """Write ``particles.csv`` and the recipe; returns what ``--json`` prints."""
        rows = [self._rows[label] for label in sorted(self._rows)]
        columns = next(tuple(row) for row in rows if len(row) == max(map(len, rows)))
        table = Table(
            "Particles of a volume", columns, tuple(tuple(row.get(c) for c in columns) for row in rows)
        )
        write_bytes(self._folder / "particles.csv", csv_text(table).encode("utf-8"))
        document = recipe_document(given, recipe, done)
        write_bytes(self._folder / RECIPE, json_bytes(document))
        return {"particles": [self._entries[label] for label in sorted(self._entries)]} | document


def recipe_document(given: VolumeInput, recipe: GrainSettings, done: ExtractedFile) -> dict[str, Any]:
    """Everything that is needed to make the same particles again, and what was left out."""
    document: dict[str, Any] = {
        "volume": {
            "path": str(given.path),
            "dataset": given.dataset,
            "axes": given.axes,
            "sha256": done.sha256,
            "shape_xyz": list(done.shape),
            "dtype": done.dtype,
            "kind": done.kind,
            "voxel_size_um": list(done.voxel_size),
        },
        "extraction": recipe.as_document()["extraction"],
        "n_particles": done.extraction.n_found,
        "border": list(done.extraction.border),
        "small": list(done.extraction.small),
        "software": software_versions() | {name: version(name) for name in _LIBRARIES},
    }
    if done.facts is not None:
        document["segmentation"] = recipe.as_document()["segmentation"]
        document["segmented"] = asdict(done.facts)
    return document
