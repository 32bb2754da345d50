"""Studies of the present choices: rows of loss weights, and the jobs of the studies."""

from collections.abc import Mapping, Sequence
from typing import Any

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.weights import LossWeights
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
COMPOUND = "compound"
PCHS = "pchs"
"""Name of the row of unions of convex parts that keep all descriptors."""


def present_row(choices: Choices) -> LossVariant:
    """What is chosen now, as a row."""
    return LossVariant(
        N_("Chosen weights"), choices.weights, choices.method, choices.facet_count, choices.settings
    )


def compound_row(choices: Choices) -> LossVariant:
    """A union of convex parts with all descriptors as conditions, beside rows of convex polyhedra."""
    settings = choices.settings if choices.method == COMPOUND else ()
    return LossVariant(
        METHODS[COMPOUND].label, LossWeights.from_preset("all"), COMPOUND, choices.facet_count, settings
    )


def pchs_row(choices: Choices) -> LossVariant:
    """A baseline without a loss: fewer facets of the convex hull."""
    settings = choices.settings if choices.method == PCHS else ()
    return LossVariant(METHODS[PCHS].label, LossWeights.of(), PCHS, choices.facet_count, settings)


def loss_names() -> dict[str, str]:
    """Everything that can be a row, with its label: losses, two other methods and the chosen weights."""
    names = {name: loss.label for name, loss in losses().items()}
    others = {name: METHODS[name].label for name in (COMPOUND, PCHS)}
    return names | others | {CHOSEN: N_("Chosen weights")}


def chosen_rows(names: Sequence[str], choices: Choices) -> tuple[LossVariant, ...]:
    """A row for each name of :func:`loss_names`."""
    like = present_row(choices)
    own = {CHOSEN: like, COMPOUND: compound_row(choices), PCHS: pchs_row(choices)}
    return tuple(own[name] if name in own else loss_variants((name,), like)[0] for name in names)


def varied_rows(
    key: str, choices: Choices, values: str, with_compound: bool = False
) -> tuple[LossVariant, ...]:
    """The rows of a variation of the present choices, from values with commas between them.

    ``with_compound``: whether a union of convex parts is compared with the rows of a trade-off.
    """
    rows = SWEEPS[key].rows(present_row(choices), parse_values(values))
    if key == "tradeoff" and with_compound:
        rows = (*rows, compound_row(choices))
    for row in rows:
        Choices(n_facets=row.n_facets)
    return rows


def study_job(
    kind: Kind, particles: Sequence[Particle], choices: Choices, options: Mapping[str, Any]
) -> tuple[str, Job]:
    """Title and job of a study of `particles` with the present `choices`."""
    match kind:
        case Kind.LMAX_STUDY:
            given = {"seed": choices.seed, "fit_options": choices.fit_options, **options}
            return N_("RMSRE against l_max"), Job(study_lmax, (tuple(particles),), given)
        case Kind.COARSENING_STUDY:
            job = Job(study_coarsening, (tuple(particles), choices.coarsening_request), options)
            return N_("RMSRE against loss weights"), job
        case _:
            raise InputError(f"There is no study called {kind}.")
