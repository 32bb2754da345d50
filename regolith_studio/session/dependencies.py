"""Which results depend on which choices: compares two snapshots and names the work to be done again."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, fields
from enum import StrEnum

from regolith_studio.harmonics.fit_options import FitOptions
from regolith_studio.session.choices import Choices


class Kind(StrEnum):
    """What can be asked for; each is a lane of its own, in which the newest request wins."""

    FIT = "fit"
    SURFACE = "surface"
    DESCRIPTORS = "descriptors"
    COARSENING = "coarsening"
    LMAX_STUDY = "lmax_study"
    COARSENING_STUDY = "coarsening_study"


LIVE = (Kind.FIT, Kind.SURFACE, Kind.DESCRIPTORS, Kind.COARSENING)
"""Kinds that follow every change of a choice by themselves."""
STUDIES = (Kind.LMAX_STUDY, Kind.COARSENING_STUDY)
"""Kinds that wait until they are asked for."""

_FIT_OPTIONS = tuple(each.name for each in fields(FitOptions))
DEPENDS_ON: Mapping[Kind, tuple[str, ...]] = {
    Kind.FIT: ("selected", *_FIT_OPTIONS),
    Kind.SURFACE: ("selected", *_FIT_OPTIONS, "l_max", "level"),
    Kind.DESCRIPTORS: ("selected", *_FIT_OPTIONS, "l_max", "level", "box_metric"),
    Kind.COARSENING: ("selected", "target", "fineness", "method", "settings", "weights", "seed"),
    Kind.LMAX_STUDY: (*_FIT_OPTIONS, "level"),
    Kind.COARSENING_STUDY: ("target", "facet_count", "method", "settings", "seed"),
}
"""The choices, and what follows from them, that each kind of result depends on."""
_COARSENING_OF_FIT = (*_FIT_OPTIONS, "l_max", "level")

_UPSTREAM: Mapping[Kind, tuple[Kind, ...]] = {
    Kind.SURFACE: (Kind.FIT,),
    Kind.DESCRIPTORS: (Kind.SURFACE,),
    Kind.COARSENING: (Kind.SURFACE,),
}


@dataclass(frozen=True)
class ComputationRequest:
    """One piece of work, and the kinds whose present results it is made from."""

    kind: Kind
    needs: tuple[Kind, ...] = ()


def plan(
    before: Choices | None, after: Choices, fitted: Collection[str] = ()
) -> tuple[ComputationRequest, ...]:
    """The work that turning `before` into `after` makes necessary, in the order of dependence.

    Parameters
    ----------
    before
        ``None`` when nothing has been computed yet.
    fitted
        Ids of particles whose coefficients by the fit options of `after`, up to degree 30, are at hand;
        they are not fitted again.
    """
    if not after.selected:
        return ()
    due = [kind for kind in LIVE if before is None or depends(kind, before, after)]
    if after.selected in fitted and Kind.FIT in due:
        due.remove(Kind.FIT)
    return tuple(ComputationRequest(kind, needs(kind, after)) for kind in due)


def depends(kind: Kind, before: Choices, after: Choices) -> bool:
    """Whether a result of `kind` for `before` is not the result for `after`."""
    names = DEPENDS_ON[kind]
    if kind in (Kind.COARSENING, Kind.COARSENING_STUDY) and after.target == "fit":
        names += _COARSENING_OF_FIT
    return any(getattr(before, name) != getattr(after, name) for name in names)


def needs(kind: Kind, choices: Choices) -> tuple[Kind, ...]:
    """The kinds that a result of `kind` is made from."""
    if kind is Kind.COARSENING and choices.target == "particle":
        return ()
    return _UPSTREAM.get(kind, ())
