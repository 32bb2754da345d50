"""Which language the window speaks, and the translators that make it do so.

The ``.ts`` file of Qt Linguist is read as it is: it is small, can be read and reviewed as text, and nothing
compiled need be kept in step with it.
"""

import xml.etree.ElementTree as ET
from pathlib import Path

from PySide6.QtCore import QCoreApplication, QLibraryInfo, QLocale, QTranslator

from regolith_studio.resources import resource
from regolith_studio.ui.translation import CONTEXT, mark

SYSTEM = "system"
LANGUAGES = {SYSTEM: mark("As the system"), "en": "English", "de": "Deutsch"}
"""What can be chosen; a language calls itself by its own name."""
SETTING = "language"
"""In the preferences of the window."""


class Translator(QTranslator):
    """Answers with the words of a table; what it does not hold stays as it is."""

    def __init__(self, words: dict[str, str]) -> None:
        super().__init__()
        self.words = words

    def isEmpty(self) -> bool:
        return not self.words

    def translate(
        self,
        context: str,
        source: str,
        disambiguation: str | None = None,  # noqa: ARG002
        n: int = -1,  # noqa: ARG002
    ) -> str | None:
        return self.words.get(source) if context == CONTEXT else None


def translation_file(language: str) -> Path:
    """The shipped translation into a language.

    Raises
    ------
    MissingRequirement
        If there is none.
    """
    return resource("translations", f"{language}.ts")


def read_words(path: Path) -> dict[str, str]:
    """The finished messages of a ``.ts`` file: translation by source."""
    messages = ET.parse(path).getroot().iter("message")
    found = {each.findtext("source", ""): each.find("translation") for each in messages}
    return {
        source: each.text
        for source, each in found.items()
        if each is not None and each.text and each.get("type") is None
    }


def language_of(choice: str) -> str:
    """``en`` or ``de``, for one of :data:`LANGUAGES` or anything else that a file of preferences may hold."""
    if choice in LANGUAGES and choice != SYSTEM:
        return choice
    wanted = QLocale.system().name().partition("_")[0]
    return wanted if wanted in LANGUAGES else "en"


def speak(app: QCoreApplication, choice: str) -> list[QTranslator]:
    """Let the window and the dialogs of Qt speak a language from now on; returns what was installed.

    Texts take it when they are made, so that this comes before any window.
    """
    language = language_of(choice)
    if language == "en":
        return []
    of_qt, ours = QTranslator(app), Translator(read_words(translation_file(language)))
    of_qt.load(f"qtbase_{language}", QLibraryInfo.path(QLibraryInfo.LibraryPath.TranslationsPath))
    ours.setParent(app)
    for each in (of_qt, ours):
        app.installTranslator(each)
    return [of_qt, ours]


def fall_silent(app: QCoreApplication, installed: list[QTranslator]) -> None:
    """Take back what :func:`speak` did."""
    for each in installed:
        app.removeTranslator(each)
        each.deleteLater()
    installed.clear()
