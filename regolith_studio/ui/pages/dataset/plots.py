"""Plots of the error against the number of representatives, and of the size distributions."""

from collections.abc import Sequence

import numpy as np

from regolith_studio.dataset.build import ShapeClass
from regolith_studio.dataset.quality import QualityCurve, QualityPoint
from regolith_studio.messages import N_
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve

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
            tr("Distance to the population [deviations]"),
            tr("Press Find representatives to plot the error against their number."),
            log_y=True,
        )
        self.setObjectName("dataset_quality")

    @property
    def points(self) -> tuple[QualityPoint, ...]:
        """The data that are drawn."""
        return self._points

    def show_points(self, points: Sequence[QualityPoint]) -> None:
        """Draw the points that are computed so far."""
        self._points, self._noise = tuple(points), None
        self._draw()

    def show_curve(self, curve: QualityCurve | None) -> None:
        """Draw the whole curve, or nothing."""
        self._points = curve.points if curve else ()
        self._noise = curve.noise_mean if curve else None
        enough = curve.sufficient_count if curve else None
        self.set_remark(tr("below the sampling noise for N ≥ {count}", count=enough) if enough else "")
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
            tr("Share at or below [%]"),
            tr("The sizes of the classes appear here."),
        )
        self.setObjectName("dataset_sizes")

    @property
    def classes(self) -> tuple[ShapeClass, ...]:
        """The data that are drawn."""
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
            curves = [PlotCurve("", self.theme.border, tuple(at), tuple(100 * row)) for row in rows]
        mixture = 100 * (weights @ rows) / weights.sum()
        kinds = {one.sizes.weighting for one in self._classes}
        joint = " " + tr("and") + " "
        words = tr("all classes, weighted by {kinds}", kinds=joint.join(tr(each) for each in sorted(kinds)))
        curves.append(PlotCurve(words, self.theme.accent, tuple(at), tuple(mixture)))
        self.set_curves(curves)
