"""Representatives of a dataset: thumbnails with captions and tool tips, error and size plots."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QEvent, QSize, Qt
from PySide6.QtWidgets import QLabel, QListView, QListWidget, QListWidgetItem, QWidget

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.representatives import QualityCurve, QualityPoint
from regolith_studio.dataset.size_distributions import ShapeClass
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.dataset_jobs import ChosenParticles
from regolith_studio.messages import N_
from regolith_studio.session.choices import Choices
from regolith_studio.ui.layout import named, vbox
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import localized, number_text, tr, tr_count, translate
from regolith_studio.ui.widgets.labels import heading
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve
from regolith_studio.ui.widgets.thumbnails import ThumbnailQueue

SIZE, CELL_WIDTH = 120, 140
"""Size of a thumbnail, and of a cell at least, in pixels."""
CAPTION_DIGITS = 24
"""Digits of a line of a caption beyond which it is elided."""


@dataclass(frozen=True)
class GalleryItem:
    """A mesh with caption and tool tip; `coarsened` selects the colour."""

    mesh: Mesh
    caption: str
    tip: str
    coarsened: bool = False


class RepresentativesGallery(QWidget):
    """A list of thumbnails, or a placeholder."""

    def __init__(self) -> None:
        super().__init__()
        self._theme = current_theme()
        self._shown: tuple[GalleryItem, ...] = ()
        self._pictures = ThumbnailQueue(SIZE, self)
        self.title = heading("")
        self.list = named(QListWidget(), "dataset_gallery", tr("Representative particles"))
        self.list.setViewMode(QListView.ViewMode.IconMode)
        self.list.setResizeMode(QListView.ResizeMode.Adjust)
        self.list.setMovement(QListView.Movement.Static)
        self.list.setIconSize(QSize(SIZE, SIZE))
        self.list.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        self.empty = QLabel()
        self.empty.setProperty("role", "hint")
        self.empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.empty.setWordWrap(True)
        vbox(self.title, (self.list, 1), (self.empty, 1), parent=self, margins=(8, 6, 8, 6))
        self.show_hint(has_particles=False)
        self.show_shapes("", ())

    @property
    def shown(self) -> tuple[GalleryItem, ...]:
        """The items, in order."""
        return self._shown

    def show_shapes(self, title: str, shown: Sequence[GalleryItem]) -> None:
        self.title.setText(title)
        self.title.setVisible(bool(title))
        self._shown = tuple(shown)
        self.list.clear()
        for each in self._shown:
            item = QListWidgetItem(each.caption)
            item.setToolTip(each.tip)
            item.setTextAlignment(Qt.AlignmentFlag.AlignHCenter)
            self.list.addItem(item)
        self.list.setVisible(bool(shown))
        self.empty.setVisible(not shown)
        self._fit_cells()
        self._redraw()

    def show_hint(self, *, has_particles: bool) -> None:
        """Say what to do to see particles here."""
        self.empty.setText(
            tr("Press Find representatives to show them here with their weights.")
            if has_particles
            else tr("No particles are open: open files, the sample, or draw some on the page Shape model.")
        )

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self._fit_cells()

    def _fit_cells(self) -> None:
        """Give all captions room for their lines, in any language and font size."""
        metrics = self.fontMetrics()
        lines = [line for each in self._shown for line in each.caption.split("\n")]
        limit = metrics.horizontalAdvance("0" * CAPTION_DIGITS)
        widest = max((min(metrics.horizontalAdvance(line), limit) for line in lines), default=0)
        cell = QSize(max(CELL_WIDTH, widest + 16), SIZE + 2 * metrics.lineSpacing() + 12)
        for row in range(self.list.count()):
            self.list.item(row).setSizeHint(cell)
        self.list.setGridSize(cell + QSize(4, 4))

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        self._redraw()

    def release(self) -> None:
        self._pictures.stop()

    def _redraw(self) -> None:
        colours = self._theme.particle, self._theme.polyhedron
        items = (self.list.item(row) for row in range(len(self._shown)))
        self._pictures.paint(
            (each.mesh, colours[each.coarsened], item.setIcon)
            for each, item in zip(self._shown, items, strict=True)
        )


NAMES = {
    "aspect_ratio": "AR",
    "sphericity": "S",
    "convexity": "V/CH",
    "min_diameter": "D<sub>min</sub>",
    "max_diameter": "D<sub>max</sub>",
}
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8c6d00")
WEIGHTINGS = (N_("number"), N_("volume"))
"""Weightings of distributions."""
MAX_CLASSES = 12
"""Number of classes up to which each distribution is drawn; beyond it only the mixture."""


class QualityPlot(CurvePlot):
    """Wasserstein distance per descriptor, their mean, and the sampling noise of the population."""

    def __init__(self) -> None:
        self._points: tuple[QualityPoint, ...] = ()
        self._noise: float | None = None
        super().__init__(
            tr("Number of representatives"),
            tr("Wasserstein distance / σ"),
            tr("Press Find representatives to plot the error against their number."),
            log_y=True,
        )
        self.setObjectName("dataset_quality")
        self.axes["left"].setToolTip(tr("σ: standard deviation of the population"))

    @property
    def points(self) -> tuple[QualityPoint, ...]:
        return self._points

    def show_points(self, points: Sequence[QualityPoint]) -> None:
        self._points, self._noise = tuple(points), None
        self._draw()

    def show_curve(self, curve: QualityCurve | None) -> None:
        """Draw the whole curve, or nothing."""
        self._points = curve.points if curve else ()
        self._noise = curve.noise_mean if curve else None
        enough = curve.sufficient_count if curve else None
        self.set_hint(tr("below the sampling noise for N ≥ {count}", count=enough) if enough else "")
        self._draw()

    def set_theme(self, theme: Theme) -> None:
        before = self.theme
        super().set_theme(theme)
        if theme != before:
            self._draw()

    def _draw(self) -> None:
        counts = tuple(float(point.count) for point in self._points)
        curves = [
            PlotCurve(NAMES.get(key, key), colour, counts, self._column(key), markers=len(counts) < 40)
            for key, colour in zip(NAMES, COLOURS, strict=True)
        ]
        curves.append(
            PlotCurve(
                tr("mean"),
                self.theme.text,
                counts,
                tuple(map(_positive, (point.mean for point in self._points))),
            )
        )
        if self._noise is not None and counts:
            ends = (counts[0], counts[-1])
            curves.append(
                PlotCurve(tr("noise"), self.theme.muted, ends, (self._noise, self._noise), dash=True)
            )
        self.set_curves(curves)

    def _column(self, key: str) -> tuple[float, ...]:
        return tuple(_positive(point.errors.get(key, np.nan)) for point in self._points)


def _positive(error: float) -> float:
    """NaN instead of zero, which a logarithmic axis cannot show."""
    return float(error) if error > 1e-6 else float("nan")


class SizesPlot(CurvePlot):
    """Cumulative distribution of the mixture and, up to :data:`MAX_CLASSES`, of each class."""

    def __init__(self) -> None:
        self._classes: tuple[ShapeClass, ...] = ()
        super().__init__(
            tr("Equivalent diameter [µm]"),
            tr("Cumulative [%]"),
            tr("The sizes of the classes appear here."),
        )
        self.setObjectName("dataset_sizes")

    @property
    def classes(self) -> tuple[ShapeClass, ...]:
        return self._classes

    def show_classes(self, classes: Sequence[ShapeClass]) -> None:
        """Draw other distributions; none for the placeholder."""
        self._classes = tuple(classes)
        self._draw()

    def set_theme(self, theme: Theme) -> None:
        before = self.theme
        super().set_theme(theme)
        if theme != before:
            self._draw()

    def _draw(self) -> None:
        if not self._classes:
            self.set_curves(())
            return
        weights = np.array([one.weight for one in self._classes])
        low = min(float(one.sizes.quantile(0.002)) for one in self._classes)
        high = max(float(one.sizes.quantile(0.998)) for one in self._classes)
        at = np.linspace(max(0.0, low - 0.05 * (high - low) - 1e-3 * low), high * 1.03, 400)
        rows = np.array([one.sizes.cdf(at) for one in self._classes])
        curves = []
        if len(self._classes) <= MAX_CLASSES:
            names = [tr("each class"), *[""] * (len(rows) - 1)]
            curves = [
                PlotCurve(name, self.theme.border, tuple(at), tuple(100 * row))
                for name, row in zip(names, rows, strict=True)
            ]
        mixture = 100 * (weights @ rows) / weights.sum()
        kinds = {one.sizes.weighting for one in self._classes}
        joint = " " + tr("and") + " "
        words = tr("all classes, weighted by {kinds}", kinds=joint.join(tr(each) for each in sorted(kinds)))
        curves.append(PlotCurve(words, self.theme.accent, tuple(at), tuple(mixture)))
        self.set_curves(curves)


def chosen_particles(particles: Sequence[Particle], chosen: ChosenParticles) -> list[GalleryItem]:
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
        words = f"{localized(f'{100 * weight:.1f} %')}, {facets}\n{one.name}"
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
    fineness = tr("at most {faces} facets", faces=choices.facet_count)
    if choices.stop_at == "error":
        limit = number_text(100 * choices.largest_error, "g")
        fineness = tr("the fewest facets with all errors below {limit} %", limit=limit)
    return tr(
        "Each with {fineness}; method: {method} (see Explore).",
        fineness=fineness,
        method=tr(known.label) if known else choices.method,
    )


def provenance_text(dataset: Dataset) -> str:
    """What a dataset was made from and with, as far as it says so."""
    origin, words = dataset.provenance, []
    if origin.representation is not None:
        count = origin.representation.n_particles
        words.append(tr_count(N_("1 particle"), N_("{count} particles"), count))
    if (made := origin.coarsening) is not None:
        known = METHODS.get(made.method)
        target = tr("target: particle")
        if made.target == "fit":
            target = tr("target: fit of degree {l_max}", l_max=origin.l_max or 0)
        facets = tr("n = {facets}", facets=made.n_facets)
        if made.max_error is not None:
            limit = number_text(100 * made.max_error, "g")
            facets = tr("the fewest facets with all errors below {limit} %", limit=limit)
        words += [
            translate(known.label) if known else made.method,
            facets,
            target,
            tr("seed {seed}", seed=made.seed),
        ]
    return ", ".join(words)


def _by_share(shown: list[tuple[float, GalleryItem]]) -> list[GalleryItem]:
    return [each for _, each in sorted(shown, key=lambda pair: -pair[0])]
