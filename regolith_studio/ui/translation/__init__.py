"""Translation of the window by Qt; the texts in the code are English.

``tr`` and ``tr_count`` translate where a text is shown, ``translate`` a sentence of the layers below, and
:func:`~regolith_studio.messages.N_` marks a text that is translated later. ``tools/update_translations.py``
keeps ``resources/translations`` in step with the code by lupdate and lrelease.
"""

from PySide6.QtCore import QCoreApplication

from regolith_studio.messages import Message, Number
from regolith_studio.ui.translation.numbers import NumberFormatter, localized

_FORMATTER = NumberFormatter()


def tr(text: str, **values: object) -> str:
    """`text` in the language of the window, its ``{placeholders}`` filled in; `text` itself if unknown.

    Numbers are formatted as Python does, with the decimal sign of the language.
    """
    found = QCoreApplication.translate("", text) if text else text  # lupdate gives Python texts no context
    return _FORMATTER.format(found, **values) if values else found


def tr_count(one: str, many: str, count: int, **values: object) -> str:
    """As :func:`tr`, of the form for one thing or of the form for `count` of them; both marked by ``N_``."""
    return tr(one if count == 1 else many, count=count, **values)


def translate(text: str) -> str:
    """A text of the layers below in the language of the window, with its values translated and filled in."""
    if isinstance(text, Number):
        return localized(text)
    if not isinstance(text, Message):
        return tr(text)
    values = {
        name: translate(each) if isinstance(each, Message | Number) else each
        for name, each in text.values.items()
    }
    return tr(text.template, **values)
