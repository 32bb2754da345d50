"""Settings of a user as dataclass fields that carry their label, unit, range and help.

The check of the values, the entries of a recipe, the options of the command line and the forms of the window
are made from these fields; see :func:`setting`.
"""

import math
import numbers
from collections.abc import Iterator, Mapping
from dataclasses import Field, field, fields
from typing import Any

from regolith_studio.errors import InputError


def setting(
    default: Any,
    label: str,
    tip: str = "",
    *,
    unit: str = "",
    minimum: float | None = None,
    maximum: float | None = None,
    choices: Mapping[str, str] | None = None,
    metavar: str = "",
) -> Any:
    """A field of a settings dataclass.

    Parameters
    ----------
    label
        Name in forms and messages.
    tip
        What it does, in a sentence: tool tip, help of the option, description in the schema.
    unit
        Of a number.
    minimum, maximum
        Range of a number, both included.
    choices
        Label of each key that a text may be.
    metavar
        What stands for its value in the help of the command line; the keys, or ``N``, by default.
    """
    metadata = {
        "label": label,
        "tip": tip,
        "unit": unit,
        "minimum": minimum,
        "maximum": maximum,
        "choices": choices,
        "metavar": metavar,
    }
    known = {name: value for name, value in metadata.items() if value not in (None, "")}
    return field(default=default, metadata=known)


def settings_of_kind(kind: Any) -> Iterator[Field[Any]]:
    """The fields of a dataclass that were made by :func:`setting`."""
    return (each for each in fields(kind) if "label" in each.metadata)


def is_whole(value: Any) -> bool:
    """Whether a value is a whole number: 4 or 4.0, but neither 4.5 nor True nor "4"."""
    number = isinstance(value, numbers.Real) and not isinstance(value, bool)
    return number and math.isfinite(value) and value == int(value)


def check_settings(values: Any) -> None:
    """Check each setting of a dataclass against its type, range and choices.

    Raises
    ------
    InputError
        Naming the first value that is wrong, and what is allowed.
    """
    for each in settings_of_kind(values):
        value, known = getattr(values, each.name), each.metadata
        if "choices" in known:
            _check_choice(each.name, value, tuple(known["choices"]))
        elif isinstance(each.default, int | float) and not isinstance(each.default, bool):
            _check_number(each, value)


def _check_choice(name: str, value: Any, keys: tuple[str, ...]) -> None:
    if value not in keys:
        named = ", ".join(filter(None, keys))
        raise InputError(f"The setting {name} must be one of {named}, got {value!r}.")


def _check_number(each: Field[Any], value: Any) -> None:
    low, high = each.metadata.get("minimum", -math.inf), each.metadata.get("maximum", math.inf)
    is_whole = isinstance(each.default, int)
    is_number = isinstance(value, int if is_whole else int | float) and not isinstance(value, bool)
    if is_number and math.isfinite(value) and low <= value <= high:
        return
    what = "a whole number" if is_whole else "a number"
    if math.isfinite(low) and math.isfinite(high):
        what += f" from {low} to {high}"
    elif math.isfinite(low):
        what += f" of at least {low}"
    raise InputError(f"The setting {each.name} must be {what}, got {value!r}.")
