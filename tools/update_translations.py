"""Keep the translations in step with the code: ``python -m tools.update_translations``.

Runs lupdate over the package, so that ``resources/translations/*.ts`` hold all texts, and lrelease, which
makes the ``*.qm`` files of the window. lupdate reads Python, but neither JSON nor keys of tables; those
texts are written into a temporary Python file that it reads too.
"""

import dataclasses
import json
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.weights import presets
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dem.engines import ENGINES
from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.resources import resource
from regolith_studio.shape_models.materials import materials
from regolith_studio.shape_models.models import MODELS

PACKAGE = Path(__file__).parent.parent / "regolith_studio"
TRANSLATIONS = Path(__file__).parent.parent / "resources" / "translations"
ALIASES = "QT_TR_NOOP+=N_"


def table_texts() -> Iterator[str]:
    """Texts of the window that stand in JSON files, and keys of tables that are shown as they are."""
    for stop in json.loads(resource("tour", "en.json").read_text(encoding="utf-8")):
        yield from (stop["title"], stop["text"])
    for preset in presets().values():
        yield from (preset.label, preset.origin)
    for card in materials().values():
        yield from (card.label, card.origin)
    yield from (row.formula for row in CATALOGUE.values())
    yield from (exporter.label for exporter in EXPORTERS.values())
    kinds: tuple[Any, ...] = (*METHODS.values(), *MODELS.values(), *ENGINES.values())
    for kind in kinds:
        for field in dataclasses.fields(kind.Settings):
            yield from map(str, field.metadata.get("choices", ()))


def update(path: Path) -> None:
    """Bring a ``.ts`` file up to date; texts that are gone are dropped, new ones are unfinished."""
    with tempfile.TemporaryDirectory() as folder:
        extra = Path(folder) / "tables.py"
        texts = sorted({text for text in table_texts() if any(map(str.isalpha, text))})
        extra.write_text("".join(f"N_({json.dumps(each, ensure_ascii=False)})\n" for each in texts), "utf-8")
        options = ["-extensions", "py", "-locations", "none", "-no-obsolete", "-sort-messages", "-silent"]
        options += ["-disable-heuristic", "sametext", "-disable-heuristic", "similartext"]
        sources = [str(PACKAGE), str(extra)]
        _run("pyside6-lupdate", *options, "-tr-function-alias", ALIASES, *sources, "-ts", str(path))


def release(path: Path) -> Path:
    """Compile a ``.ts`` file; returns the ``.qm`` file beside it."""
    _run("pyside6-lrelease", "-silent", str(path), "-qm", str(path.with_suffix(".qm")))
    return path.with_suffix(".qm")


def read_translations(path: Path) -> dict[str, str]:
    """Texts of a ``.ts`` file with their translations, empty where one is unfinished."""
    found = {}
    for message in ET.parse(path).getroot().iter("message"):
        translation = message.find("translation")
        done = translation is not None and translation.get("type") is None
        found[message.findtext("source", "")] = (
            (translation.text or "") if done and translation is not None else ""
        )
    return found


def _run(program: str, *arguments: str) -> None:
    subprocess.run([str(Path(sys.executable).parent / program), *arguments], check=True)


def main() -> None:
    """Update and compile all languages, and list what is not translated."""
    for path in sorted(TRANSLATIONS.glob("*.ts")):
        update(path)
        release(path)
        for text, translation in read_translations(path).items():
            if not translation:
                sys.stdout.write(f"{path.name}: {text!r} is not translated\n")


if __name__ == "__main__":
    main()
