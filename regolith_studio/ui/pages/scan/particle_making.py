"""What leaves the page: the file of labels, and the particles that the session adopts."""

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from regolith_studio.imaging.extraction import Extraction
from regolith_studio.imaging.label_files import LABEL_SUFFIXES
from regolith_studio.imaging.segmentation.segment import Segmentation
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.extraction_jobs import extract_labels, write_labels
from regolith_studio.jobs.extraction_settings import GrainSettings
from regolith_studio.session.batch.preprocessing import entry_of
from regolith_studio.session.provenance import VolumeSource
from regolith_studio.session.recipe import VolumeEntry
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.scan.file_dialogs import VOLUMES, ask_to_save
from regolith_studio.ui.pages.scan.opening import VolumeOpening
from regolith_studio.ui.translation import tr, translate


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
        self._context.start(tr("Saving labels"), job, written, lane="grains")

    def make_particles(self, grains: Segmentation | None, settings: GrainSettings) -> None:
        """Convert the grains, or the labels of the scan, to particles and open them.

        Parameters
        ----------
        settings
            What the grains were found with.
        """
        scan = self._opening.scan
        labels = grains.labels if grains else None
        if scan is not None and scan.volume.kind == "labels":
            labels = scan.volume
        if labels is None or scan is None:
            self._context.toast.note(tr("Find the grains first."))
            return
        entry = entry_of(self._opening.given, settings)
        grey = scan.volume if scan.volume.kind == "grey" else None
        job = Job(extract_labels, (labels, settings.extraction, self._opening.given.path, grey))
        self._context.start(
            tr("Making particles"), job, lambda found: self._adopt(found, entry), lane="grains"
        )

    def _adopt(self, extraction: Extraction, entry: VolumeEntry) -> None:
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
        if not self._context.commands.adopt(extraction.particles, origin):
            return
        summary = translate(extraction.summary)
        self._context.toast.note(summary)
        self.made.emit(summary)
