"""The sample again: measured surfaces, turned a little within their ellipsoids, and mirrored.

A measured particle is brought by a linear map to the sphere of inertia, turned there by a random rotation,
and brought back by the map of an ellipsoid of its neighbourhood. Each step is linear, so the share of its
convex hull that a particle fills stays as it was measured, and with it edges, faces and roughness; elongation
and flatness are the neighbour's; what is new is how the surface lies on the form. Particles are mapped with
all degrees that the sample has, up to twice the degree of the draws, and cut afterwards, as the measured ones
are: so both lose the same by the cut. Where the sample has no more degrees than the draws, mapped particles
are given the mean power that the measured ones have at each degree from the third on.

In the end particles are mirrored: no descriptor changes, and draws are as far from every measured particle
over all rotations as other particles of the material are.

It is a smoothed bootstrap: it makes no size and no form that was not measured in the neighbourhood, and
where mirror images count as the same its draws are near copies. Those of ``recombined`` are not; to go beyond
the sample, take ``log_field``.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.harmonics.coefficients import orders
from regolith_studio.messages import N_
from regolith_studio.settings import setting
from regolith_studio.shape_models.chunked_sampling import CHUNK
from regolith_studio.shape_models.mapped_surfaces import (
    SurfaceSampler,
    SurfaceSettings,
    measured_surfaces,
    roughness_gain,
)
from regolith_studio.shape_models.realizations import positive_rows
from regolith_studio.shape_models.sample import Sample

KEY = "sample_matched"
N_COMPARED = 2 * CHUNK
"""Particles by which the power of mapped ones is compared with that of measured ones."""
HALVINGS = 4
"""A mapped particle whose cut has a negative radius is turned by half as much, so often, then not at all."""


@dataclass(frozen=True)
class SampleMatchedSettings(SurfaceSettings):
    """Settings of matched particles.

    - ``turn``: mean angle of the rotation of a round particle, radians; angles are even between 0.6 and 1.4
      times as much, and smaller by short over long axis: on a long particle the same angle changes more, and
      more turning makes it rougher than the measured one.
    - ``n_neighbours``: the ellipsoid comes from one of so many particles nearest in elongation and flatness,
      itself among them.
    - ``mirrored``: whether particles are mirrored in the end, which changes no descriptor. Mirror images are
      as far from the measured particles as other particles of the material are; without it draws are near
      copies.
    """

    turn: float = setting(
        0.45,
        N_("Rotation [rad]"),
        N_("Mean rotation of a round particle; elongated ones are rotated less."),
        maximum=2.0,
        step=0.1,
        decimals=2,
    )
    n_neighbours: int = setting(
        20, N_("Neighbours"), N_("Nearest particles whose ellipsoid may be used."), minimum=1
    )
    mirrored: bool = setting(True, N_("Mirror images"))


@dataclass(frozen=True, eq=False)
class SampleMatched(SurfaceSampler):
    """The measured particles and how far to leave them."""

    key: ClassVar[str] = KEY

    @cached_property
    def _neighbours(self) -> IntArray:
        """Particles whose ellipsoid may be used: the nearest in the two axis ratios, shape (n, k).

        Where a particle is not among the nearest of its neighbour, it stands there itself: so each ellipsoid
        is used as often as it was measured, and long and flat ones are not lost to the middle.
        """
        ratios = self.surfaces.axes.log_ratios[:, [0, 2]]
        spread = np.maximum(ratios.std(axis=0), 1e-9)
        count = min(self.settings.n_neighbours, len(ratios))
        # Ranks as a list, or the result for one neighbour would lack an axis.
        nearest = np.asarray(cKDTree(ratios / spread).query(ratios / spread, k=np.arange(1, count + 1))[1])
        own = np.arange(len(ratios))[:, None]
        mutual = (nearest[nearest] == own[:, :, None]).any(axis=2)
        return np.asarray(np.where(mutual, nearest, own), dtype=np.int64)

    def shapes(
        self, radii: FloatArray, components: IntArray, rng: np.random.Generator
    ) -> tuple[FloatArray, dict[str, IntArray]]:
        """Measured particles, their parents, turned within ellipsoids of their neighbourhood.

        Where nothing was measured in a range of sizes, sizes are even in ln r and shapes the nearest in size.
        """
        column = rng.integers(self._neighbours.shape[1], size=len(radii))
        forms = self._neighbours[components, column]
        rotations = _random_rotations(rng, self.settings.turn) * self._roundness(components, forms)[:, None]
        rows = self._rotated(components, forms, rotations)
        if self.settings.mirrored:
            rows[:, orders(rows.shape[1]) < 0] *= -1.0  # y -> -y
        return rows, {"parents": components}

    def _roundness(self, parents: IntArray, forms: IntArray) -> FloatArray:
        """Short over long axis of whichever ellipsoid is the longer one, shape (n,)."""
        shares = np.exp(self.surfaces.axes.log_ratios[:, 0] - self.surfaces.axes.log_ratios[:, 2])
        return np.asarray(np.minimum(shares[parents], shares[forms]))

    def _rotated(self, parents: IntArray, forms: IntArray, rotations: FloatArray) -> FloatArray:
        """Coefficients of the particles `parents` on the ellipsoids of `forms`, after `rotations` (n, 3)."""
        rows = self._mapped(parents, forms, rotations)
        for halving in range(HALVINGS + 1):
            bad = np.flatnonzero(~positive_rows(rows))
            if not len(bad):
                break
            share = 0.0 if halving == HALVINGS else 0.5 ** (halving + 1)
            own = parents[bad] if halving == HALVINGS else forms[bad]
            rows[bad] = self._mapped(parents[bad], own, rotations[bad] * share)
        bad = np.flatnonzero(~positive_rows(rows))
        rows[bad] = self.surfaces.cut[parents[bad]]
        return rows

    def _mapped(self, parents: IntArray, forms: IntArray, rotations: FloatArray) -> FloatArray:
        axes, lengths = self.surfaces.axes.axes[parents], np.exp(self.surfaces.axes.log_ratios)
        back = np.swapaxes(axes, 1, 2) / lengths[forms][:, :, None]
        turn_back = Rotation.from_rotvec(-rotations).as_matrix()
        inverses = (axes * lengths[parents][:, None, :]) @ turn_back @ back
        return self.mapped(parents, inverses)

    def roughness_corrected(self) -> "SampleMatched":
        """The same with the gain by which its particles have the power of the measured ones."""
        draws = replace(self, gain=None).draw(N_COMPARED, 0)
        measured = self.surfaces.cut[draws.parents]
        return self.calibrated(gain=roughness_gain(draws.coefficients, measured))


def _random_rotations(rng: np.random.Generator, turn: float) -> FloatArray:
    """Rotation vectors (CHUNK, 3) with random axes."""
    axes = rng.standard_normal((CHUNK, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    return np.asarray(axes * turn * rng.uniform(0.6, 1.4, (CHUNK, 1)))


class SampleMatchedModel:
    """Keeps the measured particles; nothing is estimated but their ellipsoids."""

    key = KEY
    label = N_("Matched to the sample")
    summary = N_(
        "Resamples the sample: measured surfaces, slightly rotated within their ellipsoids and mirrored."
    )
    Settings = SampleMatchedSettings

    def fit(self, sample: Sample, settings: SampleMatchedSettings | None = None) -> SampleMatched:
        """The model of a sample; better the more degrees above the settings' l_max the sample has."""
        chosen = settings or SampleMatchedSettings(min(30, sample.l_max))
        if not 0 <= chosen.turn <= 2:
            raise InputError(f"The turn must be 0 to 2 radians, got {chosen.turn:g}.")
        surfaces = measured_surfaces(sample, chosen, chosen.n_neighbours)
        fitted = SampleMatched(surfaces.coefficients, chosen, sample.unit)
        return fitted.roughness_corrected() if surfaces.loses_by_mapping else fitted

    def restored(self, values: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> SampleMatched:
        """The model from its stored values."""
        return SampleMatched.restored(SampleMatchedSettings(**values["settings"]), values, arrays)


MODEL = SampleMatchedModel()
