"""Settings of a user as dataclass fields that carry their label, unit, range and help.

The check of the values, the entries of a recipe, the options of the command line and the forms of the window
are made from these fields; see :func:`setting`.
"""

import math
import numbers
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import Field, field, fields
from typing import Any, get_args

from regolith_studio.errors import InputError


def setting(
    default: Any,
    label: str,
    tip: str = "",
    *,
    symbol: str = "",
    unit: str = "",
    factor: float = 1.0,
    minimum: float | None = None,
    maximum: float | None = None,
    step: float | None = None,
    decimals: int | None = None,
    slider: tuple[float, float] | None = None,
    choices: Mapping[Any, str] | Sequence[str] | None = None,
    option: str = "",
    metavar: str = "",
) -> Any:
    """A field of a settings dataclass.

    - ``default``: ``None`` for a number that may be left out.
    - ``label``: name in forms and messages.
    - ``tip``: what it does, in a sentence: tool tip, help of the option, description in the schema.
    - ``symbol``: shorter name before the field of a form.
    - ``unit``, ``factor``: of a number: unit that forms show, and the factor that converts into it.
    - ``minimum``, ``maximum``: range of a number, both included.
    - ``step``, ``decimals``: smallest change of a number in a form, and how many decimals it shows.
    - ``slider``: ends of the slider that a form has for a number.
    - ``choices``: label of each key that a text or whole number may be.
    - ``option``: name on the command line where it differs, such as ``--facets``.
    - ``metavar``: what stands for its value in the help of the command line; the keys, or ``N``, by default.
    """
    metadata = {
        "label": label,
        "tip": tip,
        "symbol": symbol,
        "unit": unit,
        "factor": None if factor == 1.0 else factor,
        "minimum": minimum,
        "maximum": maximum,
        "step": step,
        "decimals": decimals,
        "slider": slider,
        "choices": choices,
        "option": option,
        "metavar": metavar,
    }
    known = {name: value for name, value in metadata.items() if value not in (None, "")}
    return field(default=default, metadata=known)


def setting_of(kind: Any, name: str, **changes: Any) -> Any:
    """The setting of another dataclass as a field of this one; `changes` are its default and metadata."""
    found = next(each for each in settings_of_kind(kind) if each.name == name)
    default = changes.pop("default", found.default)
    return field(default=default, metadata={**found.metadata, **changes})


def settings_of_kind(kind: Any) -> Iterator[Field[Any]]:
    """The fields of a dataclass that were made by :func:`setting`."""
    return (each for each in fields(kind) if "label" in each.metadata)


def settings_in(kind: Any, values: Any) -> dict[str, Any]:
    """The settings of a dataclass that `values` holds as attributes, by name."""
    return {each.name: getattr(values, each.name) for each in settings_of_kind(kind)}


def is_whole(value: Any) -> bool:
    """Whether a value is a whole number: 4 or 4.0, but neither 4.5 nor True nor "4"."""
    number = isinstance(value, numbers.Real) and not isinstance(value, bool)
    return number and math.isfinite(value) and value == int(value)


def check_settings(values: Any) -> None:
    """Check each setting of a dataclass against its type, range and choices.

    Raises InputError naming the first value that is wrong, and what is allowed.
    """
    for each in settings_of_kind(values):
        value, known = getattr(values, each.name), each.metadata
        if value is None and each.default is None:
            continue
        if "choices" in known:
            _check_choice(each.name, value, tuple(known["choices"]))
        elif (number := number_kind(each)) is not None:
            _check_number(each, value, number)


def number_kind(each: Field[Any]) -> type[int] | type[float] | None:
    """Whether a setting is a whole number or any; ``None`` for texts and flags."""
    kinds = get_args(each.type) or (each.type,) if each.default is None else (type(each.default),)
    return next((kind for kind in (int, float) if kind in kinds), None)


def _check_choice(name: str, value: Any, keys: tuple[str, ...]) -> None:
    if value not in keys:
        named = ", ".join(str(key) for key in keys if key)
        raise InputError(f"The setting {name} must be one of {named}, got {value!r}.")


def _check_number(each: Field[Any], value: Any, kind: type[int] | type[float]) -> None:
    low, high = each.metadata.get("minimum", -math.inf), each.metadata.get("maximum", math.inf)
    is_number = isinstance(value, int if kind is int else int | float) and not isinstance(value, bool)
    if is_number and math.isfinite(value) and low <= value <= high:
        return
    what = "a whole number" if kind is int else "a number"
    if math.isfinite(low) and math.isfinite(high):
        what += f" from {low} to {high}"
    elif math.isfinite(low):
        what += f" of at least {low}"
    raise InputError(f"The setting {each.name} must be {what}, got {value!r}.")
