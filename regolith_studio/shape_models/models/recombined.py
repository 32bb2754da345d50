"""Measured surfaces on the forms of other particles: new bodies that keep what was measured.

Two ideas. The surface of one particle, turned at random on its sphere of inertia, is stretched to the form of
another that fills about the same share of its hull, which linear maps do not change. Of several such bodies
the one is kept whose sphericity is nearest to that of the other particle.

What a map, the choice and the cut at l_max change is measured on draws and taken off what is asked for: first
the power of each degree, then mean and deviation of aspect ratio, sphericity and share of the hull. Sizes,
forms and sphericities are those of measured particles; it makes none beyond them.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, locked_floats
from regolith_studio.messages import N_
from regolith_studio.shape_models.chunked_sampling import CHUNK
from regolith_studio.shape_models.mapped_surfaces import (
    SurfaceSampler,
    SurfaceSettings,
    measured_surfaces,
    roughness_gain,
)
from regolith_studio.shape_models.realizations import positive_rows
from regolith_studio.shape_models.sample import Sample
from regolith_studio.shape_models.surface_forms import N_FEATURES, SurfaceForms, mesh_features

KEY = "recombined"
ROUNDS = 3
"""Rounds of calibration, of a chunk of particles each."""
SPREADS = (0.5, 2.0)
"""Limits of the factors on deviations that are asked for."""
ATTEMPTS = 5
"""Times that a particle is made anew where the cut has a negative radius; then it stays as measured."""


@dataclass(frozen=True)
class RecombinedSettings(SurfaceSettings):
    """Parameters
    ----------
    n_neighbours
        The surface comes from one of so many particles with the nearest share of the hull.
    n_candidates
        Surfaces that are tried for each particle.
    """

    n_neighbours: int = field(
        default=20,
        metadata={
            "label": N_("Neighbours"),
            "minimum": 1,
            "tip": N_("Number of particles with a similar hull ratio whose surfaces may be used."),
        },
    )
    n_candidates: int = field(
        default=32,
        metadata={
            "label": N_("Surfaces tried"),
            "minimum": 1,
            "tip": N_("The one with the nearest sphericity is kept."),
        },
    )


@dataclass(frozen=True, eq=False)
class Recombined(SurfaceSampler):
    """The measured particles and what is asked for to draw others like them.

    Parameters
    ----------
    offsets, spreads
        What is asked for of the features of :mod:`~regolith_studio.shape_models.surface_forms`: mean + offset
        + spread (measured - mean), shapes (3,); zeros and ones if ``None``.
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
        rows, parents = self._made(components, rng)
        for _ in range(ATTEMPTS):
            bad = np.flatnonzero(~positive_rows(rows))
            if not len(bad):
                break
            rows[bad], parents[bad] = self._made(components[bad], rng)
        bad = np.flatnonzero(~positive_rows(rows))
        rows[bad], parents[bad] = self.surfaces.cut[components[bad]], components[bad]
        return rows, {"parents": parents}

    def _made(self, targets: IntArray, rng: np.random.Generator) -> tuple[FloatArray, IntArray]:
        """Rows on the forms of `targets`, and the particles that their surfaces are from."""
        measured = self.forms.features[targets]
        middle = self.forms.features.mean(axis=0)
        wanted = middle + np.asarray(self.offsets) + np.asarray(self.spreads) * (measured - middle)
        forms = self.forms.elongated(targets, wanted[:, 0] - measured[:, 0])
        parents, maps = np.zeros_like(targets), np.empty((len(targets), 3, 3))
        nearest = np.full(len(targets), np.inf)
        for _ in range(self.settings.n_candidates):
            picks = self._lenders(targets, wanted[:, 2], rng)
            turns = Rotation.from_quat(rng.standard_normal((len(targets), 4))).as_matrix()
            tried, sphericities = self.forms.stretched(picks, turns, forms)
            distance = np.abs(sphericities - wanted[:, 1])
            better = distance < nearest
            nearest[better], parents[better], maps[better] = distance[better], picks[better], tried[better]
        whole = self.forms.from_frame[targets] @ maps @ self.forms.to_sphere[parents]
        return self.mapped(parents, np.asarray(np.linalg.inv(whole), dtype=np.float64)), parents

    def _lenders(self, targets: IntArray, convexities: FloatArray, rng: np.random.Generator) -> IntArray:
        """A particle for each target, not itself, out of those nearest to a share of the hull."""
        order, n = self._by_convexity, len(self.surfaces)
        count = min(self.settings.n_neighbours, n)
        place = np.searchsorted(self.forms.features[order, 2], convexities)
        first = np.clip(place - count // 2, 0, n - count)
        found = first + rng.integers(count, size=len(targets))
        itself = order[found] == targets
        return np.asarray(order[np.where(itself, np.where(found + 1 < n, found + 1, found - 1), found)])

    def roughened(self) -> "Recombined":
        """The model with the gain by which its particles have the power of the measured ones."""
        rows, targets = self._tried(0)
        return self.calibrated(gain=roughness_gain(rows, self.surfaces.cut[targets]))

    def corrected(self, number: int) -> "Recombined":
        """The model after round `number`, from 1, of calibrating what is asked for.

        Each round has particles of its own and takes the 1 / `number`-th part of what is missing, so that
        their noise averages out (Robbins and Monro 1951).
        """
        rows, targets = self._tried(number)
        measured, drawn = self.forms.features[targets], mesh_features(rows)
        missing = measured.mean(axis=0) - drawn.mean(axis=0)
        ratio = (measured.std(axis=0) + 1e-9) / (drawn.std(axis=0) + 1e-9)
        return self.calibrated(
            offsets=np.asarray(self.offsets) + missing / number,
            spreads=np.clip(np.asarray(self.spreads) * ratio ** (1 / number), *SPREADS),
        )

    def _tried(self, number: int) -> tuple[FloatArray, IntArray]:
        """A chunk of particles for a round of calibration, and whose forms they have."""
        rng = np.random.default_rng(np.random.SeedSequence(number))
        targets = rng.permutation(np.resize(rng.permutation(len(self.surfaces)), CHUNK))
        return self._made(targets, rng)[0], targets


class RecombinedModel:
    """Keeps the measured particles, and calibrates what is asked for on draws."""

    key = KEY
    label = N_("Recombined surfaces")
    summary = N_("Combines the surface of one measured particle with the form of another.")
    Settings = RecombinedSettings

    def fit(self, sample: Sample, settings: RecombinedSettings | None = None) -> Recombined:
        """The model of a sample.

        Raises
        ------
        InputError
            If a setting is out of range, the sample is not expanded so far, or fewer than two particles have
            a positive radius.
        """
        chosen = settings or RecombinedSettings(min(30, sample.l_max))
        if chosen.n_candidates < 1:
            raise InputError(f"The surfaces tried must be at least 1, got {chosen.n_candidates}.")
        surfaces = measured_surfaces(sample, chosen, chosen.n_neighbours)
        fitted = Recombined(surfaces.coefficients, chosen, sample.unit)
        fitted = fitted.roughened() if surfaces.loses_by_mapping else fitted
        for number in range(1, ROUNDS + 1):
            fitted = fitted.corrected(number)
        return fitted

    def restored(self, values: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> Recombined:
        """The model from its stored values."""
        return Recombined.restored(RecombinedSettings(**values["settings"]), values, arrays)


MODEL = RecombinedModel()
