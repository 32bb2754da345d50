"""Captions and tool tips of representatives and of the shapes of a dataset, sorted by share."""

from collections.abc import Sequence

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.representatives_jobs import ChosenParticles
from regolith_studio.messages import N_
from regolith_studio.session.choices import Choices
from regolith_studio.ui.dialogs.export import facet_limit_text
from regolith_studio.ui.pages.dataset.gallery import GalleryItem
from regolith_studio.ui.translation import tr, tr_count
from regolith_studio.ui.translation.numbers import localized


def chosen_particles(particles: Sequence[Particle], chosen: ChosenParticles) -> list[GalleryItem]:
    """Gallery items of the representatives."""
    classes = chosen.representatives.classes
    total = sum(one.weight for one in classes)
    shown = []
    for place, one in zip(chosen.places, classes, strict=True):
        particle = particles[place]
        share = localized(f"{100 * one.weight / total:.1f} %")
        tip = tr_count(
            N_("{name} represents 1 particle ({share})"),
            N_("{name} represents {count} particles ({share})"),
            one.n_members,
            name=particle.name,
            share=share,
        )
        shown.append((one.weight, GalleryItem(particle.mesh, f"{share}\n{particle.name}", tip)))
    return _by_share(shown)


def shapes(dataset: Dataset) -> list[GalleryItem]:
    """Gallery items of the polyhedra of a dataset."""
    shown = []
    for one, weight in zip(dataset.representatives, dataset.weights, strict=True):
        solid = one.shape
        tip = tr(
            "{name}: {faces} facets, {vertices} vertices, represents {count} particles",
            name=one.name,
            faces=solid.n_facets,
            vertices=solid.n_vertices,
            count=one.n_members,
        )
        parts = len(solid.part_meshes)
        facets = (
            tr("{parts} parts, {count} facets", parts=parts, count=solid.n_facets)
            if parts > 1
            else tr("{count} facets", count=solid.n_facets)
        )
        words = localized(f"{100 * weight:.1f} %\n") + facets
        shown.append((float(weight), GalleryItem(solid.mesh, words, tip, coarsened=True)))
    return _by_share(shown)


def dataset_title(dataset: Dataset) -> str:
    """Name, number of shapes and weighting of a dataset."""
    counts = tr(str(dataset.weighting))
    return tr(
        "{name}: {count} shapes, weighted by {weighting}",
        name=dataset.name,
        count=len(dataset),
        weighting=counts,
    )


SHAPE_FIELDS = ("method", "stop_at", "n_facets", "n_triangles", "n_vertices", "largest_error")
"""Choices that :func:`coarsening_text` names."""


def coarsening_text(choices: Choices) -> str:
    """Description of how the shapes will be coarsened."""
    known = METHODS.get(choices.method)
    return tr(
        "Each with {fineness}; method: {method} (see Explore).",
        fineness=facet_limit_text(choices),
        method=tr(known.label) if known else choices.method,
    )


def _by_share(shown: list[tuple[float, GalleryItem]]) -> list[GalleryItem]:
    return [each for _, each in sorted(shown, key=lambda pair: -pair[0])]
