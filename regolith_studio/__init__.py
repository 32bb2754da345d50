"""Regolith Studio: from X-ray micro-CT to DEM-ready particles whose geometry is right.

Functions for notebooks, each imported from the folder of its name when first used::

    import regolith_studio as rs

    particle = rs.read_mesh("grain.stl", unit="um")
    rs.describe(particle)["sphericity"]
    fit = rs.fit_harmonics(particle)
    coarse = rs.coarsen(particle, n_facets=20)
    rs.write_dataset("grains", rs.build_dataset([(particle, coarse)]))
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from regolith_studio.coarsening.coarsen import coarsen
    from regolith_studio.coarsening.weights import LossWeights
    from regolith_studio.dataset.build import build_dataset
    from regolith_studio.dataset.folder_io import read_dataset, write_dataset
    from regolith_studio.dem.angle_of_repose import measure_repose
    from regolith_studio.descriptors.describe import describe
    from regolith_studio.harmonics.fit import fit_harmonics
    from regolith_studio.harmonics.surface import reconstruct
    from regolith_studio.jobs.events import result_of
    from regolith_studio.jobs.repose_calibration import calibrate_repose
    from regolith_studio.readers.particles import read_mesh, read_particles, sample_particles
    from regolith_studio.scene.repose_export import export_repose
    from regolith_studio.shape_models.models.gaussian_field import GaussianRadiusModel
    from regolith_studio.web.notebook import show

__version__ = "0.1.0"
__all__ = [
    "GaussianRadiusModel",
    "LossWeights",
    "__version__",
    "build_dataset",
    "calibrate_repose",
    "coarsen",
    "describe",
    "export_repose",
    "fit_harmonics",
    "measure_repose",
    "read_dataset",
    "read_mesh",
    "read_particles",
    "reconstruct",
    "result_of",
    "sample_particles",
    "show",
    "write_dataset",
]

_LAZY_EXPORTS = {
    "GaussianRadiusModel": "shape_models.models.gaussian_field:GaussianRadiusModel",
    "LossWeights": "coarsening.weights:LossWeights",
    "build_dataset": "dataset.build:build_dataset",
    "calibrate_repose": "jobs.repose_calibration:calibrate_repose",
    "coarsen": "coarsening.coarsen:coarsen",
    "describe": "descriptors.describe:describe",
    "export_repose": "scene.repose_export:export_repose",
    "fit_harmonics": "harmonics.fit:fit_harmonics",
    "measure_repose": "dem.angle_of_repose:measure_repose",
    "read_dataset": "dataset.folder_io:read_dataset",
    "read_mesh": "readers.particles:read_mesh",
    "read_particles": "readers.particles:read_particles",
    "reconstruct": "harmonics.surface:reconstruct",
    "result_of": "jobs.events:result_of",
    "sample_particles": "readers.particles:sample_particles",
    "show": "web.notebook:show",
    "write_dataset": "dataset.folder_io:write_dataset",
}


def __getattr__(name: str) -> Any:
    if name not in _LAZY_EXPORTS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, attribute = _LAZY_EXPORTS[name].split(":")
    value = getattr(import_module(f"{__name__}.{module}"), attribute)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
