"""Measured surfaces on the forms of other particles: new bodies that keep what was measured.

Two ideas. The surface of one particle, turned at random on its sphere of inertia, is stretched to the form of
another that fills about the same share of its hull, which linear maps do not change. Of several such bodies
the one is kept whose sphericity is nearest to that of the other particle.

What a map, the choice and the cut at l_max change is measured on draws and taken off what is asked for: first
the power of each degree, then mean and deviation of aspect ratio, sphericity and share of the hull. Sizes,
forms and sphericities are those of measured particles; it makes none beyond them.

Measured surfaces apart from their forms, on coarse meshes: quick to turn, to stretch and to compare.

Each surface is mapped linearly to its sphere of inertia. Turned there and stretched to the form of another
particle it is a new body, whose sphericity follows from the area of the stretched mesh. The form along a
principal axis is the geometric mean of the extent and of the axis of the ellipsoid of inertia: of real grains
the aspect ratio of the minimum-volume box lies half-way between those of the two.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, locked_floats
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.sphere_grid import enclosed_volumes, harmonics, sphere_grid
from regolith_studio.messages import N_
from regolith_studio.settings import setting
from regolith_studio.shape_models.chunked_sampling import CHUNK
from regolith_studio.shape_models.inertia_ellipsoid import PrincipalAxes, principal_axes
from regolith_studio.shape_models.mapped_surfaces import (
    SurfaceSampler,
    SurfaceSettings,
    measured_surfaces,
    roughness_gain,
)
from regolith_studio.shape_models.realizations import positive_rows
from regolith_studio.shape_models.sample import Sample
from regolith_studio.shape_models.shape_features import hull_grid, log_share

Floats = NDArray[np.float32]

COARSE, FINE = 3, 4
"""Levels of the icospheres: of surfaces that are tried, and of those whose sphericity is measured."""
N_FEATURES = 3
"""Columns of :func:`mesh_features`."""
MIN_HULL_DEGREE = 13
FACTORS = (0.5, 2.0)
"""Limits of the factor on the logarithms of a form."""
BOX_TURN = 0.35
"""Boxes are turned out of the principal axes by so much, to either side about each of them, radians."""
_MIN_RADIUS = 1e-3
_BATCH = 250


@dataclass(frozen=True, eq=False)
class SurfaceForms:
    """Surfaces of n particles on their spheres of inertia, and the forms that they had.

    - ``vertices``: on the sphere of inertia, in the frame of the principal axes, shape (n, 642, 3).
    - ``to_sphere``: linear maps of the particles there, shape (n, 3, 3).
    - ``from_frame``: principal axes as columns, shape (n, 3, 3): maps back from the frame of the axes.
    - ``forms``: along the principal axes, with a product of one, shape (n, 3).
    - ``features``: as :func:`mesh_features`, shape (n, 3).
    - ``area_factors``: sphericity times the area of a mesh of unit volume, shape (n,): what the coarse mesh
      does not see of the surface stays the same when it is stretched.
    """

    vertices: Floats
    to_sphere: FloatArray
    from_frame: FloatArray
    forms: FloatArray
    features: FloatArray
    area_factors: FloatArray

    @classmethod
    def of(cls, rows: FloatArray, principal: PrincipalAxes) -> "SurfaceForms":
        """Of radius functions (n, (l_max + 1)^2) with these principal axes."""
        lengths = np.exp(principal.log_ratios)
        radii = rows @ harmonics(icosphere(COARSE).vertices, round(rows.shape[1] ** 0.5) - 1)
        points = (radii[:, :, None] * icosphere(COARSE).vertices) @ principal.axes
        features = mesh_features(rows, principal.axes)
        return cls(
            (points / lengths[:, None, :]).astype(np.float32),
            np.swapaxes(principal.axes, 1, 2) / lengths[:, :, None],
            principal.axes,
            _unit_product(np.sqrt(np.ptp(points, axis=1) * lengths)),
            features,
            areas(points) / (1 + np.exp(-features[:, 1])),
        )

    def elongated(self, targets: IntArray, changes: FloatArray) -> FloatArray:
        """Forms (k, 3) of the particles `targets` with ln(longest / shortest) changed by `changes`."""
        logs = np.log(self.forms[targets])
        factors = 1 + changes / np.maximum(np.ptp(logs, axis=1), 1e-9)
        return np.asarray(np.exp(logs * np.clip(factors, *FACTORS)[:, None]))

    def stretched(
        self, picks: IntArray, turns: FloatArray, wanted: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Surfaces turned on the sphere of inertia and stretched along the axes to other forms.

        - ``picks``: whose surfaces, shape (k,).
        - ``turns``: rotations, shape (k, 3, 3).
        - ``wanted``: forms, shape (k, 3).

        Returns linear maps of determinant one (k, 3, 3), and ln(s / (1 - s)) of the sphericities (k,).
        """
        turned, edges = (
            np.empty((len(picks), *self.vertices.shape[1:]), dtype=np.float32),
            np.empty((len(picks), 3)),
        )
        _fill_turned(self.vertices, picks, turns, turned, edges)
        factors = _unit_product(wanted / np.sqrt(edges))
        turned *= factors[:, None, :].astype(np.float32)
        return factors[:, :, None] * turns, log_share(self.area_factors[picks] / areas(turned))


def areas(vertices: FloatArray | Floats) -> FloatArray:
    """Areas (n,) of meshes with these vertices (n, v, 3) and the triangles of the icosphere with so many."""
    level = {len(icosphere(each).vertices): each for each in (COARSE, FINE)}[vertices.shape[1]]
    surface_areas = np.empty(len(vertices))
    _fill_areas(np.ascontiguousarray(vertices, dtype=np.float32), icosphere(level).faces, surface_areas)
    return surface_areas


@kernel
def _fill_areas(vertices: Floats, faces: IntArray, areas: FloatArray) -> None:
    """Fill `areas`, shape (n,), with the areas of the triangles `faces` (f, 3) of each row of `vertices`."""
    for n in range(len(vertices)):
        points, total = vertices[n], 0.0
        for f in range(len(faces)):
            a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
            ux, uy, uz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
            vx, vy, vz = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
            x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
            total += np.sqrt(x * x + y * y + z * z)
        areas[n] = 0.5 * total


@kernel
def _fill_turned(
    vertices: Floats, picks: IntArray, turns: FloatArray, turned: Floats, edges: FloatArray
) -> None:
    """Fill `turned`, shape (k, v, 3), with the rows `picks` of `vertices` under the rotations `turns`, and
    `edges`, shape (k, 3), with the extents along the axes."""
    for n in range(len(picks)):
        points = vertices[picks[n]]
        for k in range(3):
            a, b, c = np.float32(turns[n, k, 0]), np.float32(turns[n, k, 1]), np.float32(turns[n, k, 2])
            low, high = np.float32(np.inf), np.float32(-np.inf)
            for v in range(len(points)):
                value = a * points[v, 0] + b * points[v, 1] + c * points[v, 2]
                turned[n, v, k] = value
                low, high = min(low, value), max(high, value)
            edges[n, k] = high - low


def mesh_features(rows: FloatArray, axes: FloatArray | None = None) -> FloatArray:
    """ln of the aspect ratio, and ln(s / (1 - s)) of the sphericity and of the share of the hull.

    The aspect ratio is that of the smallest of 27 boxes about the principal axes.

    ``rows``: coefficients of radius functions, shape (n, (l_max + 1)^2). ``axes``: their principal axes as
    columns, shape (n, 3, 3), where they are known.

    Returns shape (n, 3).
    """
    known = principal_axes(rows).axes if axes is None else axes
    batches = range(0, len(rows), _BATCH)
    return np.concatenate([_of_batch(rows[i : i + _BATCH], known[i : i + _BATCH]) for i in batches])


def _unit_product(values: FloatArray) -> FloatArray:
    """Rows (n, 3) divided by the cube root of their product."""
    return np.asarray(values / np.cbrt(values.prod(axis=1, keepdims=True)))


def _of_batch(rows: FloatArray, axes: FloatArray) -> FloatArray:
    l_max = round(rows.shape[1] ** 0.5) - 1
    scaled = rows / (rows[:, :1] / np.sqrt(4 * np.pi))
    grid = sphere_grid(3 * l_max // 2 + 1, l_max)
    volumes = enclosed_volumes(grid.values(scaled), grid)
    sphere = icosphere(FINE)
    surface = (scaled @ harmonics(sphere.vertices, l_max))[:, :, None] * sphere.vertices
    sphericities = np.pi ** (1 / 3) * (6 * volumes) ** (2 / 3) / areas(surface)
    hulls = hull_grid(max(MIN_HULL_DEGREE, l_max), l_max)
    convexities = hulls.convexities(np.maximum(hulls.grid.values(scaled), _MIN_RADIUS))
    return np.column_stack(
        [_log_aspect_ratios(surface, axes), log_share(sphericities), log_share(convexities)]
    )


def _log_aspect_ratios(vertices: FloatArray, axes: FloatArray) -> FloatArray:
    """ln(longest / shortest edge) of the smallest box about `axes` (n, 3, 3) of each mesh (n, v, 3)."""
    turns = Rotation.from_rotvec(list(product((-BOX_TURN, 0.0, BOX_TURN), repeat=3))).as_matrix()
    frames = np.swapaxes(axes[:, None] @ turns, 2, 3).reshape(len(axes), -1, 3).astype(np.float32)
    edges = np.empty((len(axes), len(turns), 3))
    for extents, mesh, frame in zip(edges, vertices.astype(np.float32), frames, strict=True):
        extents[:] = np.ptp(frame @ mesh.T, axis=1).reshape(-1, 3)
    smallest = edges[np.arange(len(edges)), edges.prod(axis=2).argmin(axis=1)]
    return np.asarray(np.log(smallest.max(axis=1) / smallest.min(axis=1)))


KEY = "recombined"
ROUNDS = 3
"""Rounds of calibration, of a chunk of particles each."""
SPREADS = (0.5, 2.0)
"""Limits of the factors on deviations that are asked for."""
ATTEMPTS = 5
"""Times that a particle is drawn again where the cut has a negative radius; then it stays as measured."""


@dataclass(frozen=True)
class RecombinedSettings(SurfaceSettings):
    """Settings of recombined particles.

    - ``n_neighbours``: the surface comes from one of so many particles with the nearest share of the hull.
    - ``n_candidates``: surfaces that are tried for each particle.
    """

    n_neighbours: int = setting(
        20,
        N_("Neighbours"),
        N_("Number of particles with a similar hull ratio whose surfaces may be used."),
        minimum=1,
    )
    n_candidates: int = setting(
        32, N_("Candidates"), N_("The one with the nearest sphericity is kept."), minimum=1
    )


@dataclass(frozen=True, eq=False)
class Recombined(SurfaceSampler):
    """The measured particles and what is asked for to draw others like them.

    ``offsets``, ``spreads``: what is asked for of the features of :class:`SurfaceForms`: mean + offset +
    spread (measured - mean), shapes (3,); zeros and ones if ``None``.
    """

    offsets: FloatArray | None = None
    spreads: FloatArray | None = None
    key: ClassVar[str] = KEY

    def __post_init__(self) -> None:
        super().__post_init__()
        for name, filler in (("offsets", np.zeros), ("spreads", np.ones)):
            given = getattr(self, name)
            values = filler(N_FEATURES) if given is None else given
            object.__setattr__(self, name, locked_floats(values, (N_FEATURES,), name))

    @cached_property
    def forms(self) -> SurfaceForms:
        """Their surfaces apart from their forms, both cut at l_max."""
        return SurfaceForms.of(self.surfaces.cut, self.surfaces.axes)

    @cached_property
    def _by_convexity(self) -> IntArray:
        return np.argsort(self.forms.features[:, 2], kind="stable")

    def shapes(
        self, _radii: FloatArray, components: IntArray, rng: np.random.Generator
    ) -> tuple[FloatArray, dict[str, IntArray]]:
        """Surfaces on the forms of the particles `components`, and where the surfaces are from."""
        rows, parents = self._drawn_on(components, rng)
        for _ in range(ATTEMPTS):
            bad = np.flatnonzero(~positive_rows(rows))
            if not len(bad):
                break
            rows[bad], parents[bad] = self._drawn_on(components[bad], rng)
        bad = np.flatnonzero(~positive_rows(rows))
        rows[bad], parents[bad] = self.surfaces.cut[components[bad]], components[bad]
        return rows, {"parents": parents}

    def _drawn_on(self, targets: IntArray, rng: np.random.Generator) -> tuple[FloatArray, IntArray]:
        """Rows on the forms of `targets`, and the particles that their surfaces are from."""
        measured = self.forms.features[targets]
        middle = self.forms.features.mean(axis=0)
        wanted = middle + np.asarray(self.offsets) + np.asarray(self.spreads) * (measured - middle)
        forms = self.forms.elongated(targets, wanted[:, 0] - measured[:, 0])
        parents, maps = np.zeros_like(targets), np.empty((len(targets), 3, 3))
        nearest = np.full(len(targets), np.inf)
        for _ in range(self.settings.n_candidates):
            picks = self._donors(targets, wanted[:, 2], rng)
            turns = Rotation.from_quat(rng.standard_normal((len(targets), 4))).as_matrix()
            trial_maps, sphericities = self.forms.stretched(picks, turns, forms)
            distance = np.abs(sphericities - wanted[:, 1])
            better = distance < nearest
            nearest[better], parents[better], maps[better] = (
                distance[better],
                picks[better],
                trial_maps[better],
            )
        whole = self.forms.from_frame[targets] @ maps @ self.forms.to_sphere[parents]
        return self.mapped(parents, np.asarray(np.linalg.inv(whole), dtype=np.float64)), parents

    def _donors(self, targets: IntArray, convexities: FloatArray, rng: np.random.Generator) -> IntArray:
        """A particle for each target, not itself, out of those nearest to a share of the hull."""
        order, n = self._by_convexity, len(self.surfaces)
        count = min(self.settings.n_neighbours, n)
        place = np.searchsorted(self.forms.features[order, 2], convexities)
        first = np.clip(place - count // 2, 0, n - count)
        donors = first + rng.integers(count, size=len(targets))
        # Its own surface on its own form would be a copy.
        itself = order[donors] == targets
        return np.asarray(order[np.where(itself, np.where(donors + 1 < n, donors + 1, donors - 1), donors)])

    def roughness_corrected(self) -> "Recombined":
        """The model with the gain by which its particles have the power of the measured ones."""
        rows, targets = self._trial_draws(0)
        return self.calibrated(gain=roughness_gain(rows, self.surfaces.cut[targets]))

    def corrected(self, number: int) -> "Recombined":
        """The model after round `number`, from 1, of calibrating what is asked for.

        Each round has particles of its own and takes the 1 / `number`-th part of what is missing, so that
        their noise averages out (Robbins and Monro 1951).
        """
        rows, targets = self._trial_draws(number)
        measured, drawn = self.forms.features[targets], mesh_features(rows)
        missing = measured.mean(axis=0) - drawn.mean(axis=0)
        ratio = (measured.std(axis=0) + 1e-9) / (drawn.std(axis=0) + 1e-9)
        return self.calibrated(
            offsets=np.asarray(self.offsets) + missing / number,
            spreads=np.clip(np.asarray(self.spreads) * ratio ** (1 / number), *SPREADS),
        )

    def _trial_draws(self, number: int) -> tuple[FloatArray, IntArray]:
        """A chunk of particles for a round of calibration, and whose forms they have."""
        rng = np.random.default_rng(np.random.SeedSequence(number))
        # All particles equally often, and the remainder out of a random order.
        targets = rng.permutation(np.resize(rng.permutation(len(self.surfaces)), CHUNK))
        return self._drawn_on(targets, rng)[0], targets


class RecombinedModel:
    """Keeps the measured particles, and calibrates what is asked for on draws."""

    key = KEY
    label = N_("Recombined surfaces")
    summary = N_("Combines the surface of one measured particle with the form of another.")
    Settings = RecombinedSettings

    def fit(self, sample: Sample, settings: RecombinedSettings | None = None) -> Recombined:
        """The model of a sample."""
        chosen = settings or RecombinedSettings(min(30, sample.l_max))
        if chosen.n_candidates < 1:
            raise InputError(f"The surfaces tried must be at least 1, got {chosen.n_candidates}.")
        surfaces = measured_surfaces(sample, chosen, chosen.n_neighbours)
        fitted = Recombined(surfaces.coefficients, chosen, sample.unit)
        fitted = fitted.roughness_corrected() if surfaces.loses_by_mapping else fitted
        for number in range(1, ROUNDS + 1):
            fitted = fitted.corrected(number)
        return fitted

    def restored(self, values: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> Recombined:
        """The model from its stored values."""
        return Recombined.restored(RecombinedSettings(**values["settings"]), values, arrays)


MODEL = RecombinedModel()
