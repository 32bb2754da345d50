"""A report while it is made: its sample, settings, folder, and what one section leaves for the next."""

from collections.abc import Generator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.errors import InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.events import Step
from regolith_studio.jobs.executor import Executor
from regolith_studio.jobs.representatives_jobs import MeasuredPopulation
from regolith_studio.session.report.sections import ReportSection
from regolith_studio.session.report.settings import ReportSettings

SectionSteps = Generator[Step, None, ReportSection]


@dataclass
class ReportDraft:
    """What the sections of a report are made from.

    Parameters
    ----------
    folder
        Of the report; every section writes into a folder of its own below it.
    population
        Descriptors of the sample, as soon as they are known.
    dataset
        The representatives, as soon as they are made.
    """

    particles: tuple[Particle, ...]
    settings: ReportSettings
    folder: Path
    executor: Executor
    population: MeasuredPopulation | None = None
    dataset: Dataset | None = None

    @cached_property
    def studied(self) -> tuple[Particle, ...]:
        """The particles of Figs. 3 and 8: all, or as many as asked for, at random, in their order."""
        count = min(self.settings.study_particles, len(self.particles))
        rng = np.random.default_rng(np.random.SeedSequence(self.settings.seed))
        places = np.sort(rng.choice(len(self.particles), count, replace=False))
        return tuple(self.particles[int(at)] for at in places)

    @cached_property
    def drawn(self) -> tuple[Particle, ...]:
        """The particles of Figs. 2 and 7: evenly from all over the sample."""
        places = np.linspace(0, len(self.particles) - 1, self.settings.drawn)
        return tuple(self.particles[int(at)] for at in np.unique(places.round()))

    @property
    def representatives(self) -> Dataset:
        """The dataset.

        Raises
        ------
        InputError
            If it could not be made.
        """
        if self.dataset is None:
            raise InputError("There is no dataset of representative particles, as said above.")
        return self.dataset
