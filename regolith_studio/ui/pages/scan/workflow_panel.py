"""The three steps from a volume to particles, with their results."""

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from regolith_studio.imaging.segmentation.segment import Segmentation
from regolith_studio.imaging.volume import Volume
from regolith_studio.jobs.scan_jobs import FirstLook, Scan
from regolith_studio.messages import N_
from regolith_studio.ui.pages.scan.tools import button
from regolith_studio.ui.translation import number_text, tr, tr_count, translate
from regolith_studio.ui.widgets.labels import FixedHeightText, WrappedLabel, heading
from regolith_studio.ui.widgets.result_view import ResultRecord, ResultState, ResultView

_DENSEST, _LARGEST = 0.7, 0.4
"""Plausible limits of the volume fraction of all grains, and of a single grain."""


class WorkflowPanel(QWidget):
    """A button for each step, enabled when its input is available."""

    openRequested = Signal()  # noqa: N815
    sampleRequested = Signal()  # noqa: N815
    labelsRequested = Signal()  # noqa: N815
    particlesRequested = Signal()  # noqa: N815
    showRequested = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("scan_steps")
        self.browse = button(
            "scan_open", tr("Open volume …"), tr("Open a CT volume of grey values or labels")
        )
        self.sample = button(
            "scan_sample", tr("Sample scan"), tr("Open the scan that ships with the program")
        )
        captions = (tr("Grains"), tr("Share of the volume"))
        self.card = ResultView("scan_grains", captions, tr("Find all grains"), tr("Find again"))
        self.search, self.found = self.card.button, self.card.sentence
        self.save = button(
            "scan_save_labels",
            tr("Save labels …"),
            tr("Write the volume of labels and a table of them for other programs"),
        )
        self.convert = button(
            "scan_make", tr("Make particles"), tr("Contour each grain and open it as a particle")
        )
        self.show_them = button("scan_show", tr("Show particles"), tr("Go to the table of particles"))
        self.volume, self.made = _words(), _words()
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        kept = self.show_them.sizePolicy()
        kept.setRetainSizeWhenHidden(True)  # the button beside it stays as wide
        self.show_them.setSizePolicy(kept)
        for title, buttons, result in (
            (tr("1  Volume"), (self.browse, self.sample), FixedHeightText((self.volume,))),
            (tr("2  Grains"), (self.save,), self.card),
            (tr("3  Particles"), (self.convert, self.show_them), FixedHeightText((self.made,))),
        ):
            layout.addWidget(heading(title))
            row = QHBoxLayout()
            for each in buttons:
                row.addWidget(each)
            if result is self.card:
                layout.addWidget(result)
                layout.addLayout(row)
            else:
                layout.addLayout(row)
                layout.addWidget(result)
        self.browse.clicked.connect(self.openRequested)
        self.sample.clicked.connect(self.sampleRequested)
        self.save.clicked.connect(self.labelsRequested)
        self.convert.clicked.connect(self.particlesRequested)
        self.show_them.clicked.connect(self.showRequested)

    def show_state(
        self,
        scan: Scan | None,
        preview: Segmentation | None,
        grains: Segmentation | None,
        least: int,
        searching: bool = False,
    ) -> None:
        """Describe the volume and the grains, and how many have fewer than `least` voxels.

        `searching` says that a preview is being computed.
        """
        is_grey = scan is not None and scan.volume.kind == "grey"
        self.card.set_startable("" if is_grey else tr("Open a volume of grey values first."))
        self.save.setEnabled(grains is not None)
        self.convert.setEnabled(grains is not None or (scan is not None and not is_grey))
        self.show_them.hide()
        outside = "" if scan is None or scan.outside is None else translate(scan.outside.hint_label)
        self.volume.setText(
            _sentences(_about(scan.volume.name, scan.volume), outside) if scan else tr("No volume is open.")
        )
        self.made.setText("")
        if self.card.record.state not in (ResultState.RUNNING, ResultState.FAILED):
            self.card.show_record(_record(scan, preview, grains, least, searching))

    def show_first(self, first: FirstLook) -> None:
        """Describe a volume of which a coarse picture is shown until it has been read."""
        self.volume.setText(_about(first.scan.volume.name, first))
        note = tr("The picture is coarse until all of the volume has been read.")
        self.card.show_record(ResultRecord(note=note))

    def set_particles(self, summary: str) -> None:
        """Show the result of the extraction."""
        self.made.setText(summary)
        self.show_them.show()


def _record(
    scan: Scan | None, preview: Segmentation | None, grains: Segmentation | None, least: int, searching: bool
) -> ResultRecord:
    """All grains, or what the preview says of those in its frame."""
    if scan is None:
        return ResultRecord()
    if scan.volume.kind == "labels":
        return ResultRecord(note=tr("The volume holds labels: its grains have been found already."))
    if grains is not None:
        share = float(grains.sizes.sum()) / grains.labels.array.size
        values = (number_text(grains.n_grains, ","), number_text(share, ".1%"))
        note = _sentences(translate(grains.summary), *_doubts(grains, least))
        return ResultRecord(values, scan.volume.name, state=ResultState.CURRENT, note=note)
    if preview is not None:
        found = tr("In the frame: {counts}.", counts=translate(preview.counts))
        hint = tr("Click into a slice to move the frame.")
        return ResultRecord(note=_sentences(found, *_doubts(preview, least), hint))
    if searching:
        return ResultRecord(note=tr("Searching …"))
    return ResultRecord(
        note=tr("No grain in the frame so far. Move the level, or click into a slice to move the frame.")
    )


def _sentences(*parts: str) -> str:
    return " ".join(filter(None, parts))


def _doubts(found: Segmentation, least: int) -> tuple[str, str]:
    return _too_small(found, least), _too_large(found)


def _too_small(found: Segmentation, least: int) -> str:
    count = int((found.sizes < least).sum())
    if not count:
        return ""
    return tr_count(
        N_("{count} of them has fewer than {least} voxels and will be left out."),
        N_("{count} of them have fewer than {least} voxels and will be left out."),
        count,
        least=least,
    )


def _too_large(found: Segmentation) -> str:
    """Advice if one grain has most of the volume or the volume fraction is implausible."""
    voxels = found.labels.array.size
    if found.sizes.sum() < _DENSEST * voxels and found.sizes.max() < _LARGEST * voxels:
        return ""
    return tr(
        "Grains fill most of the frame and are connected. Tick “Grains are dark” if they are darker than "
        "what is between them; otherwise change the level or reduce h."
    )


def _about(name: str, volume: Volume | FirstLook) -> str:
    edges = " × ".join(map(str, volume.shape))
    size = volume.voxel_size
    voxel = " × ".join(number_text(edge, "g") for edge in (size[:1] if (size == size[0]).all() else size))
    return tr(
        "{name}: {edges} voxels of {voxel}, {what} ({dtype}).",
        name=name,
        edges=edges,
        voxel=f"{voxel} µm",
        what=tr("labels") if volume.kind == "labels" else tr("grey values"),
        dtype=volume.dtype,
    )


def _words() -> WrappedLabel:
    """A label for the result of a step, with all lines visible."""
    label = WrappedLabel()
    label.setProperty("role", "hint")
    return label
