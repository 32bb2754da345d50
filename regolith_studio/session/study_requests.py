"""Studies of the present choices: rows of loss weights, and the jobs of the studies."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from regolith_studio.errors import InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.study_jobs import study_coarsening, study_lmax
from regolith_studio.messages import N_
from regolith_studio.session.choices import Choices, Kind
from regolith_studio.studies.loss_variants import LossVariant, loss_variants, losses
from regolith_studio.studies.sweeps import SWEEPS, parse_values

CHOSEN = "chosen"
"""Name of the loss whose weights are the present ones."""


def present_row(choices: Choices) -> LossVariant:
    """What is chosen now, as a row."""
    return LossVariant(
        N_("Chosen weights"), choices.weights, choices.method, choices.facet_count, choices.settings
    )


def loss_names() -> dict[str, str]:
    """Every loss that can be a row, with its label; the chosen weights last."""
    return {name: loss.label for name, loss in losses().items()} | {CHOSEN: N_("Chosen weights")}


def chosen_rows(names: Sequence[str], choices: Choices) -> tuple[LossVariant, ...]:
    """A row for each name of :func:`loss_names`.

    Raises
    ------
    InputError
        If there is no such loss.
    """
    like = present_row(choices)
    return tuple(like if name == CHOSEN else loss_variants((name,), like)[0] for name in names)


def varied_rows(key: str, choices: Choices, values: str) -> tuple[LossVariant, ...]:
    """The rows of a variation of the present choices, from values with commas between them.

    Raises
    ------
    InputError
        If a value is wrong, or the choices leave nothing to vary.
    """
    rows = SWEEPS[key].rows(present_row(choices), parse_values(values))
    for row in rows:
        Choices(n_facets=row.n_facets)
    return rows


@dataclass(frozen=True)
class StudyJob:
    """A job and what it is called on screen."""

    title: str
    job: Job


def study_job(
    kind: Kind, particles: Sequence[Particle], choices: Choices, options: Mapping[str, Any]
) -> StudyJob:
    """The job of a study of `particles` with the present `choices`.

    Raises
    ------
    InputError
        If `kind` is no study.
    """
    match kind:
        case Kind.LMAX_STUDY:
            return StudyJob(
                N_("RMSRE against l_max"),
                Job(
                    study_lmax,
                    (tuple(particles),),
                    {
                        "seed": choices.seed,
                        "fit_options": choices.fit_options,
                        **options,
                    },
                ),
            )
        case Kind.COARSENING_STUDY:
            job = Job(study_coarsening, (tuple(particles), choices.coarsening_request), options)
            return StudyJob(N_("RMSRE against loss weights"), job)
        case _:
            raise InputError(f"There is no study called {kind}.")
