"""Numbers in the language of the window: the one place that knows its decimal sign.

Files, the command line, and sentences about errors that come from them keep the point.
"""

import re
from numbers import Real
from string import Formatter
from typing import Any

from PySide6.QtCore import QLocale


def localized(text: str) -> str:
    """A text with numbers as Python writes them, with the decimal and group signs of the language.

    Every point and comma of the text is taken for one of a number. A per cent sign stands behind a space that
    keeps the line.
    """
    locale = QLocale()
    text = text.translate({ord("."): locale.decimalPoint(), ord(","): locale.groupSeparator()})
    return re.sub(r"(?<=\d) ?%", "\N{NO-BREAK SPACE}%", text)


def number_text(value: float | Real, form: str) -> str:
    """A number in a format of Python, such as ``.3g``, with the signs of the language."""
    return localized(format(value, form))


def with_decimal_point(text: str) -> str:
    """What a user has typed, with a point for a comma between digits."""
    return re.sub(r"(?<=\d),(?=\d)", ".", text)


class NumberFormatter(Formatter):
    """As ``str.format``, with the numbers localized."""

    def format_field(self, value: Any, format_spec: str) -> str:
        return number_text(value, format_spec) if isinstance(value, Real) else format(value, format_spec)
