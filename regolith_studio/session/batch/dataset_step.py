"""The dataset of a recipe, with its representatives and exports."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from regolith_studio.dataset.export import ExportOptions, check_loss_accepted
from regolith_studio.dataset.size_parsing import parse_sizes
from regolith_studio.errors import InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest
from regolith_studio.jobs.dataset_jobs import (
    DatasetOptions,
    build_dataset_folder,
    chosen_exporters,
    export_dataset_folder,
)
from regolith_studio.jobs.events import Steps
from regolith_studio.jobs.executor import Executor
from regolith_studio.jobs.representatives_jobs import RepresentativesRequest
from regolith_studio.session.recipe import Exports, Recipe, Representatives

DATASET, EXPORTS = "dataset", "exports"


def check_dataset_request(recipe: Recipe, n_particles: int) -> None:
    """Check before the work what would fail after it.

    Raises
    ------
    InputError
        If there are too few particles, or sizes, formats or settings make no sense.
    DatasetError
        If a format changes the shapes and that is not allowed.
    """
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


def build_dataset_step(
    recipe: Recipe,
    request: Representatives,
    particles: Sequence[Particle],
    coarsening: CoarseningRequest,
    preset: str | None,
    folder: Path,
    workers: int | Executor,
) -> Steps:
    """Write ``dataset`` in `folder`; returns :class:`~regolith_studio.jobs.dataset_jobs.DatasetBuildResult`.

    Raises
    ------
    RegolithError
        As :func:`regolith_studio.jobs.dataset_jobs.build_dataset_folder`.
    """
    chosen = representatives_request(request, recipe.seed)
    options = DatasetOptions(request.name, preset, True, workers, chosen, sizes=request.sizes)
    return (yield from build_dataset_folder(particles, coarsening, folder / DATASET, options))


def export_dataset_step(request: Exports, seed: int, folder: Path) -> Steps:
    """Write ``dataset`` below `folder` for other programs, below ``exports``; returns the exports.

    Raises
    ------
    RegolithError
        As :func:`regolith_studio.jobs.dataset_jobs.export_dataset_folder`.
    """
    return (
        yield from export_dataset_folder(
            folder / DATASET, request.targets, folder / EXPORTS, export_options(request, seed), request.lossy
        )
    )


def representatives_request(request: Representatives, seed: int) -> RepresentativesRequest | None:
    """How representatives are chosen; ``None`` where each particle represents itself."""
    if not request.count:
        return None
    chosen = seed if request.seed is None else request.seed
    return RepresentativesRequest.of(request.count, request.weighting, request.size_importance, chosen)


def export_options(request: Exports, seed: int) -> ExportOptions:
    """The export options of a recipe.

    Raises
    ------
    InputError
        If there is no such setting, or a value cannot be used.
    """
    options = ExportOptions(coarse_graining_factor=request.coarse_graining, n_particles=request.particles)
    return replace(options, seed=seed if request.seed is None else request.seed).replaced(**request.settings)
