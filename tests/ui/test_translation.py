"""The files of translations, and the sentences that are told anew."""

import ast
import re
import shutil
import string
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.coarsening.lower_bounds import max_sphericity, sphericity_reason
from regolith_studio.imaging.extraction import Extraction
from regolith_studio.imaging.segmentation.segment import Segmentation
from regolith_studio.imaging.segmentation.thresholding import Histogram
from regolith_studio.imaging.volume import Volume
from regolith_studio.resources import resource
from regolith_studio.ui.pages.sample.page import in_english
from regolith_studio.ui.translation import tr
from regolith_studio.ui.translation.language import (
    LANGUAGES,
    language_of,
)
from regolith_studio.ui.translation.sentences import retold
from tools.update_translations import PACKAGE, read_translations, update

TRANSLATIONS = resource("translations", "de.ts")
GERMAN = read_translations(TRANSLATIONS)
FORMATTER = string.Formatter()


def test_that_every_text_of_the_window_is_translated(tmp_path):
    path = Path(shutil.copy(TRANSLATIONS, tmp_path))
    update(path)
    found = read_translations(path)
    advice = "run python -m tools.update_translations, then translate these in resources/translations/de.ts"
    assert [text for text, translation in found.items() if not translation] == [], advice
    assert sorted(found) == sorted(GERMAN), advice


def test_that_the_compiled_translations_are_up_to_date(speaking):
    speaking("de")
    assert {text: tr(text) for text in GERMAN} == GERMAN, "run python -m tools.update_translations"


def test_that_no_text_is_translated_inside_an_f_string():
    """lupdate does not look into them."""
    for path in sorted(PACKAGE.rglob("*.py")):
        strings = [
            node for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.JoinedStr)
        ]
        calls = [node for each in strings for node in ast.walk(each) if isinstance(node, ast.Call)]
        hidden = [each for each in calls if getattr(each.func, "id", "") in ("tr", "N_")]
        assert not [each for each in hidden if isinstance(each.args[0], ast.Constant)], path


def test_that_a_translation_fills_in_what_the_source_does():
    def fields(text):
        return sorted((name, form) for _, name, form, _ in FORMATTER.parse(text) if name is not None)

    for source, german in GERMAN.items():
        assert fields(german) == fields(source), source
        assert re.findall(r"</?\w+>", german) == re.findall(r"</?\w+>", source)
        assert german.count("&") == source.count("&"), source
        assert german.endswith("…") == source.endswith("…"), source
        assert german.strip() == german


def test_that_sentences_of_the_layers_below_are_told_anew(speaking):
    speaking("de")
    reason = sphericity_reason(0.97, 10)
    assert retold(reason) == (
        f"Die Sphärizität 0.970 braucht mindestens {re.findall(r'[0-9]+', reason)[2]} Facetten;"
        f" mit 10 sind höchstens {max_sphericity(10):.3f} möglich."
    )
    off = "No polyhedron with 8 facets was found that meets all descriptors: sphericity is off by 3 %;"
    german = retold(f"{off} more facets or a weight of 0 would free it.")
    assert "8 Facetten" in german
    assert "Sphärizität weicht um 3 % ab" in german
    both = retold(f"{reason} The result has 8 facets instead of 10.")
    assert both == f"{retold(reason)} Das Ergebnis hat 8 statt 10 Facetten."
    assert retold("A closed mesh without faults.") == "Ein geschlossenes, fehlerfreies Netz."
    assert retold("Nobody has said this.") == "Nobody has said this."


def test_that_a_language_that_nobody_knows_is_english(app, speaking):
    assert set(LANGUAGES) == {"system", "en", "de"}
    assert language_of("tlh") in ("en", "de")
    assert language_of("de") == "de"
    speaking("en")
    assert tr("Ready") == "Ready"
    speaking("de")
    assert tr("Ready") == "Bereit"
    assert tr("of no file: {count}", count=3) == "of no file: 3"
    assert app.translate("elsewhere", "Ready") == "Ready"


def test_that_names_of_rows_are_told_part_by_part(speaking):
    assert retold("Overlap + size + box") == "Overlap + size + box"
    assert retold("Volume only") == "Volume only"
    speaking("de")
    assert retold("Overlap only") == "Nur Überdeckung"
    assert retold("Volume only") == "Nur Volumen"
    assert retold("Aspect ratio × 2") == "Seitenverhältnis × 2"
    assert retold("Overlap + size + sphericity") == "Überdeckung + Größe + Sphärizität"
    assert retold("12 facets") == "12 Facetten"


def test_that_a_filter_takes_the_words_that_are_read_and_the_english_ones(speaking):
    speaking("de")
    assert in_english("Klingenförmig S<0.8 fehlerfrei flat-2") == "blade S<0.8 sound flat-2"
    assert in_english("blade") == "blade"


@pytest.mark.parametrize("grains", [1, 60])
@pytest.mark.parametrize("bodies", [1, 3])
def test_that_what_was_found_in_a_scan_is_told_anew(grains, bodies, speaking):
    speaking("de")
    volume = Volume(np.ones((2, 2, 2), dtype=np.int32), (1.0,) * 3, "labels", "a")
    seen = Histogram(np.array([8]), np.array([0.0, 1.0]))
    found = Segmentation(volume, np.full(grains, 8), 103.5, seen, bodies, 2)
    counts = (
        f"{grains} {'Korn' if grains == 1 else 'Körner'} aus {bodies} zusammenhängenden"
        f" {'Körper' if bodies == 1 else 'Körpern'}"
    )
    assert retold(found.counts) == counts
    assert retold(found.summary) == f"{counts} beim Grauwert 103.5; 2 zu klein."
    made = Extraction((), (1, 2), (3,), grains).summary
    assert retold(made) == f"{grains} Partikel; weggelassen: 2 am Rand, 1 zu klein."
