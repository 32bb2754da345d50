"""Texts from files that are shown as they are: names, paths and sentences about them are never markup.

Qt takes a text for rich text where it finds a tag, and then loads the pictures that it names. So names
go through :func:`inert` or :func:`rich` on their way into a label, title, tool tip or message; ``tr`` does so
with all values.
"""

import html
import re

_OPEN = re.compile(r"<(?=[a-z/!?])|&(?=[a-z#])", re.IGNORECASE)
_WORD_JOINER = "\N{WORD JOINER}"


class Markup(str):
    """Rich text that the program itself has made; whatever it holds of others is escaped."""

    __slots__ = ()


def inert(text: str) -> str:
    """A text that looks the same, and which Qt shows as it is: no tag and no entity begins in it.

    An invisible character, which breaks no line, stands behind each sign that would begin one.
    """
    return text if isinstance(text, Markup) else _OPEN.sub(rf"\g<0>{_WORD_JOINER}", text)


def rich(text: str) -> Markup:
    """A text as rich text, escaped if it is not rich text of the program."""
    return (
        text if isinstance(text, Markup) else Markup(html.escape(text.replace(_WORD_JOINER, ""), quote=False))
    )
