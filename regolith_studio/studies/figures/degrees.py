"""Fig. 2: a particle and its expansion cut at several degrees, drawn without OpenGL.

Polyhedra of some particles for each loss, as a picture (Fig. 7).

Fig. 3: RMSRE of every descriptor against l_max, one panel a group.
"""

from collections.abc import Mapping
from math import ceil
from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.io.tables import write_table
from regolith_studio.studies.figures import as_written, with_subscript, write_figure
from regolith_studio.studies.lmax import BOX_NOTE, LmaxStudy, particle_table, rmsre_table
from regolith_studio.studies.polyhedron_gallery import GalleryPolyhedron, GalleryStudy, gallery_table

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
"""Okabe and Ito's palette, which most colour-blind people can tell apart."""
MARKERS = "osD^vPX"
N_COLUMNS = 3


def lmax_figure(study: LmaxStudy) -> Figure:
    """Lines are RMSRE in percent, shades the bootstrap bands; the scale is logarithmic."""
    groups = study.group_names
    columns = min(N_COLUMNS, len(groups))
    rows = ceil(len(groups) / columns)
    figure = Figure(figsize=(1.2 + 4.0 * columns, 0.6 + 3.2 * rows), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    for axis, group in zip(axes.flat, groups, strict=False):
        _draw_group(axis, study, group)
    for axis in axes.flat[len(groups) :]:
        axis.remove()
    for axis in axes[:, 0]:
        axis.set_ylabel("RMSRE (%)")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right upper", frameon=False)
    if "min_diameter" in study.keys:
        figure.supxlabel(fill(BOX_NOTE, 22 + 50 * columns), fontsize="x-small", x=0.02, ha="left")
    return figure


def write_lmax_study(study: LmaxStudy, folder: Path) -> tuple[Path, ...]:
    """Tables (CSV, JSON) of groups and of particles, and the figure (PNG, SVG)."""
    return (
        *write_table(rmsre_table(study), folder, "lmax_rmsre"),
        *write_table(particle_table(study), folder, "lmax_particles"),
        *write_figure(lmax_figure(study), folder, "lmax_rmsre"),
    )


def _draw_group(axis: Axes, study: LmaxStudy, group: str) -> None:
    values, (low, high) = 100 * study.rmsre(group), 100 * study.bands(group)
    for k, key in enumerate(study.keys):
        colour = COLOURS[k % len(COLOURS)]
        axis.fill_between(study.degrees, low[:, k], high[:, k], color=colour, alpha=0.15, linewidth=0)
        axis.plot(
            study.degrees,
            values[:, k],
            label=with_subscript(CATALOGUE[key].symbol),
            color=colour,
            marker=MARKERS[k % len(MARKERS)],
            markersize=3.5,
            linewidth=1.2,
        )
    axis.set_yscale("log")
    axis.set_title(
        f"{as_written(group) or 'all particles'} (n = {len(study.of_group(group))})", fontsize="medium"
    )
    axis.set_xlabel("$l_{max}$")
    axis.grid(True, which="major", alpha=0.3)


VIEW = np.array([[-0.5, 0.866, 0.0], [-0.296, -0.171, 0.94], [0.814, 0.47, 0.342]])
"""Rows: to the right, up, and towards the eye."""
LIGHT = np.array([0.35, 0.25, 0.9])
COLOUR, EDGE = np.array([0.902, 0.624, 0.0]), "0.15"
CELL, FONT_SIZE = 1.7, 22
"""Inches, and letters in a line of a label that is no wider than its room."""
PIXELS, SAMPLES = 240, 3
"""Of the picture of a union along each side, and of a pixel along each of its own."""


def gallery_figure(study: GalleryStudy) -> Figure:
    """A row a loss, a column a particle, those of a particle at one scale."""
    n_rows, n_columns = len(study.rows), len(study.names)
    figure = Figure(figsize=(1.6 + CELL * n_columns, 0.3 + CELL * n_rows), layout="constrained")
    axes = figure.subplots(n_rows, n_columns, squeeze=False)
    for column, name in enumerate(study.names):
        solids = [study.cells.get((row, column)) for row in range(n_rows)]
        reaches = [_reach(each.polyhedron) for each in solids if isinstance(each, GalleryPolyhedron)]
        for row, solid in enumerate(solids):
            axis = axes[row, column]
            axis.set_xticks([])
            axis.set_yticks([])
            axis.set_frame_on(False)
            if isinstance(solid, GalleryPolyhedron):
                _draw(axis, solid.polyhedron, 1.05 * max(reaches))
                axis.set_xlabel(f"J {solid.jaccard_distance:.3f}", fontsize=7)
        axes[0, column].set_title(as_written(name), fontsize=8)
    for row, label in enumerate(study.rows):
        axes[row, 0].set_ylabel(
            as_written(fill(label, FONT_SIZE)), rotation=0, ha="right", va="center", fontsize=8
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


def union_picture(compound: ConvexCompound, reach: float) -> FloatArray:
    """What is seen of a union of convex parts: red, green, blue and cover, shape (PIXELS, PIXELS, 4).

    A line towards the eye leaves each part through one plane, so that the facet that is seen is that of the
    part that it leaves last. Lines between facets are drawn where neighbouring samples see different ones.

    ``reach``: half the width of the picture, upper row first.
    """
    n = PIXELS * SAMPLES
    at = reach * (2.0 * (np.arange(n) + 0.5) / n - 1.0)
    flat = np.stack(np.meshgrid(at, -at), axis=-1).reshape(-1, 2) @ VIEW[:2]
    nearest, seen, first = np.full(n * n, -np.inf), np.full(n * n, -1), 0
    for normals, offsets in compound.part_planes:
        gap, speed = offsets - flat @ normals.T, normals @ VIEW[2]
        along = gap / np.where(speed == 0.0, 1e-300, speed)
        leaves = np.where(speed > 0.0, along, np.inf)
        far, near = leaves.min(axis=1), np.where(speed > 0.0, -np.inf, along).max(axis=1)
        better = (near < far) & (far > nearest)
        nearest[better], seen[better] = far[better], first + leaves.argmin(axis=1)[better]
        first += len(offsets)
    return _shaded(compound, seen.reshape(n, n))


def _shaded(compound: ConvexCompound, seen: IntArray) -> FloatArray:
    """Colours of the facets that samples see, -1 for none, with lines between them; pixels are means."""
    light = np.clip(compound.facet_normals @ VIEW.T @ LIGHT / np.linalg.norm(LIGHT), 0.0, 1.0)
    colours = np.clip((0.35 + 0.65 * light)[:, None] * COLOUR, 0.0, 1.0)
    samples = np.zeros((*seen.shape, 4))
    samples[..., 3] = seen >= 0
    samples[..., :3] = np.where(seen[..., None] >= 0, colours[seen], 0.0)
    for axis in (0, 1):
        for shift in (-2, -1, 1, 2):  # as wide as those of convex polyhedra
            samples[(seen >= 0) & (np.roll(seen, shift, axis) != seen), :3] = float(EDGE)
    pixels = samples.reshape(PIXELS, SAMPLES, PIXELS, SAMPLES, 4)
    cover = pixels[..., 3].mean(axis=(1, 3))
    colour = pixels[..., :3].sum(axis=(1, 3)) / np.maximum(pixels[..., 3].sum(axis=(1, 3)), 1.0)[..., None]
    return np.concatenate([colour, cover[..., None]], axis=2)


def _draw(axis: Axes, polyhedron: Polyhedron, reach: float) -> None:
    if isinstance(polyhedron, ConvexCompound):
        axis.imshow(union_picture(polyhedron, reach), extent=(-reach, reach, -reach, reach))
    else:
        outlines, brightness = visible_facets(polyhedron)
        colours = np.clip(brightness[:, None] * COLOUR, 0.0, 1.0)
        axis.add_collection(PolyCollection(outlines, facecolors=colours, edgecolors=EDGE, linewidths=0.5))
    axis.set_xlim(-reach, reach)
    axis.set_ylim(-reach, reach)
    axis.set_aspect("equal")


def _reach(polyhedron: Polyhedron) -> float:
    return float(np.abs(polyhedron.vertices @ VIEW[:2].T).max())


N_GALLERY_COLUMNS = 4
SURFACE_CELL = 1.9
"""Inches."""
SURFACE_COLOUR = np.array([0.62, 0.66, 0.71])


def degree_figure(surfaces: Mapping[str, Mesh | None]) -> Figure:
    """Each surface under its title, all at one scale; an empty place says that the radius is negative."""
    columns = min(N_GALLERY_COLUMNS, len(surfaces))
    rows = ceil(len(surfaces) / columns)
    figure = Figure(figsize=(SURFACE_CELL * columns, (SURFACE_CELL + 0.2) * rows), layout="constrained")
    axes = list(figure.subplots(rows, columns, squeeze=False).flat)
    flat = [mesh.vertices @ VIEW[:2].T for mesh in surfaces.values() if mesh is not None]
    low = np.min([each.min(axis=0) for each in flat], axis=0)
    high = np.max([each.max(axis=0) for each in flat], axis=0)
    middle, reach = (low + high) / 2, 0.53 * float((high - low).max())
    for axis, (title, mesh) in zip(axes, surfaces.items(), strict=False):
        axis.set_title(as_written(title), fontsize=8)
        if mesh is None:
            axis.text(0.5, 0.5, "the radius is negative", ha="center", fontsize=7, transform=axis.transAxes)
        else:
            draw_shaded(axis, mesh)
        axis.set_xlim(middle[0] - reach, middle[0] + reach)
        axis.set_ylim(middle[1] - reach, middle[1] + reach)
    for axis in axes:
        axis.set_aspect("equal")
        axis.set_axis_off()
    return figure


def draw_shaded(axis: Axes, mesh: Mesh) -> None:
    """The triangles that are turned to the eye, the farthest first, lit by one lamp."""
    normals = mesh.face_area_vectors @ VIEW.T
    lengths = np.linalg.norm(normals, axis=1)
    seen = np.flatnonzero(normals[:, 2] > 1e-9 * lengths)
    corners = mesh.triangles[seen] @ VIEW.T
    order = np.argsort(corners[:, :, 2].mean(axis=1), kind="stable")
    light = (normals[seen] / lengths[seen, None]) @ (LIGHT / np.linalg.norm(LIGHT))
    brightness = 0.35 + 0.65 * np.clip(light, 0.0, 1.0)
    colours = np.clip(brightness[order, None] * SURFACE_COLOUR, 0.0, 1.0)
    outlines = corners[order, :, :2]
    axis.add_collection(
        PolyCollection(
            list(outlines), facecolors=colours, edgecolors=colours, linewidths=0.3, rasterized=True
        )
    )


def write_degrees(surfaces: Mapping[str, Mesh | None], folder: Path) -> tuple[Path, Path]:
    """``degrees.png`` and ``degrees.svg``."""
    return write_figure(degree_figure(surfaces), folder, "degrees")
