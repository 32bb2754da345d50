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
    """Refuse before the work what could not be done after it.

    Raises
    ------
    InputError
        If there are too few particles, or sizes, formats or settings make no sense.
    DatasetError
        If a format changes the shapes and that is not allowed.
    """
    if (wish := recipe.representatives) is not None:
        parse_sizes(wish.sizes)
        if wish.count > n_particles:
            raise InputError(
                f"The recipe asks for {wish.count} representatives of {n_particles} particles; there cannot "
                "be more of them than particles."
            )
    if recipe.exports is not None:
        for exporter in chosen_exporters(recipe.exports.targets):
            check_loss_accepted(exporter, recipe.exports.lossy)
        export_options(recipe.exports, recipe.seed)


def build_dataset_step(
    recipe: Recipe,
    wish: Representatives,
    particles: Sequence[Particle],
    order: CoarseningRequest,
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
    name = wish.name or folder.resolve().name
    options = DatasetOptions(
        name, preset, True, workers, representatives_order(wish, recipe.seed), sizes=wish.sizes
    )
    return (yield from build_dataset_folder(particles, order, folder / DATASET, options))


def export_dataset_step(wish: Exports, seed: int, folder: Path) -> Steps:
    """Write ``dataset`` below `folder` for other programs, below ``exports``; returns the exports.

    Raises
    ------
    RegolithError
        As :func:`regolith_studio.jobs.dataset_jobs.export_dataset_folder`.
    """
    return (
        yield from export_dataset_folder(
            folder / DATASET, wish.targets, folder / EXPORTS, export_options(wish, seed), wish.lossy
        )
    )


def representatives_order(wish: Representatives, seed: int) -> RepresentativesRequest | None:
    """How those that stand for all are chosen; ``None`` where each stands for itself."""
    if not wish.count:
        return None
    chosen = seed if wish.seed is None else wish.seed
    return RepresentativesRequest.of(wish.count, wish.weighting, wish.size_importance, chosen)


def export_options(wish: Exports, seed: int) -> ExportOptions:
    """What the formats are told.

    Raises
    ------
    InputError
        If there is no such setting, or a value cannot be used.
    """
    told = ExportOptions(coarse_graining_factor=wish.coarse_graining, n_particles=wish.particles)
    return replace(told, seed=seed if wish.seed is None else wish.seed).replaced(**wish.settings)
