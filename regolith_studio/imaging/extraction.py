"""From a label volume to particles: one closed, smooth, outward mesh for each label (section 2.1).

A binary mask contoured as it is overstates the surface area by up to 9 % at any resolution. Each
contour is therefore moved to lie smoothly between the centres of voxels, and has their volume
(:mod:`~regolith_studio.imaging.grain_surface`); on spheres, ellipsoids, polyhedra and rough grains of
24 voxels a diameter and more the area is then right within 2 %.
Where the grey values are at hand, they can tell the surface and above all its volume better.

The volume is seen slab by slab for the sizes and boxes of the labels; each is cut out where it is worked on.
"""

from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any

import numpy as np

from regolith_studio.geometry.arrays import BoolArray, FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle, ScanOfGrain, Source
from regolith_studio.imaging.connected_components import largest_component, pores_filled
from regolith_studio.imaging.grain_surface import (
    MARGIN,
    clipped_share,
    grey_mesh,
    mask_mesh,
)
from regolith_studio.imaging.label_table import (
    ScanCircle,
    contact_areas,
    find_padding,
    grain_crop,
    label_table,
)
from regolith_studio.imaging.settings import ExtractionSettings, Surface
from regolith_studio.imaging.volume import Box, Origin, Volume, box_between, grown, n_voxels, touches, within
from regolith_studio.imaging.volume_slabs import BATCH_VOXELS, ParallelMap, SharedArray, in_batches
from regolith_studio.messages import N_, count_message
from regolith_studio.steps import result_of

WIDE_NECK, WIDE_NECK_OF_SMALL = 0.6, 0.65
"""Diameter of the contact of two labels, over that of the ball of the smaller one's volume, from which on
they can be pieces of one grain; the second tells by itself of a piece at most half as large as the other.
Chosen with :data:`CLOSED_GAP` on scans of ``benchmarks/agglutinate_scans.py``, of lobes and of balls."""
CLOSED_GAP = 2.16
"""Width in voxels of the gap beside the point where two balls touch that blur closes at most. A wider contact
is that of two pieces; the mean of balls in packings with a blur of 0.8 voxels is 1.4."""
_COARSE, _OF_MASK = "Only", "The surface is that of the mask"
# Clipped values hide where half of the contrast is: volumes came out 10 to 17 % too large.
_MAX_CLIPPED = 0.05
"""Share of a grain's voxels at the end of the range of grey values from which on it is said."""
_BATCH_SHARE = 8
"""Of the smallest batch of voxels: a surface takes long however small its grain is."""


@dataclass(frozen=True)
class ExtractedParticle:
    """One label that became a particle.

    - ``particle``: in micrometres, at its place in the volume.
    - ``label``, ``n_voxels``: its number in the volume, and its size there.
    - ``weight``: Miles-Lantuejoul weight (:func:`border_weight`), 1 where border grains are kept.
    - ``surface``: what its surface was taken from: of the mask, too, where the grey values do not tell it.
    """

    particle: Particle
    label: int
    n_voxels: int
    weight: float
    surface: Surface = "mask"


@dataclass(frozen=True)
class ExtractionProgress:
    """One label is done; `made` is its particle, an :class:`ExtractedParticle`, or what was made of it."""

    done: int
    total: int
    name: str
    made: Any


@dataclass(frozen=True)
class Extraction:
    """What came out of a volume, and what did not.

    - ``found``: in the order of their labels; empty where they were not collected.
    - ``border``: labels left out because they touch the border, or are pieces of grains that do.
    - ``small``: labels left out because they are too small.
    - ``n_found``: labels that became particles.
    """

    found: tuple[ExtractedParticle, ...]
    border: tuple[int, ...]
    small: tuple[int, ...]
    n_found: int

    @property
    def particles(self) -> tuple[Particle, ...]:
        """The particles alone."""
        return tuple(each.particle for each in self.found)

    @property
    def labels(self) -> tuple[int, ...]:
        """Label of each particle."""
        return tuple(each.label for each in self.found)

    @property
    def weights(self) -> tuple[float, ...]:
        """Weight of each particle."""
        return tuple(each.weight for each in self.found)

    @property
    def summary(self) -> str:
        """One sentence for the user."""
        return count_message(
            N_("1 particle; left out: {border} at the border, {small} too small."),
            N_("{count} particles; left out: {border} at the border, {small} too small."),
            self.n_found,
            border=len(self.border),
            small=len(self.small),
        )


def extract_particles(
    volume: Volume, settings: ExtractionSettings | None = None, grey: Volume | None = None
) -> Extraction:
    """Run :func:`extraction_steps` to its end."""
    return result_of(extraction_steps(volume, settings, grey=grey))


def extraction_steps(
    volume: Volume,
    settings: ExtractionSettings | None = None,
    group: str = "",
    source: Source | None = None,
    make: Callable[[ExtractedParticle], Any] | None = None,
    grey: Volume | None = None,
    run: ParallelMap = map,
) -> Generator[ExtractionProgress, None, Extraction]:
    """Make a particle of each label, telling after each how far it is.

    - ``volume``: labels, in memory or mapped from a file.
    - ``group``, ``source``: passed on to each particle.
    - ``make``: applied to each particle where it is made; what it returns takes the particle's place in the
      steps. By default the particles themselves are in the steps, and are kept for the result.
    - ``grey``: the grey values that the labels were found in; surfaces are of the masks without them.
    - ``run``: applies what is done to slabs and to single labels.

    Raises InputError if the volume holds grey values, no label, or labels beyond
    :data:`~regolith_studio.imaging.label_table.MAX_LABEL`.
    """
    settings = settings or ExtractionSettings()
    chosen = select_labels(volume, settings, grey is not None, run)
    particles: list[ExtractedParticle] = []
    cuts = _cuts(volume, grey if settings.surface == "grey" else None, chosen, settings)
    made = in_batches(
        run,
        partial(_particle_of, group, source, make),
        cuts,
        lambda cut: max(n_voxels(cut.wider), BATCH_VOXELS // _BATCH_SHARE),
    )
    for done, (cut, particle) in enumerate(zip(cuts, made, strict=True), start=1):
        if make is None:
            particles.append(particle)
        yield ExtractionProgress(done, len(cuts), cut.name, particle)
    return Extraction(tuple(particles), chosen.border, chosen.small, len(cuts))


@dataclass(frozen=True, eq=False)
class LabelSelection:
    """The labels of a volume, and which of them become particles.

    - ``boxes``, ``sizes``: box and number of voxels of the largest piece of each label.
    - ``strays``: of the labels of several pieces, the number of these, and of voxels outside of the largest.
    - ``border``, ``small``: labels that are left out, as in an :class:`Extraction`.
    - ``circle``: what the scanner saw of the slices, where that is not all.
    """

    boxes: Mapping[int, Box]
    sizes: Mapping[int, int]
    border: tuple[int, ...]
    small: tuple[int, ...]
    strays: Mapping[int, tuple[int, int]] = field(default_factory=dict)
    circle: ScanCircle | None = None

    @property
    def selected(self) -> dict[int, Box]:
        """Boxes of the labels that become particles."""
        left_out = {*self.border, *self.small}
        return {label: box for label, box in self.boxes.items() if label not in left_out}

    def name_of(self, label: int) -> str:
        """Name of the particle of a label."""
        return f"particle_{label:0{self._digits}d}"

    @cached_property
    def _digits(self) -> int:
        return max(4, len(str(max(self.boxes))))


def select_labels(
    volume: Volume, settings: ExtractionSettings, segmented: bool, run: ParallelMap = map
) -> LabelSelection:
    """Which labels become particles.

    ``segmented``: whether the labels were found in grey values: then pieces of grains at the border are left
    out too. ``run``: applies what is done to slabs.

    Raises InputError as :func:`extraction_steps`.
    """
    table = label_table(volume, run)
    boxes, sizes = table.boxes(), table.sizes()
    strays: dict[int, tuple[int, int]] = {}
    # Before anything is known by boxes: two stray voxels in the corners of a scan gave one grain a border
    # weight of 84,480 instead of 3.9.
    pieces = in_batches(run, partial(_largest_piece, SharedArray(volume.array)), boxes.items(), _size_of_row)
    for label, (box, size, n_pieces) in zip(tuple(boxes), pieces, strict=True):
        if n_pieces > 1:
            strays[label] = n_pieces, sizes[label] - size
            boxes[label], sizes[label] = box, size
    beside, columns = find_padding(volume, run) if settings.exclude_border else (set(), None)
    border = [
        k
        for k, box in boxes.items()
        if settings.exclude_border and (k in beside or touches(box, volume.shape))
    ]
    if segmented and border:
        border += pieces_of_cut_grains(contact_areas(volume, run), sizes, border)
    small = [k for k in set(boxes).difference(border) if sizes[k] < settings.min_voxels]
    circle = None if columns is None or not columns.any() else ScanCircle.of(~columns)
    return LabelSelection(boxes, sizes, tuple(border), tuple(sorted(small)), strays, circle)


def _largest_piece(labels: SharedArray, row: tuple[int, Box]) -> tuple[Box, int, int]:
    """Box and voxels of the largest face-connected piece of a label, and the number of its pieces."""
    label, box = row
    body, count = largest_component(np.ascontiguousarray(labels.array[box] == label))
    if count < 2:
        return box, int(np.count_nonzero(body)), count
    low = np.array([side.start for side in box])
    filled = [np.flatnonzero(body.any(axis=tuple({0, 1, 2} - {axis}))) for axis in range(3)]
    ends = np.array([[places[0], places[-1] + 1] for places in filled])
    return box_between(low + ends[:, 0], low + ends[:, 1]), int(np.count_nonzero(body)), count


def _size_of_row(row: tuple[int, Box]) -> int:
    return n_voxels(row[1])


def pieces_of_cut_grains(
    contacts: Mapping[tuple[int, int], float], sizes: Mapping[int, int], border: Sequence[int]
) -> list[int]:
    """Labels that a watershed has parted from a grain which the border cuts, in ascending order.

    They touch a label at the border, or another piece, in a wide neck (:func:`_is_wide`). What the border has
    left of a grain is only known to be a part, so it counts as at least as large as the piece.

    - ``contacts``: of :func:`~regolith_studio.imaging.label_table.contact_areas`.
    - ``sizes``: voxels of each label.
    - ``border``: labels at the border.
    """
    cut, rests = set(border), set(border)
    diameters = {label: voxel_diameter(size) for label, size in sizes.items()}
    while new := {
        piece
        for pair, area in contacts.items()
        for piece, other in (pair, pair[::-1])
        if piece not in cut and other in cut
        if _is_wide(area, diameters[piece], diameters[other], other in rests)
    }:
        cut |= new
    return sorted(cut - rests)


def _is_wide(area: float, piece: float, other: float, is_rest: bool) -> bool:
    """Whether a contact is too wide for two whole grains.

    Two balls that touch seem to do so in a disc of area 2 pi w r, where w is the widest gap that blur closes
    and 1 / r = 1 / r1 + 1 / r2.

    - ``area``: in faces of a voxel.
    - ``piece``, ``other``: diameters of balls of the labels' volumes, in voxels.
    - ``is_rest``: whether the other is what the border has left of a grain.
    """
    neck = 2.0 * np.sqrt(area / np.pi) / min(piece, other)
    if neck > WIDE_NECK_OF_SMALL and 2.0 * piece**3 <= other**3:
        return True
    whole = max(piece, other) if is_rest else other
    of_balls = np.pi * CLOSED_GAP * piece * whole / (piece + whole)
    return bool(neck > WIDE_NECK and area > of_balls)


def voxel_diameter(n_voxels: int) -> float:
    """Diameter, in voxels, of the ball that has the volume of `n_voxels` voxels."""
    return float((6.0 * n_voxels / np.pi) ** (1 / 3))


def is_hint(note: str) -> bool:
    """Whether a particle's note says what it was made of, few voxels or a mask, not what was changed."""
    return note.startswith(_OF_MASK) or (note.startswith(f"{_COARSE} ") and "voxels in diameter" in note)


def border_weight(box: Box, shape: tuple[int, int, int]) -> float:
    """Weight that undoes the bias of leaving out border grains: 1 / prod(1 - (b + 1) / N).

    A grain whose box has b voxels along an axis of N can lie in N + b - 1 places that show any of
    it, and in N - b - 1 that keep clear of both borders: big grains are missed more often. Counting
    all grains whose first voxel lies in the scan, each side keeps a share of (N - b - 1) / N (Miles
    1974, Lantuejoul 1980).
    """
    return float(1.0 / np.prod(_shares_inside(box, shape)))


def _shares_inside(box: Box, shape: tuple[int, int, int]) -> FloatArray:
    """Along each axis, the share of the places of a box where it keeps clear of both borders."""
    lengths = np.array([side.stop - side.start for side in box], dtype=np.float64)
    size = np.array(shape, dtype=np.float64)
    # At least one place: a grain as long as the scan would have an infinite weight.
    return np.maximum(1.0 - (lengths + 1.0) / size, 1.0 / size)


@dataclass(frozen=True, eq=False)
class LabelCut:
    """A label and where it lies: all that its particle follows from.

    - ``labels``, ``grey``: the volumes; grey values only where surfaces are taken from them.
    - ``label``, ``name``, ``n_voxels``, ``weight``: its number, and what is known of its particle.
    - ``box``, ``wider``: box of the label, and what of the grey values about it is used.
    - ``voxel_size``, ``origin``: of the volume.
    - ``strays``: number of its pieces, and of voxels outside of the largest.
    """

    labels: SharedArray
    grey: SharedArray | None
    label: int
    name: str
    n_voxels: int
    weight: float
    box: Box
    wider: Box
    voxel_size: FloatArray
    origin: Origin
    settings: ExtractionSettings
    strays: tuple[int, int]

    def placed(self, mesh: Mesh, box: Box) -> Mesh:
        """A mesh in voxels of `box` at its place in the volume, in micrometres."""
        corner = np.array([side.start for side in box]) + np.array(self.origin)
        return Mesh((mesh.vertices + corner) * self.voxel_size, mesh.faces)

    def mask_surface(self, body: BoolArray) -> Mesh:
        """Surface of a mask in the box."""
        return self.placed(mask_mesh(body, self.settings.iterations, self.settings.pass_band), self.box)


def _cuts(
    volume: Volume, grey: Volume | None, chosen: LabelSelection, settings: ExtractionSettings
) -> list[LabelCut]:
    """Each label that becomes a particle."""
    whole = box_between((0, 0, 0), volume.shape)
    labels, values = SharedArray(volume.array), None if grey is None else SharedArray(grey.array)
    if grey is not None and grey.shape != volume.shape:
        raise ValueError(f"labels of shape {volume.shape} do not fit grey values of shape {grey.shape}")
    return [
        LabelCut(
            labels,
            values,
            label,
            chosen.name_of(label),
            chosen.sizes[label],
            _weight(volume, label, box, chosen.circle) if settings.exclude_border else 1.0,
            box,
            grown(box, MARGIN if grey else 0, whole),
            volume.voxel_size,
            volume.origin,
            settings,
            chosen.strays.get(label, (1, 0)),
        )
        for label, box in chosen.selected.items()
    ]


def _weight(volume: Volume, label: int, box: Box, circle: ScanCircle | None) -> float:
    """Border weight of a grain in the volume, or in the scanner's circle."""
    if circle is None:
        return border_weight(box, volume.shape)
    footprint = (volume.array[box] == label).any(axis=2)
    return float(1.0 / (circle.share_inside(footprint) * _shares_inside(box, volume.shape)[2]))


def _particle_of(
    group: str, source: Source | None, make: Callable[[ExtractedParticle], Any] | None, cut: LabelCut
) -> Any:
    """The particle of a label, or what is made of it."""
    mesh, notes, surface, scan = surface_of_label(cut)
    particle = Particle(cut.name, mesh, group, source, notes, cut.weight, scan=scan)
    extracted = ExtractedParticle(particle, cut.label, cut.n_voxels, cut.weight, surface)
    return extracted if make is None else make(extracted)


def surface_of_label(cut: LabelCut) -> tuple[Mesh, tuple[str, ...], Surface, ScanOfGrain | None]:
    """Surface in micrometres, notes on it, what it was taken from, and its size and noise in the scan.

    It is of the grey values where they are at hand and tell it, else of the mask. Size and noise are left out
    where the scan was clipped, which moves the surface by more than noise does.
    """
    settings = cut.settings
    if cut.grey is None:
        body, notes = _one_body(np.ascontiguousarray(cut.labels.array[cut.box] == cut.label), cut)
        return cut.mask_surface(body), tuple(notes), "mask", None
    crop = grain_crop(cut.labels, cut.grey, cut.label, cut.wider)
    part = within(cut.box, cut.wider)
    body, notes = _one_body(crop.own[part], cut)
    padding = [(a.start, n - a.stop) for a, n in zip(part, crop.own.shape, strict=True)]
    # Files state the edges with rounding, often the one along z in another field than those along x and y.
    cubic = float(np.ptp(cut.voxel_size)) <= 1e-3 * float(cut.voxel_size.max())
    grey_surface = grey_mesh(crop, np.pad(body, padding), settings.iterations, settings.pass_band, cubic)
    clipped, end = clipped_share(crop.values[part], body)
    if clipped > _MAX_CLIPPED:
        notes.append(
            f"{100 * clipped:.0f} % of its voxels have the grey value {end}, where the scan was clipped: its "
            "surface lies too far outside, by an unknown distance."
        )
    if isinstance(grey_surface, str):
        notes.append(f"{_OF_MASK}: {grey_surface}.")
        return cut.mask_surface(body), tuple(notes), "mask", None
    if not grey_surface.scan.follows_grey:
        notes.append(
            f"{_OF_MASK}, its volume that of the grey values: their noise is "
            f"{100 * grey_surface.scan.noise:.0f} % of the contrast."
        )
    return (
        cut.placed(grey_surface.mesh, cut.wider),
        tuple(notes),
        "grey",
        None if clipped > _MAX_CLIPPED else grey_surface.scan,
    )


def _one_body(mask: BoolArray, cut: LabelCut) -> tuple[BoolArray, list[str]]:
    """The largest face-connected body, its closed pores filled, and notes on it."""
    notes, settings = [], cut.settings
    body, _ = largest_component(mask)
    count, dropped = cut.strays
    if count > 1:
        notes.append(f"The label had {count} separate parts; the largest was kept, {dropped} voxels dropped.")
    if settings.fill_pores:
        filled = pores_filled(body)
        if closed := int(np.count_nonzero(filled) - np.count_nonzero(body)):
            notes.append(f"Closed pores of {closed} voxels were filled.")
        body = filled
    diameter, thickness = voxel_diameter(int(np.count_nonzero(body))), _thickness(body)
    if min(diameter, thickness) < settings.warn_diameter:
        place = "" if diameter < settings.warn_diameter else " where it is thinnest"
        notes.append(
            f"{_COARSE} {thickness if place else diameter:.1f} voxels in diameter{place}: volume and "
            f"above all surface area are coarse below {settings.warn_diameter:g}."
        )
    return body, notes


def _thickness(body: BoolArray) -> float:
    """Shortest axis, in voxels, of the ellipsoid with the second moments of a body."""
    covariance = np.zeros((3, 3))
    for one, other in ((0, 1), (0, 2), (1, 2)):
        # The second moments of a body are those of its projections, which need no list of voxels.
        plane = body.sum(axis=3 - one - other).astype(np.float64)
        weights = plane / plane.sum()
        at = np.meshgrid(*(np.arange(n, dtype=np.float64) for n in plane.shape), indexing="ij")
        off = [axis - float((weights * axis).sum()) for axis in at]
        covariance[one, other] = covariance[other, one] = (weights * off[0] * off[1]).sum()
        covariance[one, one], covariance[other, other] = ((weights * each**2).sum() for each in off)
    # An ellipsoid has the variance a^2 / 5 along its half axis a: 2 a = sqrt(20 variance). A voxel's own
    # width adds 1/12, so that a plate of one voxel is not without thickness.
    return float(np.sqrt(20.0 * (max(float(np.linalg.eigvalsh(covariance)[0]), 0.0) + 1.0 / 12.0)))
