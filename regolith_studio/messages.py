"""Texts for users that can be translated: a template and the values that fill it in.

The layers below the window know no languages: they mark English texts by :func:`N_`, which lupdate finds, and
make sentences with values as :class:`Message`. The window looks up the template and fills in the values.
"""

from collections.abc import Iterable
from typing import Any


def N_(text: str) -> str:  # noqa: N802  # the usual name of this mark
    """`text` itself, marked for translation."""
    return text


class Number(str):
    """A number in a sentence: formatted as in English, and with the signs of the language where it is shown.

    ``value``, ``form``: as for ``format``. ``unit``: behind it.
    """

    __slots__ = ()

    def __new__(cls, value: float, form: str, unit: str = "") -> "Number":
        return cls.of_text(format(value, form) + unit)

    @classmethod
    def of_text(cls, text: str) -> "Number":
        """The number that was formatted as `text`."""
        return super().__new__(cls, text)

    def __reduce__(self) -> tuple[Any, ...]:
        return Number.of_text, (str(self),)


class Message(str):
    """An English sentence that remembers its template and its values.

    ``template``: with ``{placeholders}``, marked by :func:`N_`. ``values``: by placeholder; those that are
    messages themselves are translated too.
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


def count_message(one: str, many: str, count: int, **values: Any) -> Message:
    """The template for one thing, or that for several with their number as ``{count}``."""
    return Message(one if count == 1 else many, count=Number(count, ","), **values)


def to_json(text: str) -> Any:
    """A text as plain JSON that keeps template and values of a message."""
    if isinstance(text, Number):
        return {"number": str(text)}
    if not isinstance(text, Message):
        return text
    values = {name: to_json(each) if isinstance(each, str) else each for name, each in text.values.items()}
    return {"template": text.template, "values": values}


def from_json(document: Any) -> str:
    """The text that :func:`to_json` was given."""
    if not isinstance(document, dict):
        return str(document)
    if "number" in document:
        return Number.of_text(document["number"])
    values = document["values"].items()
    read = {name: from_json(each) if isinstance(each, dict) else each for name, each in values}
    return Message(document["template"], **read)
