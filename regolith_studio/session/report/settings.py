"""What a report shows, of how many particles, and what a dialog needs to know of it.

The window imports this when it starts, and the makers of the sections only when a report is made.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from regolith_studio.messages import N_
from regolith_studio.settings import check_settings, setting

if TYPE_CHECKING:  # the command line makes its options of these fields, and must not wait for numerics
    from regolith_studio.session.choices import Choices


PAGE = "report.html"


@dataclass(frozen=True)
class SectionBegun:
    """Emitted before a section is made.

    ``number``, ``total``: of the sections, from 1.
    """

    number: int
    total: int
    title: str


@dataclass(frozen=True)
class ReportSettings:
    """Settings of a report."""

    l_max: int = setting(
        10,
        N_("Maximum degree"),
        N_("Degree at which fits are cut and models draw; the paper uses 10."),
        minimum=1,
        maximum=30,
        metavar="L",
    )
    facets: int = setting(
        20,
        N_("Facets"),
        N_("Number of facets of each polyhedron."),
        minimum=5,
        maximum=500,
    )
    method: str = setting("exact", N_("Coarsening method"), N_("Method of coarsening."))
    preset: str = setting(
        "all", N_("Preset"), N_("Preset of the loss weights of the representative particles.")
    )
    study_particles: int = setting(
        150,
        N_("Particles of the studies"),
        N_("Number of particles, taken at random, that Figs. 3 and 8 are made from."),
        minimum=1,
        maximum=1_000_000,
    )
    drawn: int = setting(
        3, N_("Particles shown"), N_("Number of particles shown in Fig. 7."), minimum=1, maximum=20
    )
    splits: int = setting(
        5,
        N_("Splits"),
        N_("Number of random halves that the models of Figs. 4 to 6 are fitted to."),
        minimum=1,
        maximum=100,
    )
    representatives: int = setting(
        10,
        N_("Representatives"),
        N_("Number of shapes that the heap is made of."),
        minimum=1,
        maximum=10_000,
    )
    heap: int = setting(
        1000,
        N_("Particles of the heap"),
        N_("Number of particles of the simulated heap of Fig. 9; 0 for none."),
        minimum=0,
        maximum=5_000_000,
    )
    seed: int = setting(0, N_("Seed"), N_("Seed of the random numbers."), minimum=0, maximum=2**63 - 1)

    def __post_init__(self) -> None:
        from regolith_studio.dem.angle_of_repose import check_number
        from regolith_studio.dem.evaluation import EvaluationSettings

        check_settings(self)
        _ = self.choices
        if self.heap:
            check_number(self.heap, EvaluationSettings())

    @property
    def choices(self) -> "Choices":
        """How particles are fitted and coarsened: the target is the fit, as in section 3.2."""
        from regolith_studio.session.choices import Choices

        return Choices().replaced(
            l_max=self.l_max,
            n_facets=self.facets,
            method=self.method,
            preset=self.preset,
            seed=self.seed,
            target="fit",
        )
