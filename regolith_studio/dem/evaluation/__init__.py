"""From particle positions to the surface of a heap and its slopes, as section 3.3 describes it.

* :mod:`~regolith_studio.dem.evaluation.profile`: a vertical section and the surface of the heap in it.
* :mod:`~regolith_studio.dem.evaluation.section`: the asymmetric and the symmetric triangle in one section.
"""

from dataclasses import dataclass

from regolith_studio.dataset.parameters import check_limits
from regolith_studio.errors import InputError
from regolith_studio.messages import N_
from regolith_studio.settings import setting


@dataclass(frozen=True)
class EvaluationSettings:
    """Parameters of the evaluation. Lengths are in mean particle diameters.

    Parameters
    ----------
    gap
        Vertical gap that ends the connected column from the base ("a multiple of the mean diameter").
    bin_width
        Distance of the vertical lines on which the surface is read.
    median_window
        Points of the rolling median, odd; 1 for none.
    cut_top, cut_bottom
        Shares of the heap's height that are left out above and below (the paper: 0.15).
    toe
        Minimum height of the lower cut: one layer of particles is no flank. 0 as in the paper.
    slab
        Thickness of the slice that is projected; 0 projects the whole pile, as the paper does.
    grain_correction
        Raise the surface by :func:`~regolith_studio.dem.evaluation.section.silhouette_deficit`, the bias of
        a pile of few grains; only for the projection of the whole pile. The paper does not.
    azimuths
        Vertical sections, equally spaced over half a turn and beginning with x-z; even, so that y-z is
        one of them. 2 for the paper's two.
    min_points
        Minimum number of surface points of a flank.
    min_particles
        Minimum number of particles of a pile.
    min_height
        Minimum height of a heap; what is lower is a layer.
    confidence
        Of the interval.

    Raises
    ------
    InputError
        If a value is out of its range.
    """

    gap: float = setting(1.0, N_("Gap, in mean d"), minimum=0.1, maximum=10.0)
    bin_width: float = setting(0.5, N_("Bin width, in mean d"), minimum=0.05, maximum=3.0)
    median_window: int = setting(5, N_("Rolling median"), minimum=1, maximum=101)
    cut_top: float = setting(0.15, N_("Upper cut"), minimum=0.0, maximum=0.45)
    cut_bottom: float = setting(0.15, N_("Lower cut"), minimum=0.0, maximum=0.45)
    toe: float = setting(1.5, N_("Minimum height of the cut, in mean d"), minimum=0.0, maximum=10.0)
    slab: float = setting(0.0, N_("Slice, in mean d"), N_("0: whole heap"), minimum=0.0, maximum=1000.0)
    grain_correction: bool = setting(True, N_("Correct for grain size"), minimum=False, maximum=True)
    azimuths: int = setting(12, N_("Sections"), minimum=2, maximum=360)
    min_points: int = setting(4, N_("Points per flank"), minimum=3, maximum=1000)
    min_particles: int = setting(150, N_("Minimum number of particles"), minimum=10, maximum=1_000_000)
    min_height: float = setting(2.5, N_("Minimum height of the heap, in mean d"), minimum=0.0, maximum=100.0)
    confidence: float = setting(0.95, N_("Confidence"), minimum=0.5, maximum=0.999)

    def __post_init__(self) -> None:
        check_limits(self, "evaluation setting")
        if self.median_window % 2 == 0:
            raise InputError(f"The rolling median needs an odd number of points, got {self.median_window}.")
        if self.azimuths % 2:
            raise InputError(
                f"The number of sections must be even, with x-z and y-z among them, got {self.azimuths}."
            )


MAX_ANGLE = 60.0
"""Maximum angle in degrees; a steeper heap is a column that has not collapsed."""
MIN_R_SQUARED = 0.7
"""Minimum R squared of the fit of two straight flanks."""
MAX_CURVATURE = 0.5
"""Maximum difference of the slopes at foot and top of a flank, in units of its slope. Measured: 0.8 to 1.4 on
domes, -0.7 to -1.1 on exponential heaps, 0.3 at most on cones of 1,000 balls."""
HEAP_SHARE = 0.6
"""Minimum share of the particles that must lie in the heap."""
