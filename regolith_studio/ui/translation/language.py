"""The language of the window, the translators that it needs, and the signs of its numbers."""

from PySide6.QtCore import QCoreApplication, QLibraryInfo, QLocale, QTranslator

from regolith_studio.messages import N_
from regolith_studio.resources import resource

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
