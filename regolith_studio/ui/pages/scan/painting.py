"""Painting of examples: strokes with undo, and the classifier that is trained and shown after each."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from PySide6.QtCore import QObject, Signal

from regolith_studio.imaging.segmentation.pixel_classifier import ClassifierSettings, TrainingSet
from regolith_studio.imaging.segmentation.strokes import Stroke, draw_stroke, painted_rows
from regolith_studio.imaging.volume import Volume
from regolith_studio.jobs.classifier_jobs import (
    TrainedStrokes,
    Vectors,
    predict_slices,
    read_strokes,
    save_classifier,
    train_on_strokes,
)
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.extraction_settings import VolumeInput
from regolith_studio.readers.volumes.region import RegionSettings
from regolith_studio.session.history import History
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.scan.slices import SlicesView
from regolith_studio.ui.pages.scan.tools import CLASSES, BrushPanel
from regolith_studio.ui.translation import tr, translate

Strokes = tuple[Stroke, ...]


class Painting(QObject):
    """Connects the brush, the slices and the jobs that train and predict."""

    trained = Signal(object)
    """The training set after a stroke, or ``None``."""

    def __init__(self, context: PageContext, panel: BrushPanel, slices: SlicesView, parent: QObject) -> None:
        super().__init__(parent)
        self._context, self._panel, self._slices = context, panel, slices
        self.history: History[Strokes] = History(())
        self._volume: Volume | None = None
        self._vectors: Vectors = {}
        self.training: TrainingSet | None = None
        panel.paintingChanged.connect(self._set_painting)
        panel.overlayChanged.connect(slices.set_overlay)
        panel.featuresChanged.connect(self._retrain)
        panel.undoRequested.connect(self.undo)
        panel.clearRequested.connect(lambda: self._push(()))
        slices.strokeDrawn.connect(self._add)
        slices.moved.connect(self._predict)

    @property
    def strokes(self) -> Strokes:
        return self.history.value

    def set_volume(self, volume: Volume | None) -> None:
        """Begin again on another volume of grey values, or with nothing on labels or without a volume."""
        self.history.restart(())
        self._volume = volume if volume is not None and volume.kind == "grey" else None
        self._vectors, self.training = {}, None
        self._panel.setEnabled(self._volume is not None)
        self._panel.paint.setChecked(False)
        self._show()

    def undo(self) -> None:
        self.history.undo()
        self._learn()

    def redo(self) -> None:
        self.history.redo()
        self._learn()

    def read_labels(self, path: Path, region: RegionSettings) -> None:
        """Add what is painted in a volume of labels to the strokes."""
        if self._volume is None:
            return
        given = VolumeInput(path, tuple(self._volume.voxel_size.tolist()), kind="labels")
        job = Job(read_strokes, (given, self._volume, len(CLASSES), region))
        self._context.start(
            tr("Reading labels"), job, lambda found: self._push((*self.strokes, *found)), queue="labels"
        )

    def save(self, path: Path, scan: Path, done: Callable[[Path], None]) -> None:
        """Write the classifier, and call `done` with its path."""
        if self.training is not None:
            job = Job(save_classifier, (path, self.training, scan))
            self._context.start(tr("Saving the classifier"), job, done, queue="classifier")

    def stop(self) -> None:
        self._context.stop("labels")
        self._context.stop("train")
        self._context.stop("predict")

    def _set_painting(self, painting: bool) -> None:
        self._slices.set_painting(self._panel if painting else None)
        self._predict()

    def _add(self, axis: int, number: int, points: object) -> None:
        if self._volume is None or not self._panel.paint.isChecked():
            return
        brush = self._panel.brush
        corners = np.asarray(points, dtype=np.float64)
        stroke = draw_stroke(axis, number, corners, brush.diameter / 2, self._volume.shape, brush.label)
        if len(stroke.positions):
            self._push((*self.strokes, stroke))

    def _push(self, strokes: Strokes) -> None:
        self.history.push(strokes)
        self._learn()

    def _retrain(self) -> None:
        """Train again on the same strokes with other features."""
        self._vectors = {}
        if self.strokes:
            self._learn()

    def _learn(self) -> None:
        """Train on the strokes in the background, then predict what is seen."""
        if self._volume is None:
            return
        self._slices.show_strokes(*painted_rows(self.strokes)[:2])
        self._context.stop("predict")
        settings = ClassifierSettings(self._panel.features)
        arguments = (self._volume, self.strokes, self._vectors, CLASSES, settings)
        self._context.start(tr("Training"), Job(train_on_strokes, arguments), self._take, queue="train")
        self._show_panel("")

    def _take(self, found: TrainedStrokes) -> None:
        self._vectors, self.training = found.vectors, found.training
        if found.training is None:
            self._slices.clear_predictions()
        self._show_panel(translate(found.missing))
        self.trained.emit(found.training)
        self._predict()

    def _predict(self) -> None:
        """Predict the visible slices while painting."""
        if self._volume is None or self.training is None or not self._panel.paint.isChecked():
            return
        job = Job(predict_slices, (self._volume, self._slices.position, self.training))
        show = self._slices.show_predictions
        self._context.start(tr("Predicting"), job, show, partial=show, queue="predict", repeats=True)

    def _show(self) -> None:
        self._slices.show_strokes(*painted_rows(self.strokes)[:2])
        self._slices.clear_predictions()
        self._show_panel("")

    def _show_panel(self, missing: str) -> None:
        self._panel.set_state(len(self.strokes), missing, trained=self.training is not None)
