"""Regolith Studio: from X-ray micro-CT to DEM-ready particles whose geometry is right.

Functions for notebooks, in the order of the paper, each imported from its folder when first used::

    import regolith_studio as rs

    grains = rs.extract(rs.read_volume("scan.tif", voxel_size=2.3))
    fits = [rs.fit_harmonics(grain) for grain in grains]
    virtual = rs.draw_particles(rs.fit_model(fits, l_max=10), 20)
    coarse = [(particle, rs.coarsen(particle, n_facets=20)) for particle in virtual]
    rs.write_dataset("grains", rs.build_dataset(coarse))
    rs.simulate_repose("grains", "heap").measurement.angle
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from regolith_studio.version import __version__

if TYPE_CHECKING:
    from regolith_studio.coarsening.coarsen import coarsen
    from regolith_studio.coarsening.weights import LossWeights
    from regolith_studio.dataset.build import build_dataset
    from regolith_studio.dataset.folder_io import read_dataset, write_dataset
    from regolith_studio.dataset.parameters import ContactParameters, DrumRotation
    from regolith_studio.dem.angle_of_repose import measure_repose
    from regolith_studio.dem.case import ReposeCase
    from regolith_studio.descriptors.describe import describe
    from regolith_studio.harmonics.fit import fit_harmonics
    from regolith_studio.harmonics.synthesis import reconstruct
    from regolith_studio.jobs.repose_calibration import calibrate_repose
    from regolith_studio.jobs.repose_jobs import ReposeRequest
    from regolith_studio.jobs.uncertainty import measure_uncertainty
    from regolith_studio.pipeline import (
        compare_draws,
        draw_particles,
        export_dataset,
        extract,
        fit_model,
        simulate_repose,
    )
    from regolith_studio.readers.particles import read_mesh, read_particles, sample_particles
    from regolith_studio.readers.volumes.read import read_volume
    from regolith_studio.scene.repose_export import export_repose
    from regolith_studio.steps import result_of
    from regolith_studio.studies.matching import ComparedMaterial, match
    from regolith_studio.web.notebook import show

__all__ = [
    "ComparedMaterial",
    "ContactParameters",
    "DrumRotation",
    "LossWeights",
    "ReposeCase",
    "ReposeRequest",
    "__version__",
    "build_dataset",
    "calibrate_repose",
    "coarsen",
    "compare_draws",
    "describe",
    "draw_particles",
    "export_dataset",
    "export_repose",
    "extract",
    "fit_harmonics",
    "fit_model",
    "match",
    "measure_repose",
    "measure_uncertainty",
    "read_dataset",
    "read_mesh",
    "read_particles",
    "read_volume",
    "reconstruct",
    "result_of",
    "sample_particles",
    "show",
    "simulate_repose",
    "write_dataset",
]

_MODULES = {
    "ContactParameters": "dataset.parameters",
    "DrumRotation": "dataset.parameters",
    "LossWeights": "coarsening.weights",
    "ComparedMaterial": "studies.matching",
    "ReposeCase": "dem.case",
    "ReposeRequest": "jobs.repose_jobs",
    "build_dataset": "dataset.build",
    "calibrate_repose": "jobs.repose_calibration",
    "coarsen": "coarsening.coarsen",
    "compare_draws": "pipeline",
    "describe": "descriptors.describe",
    "draw_particles": "pipeline",
    "export_dataset": "pipeline",
    "export_repose": "scene.repose_export",
    "extract": "pipeline",
    "fit_harmonics": "harmonics.fit",
    "fit_model": "pipeline",
    "measure_repose": "dem.angle_of_repose",
    "measure_uncertainty": "jobs.uncertainty",
    "match": "studies.matching",
    "read_dataset": "dataset.folder_io",
    "read_mesh": "readers.particles",
    "read_particles": "readers.particles",
    "read_volume": "readers.volumes.read",
    "reconstruct": "harmonics.synthesis",
    "result_of": "steps",
    "sample_particles": "readers.particles",
    "show": "web.notebook",
    "simulate_repose": "pipeline",
    "write_dataset": "dataset.folder_io",
}
"""Module of each function."""


def __getattr__(name: str) -> Any:
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
