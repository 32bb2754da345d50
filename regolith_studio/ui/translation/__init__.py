"""Translation of the window by Qt; the texts in the code are English.

``tr`` and ``tr_count`` translate where a text is shown, ``translate`` a sentence of the layers below, and
:func:`~regolith_studio.messages.N_` marks a text that is translated later. ``tools/update_translations.py``
keeps ``resources/translations`` in step with the code by lupdate and lrelease.
"""

import re
from numbers import Real

from PySide6.QtCore import QCoreApplication

from regolith_studio.messages import Message, Number
from regolith_studio.ui.translation.numbers import NumberFormatter, localized
from regolith_studio.ui.translation.plain_text import Markup, inert, rich

_TAG = re.compile(r"<[a-z/]", re.IGNORECASE)
_FORMATTER = NumberFormatter()


def tr(text: str, **values: object) -> str:
    """`text` in the language of the window, its ``{placeholders}`` filled in; `text` itself if unknown.

    Numbers are formatted as Python does, with the decimal sign of the language. Values are text: in a text
    with tags they are escaped, unless they are :class:`Markup`, and elsewhere they are :func:`inert`.
    """
    found = _translation(text)
    has_tags = "<" in found and _TAG.search(found) is not None
    if not values:
        return Markup(found) if has_tags else found
    if has_tags or any(isinstance(each, Markup) for each in values.values()):
        shown = {name: rich(str(each)) if _is_text(each) else each for name, each in values.items()}
        return Markup(_FORMATTER.format(found, **shown))
    return _FORMATTER.format(found, **{n: inert(str(v)) if _is_text(v) else v for n, v in values.items()})


def _translation(text: str) -> str:
    return QCoreApplication.translate("", text) if text else text  # lupdate gives Python texts no context


def _is_text(value: object) -> bool:
    return not isinstance(value, Real | Markup)


def tr_count(one: str, many: str, count: int, **values: object) -> str:
    """As :func:`tr`, of the form for one thing or of the form for `count` of them; both marked by ``N_``."""
    return tr(one if count == 1 else many, count=count, **values)


def translate(text: str) -> str:
    """A text of the layers below in the language of the window, with its values translated and filled in.

    Those layers know no markup: what looks like it is of a name, and :func:`inert`.
    """
    if isinstance(text, Number):
        return localized(text)
    if not isinstance(text, Message):
        return text if isinstance(text, Markup) else inert(_translation(text))
    values = {
        name: translate(each) if isinstance(each, Message | Number) else each
        for name, each in text.values.items()
    }
    return inert(_FORMATTER.format(_translation(text.template), **values))
