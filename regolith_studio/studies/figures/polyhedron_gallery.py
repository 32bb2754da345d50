"""Polyhedra of some particles for each loss, as a picture (Fig. 7)."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.io.tables import write_table
from regolith_studio.studies.figures.files import write_figure
from regolith_studio.studies.polyhedron_gallery import GalleryPolyhedron, GalleryStudy, gallery_table

VIEW = np.array([[-0.5, 0.866, 0.0], [-0.296, -0.171, 0.94], [0.814, 0.47, 0.342]])
"""Rows: to the right, up, and towards the eye."""
LIGHT = np.array([0.35, 0.25, 0.9])
COLOUR, EDGE = np.array([0.902, 0.624, 0.0]), "0.15"
CELL = 1.7
"""Inches."""


def gallery_figure(study: GalleryStudy) -> Figure:
    """A row a loss, a column a particle, those of a particle at one scale."""
    n_rows, n_columns = len(study.rows), len(study.names)
    figure = Figure(figsize=(1.6 + CELL * n_columns, 0.3 + CELL * n_rows), layout="constrained")
    axes = figure.subplots(n_rows, n_columns, squeeze=False)
    for column, name in enumerate(study.names):
        solids = [study.cells.get((row, column)) for row in range(n_rows)]
        reaches = [_reach(each.polyhedron) for each in solids if isinstance(each, GalleryPolyhedron)]
        for row, found in enumerate(solids):
            axis = axes[row, column]
            axis.set_xticks([])
            axis.set_yticks([])
            axis.set_frame_on(False)
            if isinstance(found, GalleryPolyhedron):
                _draw(axis, found.polyhedron, 1.05 * max(reaches))
                axis.set_xlabel(f"J {found.jaccard_distance:.3f}", fontsize=7)
        axes[0, column].set_title(name, fontsize=8)
    for row, label in enumerate(study.rows):
        axes[row, 0].set_ylabel(
            label.replace(" and ", "\nand "), rotation=0, ha="right", va="center", fontsize=8
        )
    return figure


def write_gallery(study: GalleryStudy, folder: Path) -> tuple[Path, ...]:
    """Table (CSV, JSON) and figure (PNG, SVG)."""
    return (
        *write_table(gallery_table(study), folder, "solids"),
        *write_figure(gallery_figure(study), folder, "solids"),
    )


def visible_facets(polyhedron: ConvexPolyhedron) -> tuple[list[FloatArray], FloatArray]:
    """Outlines (k, 2) of the facets that are turned to the eye, and how brightly they are lit, (m,)."""
    flat = polyhedron.vertices @ VIEW[:2].T
    turned = polyhedron.half_spaces.normals @ VIEW.T
    seen = np.flatnonzero(turned[:, 2] > 1e-9)
    light = np.clip(turned[seen] @ LIGHT / np.linalg.norm(LIGHT), 0.0, 1.0)
    return [flat[list(polyhedron.facets[facet])] for facet in seen], 0.35 + 0.65 * light


def _draw(axis: Axes, polyhedron: ConvexPolyhedron, reach: float) -> None:
    outlines, brightness = visible_facets(polyhedron)
    colours = np.clip(brightness[:, None] * COLOUR, 0.0, 1.0)
    axis.add_collection(PolyCollection(outlines, facecolors=colours, edgecolors=EDGE, linewidths=0.5))
    axis.set_xlim(-reach, reach)
    axis.set_ylim(-reach, reach)
    axis.set_aspect("equal")


def _reach(polyhedron: ConvexPolyhedron) -> float:
    return float(np.abs(polyhedron.vertices @ VIEW[:2].T).max())
