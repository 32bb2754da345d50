"""From grey values to labels: denoise, threshold, clean, find bodies, part touching grains.

Everything happens slab by slab or body by body, so that the volume never has to be in memory
whole: give a :class:`~regolith_studio.imaging.volume_slabs.ScratchArrays` in a folder for that. Tasks read
and write their own slabs of these arrays, also in other processes, and can be done twice.
"""

from collections.abc import Generator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.imaging.connected_components import (
    ComponentJoiner,
    ConnectedComponents,
    SlabComponents,
    components_of_slab,
)
from regolith_studio.imaging.segmentation.denoising import denoised_volume
from regolith_studio.imaging.segmentation.label_edits import LabelEdit, apply_edits
from regolith_studio.imaging.segmentation.object_classifier import (
    ObjectTable,
    ObjectTraining,
    describe_objects,
    sort_objects,
)
from regolith_studio.imaging.segmentation.pixel_classifier import (
    TrainingSet,
    box_probability,
    check_voxel_size,
    probability_map,
    probability_volume,
    train,
)
from regolith_studio.imaging.segmentation.scan_outside import OUTSIDE, Padding, ScanOutside, background_filled
from regolith_studio.imaging.segmentation.splitting import GrainSplitter
from regolith_studio.imaging.segmentation.thresholding import (
    Histogram,
    cleaned,
    grain_voxels,
    level_of,
    threshold_words,
    weak_level,
)
from regolith_studio.imaging.settings import (
    CleaningSettings,
    DenoiseSettings,
    SplittingSettings,
    ThresholdSettings,
    TileSettings,
)
from regolith_studio.imaging.volume import Box, Volume
from regolith_studio.imaging.volume_slabs import (
    ParallelMap,
    ScratchArrays,
    SharedArray,
    SliceSource,
    slab_ranges,
    unpacked,
)
from regolith_studio.io.tables import Column, Table
from regolith_studio.messages import N_, Message, Number
from regolith_studio.steps import as_events, result_of


@dataclass(frozen=True)
class SegmentationSettings:
    """The recipe from grey values to labels.

    - ``classifier``: turns the grey values into the probability of a voxel to be grain, which `threshold`
      then takes; without one the threshold takes the volume as it is.
    - ``objects``: says which of the grains that were found are kept, split again or dropped.
    - ``edits``: corrections by hand, which come last.
    """

    denoise: DenoiseSettings = field(default_factory=DenoiseSettings)
    threshold: ThresholdSettings = field(default_factory=ThresholdSettings)
    cleaning: CleaningSettings = field(default_factory=CleaningSettings)
    splitting: SplittingSettings = field(default_factory=SplittingSettings)
    tiles: TileSettings = field(default_factory=TileSettings)
    classifier: TrainingSet | None = None
    objects: ObjectTraining | None = None
    edits: tuple[LabelEdit, ...] = ()

    @property
    def uncorrected(self) -> "SegmentationSettings":
        """The same without what is done with the grains once they are found."""
        return replace(self, objects=None, edits=())

    def __post_init__(self) -> None:
        if self.classifier is not None and self.threshold.method != "probability":
            raise InputError(
                "With a classifier, the threshold is a probability from 0 to 1, not "
                f"{self.threshold.method!r}."
            )


@dataclass(frozen=True)
class SegmentationProgress:
    """A step is done: `done` of `total` of the work that `stage` names."""

    stage: str
    done: int
    total: int


@dataclass(frozen=True, eq=False)
class Segmentation:
    """What came out of a volume of grey values.

    - ``labels``: 0 between grains, 1 to n in them; with gaps where grains were dropped, merged or deleted.
    - ``sizes``: voxels of each grain in the order of their labels, shape (n,).
    - ``level``: grey value at which grains begin.
    - ``seen``: histogram of the denoised values.
    - ``n_bodies``: connected bodies before they were parted, the small ones left out.
    - ``n_small``: ConnectedComponents and grains that were dropped for their size.
    - ``n_not_finite``: voxels without a finite number (NaN, infinities), which are in no grain.
    - ``probability``: at which grains begin, where the values are probabilities; else none.
    - ``outside``: what lies outside of the scanner's circle, where the labels are -1.
    """

    labels: Volume
    sizes: IntArray
    level: float
    seen: Histogram
    n_bodies: int
    n_small: int
    n_not_finite: int = 0
    probability: float | None = None
    outside: ScanOutside | None = None

    @property
    def n_grains(self) -> int:
        """Number of grains."""
        return len(self.sizes)

    @property
    def counts(self) -> str:
        """How many grains of how many bodies."""
        templates = {
            (True, True): N_("1 grain from 1 connected body"),
            (True, False): N_("1 grain from {bodies} connected bodies"),
            (False, True): N_("{grains} grains from 1 connected body"),
            (False, False): N_("{grains} grains from {bodies} connected bodies"),
        }
        template = templates[self.n_grains == 1, self.n_bodies == 1]
        return Message(template, grains=self.n_grains, bodies=self.n_bodies)

    @property
    def summary(self) -> str:
        """One sentence for the user."""
        template = N_("{counts} at {threshold}; {small} too small.")
        if self.n_not_finite:
            template = N_(
                "{counts} at {threshold}; {small} too small. {voxels} voxels hold no finite number "
                "(NaN or infinity) and are in no grain."
            )
        return Message(
            template,
            counts=self.counts,
            threshold=threshold_words(self.level, self.probability),
            small=self.n_small,
            voxels=Number(self.n_not_finite, ","),
        )


Steps = Generator[SegmentationProgress, None, Segmentation]


def segment(
    volume: Volume, settings: SegmentationSettings | None = None, outside: ScanOutside | None = None
) -> Segmentation:
    """Run :func:`segmentation_steps` on a volume in memory to its end."""
    return result_of(segmentation_steps(volume, settings, outside=outside))


def segmentation_steps(
    source: SliceSource,
    settings: SegmentationSettings | None = None,
    scratch: ScratchArrays | None = None,
    run: ParallelMap = map,
    outside: ScanOutside | None = None,
) -> Steps:
    """Find the grains in grey values, telling after each step how far it is.

    - ``source``: the grey values, or the probabilities of voxels to be grain.
    - ``scratch``: where arrays as large as the volume lie, the result among them; in memory by default.
    - ``run``: applies what is done to slabs and to bodies; the result does not depend on it. Other processes
      than this one need `source` and `scratch` in files.
    - ``outside``: what lies outside of the scanner's circle: in no grain, and of no effect on the level.

    Raises InputError if the volume is too uniform for an automatic threshold, or no grain is found.
    """
    settings, scratch = settings or SegmentationSettings(), scratch or ScratchArrays()
    volume: Volume = yield from _staged(N_("Reading the slices"), unpacked(source, scratch, run))
    bodies = yield from _find_bodies(volume, settings, scratch, run, outside)
    numbers: NDArray[np.int32] = scratch.zeros(volume.shape, np.int32)
    sizes, n_parts = yield from _parted(numbers, bodies, settings, scratch, run)
    scratch.drop(bodies.numbers.array)
    least = settings.cleaning.min_voxels
    probability = settings.threshold.value if settings.threshold.method == "probability" else None
    if not len(sizes):
        threshold = threshold_words(bodies.level, probability)
        raise InputError(
            f"No grain of {least} voxels or more was found in {source.name} at {threshold}; "
            "is the threshold right, and are grains brighter than what is between them?"
        )
    small = int((bodies.bodies.sizes < least).sum()) + n_parts - len(sizes)
    labels = Volume(numbers, bodies.edges, "labels", f"{source.name}, labels", source.origin)
    n_bodies = int((bodies.bodies.sizes >= least).sum())
    result = Segmentation(
        labels, sizes, bodies.level, bodies.seen, n_bodies, small, bodies.n_not_finite, probability, outside
    )
    _mark_outside(numbers, volume, outside)
    if settings.objects is None and not settings.edits:
        return result
    sizes = yield from _correct(numbers, volume, settings, outside)
    return replace(result, sizes=sizes)


def correction_steps(
    segmentation: Segmentation,
    grey: Volume,
    settings: SegmentationSettings,
    scratch: ScratchArrays | None = None,
    objects: ObjectTable | None = None,
) -> Steps:
    """A copy of a segmentation with the objects and edits of `settings`, as :func:`segmentation_steps` ends.

    - ``segmentation``: the segmentation without them.
    - ``grey``: what it was found in.
    - ``objects``: the objects of `segmentation`, if they have been described.

    Raises InputError if an edit does not find its grains, or no grain is left.
    """
    numbers: NDArray[np.int32] = (scratch or ScratchArrays()).zeros(segmentation.labels.shape, np.int32)
    np.copyto(numbers, segmentation.labels.array)
    sizes = yield from _correct(numbers, grey, settings, segmentation.outside, objects)
    return replace(segmentation, labels=replace(segmentation.labels, array=numbers), sizes=sizes)


def _correct(
    numbers: NDArray[np.int32],
    grey: Volume,
    settings: SegmentationSettings,
    outside: ScanOutside | None,
    objects: ObjectTable | None = None,
) -> Generator[SegmentationProgress, None, IntArray]:
    """Object step and edits, in place; voxels of each grain that is left."""
    edges = np.ravel(np.asarray(grey.voxel_size, dtype=np.float64))
    least = settings.cleaning.min_voxels
    if settings.objects is not None:
        if objects is None:
            described = describe_objects(Volume(numbers, edges, "labels", grey.name), grey)
            objects = yield from _staged(N_("Describing objects"), described)
        sorting = sort_objects(numbers, objects, edges, settings.objects, settings.splitting, least)
        yield from _staged(N_("Classifying objects"), sorting)
    yield from _staged(N_("Correcting labels"), apply_edits(numbers, settings.edits, edges))
    # Again: grains may have been painted beyond the circle.
    _mark_outside(numbers, grey, outside)
    counts = np.zeros(int(numbers.max()) + 1, dtype=np.int64)
    for first, stop in slab_ranges(SharedArray(numbers).shape):
        slab = np.maximum(numbers[:, :, first:stop], 0)
        counts += np.bincount(slab.ravel(order="K"), minlength=len(counts))
    sizes = counts[1:][counts[1:] > 0]
    if not len(sizes):
        raise InputError(
            "No grain is left: all were dropped by the object classifier or deleted; choose other examples "
            "or fewer deletions."
        )
    return sizes


def _mark_outside(numbers: NDArray[np.int32], grey: Volume, outside: ScanOutside | None) -> None:
    """Label what lies outside of the scanner's circle, so that grains beside it are known to be cut."""
    if outside is not None:
        for first, stop in slab_ranges(grey.shape):
            numbers[:, :, first:stop][outside.of(grey.read(first, stop))] = OUTSIDE


def _staged(
    stage: str, steps: Generator[tuple[int, int], None, Any]
) -> Generator[SegmentationProgress, None, Any]:
    """The steps under the name of their stage; returns what they do."""
    return as_events(steps, lambda step: (SegmentationProgress(stage, *step),))


@dataclass(frozen=True, eq=False)
class GrainsAtHeight:
    """What one h of the h-maxima gives.

    ``h_maxima``: in voxels. ``sizes``: voxels of each grain, shape (n,).
    """

    h_maxima: float
    sizes: IntArray

    @property
    def n_grains(self) -> int:
        """Number of grains."""
        return len(self.sizes)


def grains_over_heights(
    source: SliceSource,
    heights: Sequence[float],
    settings: SegmentationSettings | None = None,
    scratch: ScratchArrays | None = None,
    outside: ScanOutside | None = None,
) -> Generator[SegmentationProgress, None, tuple[GrainsAtHeight, ...]]:
    """The grains that :func:`segmentation_steps` finds with each h; what comes before is done once.

    ``heights``: values of ``h_maxima`` that take the place of the settings' own.

    Raises InputError if an h is negative, or the volume is too uniform for an automatic threshold.
    """
    settings, scratch = settings or SegmentationSettings(), scratch or ScratchArrays()
    trials = [replace(settings, splitting=replace(settings.splitting, h_maxima=h)) for h in heights]
    volume: Volume = yield from _staged(N_("Reading the slices"), unpacked(source, scratch))
    bodies = yield from _find_bodies(volume, settings, scratch, outside=outside)
    numbers: NDArray[np.int32] = scratch.zeros(source.shape, np.int32)
    rows = []
    for each in trials:
        numbers[...] = 0
        sizes, _ = yield from _parted(numbers, bodies, each, scratch)
        rows.append(GrainsAtHeight(each.splitting.h_maxima, sizes))
    return tuple(rows)


def heights_table(counts: Sequence[GrainsAtHeight]) -> Table:
    """A row for each h: number of grains, and equivalent diameters in voxels."""
    names = ("h_maxima", "grains", "median_diameter", "largest_diameter")
    rows = []
    for each in counts:
        diameters = np.cbrt(6 * each.sizes / np.pi) if each.n_grains else np.full(1, np.nan)
        rows.append((each.h_maxima, each.n_grains, float(np.median(diameters)), float(diameters.max())))
    units = ("voxels", "", "voxels", "voxels")
    columns = tuple(Column(name, unit) for name, unit in zip(names, units, strict=True))
    return Table("grains over h", columns, tuple(rows))


@dataclass(frozen=True, eq=False)
class _NumberedBodies:
    numbers: SharedArray
    bodies: ConnectedComponents
    edges: FloatArray
    level: float
    seen: Histogram
    n_not_finite: int


def _find_bodies(
    source: Volume,
    settings: SegmentationSettings,
    scratch: ScratchArrays,
    run: ParallelMap = map,
    outside: ScanOutside | None = None,
) -> Generator[SegmentationProgress, None, _NumberedBodies]:
    """Connected bodies before they are parted."""
    filled, padding = source, None
    if outside is not None:
        padding = Padding(SharedArray(source.array), outside)
        filled = background_filled(source, outside, _threshold_of_grey(settings), scratch)
    values = filled
    if settings.classifier is not None:
        values = yield from _predicted(filled, settings.classifier, scratch, run)
    smooth, seen, n_not_finite = yield from _staged(
        N_("Denoising"),
        denoised_volume(
            values, settings.denoise, settings.threshold.method == "probability", scratch, run, padding
        ),
    )
    level = level_of(seen, settings.threshold, values.dtype)
    numbers = SharedArray(scratch.zeros(source.shape, np.int32))
    bodies = yield from _numbered(smooth, level, settings, numbers, scratch, run, padding)
    # By identity: without filling, classifier or denoising some of the three are one array.
    for array in {id(each): each for each in (smooth.array, values.array, filled.array)}.values():
        if array is not source.array:
            scratch.drop(array)
    edges = np.asarray(source.voxel_size, dtype=np.float64)
    return _NumberedBodies(numbers, bodies, edges, level, seen, n_not_finite)


def _threshold_of_grey(settings: SegmentationSettings) -> ThresholdSettings:
    """The threshold, but an automatic one where that is of a classifier's probabilities."""
    how = settings.threshold
    return how if settings.classifier is None else ThresholdSettings(dark=how.dark)


def _predicted(
    source: Volume, training: TrainingSet, scratch: ScratchArrays, run: ParallelMap
) -> Generator[SegmentationProgress, None, Volume]:
    """The map of probabilities that a classifier makes of grey values."""
    yield SegmentationProgress(N_("Training the classifier"), 0, 1)
    steps = probability_map(train(training), source, scratch, run)
    probabilities: Volume = yield from _staged(N_("Predicting grains"), steps)
    return probabilities


def _parted(
    labels: NDArray[np.int32],
    bodies: _NumberedBodies,
    settings: SegmentationSettings,
    scratch: ScratchArrays,
    run: ParallelMap = map,
) -> Generator[SegmentationProgress, None, tuple[IntArray, int]]:
    """Write labels of grains into zeros; voxels of each grain, and parts before small ones were dropped."""
    least = settings.cleaning.min_voxels
    splitter = GrainSplitter(
        bodies.numbers,
        labels,
        bodies.bodies,
        bodies.edges,
        settings.splitting,
        settings.cleaning.fill_pores,
        settings.tiles,
    )
    for done, total in splitter.steps(least, run):
        yield SegmentationProgress(N_("Separating touching grains"), done, total)
    sizes = splitter.sizes
    kept = sizes >= max(least, 1)
    label = np.concatenate([[0], np.where(kept, np.cumsum(kept), 0)])
    shared = SharedArray(labels)
    shared.publish()
    table = _shared_table(label, scratch)
    relabel = partial(_relabel_slab, shared, table)
    ranges = slab_ranges(shared.shape)
    for done, _ in enumerate(run(relabel, ranges), start=1):
        yield SegmentationProgress(N_("Numbering grains"), done, len(ranges))
    scratch.drop(table.array)
    return sizes[kept], len(sizes)


def _shared_table(values: IntArray, scratch: ScratchArrays) -> SharedArray:
    """A table that tasks look up, shape (n, 1, 1)."""
    table = SharedArray(scratch.zeros((len(values), 1, 1), np.int32))
    table.write(0, values.reshape(-1, 1, 1))
    return table


def _relabel_slab(numbers: SharedArray, table: SharedArray, part: tuple[int, int], shift: int = 0) -> None:
    """Replace each -k in a slab by entry k + `shift` of a table; what is not negative stays."""
    # What is not negative was replaced by the same task in a worker that ended before it answered.
    slab = numbers.slices(*part)
    entries = np.asarray(table.array)[:, 0, 0]
    numbers.write(part[0], np.where(slab < 0, entries[np.where(slab < 0, shift - slab, 0)], slab))


def preview(
    volume: Volume,
    box: Box,
    settings: SegmentationSettings | None = None,
    level: float | None = None,
    outside: ScanOutside | None = None,
) -> Segmentation:
    """The segmentation of a small part of a volume, as if there were nothing else.

    ``level``: taken instead of the one that an automatic threshold would find in this part. ``outside``:
    what lies outside of the scanner's circle in the whole volume.
    """
    part, chosen = part_of(volume, box, settings, level)
    return segment(part, chosen, None if outside is None else outside.within(box))


def part_of(
    volume: Volume, box: Box, settings: SegmentationSettings | None = None, level: float | None = None
) -> tuple[Volume, SegmentationSettings]:
    """A small part of a volume and its settings, for :func:`preview` and :func:`grains_over_heights`.

    With a classifier, the part holds the probabilities, which depend on voxels about it. Objects and edits
    are left out: both are chosen in the whole volume.
    """
    settings = (settings or SegmentationSettings()).uncorrected
    if settings.classifier is not None:
        classifier = train(settings.classifier)
        check_voxel_size(classifier.voxel_size, volume)
        part = box_probability(classifier, volume, box)
        return probability_volume(part, volume), replace(settings, classifier=None)
    if level is not None and settings.threshold.is_automatic:
        manual = replace(settings.threshold, method="manual", value=level)
        settings = replace(settings, threshold=manual)
    return Volume(np.array(volume.array[box]), volume.voxel_size, volume.kind, volume.name), settings


def _numbered(
    values: Volume,
    level: float,
    settings: SegmentationSettings,
    numbers: SharedArray,
    scratch: ScratchArrays,
    run: ParallelMap,
    padding: Padding | None,
) -> Generator[SegmentationProgress, None, ConnectedComponents]:
    """Write the number of the body of each voxel into `numbers`, which hold zeros."""
    joiner, ranges = ComponentJoiner(), slab_ranges(values.shape)
    number = partial(_number_slab, SharedArray(values.array), numbers, level, settings, padding)
    shifts = []
    for done, (part, slab) in enumerate(zip(ranges, run(number, ranges), strict=True), start=1):
        first = part[0]
        below = None if first == 0 else -numbers.slices(first - 1, first)
        shifts.append(joiner.add(slab, below, -numbers.slices(first, first + 1)))
        yield SegmentationProgress(N_("Finding connected bodies"), done, 2 * len(ranges))
    body_of, bodies = joiner.finish()
    table = _shared_table(body_of, scratch)
    join = partial(_join_slab, numbers, table)
    for done, _ in enumerate(run(join, zip(ranges, shifts, strict=True)), start=len(ranges) + 1):
        yield SegmentationProgress(N_("Finding connected bodies"), done, 2 * len(ranges))
    scratch.drop(table.array)
    return bodies


def _number_slab(
    values: SharedArray,
    numbers: SharedArray,
    level: float,
    settings: SegmentationSettings,
    padding: Padding | None,
    part: tuple[int, int],
) -> SlabComponents:
    """Write -k for each voxel of a slab's component k; returns what is known of them."""
    slab = values.thick(*part, settings.cleaning.margin)
    how = settings.threshold
    mask = cleaned(grain_voxels(slab.values, weak_level(level, how), how), settings.cleaning)[
        :, :, slab.inner
    ]
    if padding is not None:
        # After the cleaning, whose closing may bridge a gap into what lies outside.
        mask &= ~padding.of(part)
    core = mask & grain_voxels(slab.values[:, :, slab.inner], level, how) if how.low else None
    slab_components, components = components_of_slab(mask, slab.first, core)
    numbers.write(slab.first, -slab_components)
    return components


def _join_slab(numbers: SharedArray, body_of: SharedArray, part: tuple[tuple[int, int], int]) -> None:
    _relabel_slab(numbers, body_of, *part)
