"""The files of translations, and the sentences that are told anew."""

import ast
import re
import shutil
import string
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from regolith_studio.coarsening.lower_bounds import max_sphericity, sphericity_reason
from regolith_studio.coarsening.reasons import MISSED, MISSED_BY, NAMES
from regolith_studio.errors import InputError
from regolith_studio.messages import Message, join_messages
from regolith_studio.resources import resource
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.models.hull_field import HullField
from regolith_studio.shape_models.sample import Sample
from regolith_studio.studies.loss_variants import losses
from regolith_studio.ui.pages.sample.page import in_english
from regolith_studio.ui.translation import LANGUAGES, language_of, tr, translate
from tools.update_translations import PACKAGE, read_translations, update

TRANSLATIONS = resource("translations", "de.ts")
GERMAN = read_translations(TRANSLATIONS)
FORMATTER = string.Formatter()


@pytest.fixture(scope="module")
def parsed():
    """The syntax tree of each module, by its path."""
    return {path: ast.parse(path.read_text("utf-8")) for path in sorted(PACKAGE.rglob("*.py"))}


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


def test_that_no_text_is_translated_inside_an_f_string(parsed):
    """lupdate does not look into them."""
    for path, tree in parsed.items():
        strings = [node for node in ast.walk(tree) if isinstance(node, ast.JoinedStr)]
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


def test_that_messages_of_the_layers_below_are_translated(speaking):
    speaking("de")
    reason = sphericity_reason(0.97, 10)
    assert translate(reason) == (
        f"Die Sphärizität 0,970 braucht mindestens {re.findall(r'[0-9]+', reason)[2]} Facetten;"
        f" mit 10 sind höchstens {max_sphericity(10):.3f}".replace(".", ",")
        + " möglich."
    )
    by = Message(MISSED_BY, name=Message(NAMES["sphericity"]), error="3")
    missed = Message(MISSED, faces=8, missed=by)
    assert "8 Facetten" in translate(missed)
    assert "Sphärizität um 3 %" in translate(missed)
    fewer = Message("The result has {real} facets instead of {faces}.", real=8, faces=10)
    both = translate(join_messages([reason, fewer]))
    assert both == f"{translate(reason)} Das Ergebnis hat 8 statt 10 Facetten."
    assert translate("A closed mesh without faults.") == "Ein geschlossenes, fehlerfreies Netz."
    assert translate("Nobody has said this.") == "Nobody has said this."


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


def test_that_labels_of_losses_are_translated_with_their_parts(speaking):
    speaking("de")
    assert losses()["only_volume"].label == "Volume only"
    assert translate(losses()["only_volume"].label) == "Nur Volumen"
    label = Message("{name} × {factor}", name=Message("Aspect ratio"), factor="2")
    assert translate(label) == "Seitenverhältnis × 2"
    parts = join_messages([Message(each) for each in ("Overlap", "size", "sphericity")], " + ")
    assert parts == "Overlap + size + sphericity"
    assert translate(parts) == "Überdeckung + Größe + Sphärizität"


@pytest.mark.parametrize("l_max", [0, 2])
def test_that_a_model_that_refuses_a_degree_does_so_in_german(l_max, speaking):
    """So are all sentences that the forms of the window let through."""
    radii = np.random.default_rng(0).normal(0.0, 0.02, (12, (l_max + 1) ** 2))
    radii[:, 0] = np.linspace(50.0, 200.0, 12)
    sample = Sample(radii, tuple("abcdefghijkl"))
    speaking("de")
    said = [
        sentence
        for model in MODELS.values()
        if (sentence := _refusal(partial(model.fit, sample, model.Settings(l_max=l_max))))
    ]
    said.append(_refusal(partial(sample.truncated, 5)))
    for fine in (None, range(5)):
        said.append(_refusal(partial(HullField.truncated, _drawn(fine), 31)))
    assert len(said) == {0: 4, 2: 1}[l_max] + 3
    for sentence in said:
        assert translate(sentence) != sentence


def _drawn(fine):
    """As much of a hull field up to degree 8 as is asked for its degrees."""
    return SimpleNamespace(_base=8 - len(fine or ()), l_max=8, fine=fine)


def _refusal(act):
    try:
        act()
    except InputError as error:
        return error.args[0]
    return ""


def test_that_a_filter_takes_the_words_that_are_read_and_the_english_ones(speaking):
    speaking("de")
    assert in_english("Klingenförmig S<0.8 fehlerfrei flat-2") == "blade S<0.8 sound flat-2"
    assert in_english("blade") == "blade"


def _literal(node: ast.expr) -> str | None:
    """The text of a string, or of a string marked for translation."""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "N_":
        node = node.args[0]
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None


def _mismatches(path: Path, tree: ast.Module) -> list[str]:
    """Calls whose keywords are not the placeholders of their template."""
    found = []
    for call in ast.walk(tree):
        name = call.func.id if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) else ""
        if name not in ("tr", "tr_count", "Message", "count_message"):
            continue
        counts = name in ("tr_count", "count_message")
        templates = [_literal(each) for each in call.args[: 2 if counts else 1]]
        keywords = {each.arg for each in call.keywords}
        if None in keywords or None in templates:
            continue  # values or templates that are only known when the program runs
        needed = {name for each in templates for _, name, _, _ in string.Formatter().parse(each) if name}
        given = keywords | ({"count"} if counts else set())
        if needed - given or keywords - needed:
            found.append(f"{path.relative_to(PACKAGE)}:{call.lineno} {templates[0]!r}")
    return found


def test_that_every_placeholder_of_a_text_is_given_its_value(parsed):
    assert [each for path, tree in parsed.items() for each in _mismatches(path, tree)] == []
