"""Words of the window in the language of the user; the words in the code are English.

``tr`` translates where a text is shown, ``mark`` names one in a table that is made when a module is loaded.
The translations lie in ``resources/translations``; :mod:`regolith_studio.ui.translation.extract` keeps them
in step with the code.
"""

from PySide6.QtCore import QCoreApplication

CONTEXT = "RegolithStudio"
"""The one context of all messages: a word means the same wherever it stands in the window."""


def tr(text: str, **values: object) -> str:
    """`text` in the language of the window, its ``{placeholders}`` filled in; `text` itself if unknown.

    Numbers are formatted as Python does, with a point, in every language.
    """
    found = QCoreApplication.translate(CONTEXT, text) if text else text
    return found.format(**values) if values else found


def tr_count(one: str, many: str, count: int, **values: object) -> str:
    """As :func:`tr`, of the form for one thing or of the form for `count` of them."""
    return tr(one if count == 1 else many, count=count, **values)


def mark(text: str) -> str:
    """`text` itself, so that it is found for the translators; :func:`tr` is called where it is shown."""
    return text
