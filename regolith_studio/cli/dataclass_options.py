"""Groups of options that a command takes as one argument, defined by a dataclass.

A group is a frozen dataclass whose fields are annotated as options, are made by
:func:`~regolith_studio.settings.setting`, or are groups themselves. A command with
:func:`with_dataclass_options` above it has each of those fields as an option, in the group's place.
"""

import functools
import inspect
from collections.abc import Callable, Iterator
from dataclasses import MISSING, Field, fields, is_dataclass
from typing import Annotated, Any, Literal, get_origin, get_type_hints

import typer

from regolith_studio.errors import InputError
from regolith_studio.settings import setting_of


def with_dataclass_options(command: Callable[..., None]) -> Callable[..., None]:
    """The command with the options of its groups in place of the groups, for typer."""
    hints = get_type_hints(command, include_extras=True)
    parameters = inspect.signature(command).parameters.values()
    groups = {each.name: hints[each.name] for each in parameters if is_dataclass(hints[each.name])}

    @functools.wraps(command)
    def called(**values: Any) -> None:
        arguments = {name: _make_group(group, values) for name, group in groups.items()}
        command(**values, **arguments)

    options = [
        option for each in parameters for option in _options(each.name, hints[each.name], each.default)
    ]
    signature = inspect.Signature(options)
    called.__signature__ = signature  # type: ignore[attr-defined]
    called.__annotations__ = {each.name: each.annotation for each in options}
    return called


def _options(name: str, hint: Any, default: Any) -> Iterator[inspect.Parameter]:
    """An option, or those of a group."""
    if not is_dataclass(hint):
        yield inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=hint)
        return
    hints = get_type_hints(hint, include_extras=True)
    for each in fields(hint):
        default = inspect.Parameter.empty if each.default is MISSING else each.default
        annotation = hints[each.name]
        if "label" in each.metadata:
            plain = str if get_origin(annotation) is Literal else annotation  # the group checks its keys
            annotation = Annotated[plain, _option(each, each.name)]
        yield from _options(each.name, annotation, default)


def option_of(kind: type[Any], name: str, **changes: Any) -> Any:
    """The option of a single setting, for ``Annotated``; `changes` of its metadata, such as ``metavar``."""
    return _option(setting_of(kind, name, **changes), name)


def _option(each: Field[Any], name: str) -> Any:
    """The option of a setting; its tip and its keys are the help, its range is checked."""
    metadata = each.metadata
    keys = [str(key) for key in metadata.get("choices", ()) if key]
    help_ = metadata.get("tip") or f"{metadata['label']}."
    flag = metadata.get("option") or f"--{name.strip('_').replace('_', '-')}"
    if isinstance(each.default, bool):
        off = f"/--no-{flag.removeprefix('--')}" if each.default and "/" not in flag else ""
        return typer.Option(f"{flag}{off}", help=help_)
    limits = {end[:3]: metadata[end] for end in ("minimum", "maximum") if end in metadata}
    metavar = "KEY" if isinstance(each.default, str) else "N"
    if metadata.get("unit") == "%":
        metavar, limits = "PERCENT", {end: 100.0 * limit for end, limit in limits.items()}
    return typer.Option(
        flag,
        help=f"{help_} One of: {', '.join(keys)}." if keys else help_,
        metavar=metadata.get("metavar", metavar),
        show_default=metadata.get("shown_default", bool(each.default)),
        **limits,
    )


def _make_group(group: Any, values: dict[str, Any]) -> Any:
    """Make a group of its values, which are removed from `values`."""
    hints = get_type_hints(group)
    arguments = {}
    for name in (each.name for each in fields(group)):
        arguments[name] = _make_group(hints[name], values) if is_dataclass(hints[name]) else values.pop(name)
    try:
        return group(**arguments)
    except InputError as error:
        raise typer.BadParameter(str(error)) from error
