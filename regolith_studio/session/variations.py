"""The rows that present choices stand for: of studies of the coarsening, and of the gallery of Fig. 7."""

from collections.abc import Sequence

from regolith_studio.session.choices import Choices
from regolith_studio.studies.loss_rows import StudyRow, loss_rows, losses
from regolith_studio.studies.variations import VARIATIONS, parsed_values

CHOSEN = "chosen"
"""Name of the loss whose weights are the present ones."""


def present_row(choices: Choices) -> StudyRow:
    """What is chosen now, as a row."""
    return StudyRow("Chosen weights", choices.weights, choices.method, choices.facet_count, choices.settings)


def loss_names() -> dict[str, str]:
    """Every loss that can be a row, with its label; the chosen weights last."""
    return {name: loss.label for name, loss in losses().items()} | {CHOSEN: "Chosen weights"}


def chosen_rows(names: Sequence[str], choices: Choices) -> tuple[StudyRow, ...]:
    """A row for each name of :func:`loss_names`.

    Raises
    ------
    InputError
        If there is no such loss.
    """
    like = present_row(choices)
    return tuple(like if name == CHOSEN else loss_rows((name,), like)[0] for name in names)


def varied_rows(key: str, choices: Choices, values: str) -> tuple[StudyRow, ...]:
    """The rows of a variation of the present choices, from values with commas between them.

    Raises
    ------
    InputError
        If a value is wrong, or the choices leave nothing to vary.
    """
    rows = VARIATIONS[key].rows(present_row(choices), parsed_values(values))
    for row in rows:
        Choices(n_facets=row.n_facets)
    return rows
