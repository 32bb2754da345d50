"""Settings from grey values to particles: denoising, threshold, cleaning, separation, surface (section 2.1).

Imports no numerics: the command line makes its options of these fields.
"""

from dataclasses import dataclass
from typing import Literal, get_args

from regolith_studio.errors import InputError
from regolith_studio.messages import N_
from regolith_studio.settings import check_settings, setting

DenoiseMethod = Literal["none", "gaussian", "median", "non-local-means"]
DENOISE_METHODS: tuple[DenoiseMethod, ...] = get_args(DenoiseMethod)
ThresholdMethod = Literal["otsu", "multi-otsu", "manual", "probability"]
THRESHOLDS = {
    "otsu": N_("Otsu"),
    "multi-otsu": N_("Multi-Otsu, three classes"),
    "manual": N_("By hand: drag the line"),
    "probability": N_("Probability map"),
}
Surface = Literal["mask", "grey"]
MAX_VOXELS = 2**63 - 1


@dataclass(frozen=True)
class DenoiseSettings:
    """How grey values are smoothed before they are thresholded; lengths in voxels.

    - ``method``: ``gaussian`` is fast and rounds edges a little; ``median`` keeps edges and removes single
      outliers; ``non-local-means`` averages similar patches, keeps edges and fine cracks best and takes
      longest.
    - ``sigma``: standard deviation of the Gaussian.
    - ``size``: edge of the median's cube; odd.
    - ``strength``: of the non-local means: patches count as similar up to this many standard deviations of
      the noise.
    - ``patch``, ``reach``: of the non-local means: edge of a patch (odd), and how far away patches are
      searched.

    Raises InputError if a value is out of its range.
    """

    method: DenoiseMethod = setting(
        "median",
        N_("Denoise"),
        N_("Smoothing of the grey values."),
        choices={
            "median": N_("Median of 27 voxels"),
            "gaussian": N_("Gaussian (fast)"),
            "non-local-means": N_("Non-local means (slow)"),
            "none": N_("None"),
        },
    )
    sigma: float = setting(0.8, "Standard deviation of the Gaussian", minimum=1e-6, maximum=10.0)
    size: int = setting(3, "Edge of the median's cube", minimum=3, maximum=9)
    strength: float = setting(0.8, "Strength of the non-local means", minimum=1e-6, maximum=10.0)
    patch: int = setting(3, "Edge of a patch", minimum=3, maximum=9)
    reach: int = setting(3, "Distance at which patches are searched", minimum=1, maximum=10)

    def __post_init__(self) -> None:
        check_settings(self)
        for name, value in (("median's size", self.size), ("patch", self.patch)):
            if value % 2 == 0:
                raise InputError(f"The {name} is an odd number from 3 to 9, got {value}.")

    @property
    def margin(self) -> int:
        """Slices beyond a slab that the result in the slab depends on."""
        match self.method:
            case "gaussian":
                return int(4.0 * self.sigma + 0.5)
            case "median":
                return self.size // 2
            case "non-local-means":
                return self.reach + self.patch // 2 + 1
            case _:
                return 0


@dataclass(frozen=True)
class ThresholdSettings:
    """Which voxels are grains.

    - ``method``: ``otsu`` parts the histogram in two, ``multi-otsu`` in `classes` (pores, resin and minerals
      of different brightness), ``manual`` takes `value`, and ``probability`` reads the volume as the
      probability of a voxel to be grain, as ilastik exports it: 0 to 1, or over the range of its type.
    - ``value``: level of ``manual`` in grey values, of ``probability`` from 0 to 1.
    - ``classes``, ``boundary``: of ``multi-otsu``: parts of the histogram, 3 to 5, and which boundary
      between them is taken, counted from the dark end from 1.
    - ``dark``: whether grains are what lies below the level.
    - ``low``: of ``probability``: the lower threshold of a hysteresis. Voxels from there on belong to a
      grain if they are connected to some from `value` on (Canny 1986); 0 for no hysteresis.

    Raises InputError if a value is out of its range.
    """

    method: ThresholdMethod = setting(
        "otsu",
        N_("Threshold"),
        choices=THRESHOLDS,
    )
    value: float = setting(
        0.5,
        N_("Grey level at which grains begin"),
        symbol=N_("Level"),
        minimum=-1e300,
        maximum=1e300,
        decimals=2,
    )
    classes: int = setting(3, "Classes of the histogram", minimum=3, maximum=5)
    boundary: int = setting(1, N_("Boundary"), minimum=1, maximum=4)
    dark: bool = setting(False, N_("Grains are dark"), N_("Grains are darker than what is between them."))
    low: float = setting(
        0.0,
        N_("Lower probability of a hysteresis"),
        N_(
            "Hysteresis: voxels from this probability on belong to a grain if they are connected to some "
            "from the level on; 0 for none."
        ),
        symbol=N_("Hysteresis"),
        step=0.05,
        decimals=2,
    )

    def __post_init__(self) -> None:
        check_settings(self)
        if self.method == "probability" and not 0.0 < self.value < 1.0:
            raise InputError(f"The threshold of a probability lies between 0 and 1, got {self.value}.")
        if self.low and (self.method != "probability" or self.dark or not 0.0 < self.low < self.value):
            raise InputError(
                f"The lower threshold of a hysteresis lies between 0 and the threshold, {self.value:g}, of a "
                f"probability to be grain, got {self.low:g}."
            )
        if self.boundary >= self.classes:
            raise InputError(
                f"Multi-Otsu takes 3 to 5 classes and a boundary from 1 to one less than that, got "
                f"{self.classes} and {self.boundary}."
            )

    @property
    def is_automatic(self) -> bool:
        """Whether the level follows from the histogram."""
        return self.method in ("otsu", "multi-otsu")


@dataclass(frozen=True)
class CleaningSettings:
    """Morphology of the mask, in voxels.

    - ``opening``: removes what is thinner than about twice this: small components, thin bridges.
    - ``closing``: closes cracks and gaps thinner than about twice this.
    - ``fill_pores``: fill pores inside grains that have no way out.
    - ``min_voxels``: drop what has fewer voxels, before and after grains are split.

    Raises InputError if a value is out of its range.
    """

    opening: int = setting(
        0,
        N_("Opening"),
        N_("Removes specks and thin bridges, in voxels."),
        minimum=0,
        maximum=10,
        slider=(0, 5),
    )
    closing: int = setting(
        0, N_("Closing"), N_("Closes cracks and thin gaps, in voxels."), minimum=0, maximum=10, slider=(0, 5)
    )
    fill_pores: bool = setting(
        True, N_("Fill closed pores"), N_("Pores enclosed by a grain are counted as grain.")
    )
    min_voxels: int = setting(64, "Minimum number of voxels of a body", minimum=0)

    def __post_init__(self) -> None:
        check_settings(self)

    @property
    def margin(self) -> int:
        """Slices beyond a slab that the result in the slab depends on."""
        return 2 * (self.opening + self.closing)


@dataclass(frozen=True)
class SplittingSettings:
    """How touching grains are parted.

    - ``enabled``: otherwise each connected body is one grain.
    - ``h_maxima``: persistence up to which a peak of the distance map is no grain of its own, in voxels.
    - ``relative``: the same as a share of the peak's height, 0 to 1; the larger of the two counts. Large
      grains have larger bumps, so that a mixture of sizes is parted better with some of both.

    Raises InputError if a value is out of its range.
    """

    enabled: bool = setting(
        True, N_("Separate touching grains"), N_("Otherwise each connected body is one grain.")
    )
    h_maxima: float = setting(
        0.8,
        N_("Height of a maximum that is a grain of its own, in voxels"),
        N_(
            "Height above which a maximum of the distance map is a grain of its own. Increase it if "
            "grains are split, reduce it if grains stay connected."
        ),
        symbol="h",
        minimum=0.0,
        maximum=1e6,
        step=0.1,
        slider=(0.0, 6.0),
        metavar="H",
    )
    relative: float = setting(0.1, "Relative height of a maximum", minimum=0.0, maximum=1.0)

    def __post_init__(self) -> None:
        check_settings(self)


@dataclass(frozen=True)
class TileSettings:
    """When and how a body is cut into tiles, in voxels.

    - ``largest``: voxels of the box of a body that is not cut.
    - ``core``: edge of a tile.
    - ``margin``: looked at around a tile at first; doubled, at most twice, where it cuts a grain.
    """

    largest: int = 2**23
    core: int = 128
    margin: int = 40


@dataclass(frozen=True)
class ExtractionSettings:
    """Which labels become particles, and how they are contoured.

    - ``exclude_border``: leave out what touches the border of the volume, and so is cut.
    - ``min_voxels``: leave out what has fewer voxels; 268 are those of a ball of 8 voxels in diameter.
    - ``warn_diameter``: note on particles below this diameter, in voxels, that their shape is coarse; thin
      ones by their shortest axis.
    - ``fill_pores``: close pores that have no way out.
    - ``iterations``, ``pass_band``: of the smoothing (:func:`~regolith_studio.imaging.contours.LowPass`).
    - ``surface``: what surfaces are taken from: the ``grey`` values about each label where they are at hand
      (:mod:`~regolith_studio.imaging.grain_surface`), or its ``mask`` always.

    Raises InputError if a value is out of its range.
    """

    exclude_border: bool = setting(
        True,
        N_("Leave out grains at the border"),
        N_("They are cut by the border. The others then have larger weights (Miles-Lantuéjoul)."),
    )
    min_voxels: int = setting(
        268,
        N_("Minimum number of voxels of a grain"),
        N_("Grains of fewer voxels are left out; below 12 voxels in diameter shapes are coarse."),
        symbol=N_("Smallest"),
        minimum=0,
        maximum=MAX_VOXELS,
        slider=(0, 2000),
    )
    warn_diameter: float = 12.0
    fill_pores: bool = True
    iterations: int = setting(20, "Iterations of the smoothing", minimum=0)
    # 0.1 takes 2.5 % off the area of a contour of polyhedra of 7 to 9 facets (24 voxels), 0.13 takes 1.7 %;
    # balls have 1.5 % too much. The refinement of the surface begins there.
    pass_band: float = setting(0.13, "Pass band of the smoothing", minimum=1e-9, maximum=2.0)
    surface: Surface = setting(
        "grey",
        N_("Surface"),
        N_(
            "The grey values around a grain give its volume more accurately than its mask, "
            "also in blurred scans."
        ),
        choices={"grey": N_("Grey values"), "mask": N_("Mask")},
    )

    def __post_init__(self) -> None:
        check_settings(self)
