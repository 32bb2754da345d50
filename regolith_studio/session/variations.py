"""The rows that present choices stand for: of studies of the coarsening, and of the gallery of Fig. 7."""

from collections.abc import Sequence

from regolith_studio.session.choices import Choices
from regolith_studio.studies.loss_rows import StudyRow, loss_rows, losses

CHOSEN = "chosen"
"""Name of the loss whose weights are the present ones."""


def present_row(choices: Choices) -> StudyRow:
    """What is chosen now, as a row."""
    return StudyRow("Chosen weights", choices.weights, choices.method, choices.n_faces, choices.settings)


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
