"""Saving a model or a material card."""

import re
from functools import partial
from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QWidget

from regolith_studio.errors import RegolithError
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.model_jobs import make_card
from regolith_studio.messages import N_, Message
from regolith_studio.readers.shape_files import ShapeSource
from regolith_studio.shape_models.io import write_model
from regolith_studio.shape_models.materials import MaterialCard, write_card
from regolith_studio.shape_models.protocol import FittedModel
from regolith_studio.shape_models.sample import Sample
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.toast import Toast

MODELS, CARDS = N_("Models (*.json)"), N_("Cards (*.json)")


def save_model(parent: QWidget, toast: Toast, model: FittedModel, source: ShapeSource) -> None:
    """Ask for a name and write the model."""
    name, _ = QFileDialog.getSaveFileName(parent, tr("Save the model"), "model.json", tr(MODELS))
    if not name:
        return
    path = _json_path(name)
    try:
        write_model(path, model, {"source": source.name, "sha256": source.sha256 or None})
    except RegolithError as error:
        toast.problem(str(error))
        return
    toast.note(tr("Saved {name}.", name=path.name))


def save_card(parent: QWidget, context: PageContext, sample: Sample, source: ShapeSource) -> None:
    """Ask for a name and write the card of a sample; the file's name becomes that of the material."""
    name, _ = QFileDialog.getSaveFileName(parent, tr("Save a material card"), "material.json", tr(CARDS))
    if not name:
        return
    path = _json_path(name)
    key = re.sub(r"[^a-z0-9_]+", "_", path.stem.lower()).strip("_") or "material"
    template = N_("Statistics of {count} particles of {name}, made by Regolith Studio.")
    origin = Message(template, count=len(sample), name=source.name)
    job = Job(make_card, (sample, key, path.stem, origin))
    context.start(tr("Making a material card"), job, partial(_write_card, context.toast, path), lane="card")


def _json_path(name: str) -> Path:
    """The path of a name that the user may have typed without its suffix."""
    return Path(name if name.endswith(".json") else f"{name}.json")


def _write_card(toast: Toast, path: Path, card: MaterialCard) -> None:
    try:
        write_card(card, path)
    except (RegolithError, OSError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        toast.problem(tr("The card {name} cannot be written ({reason}).", name=path.name, reason=reason))
        return
    toast.note(tr("Saved {name}.", name=path.name))
