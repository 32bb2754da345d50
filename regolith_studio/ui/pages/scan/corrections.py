"""Painted examples, object step and corrections by hand: undo, and the grains that follow."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QColor

from regolith_studio.imaging.segmentation.label_edits import LabelEdit, Voxel
from regolith_studio.imaging.segmentation.object_classifier import (
    OBJECT_ACTIONS,
    ObjectAction,
    ObjectTable,
    ObjectTraining,
)
from regolith_studio.imaging.segmentation.pixel_classifier import ClassifierSettings, TrainingSet
from regolith_studio.imaging.segmentation.segment import Segmentation, SegmentationSettings
from regolith_studio.imaging.segmentation.strokes import ERASER, Stroke, draw_stroke, painted_rows
from regolith_studio.imaging.volume import Volume
from regolith_studio.jobs.classifier_jobs import (
    ClassifiedObjects,
    TrainedStrokes,
    Vectors,
    classify_grains,
    correct_grains,
    describe_grains,
    predict_slices,
    read_strokes,
    save_training,
    train_on_strokes,
)
from regolith_studio.jobs.events import Failed, Job
from regolith_studio.jobs.extraction_settings import VolumeInput
from regolith_studio.jobs.scan_jobs import GrainSegmentation
from regolith_studio.readers.volumes.region import RegionSettings
from regolith_studio.session.history import History
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.scan.slices import SlicesView
from regolith_studio.ui.pages.scan.tools import (
    BRUSHED,
    CLASSES,
    NO_TOOL,
    OBJECT_COLOURS,
    Brush,
    BrushPanel,
    EditsPanel,
    ObjectsPanel,
)
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
        panel.paint.toggled.connect(self._set_painting)
        panel.overlay.currentIndexChanged.connect(lambda: slices.set_overlay(panel.overlay.value()))
        panel.featuresChanged.connect(self._retrain)
        panel.undo.clicked.connect(self.undo)
        panel.clear.clicked.connect(lambda: self._push(()))
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
            job = Job(save_training, (path, self.training, scan))
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


_OPACITY, _EXAMPLE_OPACITY = 90, 190
_SAMPLES = 200
_BESIDE = [*np.eye(3, dtype=np.int64), *-np.eye(3, dtype=np.int64)]
"""Places along a line at which grains are looked up, and the steps to both sides of it."""
_CUT = Brush(ERASER, 1.0, "line")
_CLICKS = {"merge": 2, "delete": 1, "seeds": 2, "fill": 1}


@dataclass(frozen=True)
class CorrectionState:
    """What a step of undo takes back.

    - ``examples``: voxels in marked objects, and their classes.
    - ``loaded``: an object classifier from a file or a recipe, used while nothing is marked.
    - ``actions``: what is done with each class.
    - ``applied``: whether the object step is part of the segmentation.
    - ``edits``: corrections by hand.
    """

    examples: tuple[tuple[Voxel, int], ...] = ()
    loaded: ObjectTraining | None = None
    actions: tuple[ObjectAction, ...] = OBJECT_ACTIONS
    applied: bool = False
    edits: tuple[LabelEdit, ...] = ()


class Corrections(QObject):
    """Connects both panels, the slices and the jobs that describe, classify and correct."""

    changed = Signal()
    """Other grains, or none while they are being corrected."""

    def __init__(
        self,
        context: PageContext,
        objects: ObjectsPanel,
        edits: EditsPanel,
        slices: SlicesView,
        parent: QObject,
    ) -> None:
        super().__init__(parent)
        self._context, self._objects, self._edits, self._slices = context, objects, edits, slices
        self.history: History[CorrectionState] = History(CorrectionState())
        self._clicks: tuple[Voxel, ...] = ()
        self._repaired: LabelEdit | None = None
        self._grey: Volume | None = None
        self._base: GrainSegmentation | None = None
        self._found_with = SegmentationSettings()
        self._corrected: GrainSegmentation | None = None
        self._table: ObjectTable | None = None
        self.classified: ClassifiedObjects | None = None
        self._connect()

    @property
    def state(self) -> CorrectionState:
        return self.history.value

    @property
    def grains(self) -> Segmentation | None:
        """The corrected grains; ``None`` where there are none yet."""
        return self._corrected.segmentation if self._corrected is not None else None

    def added_to(self, settings: SegmentationSettings) -> SegmentationSettings:
        """Settings with the object step and the edits."""
        state = self.state
        training = self._training() if state.applied else None
        return replace(settings, objects=training, edits=state.edits)

    def take_from(self, settings: SegmentationSettings) -> None:
        """Begin with the object step and the edits of a recipe."""
        objects = settings.objects
        self.history.restart(
            CorrectionState(
                (),
                objects,
                objects.actions if objects else OBJECT_ACTIONS,
                objects is not None,
                settings.edits,
            )
        )
        self.classified = None
        self._refresh()

    def forget(self) -> None:
        """Begin again with nothing, for another volume."""
        self.discard()
        self.classified = None
        self.history.restart(CorrectionState())
        self._refresh()

    def begin(self, grey: Volume, base: GrainSegmentation, settings: SegmentationSettings) -> None:
        """Correct the grains that were found with `settings`, which hold neither objects nor edits."""
        self.discard()
        self._grey, self._base, self._found_with = grey, base, settings
        self._refresh()

    def discard(self) -> None:
        """Forget the grains, but neither examples nor edits."""
        for queue in ("describe", "classify", "correct"):
            self._context.stop(queue)
        self._close_corrected()
        if self._base is not None:
            self._base.scratch.close()
        self._grey = self._base = self._table = None
        self._clicks = ()
        self._objects.mark.setChecked(False)
        self._edits.tools[NO_TOOL].setChecked(True)
        self._show_panels()

    def stop_tools(self) -> None:
        """Let clicks show slices again."""
        self._objects.mark.setChecked(False)
        self._edits.tools[NO_TOOL].setChecked(True)

    def undo(self) -> None:
        self._clicks, self._repaired = (), None
        self._edits.show_hint()
        self.history.undo()
        self._refresh()

    def redo(self) -> None:
        self._repaired = None
        self.history.redo()
        self._refresh()

    def load(self, training: ObjectTraining) -> None:
        self._push(replace(self.state, examples=(), loaded=training, actions=training.actions, applied=True))

    def save(self, path: Path, scan: Path, done: Callable[[Path], None]) -> None:
        """Write the object classifier, and call `done` with its path."""
        training = self._training()
        if training is not None:
            job = Job(save_training, (path, training, scan))
            self._context.start(tr("Saving the classifier"), job, done, queue="classifier")

    # --- steps ---------------------------------------------------------------------------------

    def _training(self) -> ObjectTraining | None:
        if self.state.examples:
            return self.classified.training if self.classified is not None else None
        loaded = self.state.loaded
        return replace(loaded, actions=self.state.actions) if loaded is not None else None

    def _push(self, state: CorrectionState) -> None:
        self._repaired = None
        self.history.push(state)
        self._refresh()

    def _refresh(self) -> None:
        """Bring classes and grains up to the state."""
        self._show_panels()
        if self._base is None or self._grey is None:
            return
        self._context.stop("correct")
        self._close_corrected()
        self.changed.emit()
        needs_table = self._objects.mark.isChecked() or self.state.examples or self.state.applied
        if needs_table and self._table is None:
            job = Job(describe_grains, (self._grey, self._base.segmentation))
            self._context.start(tr("Describing objects"), job, self._take_table, queue="describe")
        elif self.state.examples and self._table is not None:
            labels = self._base.segmentation.labels
            job = Job(classify_grains, (self._table, labels, self.state.examples, self.state.actions))
            self._context.start(tr("Classifying objects"), job, self._take_classes, queue="classify")
        else:
            self.classified = None
            self._correct()

    def _take_table(self, table: ObjectTable) -> None:
        self._table = table
        self._refresh()

    def _take_classes(self, found: ClassifiedObjects) -> None:
        self.classified = found
        self._correct()

    def _correct(self) -> None:
        """Apply object step and edits in the background, if there are some."""
        assert self._base is not None
        self._show_panels()
        settings = self.added_to(self._found_with)
        if settings.objects is None and not settings.edits:
            self._corrected = self._base
            self._show()
            return
        job = Job(correct_grains, (self._grey, self._base.segmentation, settings, self._table))
        self._context.start(
            tr("Correcting labels"), job, self._take_corrected, failed=self._on_failed, queue="correct"
        )

    def _take_corrected(self, made: GrainSegmentation) -> None:
        self._corrected = made
        self._show()

    def _on_failed(self, failure: Failed) -> None:
        """Say what cannot be done, and go back to where it could."""
        self._context.toast.problem(failure.sentence)
        if self.history.can_undo:
            self.undo()
        else:
            self._push(replace(self.state, applied=False, edits=()))

    def _close_corrected(self) -> None:
        if self._corrected is not None and self._corrected is not self._base:
            self._corrected.scratch.close()
        self._corrected = None

    # --- the mouse -----------------------------------------------------------------------------

    def _on_click(self, x: int, y: int, z: int, axis: int) -> None:
        if self._base is None:
            return
        place = (x, y, z)
        if self._objects.mark.isChecked():
            if self._base.segmentation.labels.array[place] > 0:
                kind = self._objects.kind.value()
                others = tuple(each for each in self.state.examples if not self._same_object(each[0], place))
                self._push(replace(self.state, examples=(*others, (place, kind))))
        elif (needed := _CLICKS.get(self._edits.tool)) is not None and self.grains is not None:
            if self.grains.labels.array[place] <= 0:
                return
            self._clicks = (*self._clicks, place)
            if len(self._clicks) == needed:
                clicks, self._clicks = self._clicks, ()
                self._edits.show_hint()
                self._edit(self._edits.tool, clicks, axis)
            else:
                self._edits.show_hint(tr("Now click the second place."))
                self._slices.highlight({int(self.grains.labels.array[place])})

    def _same_object(self, one: Voxel, other: Voxel) -> bool:
        assert self._base is not None
        labels = self._base.segmentation.labels.array
        return bool(labels[one] == labels[other])

    def _on_line(self, axis: int, number: int, points: NDArray[np.float64]) -> None:
        tool = self._edits.tool
        if tool not in ("cut", *BRUSHED) or self.grains is None:
            return
        places = np.full((len(points), 3), number, dtype=np.int64)
        places[:, [k for k in range(3) if k != axis]] = np.floor(points)
        if tool in BRUSHED:
            inside = ((places >= 0) & (places < self.grains.labels.shape)).all(axis=1)
            places = places[inside]
        else:
            places = places[[0, -1]]
        corners = [(x, y, z) for x, y, z in places.tolist()]
        if corners:
            kept = corners[:1] + [b for a, b in pairwise(corners) if a != b]
            self._edit(tool, tuple(kept), axis, self._edits.diameter.value() / 2)

    def _edit(self, kind: str, points: tuple[Voxel, ...], axis: int = 2, radius: float = 0.5) -> None:
        radius = radius if kind in BRUSHED else 0.5
        with self._context.toast.reporting():
            edit = LabelEdit(kind, points, axis, radius)  # type: ignore[arg-type]  # one of the tools
            self._push(replace(self.state, edits=(*self.state.edits, edit)))
            self._repaired = edit

    def _set_tool(self, kind: str) -> None:
        self._clicks = ()
        if kind:
            self._objects.mark.setChecked(False)
        self._slices.highlight(set())
        self._slices.set_line_tool(self._brush if kind in ("cut", *BRUSHED) else None)

    def _brush(self) -> Brush:
        """What the mouse draws with the tool."""
        tool = self._edits.tool
        if tool not in BRUSHED:
            return _CUT
        return Brush(ERASER if tool == "erase" else 1, float(self._edits.diameter.value()))

    def _set_marking(self, on: bool) -> None:
        if on:
            self._edits.tools[NO_TOOL].setChecked(True)
        if self._base is not None:
            if on and self._table is None:
                self._refresh()
            elif self.grains is not None:
                self._show()

    # --- what is shown -------------------------------------------------------------------------

    def _show(self) -> None:
        """The classes of the objects while examples are marked, else the corrected grains."""
        if self._base is None or self._corrected is None:
            return
        if self._objects.mark.isChecked():
            self._slices.show_segmentation(self._base.segmentation, self._base.sections, self._colours())
        else:
            self._slices.show_segmentation(self._corrected.segmentation, self._corrected.sections)
        self._slices.highlight(self._repaired_labels())
        self._show_panels()
        self.changed.emit()

    def _repaired_labels(self) -> set[int]:
        """Labels of the grains along the line of the last correction, and at its points."""
        if self._repaired is None or self._corrected is None:
            return set()
        labels = self._corrected.segmentation.labels.array
        points = np.array(self._repaired.points)
        if self._repaired.kind == "cut":
            line = np.rint(np.linspace(points[0], points[-1], _SAMPLES)).astype(np.int64)
            points = np.concatenate([line + step for step in _BESIDE])
        inside = points[((points >= 0) & (points < labels.shape)).all(axis=1)]
        return set(labels[tuple(inside.T)].tolist()) - {0}

    def _colours(self) -> NDArray[np.uint8]:
        """A colour for each label: grey without a class, more opaque for examples."""
        assert self._base is not None
        labels = self._base.segmentation.labels.array
        highest = int(self._table.table.labels[-1]) if self._table is not None else 0
        table = np.full((highest + 1, 4), (150, 150, 150, _OPACITY), dtype=np.uint8)
        table[0] = 0
        colours = np.array([QColor(each).getRgb() for each in OBJECT_COLOURS], dtype=np.uint8)
        if self.classified is not None and self.classified.training is not None and self._table is not None:
            table[self._table.table.labels] = colours[self.classified.kinds]
            table[1:, 3] = _OPACITY
        for place, kind in self.state.examples:
            table[int(labels[place])] = colours[kind]
            table[int(labels[place]), 3] = _EXAMPLE_OPACITY
        return table

    def _show_panels(self) -> None:
        found, state = self._base is not None, self.state
        trained = self._training() is not None
        self._objects.set_state(
            found=found, trained=trained, applied=state.applied, can_undo=self.history.can_undo
        )
        self._objects.set_actions(state.actions)
        classified = self.classified
        known = classified is not None and classified.training is not None and self._table is not None
        counts = classified.counts() if known and classified is not None else {}
        self._objects.set_counts(counts, translate(classified.missing) if classified is not None else "")
        self._edits.set_state(found=found, can_undo=self.history.can_undo, can_redo=self.history.can_redo)
        self._edits.set_edits(state.edits)

    def _connect(self) -> None:
        self._slices.picked.connect(self._on_click)
        self._slices.strokeDrawn.connect(self._on_line)
        self._objects.mark.toggled.connect(self._set_marking)
        for box in self._objects.action_boxes:
            box.currentIndexChanged.connect(
                lambda: self._push(replace(self.state, actions=self._objects.action_of_each()))
            )
        self._objects.apply.toggled.connect(lambda on: self._push(replace(self.state, applied=on)))
        self._objects.clear.clicked.connect(
            lambda: self._push(replace(self.state, examples=(), loaded=None, applied=False))
        )
        for panel in (self._objects, self._edits):
            panel.undo.clicked.connect(self.undo)
        self._edits.redo.clicked.connect(self.redo)
        self._edits.toolChanged.connect(self._set_tool)
