"""Translation of the window by Qt, and the signs of its numbers; the texts in the code are English.

``tr`` and ``tr_count`` translate where a text is shown, ``translate`` a sentence of the layers below, and
:func:`~regolith_studio.messages.N_` marks a text that is translated later. ``tools/update_translations.py``
keeps ``resources/translations`` in step with the code by lupdate and lrelease. Files, the command line, and
sentences about errors that come from them keep the decimal point.

Texts from files are shown as they are: names, paths and sentences about them are never markup. Qt takes a
text for rich text where it finds a tag, and then loads the pictures that it names. So names go through
:func:`inert` or :func:`rich` on their way into a label, title, tool tip or message; ``tr`` does so with
all values.
"""

import html
import re
from numbers import Real
from string import Formatter
from typing import Any

from PySide6.QtCore import QCoreApplication, QLibraryInfo, QLocale, QTranslator

from regolith_studio.messages import N_, Message, Number
from regolith_studio.resources import resource

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


SYSTEM = "system"
LANGUAGES = {SYSTEM: N_("As the system"), "en": "English", "de": "Deutsch"}
"""What can be chosen; a language calls itself by its own name."""
SETTING = "language"
"""In the preferences of the window."""


def language_of(choice: str) -> str:
    """``en`` or ``de``, for one of :data:`LANGUAGES` or anything else that a file of preferences may hold."""
    if choice in LANGUAGES and choice != SYSTEM:
        return choice
    wanted = QLocale.system().name().partition("_")[0]
    return wanted if wanted in LANGUAGES else "en"


def install_translators(app: QCoreApplication, choice: str) -> list[QTranslator]:
    """Translate the window, its numbers and the dialogs of Qt from now on; returns the translators installed.

    Texts take it when they are made, so that this comes before any window.
    """
    language = language_of(choice)
    if language == "en":
        return []
    of_qt, ours = QTranslator(app), QTranslator(app)
    of_qt.load(f"qtbase_{language}", QLibraryInfo.path(QLibraryInfo.LibraryPath.TranslationsPath))
    ours.load(str(resource("translations", f"{language}.qm")))
    for each in (of_qt, ours):
        app.installTranslator(each)
    set_number_locale(QLocale(language))
    return [of_qt, ours]


def remove_translators(app: QCoreApplication, installed: list[QTranslator]) -> None:
    """Remove the translators that :func:`install_translators` installed."""
    for each in installed:
        app.removeTranslator(each)
        each.deleteLater()
    installed.clear()
    set_number_locale(QLocale.c())


def set_number_locale(locale: QLocale) -> None:
    """Let all widgets made from now on write numbers with the signs of this locale, thousands ungrouped."""
    locale.setNumberOptions(QLocale.NumberOption.OmitGroupSeparator)
    QLocale.setDefault(locale)


_TAG = re.compile(r"<[a-z/]", re.IGNORECASE)
_FORMATTER = NumberFormatter()


def tr(text: str, **values: object) -> str:
    """`text` in the language of the window, its ``{placeholders}`` filled in; `text` itself if unknown.

    Numbers are formatted as Python does, with the decimal sign of the language. Values are text: in a text
    with tags they are escaped, unless they are :class:`Markup`, and elsewhere they are :func:`inert`.
    """
    translated = _translation(text)
    has_tags = "<" in translated and _TAG.search(translated) is not None
    if not values:
        return Markup(translated) if has_tags else translated
    if has_tags or any(isinstance(each, Markup) for each in values.values()):
        shown = {name: rich(str(each)) if _is_text(each) else each for name, each in values.items()}
        return Markup(_FORMATTER.format(translated, **shown))
    return _FORMATTER.format(
        translated, **{n: inert(str(v)) if _is_text(v) else v for n, v in values.items()}
    )


def _translation(text: str) -> str:
    return QCoreApplication.translate("", text) if text else text  # lupdate gives Python texts no context


def _is_text(value: object) -> bool:
    return not isinstance(value, Real | Markup)


def in_a_sentence(label: str) -> str:
    """A label within a sentence: lower case in English, unchanged in other languages."""
    shown = tr(label)
    return shown.lower() if shown == label else shown


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
