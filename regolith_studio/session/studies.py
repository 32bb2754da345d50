"""The jobs behind the studies that the session can start."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from regolith_studio.errors import InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.study_jobs import study_coarsening, study_lmax
from regolith_studio.session.choices import Choices
from regolith_studio.session.plan import Kind


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
                "RMSRE against l_max",
                Job(
                    study_lmax,
                    (tuple(particles),),
                    {
                        "seed": choices.seed,
                        "level": choices.level,
                        "fit_options": choices.fit_options,
                        **options,
                    },
                ),
            )
        case Kind.COARSENING_STUDY:
            job = Job(study_coarsening, (tuple(particles), choices.order), options)
            return StudyJob("RMSRE against loss weights", job)
        case _:
            raise InputError(f"There is no study called {kind}.")
