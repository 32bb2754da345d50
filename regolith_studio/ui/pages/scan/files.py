"""What the page reads and writes: scans, grains as particles, settings, classifiers and edits."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError
from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QFileDialog, QWidget

from regolith_studio.errors import RegolithError
from regolith_studio.imaging.extraction import Extraction
from regolith_studio.imaging.label_files import LABEL_SUFFIXES
from regolith_studio.imaging.segmentation.pixel_classifier import TrainingSet
from regolith_studio.imaging.segmentation.segment import Segmentation
from regolith_studio.imaging.volume import sample_file
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.own_files import json_bytes
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.extraction_jobs import extract_labels, write_labels
from regolith_studio.jobs.extraction_settings import (
    GrainSettings,
    VolumeInput,
    read_classifier,
    read_grain_settings,
    read_objects,
)
from regolith_studio.jobs.scan_jobs import FirstLook, Scan, read_header, read_sample_scan, read_scan
from regolith_studio.messages import N_
from regolith_studio.readers.sandbox.parent import volume_sandbox
from regolith_studio.readers.volume_formats import volume_suffixes
from regolith_studio.readers.volumes.files import missing_slices
from regolith_studio.readers.volumes.header import VolumeHeader, layout_from_name
from regolith_studio.readers.volumes.region import RegionSettings, crop_of_rectangle
from regolith_studio.readers.voxels.scanner_headers import header_beside
from regolith_studio.session.batch.preprocessing import entry_of, volume_input
from regolith_studio.session.project import fingerprint
from regolith_studio.session.provenance import VolumeSource
from regolith_studio.session.recipe import VolumeEntry
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.scan.controls import SegmentationControls
from regolith_studio.ui.pages.scan.corrections import Corrections, Painting
from regolith_studio.ui.pages.scan.volume_dialog import RAW_SUFFIXES, VolumeDialog, needs_asking
from regolith_studio.ui.translation import tr, translate

VOLUMES = N_("Volumes ({suffixes});;All files (*)")
CLASSIFIERS = N_("Classifiers (*.json);;All files (*)")
SETTINGS = N_("Settings (*.json);;All files (*)")


def last_folder(context: PageContext) -> Path:
    """The folder that was used last, or the user's own."""
    return Path(str(context.recall("folder", str(Path.home()))))


def ask_to_open(parent: QWidget, context: PageContext, title: str, kinds: str) -> Path | None:
    """A file that the user chooses, or ``None``."""
    name, _ = QFileDialog.getOpenFileName(parent, title, str(last_folder(context)), kinds)
    return Path(name) if name else None


def ask_to_save(parent: QWidget, context: PageContext, title: str, proposed: str, kinds: str) -> Path | None:
    """A file that the user wants written, or ``None``; `proposed` is its name at first."""
    name, _ = QFileDialog.getSaveFileName(parent, title, str(last_folder(context) / proposed), kinds)
    return Path(name) if name else None


def note_command(context: PageContext, command: str) -> None:
    """Say with which command a file that was written is used."""
    context.toast.note(tr("Saved; use it with: {command}", command=command))


class VolumeOpening(QObject):
    """Reads the volume that the user names, in the region that the controls say.

    `scan` is what is shown, `given` its file and `region` its region; `wanted` and `wanted_region` are those
    of what is being read, and `first` is a coarse picture of it until it has been read.
    """

    opened = Signal()
    """Another scan is there; the one before has been closed."""
    looked = Signal()
    """A first look at a large volume is there; the scan before it has been closed."""
    leaving = Signal()
    """The scan is about to be closed."""

    def __init__(self, context: PageContext, controls: SegmentationControls, page: QWidget) -> None:
        super().__init__(page)
        self._context, self._controls, self._page = context, controls, page
        self.scan: Scan | None = None
        self.first: FirstLook | None = None
        self.given = self.wanted = VolumeInput(Path())
        self.fingerprint = ""
        self.region = self.wanted_region = RegionSettings()
        volume_sandbox().start_in_background()  # so that the first file need not wait for it

    def ask_for_file(self) -> None:
        kinds = tr(VOLUMES, suffixes=" ".join(f"*{suffix}" for suffix in sorted(volume_suffixes())))
        path = ask_to_open(self._page, self._context, tr("Open a volume"), kinds)
        if path is not None:
            self.open(path)

    def ask_for_folder(self) -> None:
        start = str(last_folder(self._context))
        name = QFileDialog.getExistingDirectory(self._page, tr("Open a folder of slices"), start)
        if name:
            self.open(Path(name))

    def open(self, path: Path) -> None:
        """Open a file or a folder of slices whole, and ask for missing properties."""
        settings = self._controls.value()
        self._controls.setValue(replace(settings, region=replace(settings.region, crop="")))
        self._context.remember("folder", str(path.parent))
        if path.suffix.lower() in RAW_SUFFIXES and header_beside(path) is None:
            self._ask_layout(path)
            return
        gaps = self._gaps(path)
        job = Job(read_header, (VolumeInput(path, allow_gaps=bool(gaps)),))
        self._context.start(
            tr("Inspecting the volume"), job, lambda header: self._on_header(path, header, gaps), queue="read"
        )

    def open_sample(self) -> None:
        self.read(VolumeInput(sample_file("grey")))

    def open_gradient(self) -> None:
        """Open the second shipped scan, which no threshold segments."""
        self.read(VolumeInput(sample_file("grey", "gradient")))

    def read(self, volume: VolumeInput) -> None:
        region = self._controls.value().region
        self.wanted, self.wanted_region = volume, region
        job = Job(read_scan, (volume, region))
        title = tr("Reading the volume")
        if volume.path == sample_file("grey"):
            job, title = Job(read_sample_scan, ("grey", region)), tr("Reading the sample scan")
        self._context.start(
            title, job, lambda scan: self._take(scan, volume, region), partial=self._look, queue="read"
        )

    def state(self) -> dict[str, Any]:
        """Where the scan is, what its file does not say, and its fingerprint; nothing if none is open."""
        if self.scan is None:
            return {}
        entry = entry_of(self.given, GrainSettings())
        named = entry.model_dump(exclude={"region", "segmentation", "extraction"}, exclude_none=True)
        return named | {"fingerprint": self.fingerprint}

    def restore(self, state: Mapping[str, Any]) -> bool:
        """Open the scan that :meth:`state` named, unless it has moved or changed; whether it is read."""
        try:
            entry = VolumeEntry(**{key: value for key, value in state.items() if key != "fingerprint"})
        except (ValidationError, TypeError):
            return False
        volume = volume_input(entry, Path())
        if fingerprint(volume.path) != state.get("fingerprint"):
            self._context.toast.problem(
                tr(
                    "The scan {path} has been moved or changed since the project was saved. Open it from its "
                    "new place: the project keeps its corrections until then.",
                    path=volume.path,
                )
            )
            return False
        self.read(volume)
        return True

    def follow_region(self) -> bool:
        """Read again if the controls want another region; returns whether they do."""
        other = self._controls.value().region != self.wanted_region and self.wanted.path != Path()
        if other:
            self.read(self.wanted)
        return other

    def crop_to_box(self, axis: int, _number: int, points: NDArray[np.float64]) -> None:
        """Read the region that was drawn in a slice."""
        if self.scan is None or not self._controls.draw_box.isChecked():
            return
        self._controls.draw_box.setChecked(False)
        shape = [edge for each, edge in enumerate(self.scan.volume.shape) if each != axis]
        ends = points[[0, -1]]
        low, high = np.floor(ends.min(axis=0)), np.ceil(ends.max(axis=0))
        (x0, y0), (x1, y1) = (np.clip(each, 0, shape).astype(int).tolist() for each in (low, high))
        if x0 < x1 and y0 < y1:
            origin = self.scan.volume.origin
            self._controls.set_crop(crop_of_rectangle(self.region, origin, axis, (x0, y0), (x1, y1)))

    def close(self) -> None:
        """Remove the temporary files of the scan."""
        if self.scan is not None:
            self.scan.scratch.close()

    def _gaps(self, path: Path) -> Mapping[str, str]:
        try:
            return missing_slices(path)
        except RegolithError:
            return {}  # it is reported when the folder is read

    def _on_header(self, path: Path, header: VolumeHeader, gaps: Mapping[str, str]) -> None:
        if gaps or needs_asking(header):
            last = self._last_size()
            self._show_dialog(VolumeDialog(path, header, last=last, gaps=gaps, parent=self._page))
        else:
            self.read(VolumeInput(path))

    def _ask_layout(self, path: Path) -> None:
        with self._context.toast.reporting():
            layout = layout_from_name(path)
            self._show_dialog(VolumeDialog(path, None, layout, self._last_size(), parent=self._page))

    def _show_dialog(self, dialog: VolumeDialog) -> None:
        dialog.accepted.connect(lambda: self._read_described(dialog.value()))
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def _read_described(self, volume: VolumeInput) -> None:
        size = np.ravel(np.asarray(volume.voxel_size))[0]
        self._context.remember("voxel_size", [float(size), volume.unit])
        self.read(volume)

    def _last_size(self) -> tuple[float, str]:
        """Voxel size and unit of the previous volume, proposed for the next one."""
        size, unit = self._context.recall("voxel_size", [1.0, "um"])
        return float(size), str(unit)

    def _look(self, first: FirstLook) -> None:
        self._leave()
        self.first = first
        self.looked.emit()

    def _take(self, scan: Scan, volume: VolumeInput, region: RegionSettings) -> None:
        self._leave()
        self.scan, self.given, self.region = scan, volume, region
        self.fingerprint = fingerprint(volume.path)
        self.opened.emit()

    def _leave(self) -> None:
        if self.scan is not None:
            self.leaving.emit()
        self.close()
        self.scan = self.first = None


class ParticleMaking(QObject):
    """Writes labels and makes particles of them."""

    made = Signal(str)
    """Summary of the particles that the session has adopted."""

    def __init__(self, context: PageContext, opening: VolumeOpening, page: QWidget) -> None:
        super().__init__(page)
        self._context, self._opening, self._page = context, opening, page

    def save_labels(self, grains: Segmentation | None, settings: GrainSettings) -> None:
        """Ask for a file and write the labels of the grains."""
        if grains is None:
            self._context.toast.note(tr("Find the grains first."))
            return
        kinds = tr(VOLUMES, suffixes=" ".join(f"*{suffix}" for suffix in LABEL_SUFFIXES))
        proposed = f"{self._opening.given.path.stem}_labels.tif"
        path = ask_to_save(self._page, self._context, tr("Save labels"), proposed, kinds)
        if path is None:
            return

        def written(table: object) -> None:
            words = tr(
                "Labels were written to {file}, their particles to {table}.",
                file=path.name,
                table=getattr(table, "name", ""),
            )
            self._context.toast.note(words)

        job = Job(write_labels, (grains.labels, settings.extraction, path, True))
        self._context.start(tr("Saving labels"), job, written, queue="grains")

    def make_particles(self, grains: Segmentation | None, settings: GrainSettings) -> None:
        """Convert the grains, or the labels of the scan, to particles and open them.

        ``settings``: what the grains were found with.
        """
        scan = self._opening.scan
        labels = grains.labels if grains else None
        if scan is not None and scan.volume.kind == "labels":
            labels = scan.volume
        if labels is None or scan is None:
            self._context.toast.note(tr("Find the grains first."))
            return
        answer = self._context.commands.ask_before_making()
        if not answer:
            return
        entry = entry_of(self._opening.given, settings)
        grey = scan.volume if scan.volume.kind == "grey" else None
        job = Job(extract_labels, (labels, settings.extraction, self._opening.given.path, grey))
        self._context.start(
            tr("Making particles"), job, lambda found: self._adopt(found, entry, answer), queue="grains"
        )

    def _adopt(self, extraction: Extraction, entry: VolumeEntry, answer: str) -> None:
        if not extraction.found:
            self._context.toast.problem(
                tr(
                    "No grain became a particle: {border} touch the border of the volume,"
                    " {small} are too small.",
                    border=len(extraction.border),
                    small=len(extraction.small),
                )
            )
            return
        origin = VolumeSource.of(entry, extraction.particles)
        if not self._context.commands.adopt(extraction.particles, origin, answer):
            return
        summary = translate(extraction.summary)
        self._context.toast.note(summary)
        self.made.emit(summary)


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
        with self._context.toast.reporting():
            write_bytes(path, json_bytes(settings.as_document()))
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
        with self._context.toast.reporting():
            use(read(path))

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
