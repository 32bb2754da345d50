"""Groups of options that several commands take, each with what its values stand for."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from regolith_studio.cli.options import (
    Facets,
    LMax,
    MaxError,
    Method,
    RadiusRule,
    Reference,
    Repair,
    Settings,
    StarPoint,
    Target,
    Triangles,
    Unit,
    Weights,
    as_bad_use,
    numbers,
    values,
)

if TYPE_CHECKING:
    from regolith_studio.coarsening.weights import LossWeights
    from regolith_studio.harmonics.fit import FitOptions
    from regolith_studio.readers.particles import LoadedParticles
    from regolith_studio.session.choices import Choices

FACETS = 20
"""By itself; :class:`FinenessOptions` tells by it whether another number was asked for."""


@dataclass(frozen=True)
class ReadingOptions:
    """How meshes are read."""

    unit: Unit = "um"
    repair: Repair = True

    def read(self, paths: Sequence[Path]) -> "LoadedParticles":
        """The particles in files and folders; see :func:`~regolith_studio.cli.inputs.read_inputs`."""
        from regolith_studio.cli.inputs import read_inputs

        return read_inputs(paths, self.unit, self.repair)


@dataclass(frozen=True)
class ExpansionOptions:
    """How the radii of a particle are taken for its spherical harmonics."""

    star_point: StarPoint = ""
    rule: RadiusRule = "volume"
    reference: Reference = "sphere"

    @property
    def fit_options(self) -> "FitOptions":
        """The same, checked; a bad value is bad use."""
        from regolith_studio.harmonics.fit import FitOptions

        with as_bad_use():
            return FitOptions(self.star_point, self.rule, self.reference)


@dataclass(frozen=True)
class FinenessOptions:
    """How fine a polyhedron is to be."""

    facets: Facets = FACETS
    triangles: Triangles = None
    max_error: MaxError = None

    @property
    def changes(self) -> dict[str, object]:
        """Of the choices; more than one way of saying it is bad use."""
        named = (self.facets != FACETS) + (self.triangles is not None) + (self.max_error is not None)
        if named > 1:
            raise typer.BadParameter(
                "Only one of --facets, --triangles and --max-error can say how fine to be."
            )
        if self.triangles is not None:
            return {"stop_at": "triangles", "n_triangles": self.triangles}
        if self.max_error is not None:
            return {"stop_at": "error", "largest_error": round(self.max_error / 100.0, 12)}
        return {"n_facets": self.facets}


@dataclass(frozen=True, kw_only=True)
class CoarseningOptions:
    """How particles become polyhedra, but for the number of facets and named weights."""

    method: Method = ""
    weight: Weights = None
    set_: Settings = None
    target: Target = "fit"
    l_max: LMax = 10
    radii: ExpansionOptions

    def choices(self, preset: str = "", **others: object) -> "Choices":
        """The choices that the options stand for; a bad one is bad use.

        Parameters
        ----------
        preset
            Key of the loss weights that ``--weight`` changes; without one, those that it names are the only.
        others
            Further choices, ``seed`` and ``n_facets`` say.
        """
        from regolith_studio.errors import InputError
        from regolith_studio.session.choices import Choices

        changes: dict[str, object] = {
            "settings": tuple(values(self.set_, "setting").items()),
            "target": self.target,
            "l_max": self.l_max,
            "star_point": self.radii.star_point,
            "rule": self.radii.rule,
            "reference": self.radii.reference,
            **others,
        }
        with as_bad_use():
            if self.method:
                changes["method"] = self.method
            if preset:
                changes["preset"] = preset
            if (weights := self._weights(preset)) is not None:
                changes["weights"] = weights
            made = Choices().replaced(**changes)
            if made.weights.all_zero and made.method != "quadric":
                raise InputError("All weights of the loss are 0, so there is nothing to optimise; raise one.")
            return made

    def _weights(self, preset: str) -> "LossWeights | None":
        from regolith_studio.coarsening.coarsen import DEFAULT_PRESET
        from regolith_studio.coarsening.weights import LossWeights

        named = numbers(self.weight, "weight")
        if not named:
            return None
        if preset or not any(named.values()):
            return LossWeights.from_preset(preset or DEFAULT_PRESET).replaced(**named)
        return LossWeights.of(**named)
