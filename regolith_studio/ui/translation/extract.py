"""Keeps the translation files in step with the code: ``python -m regolith_studio.ui.translation.extract``.

Qt's own ``lupdate`` does not see what stands in tables (actions, pages, sliders) or in the layers below the
window, so the messages are looked for here: texts given to ``tr``, ``tr_count`` and ``mark``, the rows of
the tables named in :data:`ROWS`, the tour, and the labels of descriptors, methods, presets and directions.
"""

import ast
import dataclasses
import json
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.weights import presets
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.parameters import GRAVITIES, ContactParameters, LiftingCylinderTest, ScriptTimes
from regolith_studio.dem.engines import CAPABILITY_LABELS, ENGINES, engine_rows
from regolith_studio.dem.evaluation.settings import EvaluationSettings
from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.resources import resource
from regolith_studio.scene import cameras, sectioning, shapes
from regolith_studio.shape_models.materials import materials
from regolith_studio.shape_models.models import MODELS
from regolith_studio.studies.sweeps import SWEEPS
from regolith_studio.ui.translation import CONTEXT
from regolith_studio.ui.translation.language import translation_file

UI = Path(__file__).parent.parent
SHIPPED = ("de",)
CALLS: Mapping[str, tuple[int, ...]] = {"tr": (0,), "mark": (0,), "tr_count": (0, 1)}
"""Which arguments of a call are messages."""
STARTS = ("Started", "StudyJob", "_load")
"""Calls that begin with the title of a task."""
ROWS: Mapping[str, Mapping[str, int]] = {
    "ActionSpec": {"menu": 0, "text": 2, "tip": 5},
    "Page": {"title": 1, "tip": 4},
}
"""Which fields of a row are messages, and where they stand without their names."""
TASKS = (
    "session/*.py",
    *(
        f"jobs/{name}.py"
        for name in (
            "coarsening",
            "fitting",
            "loading",
            "examining",
            "extracting",
            "scanning",
            "generating",
            "comparing",
        )
    ),
)
"""Modules beside the window whose titles are seen in the status bar and in the list of tasks."""
FORMS = (ContactParameters, LiftingCylinderTest, ScriptTimes, EvaluationSettings)
"""Dataclasses whose fields are edited in the window."""
SAID_BELOW = (
    "As given",
    "Chosen weights",
    "A closed mesh without faults.",
    "Being measured …",
    "Compiling",
    "Counting grey values",
    "Denoising",
    "Finding bodies",
    "Looking for the cluster",
    "Looking through the slices",
    "Numbering grains",
    "Parting touching grains",
    "Starting the workers",
    "Unpacking into a temporary file",
    "Writing the dataset",
)
"""Sentences of the layers below that are no rows of a table."""


def messages_of(source: str) -> Iterator[str]:
    """Every message of a module of the window."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call):
            name = node.func.id if isinstance(node.func, ast.Name) else ""
            given = [node.args[at] for at in CALLS.get(name, ()) if at < len(node.args)]
            fields = ROWS.get(name, {})
            given += [node.args[at] for at in fields.values() if at < len(node.args)]
            given += [each.value for each in node.keywords if each.arg in fields]
            yield from _texts(given)


def _texts(nodes: Iterable[ast.expr]) -> Iterator[str]:
    for node in nodes:
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and is_message(node.value):
            yield node.value


def is_message(text: str) -> bool:
    """Whether there is anything to translate."""
    return any(map(str.isalpha, text))


def tasks_of(source: str) -> Iterator[str]:
    """Titles of the work that a module of the session starts."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Assign) and "title" in (getattr(each, "id", "") for each in node.targets):
            yield from _texts([node.value])
        elif isinstance(node, ast.Call):
            name = getattr(node.func, "id", getattr(node.func, "attr", ""))
            yield from _texts(node.args[:1] if name in STARTS else ())


def words_below() -> Iterator[str]:
    """What tables of the layers below bring to the screen."""
    from regolith_studio.session.recompute import TITLES

    yield from SAID_BELOW
    for row in CATALOGUE.values():
        yield from (row.label, row.formula)
    yield from (method.label for method in METHODS.values())
    engines = tuple(engine.Settings for engine in ENGINES.values())
    models = tuple(model.Settings for model in MODELS.values())
    for settings in (*(method.Settings for method in METHODS.values()), *models, *engines, *FORMS):
        for each in dataclasses.fields(settings):
            yield from (
                str(each.metadata[name]) for name in ("label", "tip", "source") if each.metadata.get(name)
            )
            yield from map(str, each.metadata.get("choices", ()))
    for model in MODELS.values():
        yield from (model.label, model.summary)
    yield from (card.label for card in materials().values())
    yield from (*GRAVITIES, *CAPABILITY_LABELS.values())
    yield from (str(row[key]) for row in engine_rows() for key in CAPABILITY_LABELS)
    for exporter in EXPORTERS.values():
        yield from (*exporter.carries, *exporter.loses, exporter.units, exporter.alters)
    for variation in SWEEPS.values():
        yield from (variation.title, variation.asks)
    for preset in presets().values():
        yield from (preset.label, preset.origin)
    yield from (each.label for each in cameras.DIRECTIONS.values())
    yield from (*sectioning.DIRECTIONS.values(), *shapes.LABELS.values(), *TITLES.values())
    for stop in json.loads(resource("tour", "en.json").read_text(encoding="utf-8")):
        yield from (stop["title"], stop["text"])


def task_titles() -> dict[str, str]:
    """Titles of the work that sessions start, each with a module where it stands."""
    found: dict[str, str] = {}
    for path in (path for pattern in TASKS for path in sorted(UI.parent.glob(pattern))):
        place = path.relative_to(UI.parent).as_posix()
        found |= dict.fromkeys(tasks_of(path.read_text(encoding="utf-8")), place)
    return found


def all_messages() -> dict[str, list[str]]:
    """Every message with the modules where it stands, sorted."""
    found: dict[str, list[str]] = {}
    for path in sorted(UI.rglob("*.py")):
        for text in messages_of(path.read_text(encoding="utf-8")):
            found.setdefault(text, []).append(path.relative_to(UI.parent).as_posix())
    for text, place in task_titles().items():
        found.setdefault(text, []).append(place)
    for text in words_below():
        if is_message(text):
            found.setdefault(text, [])
    return {text: sorted(set(found[text])) for text in sorted(found)}


def ts_text(language: str, words: Mapping[str, str]) -> str:
    """A ``.ts`` file of all messages with the translations that there are; the others are unfinished."""
    root = ET.Element("TS", version="2.1", language=language, sourcelanguage="en")
    context = ET.SubElement(root, "context")
    ET.SubElement(context, "name").text = CONTEXT
    for source, places in all_messages().items():
        message = ET.SubElement(context, "message")
        for place in places:
            ET.SubElement(message, "location", filename=place)
        ET.SubElement(message, "source").text = source
        known = words.get(source, "")
        ET.SubElement(message, "translation", {} if known else {"type": "unfinished"}).text = known
    ET.indent(root, " ")
    body = ET.tostring(root, encoding="unicode", short_empty_elements=True)
    return f'<?xml version="1.0" encoding="utf-8"?>\n<!DOCTYPE TS>\n{body}\n'


def update(path: Path, language: str) -> list[str]:
    """Write the file anew, keeping its translations; returns the messages that have none."""
    from regolith_studio.ui.translation.language import read_words

    words = read_words(path) if path.exists() else {}
    path.write_text(ts_text(language, words), encoding="utf-8")
    return [each for each in all_messages() if each not in words]


if __name__ == "__main__":
    for each in SHIPPED:
        for missing in update(translation_file(each), each):
            sys.stdout.write(f"{each}: {missing!r} is not translated\n")
