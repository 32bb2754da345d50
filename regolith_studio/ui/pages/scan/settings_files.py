"""Files of settings and classifiers: ask for them, read and write them."""

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from regolith_studio.errors import RegolithError
from regolith_studio.imaging.segmentation.pixel_classifier import TrainingSet
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.json_text import json_bytes
from regolith_studio.jobs.extraction_settings import (
    GrainSettings,
    read_classifier,
    read_grain_settings,
    read_objects,
)
from regolith_studio.readers.volume_formats import volume_suffixes
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.scan.controls import SegmentationControls
from regolith_studio.ui.pages.scan.corrections import Corrections
from regolith_studio.ui.pages.scan.file_dialogs import (
    CLASSIFIERS,
    SETTINGS,
    VOLUMES,
    ask_to_open,
    ask_to_save,
    note_command,
)
from regolith_studio.ui.pages.scan.opening import VolumeOpening
from regolith_studio.ui.pages.scan.painting import Painting
from regolith_studio.ui.translation import tr

T = TypeVar("T")


class SettingsFiles(QObject):
    """Opens and saves settings of the page, pixel classifiers, and object classifiers."""

    settingsOpened = Signal(object)  # noqa: N815
    """The :class:`GrainSettings` of a file."""

    def __init__(
        self,
        context: PageContext,
        controls: SegmentationControls,
        painting: Painting,
        corrections: Corrections,
        opening: VolumeOpening,
        page: QWidget,
    ) -> None:
        super().__init__(page)
        self._context, self._controls, self._page = context, controls, page
        self._painting, self._corrections, self._opening = painting, corrections, opening

    def open_settings(self) -> None:
        """Ask for a recipe of this page or of ``extract`` and hand its settings over."""
        self._open(tr("Open settings"), tr(SETTINGS), read_grain_settings, self.settingsOpened.emit)

    def save_settings(self, settings: GrainSettings) -> None:
        """Ask for a file and write the settings as a recipe."""
        path = ask_to_save(self._page, self._context, tr("Save settings"), "grains.json", tr(SETTINGS))
        if path is None:
            return
        try:
            write_bytes(path, json_bytes(settings.as_document()))
        except RegolithError as error:
            self._context.toast.problem(str(error))
            return
        note_command(self._context, f"regolith-studio extract --recipe {path.name}")

    def open_classifier(self) -> None:
        """Ask for the file of a classifier and take it as the threshold."""
        self._open(tr("Open a classifier"), tr(CLASSIFIERS), read_classifier, self._use_classifier)

    def read_labels(self) -> None:
        """Ask for a volume of labels and add what is painted there to the strokes."""
        suffixes = " ".join(f"*{suffix}" for suffix in sorted(volume_suffixes()))
        path = ask_to_open(self._page, self._context, tr("Read labels"), tr(VOLUMES, suffixes=suffixes))
        if path is not None:
            self._painting.read_labels(path, self._controls.value().region)

    def open_objects(self) -> None:
        """Ask for the file of an object classifier and apply it."""
        self._open(tr("Open a classifier"), tr(CLASSIFIERS), read_objects, self._corrections.load)

    def save_classifier(self) -> None:
        """Ask for a file and write the classifier that was trained by strokes."""
        self._save("classifier", self._painting.save)

    def save_objects(self) -> None:
        """Ask for a file and write the object classifier."""
        self._save("objects", self._corrections.save)

    def _open(self, title: str, kinds: str, read: Callable[[Path], T], use: Callable[[T], object]) -> None:
        path = ask_to_open(self._page, self._context, title, kinds)
        if path is None:
            return
        try:
            use(read(path))
        except RegolithError as error:
            self._context.toast.problem(str(error))

    def _use_classifier(self, training: TrainingSet) -> None:
        self._controls.set_classifier(training)
        self._controls.use_classifier()

    def _save(self, option: str, write: Callable[[Path, Path, Callable[[Path], None]], None]) -> None:
        """Ask for a file and have a classifier written into it, the option of ``extract`` that takes it."""
        path = ask_to_save(
            self._page, self._context, tr("Save the classifier"), f"{option}.json", tr(CLASSIFIERS)
        )
        if path is not None:
            command = f"regolith-studio extract --{option} {path.name}"
            write(path, self._opening.given.path, lambda _: note_command(self._context, command))
