"""Parse size distributions from one line of text, for the command line and the window."""

from collections.abc import Callable, Sequence

import numpy as np
from pydantic import ValidationError

from regolith_studio.dataset.build import ShapeClass
from regolith_studio.dataset.size_distributions import (
    PAPER_CLASSES_UM,
    DiscreteSizeDistribution,
    LogNormalSizeDistribution,
    RosinRammlerSizeDistribution,
    SieveSizeDistribution,
    SizeDistribution,
    Weighting,
)
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray

FORMS = (
    "measured",
    "classes:25,37,56,84,125",
    "fitted:log-normal",
    "discrete:25=85.5,37=12.6,56=1.7",
    "sieve:20,32,45,63=10,60,30",
    "log-normal:MEDIAN,SIGMA",
    "rosin-rammler:SCALE,SHAPE,MIN,MAX",
)
"""Valid forms; shares count particles, or volume with the suffix ``@volume``."""

SizeRule = Callable[[ShapeClass], SizeDistribution]
"""Function from a class with its measured sizes to its size distribution."""


def parse_sizes(text: str) -> SizeRule:
    """The rule that a text of :data:`FORMS` describes.

    ``measured`` keeps the members' diameters; ``classes`` rounds each to the nearest of these diameters (the
    paper's Table 1); ``fitted:log-normal`` has the mean and deviation of their ln d; the others are the same
    for every class. Diameters in micrometres.

    Raises
    ------
    InputError
        If the text has another form, or describes no distribution.
    """
    body, _, counted = text.strip().partition("@")
    if counted not in ("", "number", "volume"):
        raise InputError(f"@ must be followed by number or volume, got {counted!r}.")
    weighting: Weighting = "volume" if counted == "volume" else "number"
    kind, _, rest = body.partition(":")
    if kind in ("measured", "classes", "fitted"):
        if counted:
            raise InputError(f"{kind} sizes are weighted as the dataset is; remove @{counted}.")
        return _from_members(kind, rest)
    if kind not in {form.partition(":")[0] for form in FORMS}:
        raise InputError(_no_form(text))
    try:
        fixed = _fixed(kind, rest, weighting)
    except ValidationError as error:
        reason = error.errors(include_url=False)[0]
        place = ".".join(str(part) for part in reason["loc"])
        raise InputError(f"The sizes {text!r} describe no distribution: {place} {reason['msg']}.") from error
    return lambda _: fixed


def _from_members(kind: str, rest: str) -> SizeRule:
    if kind == "measured" and not rest:
        return lambda own: own.sizes
    if kind == "classes":
        classes = _numbers(rest) if rest else list(PAPER_CLASSES_UM)
        if sorted(set(classes)) != classes or classes[0] <= 0.0:
            raise InputError(f"Size classes must be positive and ascending, got {rest!r}.")
        return lambda own: _in_classes(own, classes)
    if kind == "fitted" and rest == "log-normal":
        return _fitted_log_normal
    raise InputError(_no_form(f"{kind}:{rest}"))


def _fixed(kind: str, rest: str, weighting: Weighting) -> SizeDistribution:
    if kind == "discrete":
        pairs = [pair.partition("=") for pair in rest.split(",")]
        diameters = _numbers(",".join(first for first, _, _ in pairs))
        amounts = _numbers(",".join(second or "1" for _, _, second in pairs))
        return DiscreteSizeDistribution.of(diameters, amounts, weighting)
    if kind == "sieve":
        openings, _, shares = rest.partition("=")
        return SieveSizeDistribution.of(_numbers(openings), _numbers(shares), weighting)
    numbers = _numbers(rest)
    if kind == "log-normal" and len(numbers) == 2:
        return LogNormalSizeDistribution(weighting=weighting, median_um=numbers[0], log_deviation=numbers[1])
    if kind == "rosin-rammler" and len(numbers) == 4:
        scale, shape, smallest, largest = numbers
        return RosinRammlerSizeDistribution(
            weighting=weighting, scale_um=scale, shape=shape, min_um=smallest, max_um=largest
        )
    raise InputError(_no_form(f"{kind}:{rest}"))


def _in_classes(own: ShapeClass, classes: Sequence[float]) -> DiscreteSizeDistribution:
    diameters, shares = _members(own)
    limits = np.sqrt(np.array(classes[:-1]) * np.array(classes[1:]))
    place = np.searchsorted(limits, diameters)
    amounts = np.bincount(place, weights=shares, minlength=len(classes))
    return DiscreteSizeDistribution.of(classes, amounts, own.sizes.weighting)


def _fitted_log_normal(own: ShapeClass) -> SizeDistribution:
    """The measured sizes if their deviation is zero."""
    diameters, shares = _members(own)
    logarithms = np.log(diameters)
    mean = float(shares @ logarithms)
    deviation = float(np.sqrt(shares @ (logarithms - mean) ** 2))
    if deviation < 1e-6:
        return own.sizes
    return LogNormalSizeDistribution(
        weighting=own.sizes.weighting, median_um=float(np.exp(mean)), log_deviation=deviation
    )


def _members(own: ShapeClass) -> tuple[FloatArray, FloatArray]:
    if not isinstance(own.sizes, DiscreteSizeDistribution):
        raise InputError("Only measured sizes can be moved into classes or fitted.")
    return np.array(own.sizes.diameters_um), np.array(own.sizes.shares)


def _numbers(text: str) -> list[float]:
    try:
        return [float(word) for word in text.split(",")]
    except ValueError:
        raise InputError(f"Numbers must be separated by commas, as 25,37,56; got {text!r}.") from None


def _no_form(text: str) -> str:
    return f"{text.strip(':')!r} is not a size distribution; write one of: {'; '.join(FORMS)}."
