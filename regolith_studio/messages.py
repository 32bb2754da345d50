"""Texts for users that can be translated: a template and the values that fill it in.

The layers below the window know no languages: they mark English texts by :func:`N_`, which lupdate finds, and
make sentences with values as :class:`Message`. The window looks up the template and fills in the values.
"""

from collections.abc import Iterable
from typing import Any


def N_(text: str) -> str:  # noqa: N802  # the usual name of this mark
    """`text` itself, marked for translation."""
    return text


class Message(str):
    """An English sentence that remembers its template and its values.

    Parameters
    ----------
    template
        With ``{placeholders}``, marked by :func:`N_`.
    values
        By placeholder; those that are messages themselves are translated too.
    """

    template: str
    values: dict[str, Any]

    __slots__ = ("template", "values")

    def __new__(cls, template: str, **values: Any) -> "Message":
        made = super().__new__(cls, template.format(**values) if values else template)
        made.template, made.values = template, values
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (self.template, self.values)


def _rebuild(template: str, values: dict[str, Any]) -> Message:
    return Message(template, **values)


def join_messages(parts: Iterable[str], separator: str = " ") -> Message:
    """Several texts as one message; each is translated by itself."""
    values = {f"part_{number}": part for number, part in enumerate(parts)}
    return Message(separator.join(f"{{{name}}}" for name in values), **values)
