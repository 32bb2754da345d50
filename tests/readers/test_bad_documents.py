"""Our own JSON, broken in ways we made: each file is refused, and the entry that is wrong is named.

Fits, models, cards, recipes, projects and datasets. Which kind of value belongs where is written down here by
hand; every entry gets values of the other kinds, and each file is also cut short, emptied and exchanged.
"""

import copy
import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from regolith_studio.dataset.folder_io import dataset_files, read_document
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.readers.shape_files import read_shape_source
from regolith_studio.session.outputs.measurements import FittedSample, write_fits
from regolith_studio.session.project import Project, read_project
from regolith_studio.session.recipe import Recipe, read_recipe
from regolith_studio.shape_models.materials import materials, write_card
from regolith_studio.shape_models.models import MODELS, write_model
from regolith_studio.shape_models.sample import Sample
from tests.dataset.example import example_dataset

Bad = tuple[str, bytes, str]
OTHERS: dict[str, list[Any]] = {
    "text": [3, [], {}],
    "a whole number": ["three", 1.5, []],
    "a number": ["three", [], {}],
    "a list": [3, "three", {}],
    "named values": [3, "three", []],
    "true or false": [3, "three", []],
}
"""For each kind of value some that are none."""

ENTRIES: dict[str, dict[str, str]] = {
    "fit": {
        "convention": "text", "unit": "text", "l_max": "a whole number", "particles": "a list",
        "particles[1]": "named values", "particles[1].name": "text", "particles[1].notes": "a list",
        "particles[0].hidden_surface_share": "a number", "particles[0].radial_error": "a number",
        "particles[0].unrepresentable_volume_share": "a number", "particles[0].rule": "text",
        "particles[0].sampling_degree": "a whole number", "arrays.names": "named values",
        "arrays.names.sha256": "text",
    },
    "model": {
        "convention": "text", "unit": "text", "model": "text", "values": "named values",
        "arrays": "named values",
    },
    "card": {
        "name": "text", "label": "text", "origin": "text", "n_particles": "a whole number", "unit": "text",
        "median_radius": "a number", "log_deviation": "a number", "relative_amplitudes": "a list",
        "relative_amplitudes[2]": "a number",
    },
    "recipe": {
        "inputs": "a list", "volumes": "a list", "unit": "text", "l_max": "a whole number",
        "level": "a whole number", "method": "text", "settings": "named values", "n_facets": "a whole number",
        "seed": "a whole number", "outputs": "named values", "outputs.meshes": "true or false",
        "population.sources": "a list", "population.n": "a whole number", "volumes[0].file": "text",
        "representatives.count": "a whole number", "exports.targets": "a list",
    },
    "project": {
        "recipe": "named values", "recipe.inputs": "a list", "recipe.n_facets": "a whole number",
        "recipe.unit": "text", "recipe.outputs.fits": "true or false", "selected": "text", "page": "text",
        "pages": "named values", "pages.scan": "named values", "recipe.settings": "named values",
        "recipe.method": "text",
    },
    "dataset": {
        "name": "text", "metadata": "named values", "metadata.description": "text",
        "metadata.processing_steps": "a list", "representatives": "a list",
        "representatives[0].weight": "a number", "representatives[0].n_members": "a whole number",
        "representatives[1].mesh": "named values", "representatives[1].mesh.n_facets": "a whole number",
        "representatives[0].half_spaces.offsets": "a list", "representatives[0].frame.scale_um": "a number",
    },
}  # fmt: skip

FULL = {
    "volumes": [{"file": "a.tif", "voxel_size": 1}],
    "population": {"sources": ["ma165"], "n": 5},
    "representatives": {"count": 3},
    "exports": {"targets": ["rocky"]},
}


def source(path: Path) -> object:
    return read_shape_source(str(path))


READERS: dict[str, tuple[str, Callable[[Path], object]]] = {
    "fit": ("fit.json", source),
    "model": ("model.json", source),
    "card": ("card.json", source),
    "recipe": ("recipe.json", read_recipe),
    "project": ("project.regolith", read_project),
    "dataset": ("dataset.json", lambda path: read_document(path.parent)),
}


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A sound file of each kind, with what belongs to it."""
    folder = tmp_path_factory.mktemp("documents")
    sphere = icosphere(2)
    bodies = [Mesh(sphere.vertices * axes, sphere.faces) for axes in ((3, 2, 1.5), (2, 2, 1), (4, 3, 2))]
    fits = [fit_harmonics(body, 3, sampling_degree=8) for body in bodies]
    write_fits(
        folder / "fit.json",
        FittedSample.of([Particle(name, body) for name, body in zip("abc", bodies, strict=True)], fits),
    )
    model = MODELS["gaussian_field"]
    sample = Sample(np.stack([fit.coefficients.values for fit in fits]))
    write_model(folder / "model.json", model.fit(sample, model.Settings(3)))
    write_card(materials()["ma165"], folder / "card.json")
    recipe = Recipe.model_validate(FULL)
    (folder / "recipe.json").write_text(recipe.to_json())
    project = Project(recipe=recipe, pages={"scan": {"zoom": 2}})
    (folder / "project.regolith").write_text(project.model_dump_json(indent=2))
    (folder / "dataset.json").write_bytes(dataset_files(example_dataset(2))["dataset.json"])
    return folder


def changed(document: Any, entry: str, value: Any) -> bytes:
    """The document with another value at the place that is called ``particles[1].name``."""
    whole = inner = copy.deepcopy(document)
    *steps, last = [int(step) if step.isdigit() else step for step in re.findall(r"\w+", entry)]
    for step in steps:
        inner = inner[step]
    inner[last] = value
    return json.dumps(whole).encode()


def without(document: Any, entry: str) -> bytes:
    whole = copy.deepcopy(document)
    del whole[entry]
    return json.dumps(whole).encode()


def spoilt(key: str, good: bytes) -> Iterator[Bad]:
    document = json.loads(good)
    for entry, kind in ENTRIES[key].items():
        for number, value in enumerate(OTHERS[kind]):
            wanted = rf"{re.escape(entry)} must be {kind}"
            yield f"{entry} {number}", changed(document, entry, value), wanted
    for share in (1, 10, 50, 90, 99):
        cut = good.rstrip()[: len(good) * share // 100]
        yield f"cut at {share}", cut, r"line \d+, column \d+|is not JSON: .* in line \d+|is not text"
    text = r"line 1, column 1|is not JSON|is not text|is not UTF-8 text"
    yield "empty", b"", "is empty|is not JSON"
    yield "diary", b"dear diary, today I lost my fit\n", text
    yield "picture", b"\x89PNG\r\n\x1a\n" + bytes(300), text
    yield "deep", b"[" * 100_000, "is not JSON|no proper JSON|nests too deeply"
    yield "list", b"[1, 2, 3]", "is not a fit|must be named values|is not a dataset"
    yield "number", b"3", "is not a fit|must be named values|is not a dataset"


def special(key: str, good: bytes) -> Iterator[Bad]:
    """What only one kind of file can have wrong."""
    document = json.loads(good)
    if key in ("fit", "model"):
        yield "future", changed(document, "version", 2), "version must be 1, not 2"
        yield "unit", changed(document, "unit", "furlong"), "there is no unit “furlong”; the units are um, mm"
        yield (
            "other convention",
            changed(document, "convention", "Schmidt"),
            "the coefficients follow another",
        )
        for entry in ("version", "unit", "convention"):
            yield f"no {entry}", without(document, entry), f"{entry} is missing"
    if key == "fit":
        twice = changed(document, "particles[1].name", "a")
        yield "twice", twice, "particles: two of them are called “a”"
        yield (
            "degree",
            changed(document, "l_max", 4),
            "it states l_max = 4, and its coefficients reach up to 3",
        )
        fewer = changed(document, "particles", document["particles"][:2])
        yield "fewer", fewer, "names 2 particles but holds coefficients of 3"
        other = changed(document, "arrays.names.sha256", "0" * 64)
        yield "other arrays", other, "the array 'names' is damaged"
        other = changed(document, "arrays.names.sha256", "zz")
        yield "hash", other, r"arrays\.names\.sha256 has letters or a form"
        share = changed(document, "particles[0].hidden_surface_share", 1.5)
        yield "share", share, r"hidden_surface_share must be at most 1, not 1\.5"
    if key == "model":
        yield "unknown", changed(document, "model", "crystal"), "there is no model called 'crystal'"
        for number, values in enumerate(({}, {"mean": "x"}, {"mean": 1.0, "spectrum": 3})):
            yield (
                f"numbers {number}",
                changed(document, "values", values),
                "are impossible for a model of its kind",
            )
    if key == "card":
        yield "negative", changed(document, "median_radius", -2.0), "radius must be at least 1e-12, not -2"
        yield "far", changed(document, "median_radius", 1e300), r"median_radius must be at most 1e\+12"
        yield "wide", changed(document, "log_deviation", 9), "log_deviation must be at most 5, not 9"
        yield "short", changed(document, "relative_amplitudes", [0.1]), "it has 1 of at least 2 entries"
        yield "extra", changed(document, "colour", "grey"), "colour is not known here"
        odd = json.dumps({**document, "co\nlour": 1}).encode()
        yield "unprintable", odd, r"co\?lour is not known here"
        yield "furlong", changed(document, "unit", "furlong"), "there is no unit “furlong”"
    if key == "dataset":
        odd = changed(document, "representatives[1].sizes.type", "log-norm{al")
        yield "sizes", odd, r"representatives\[1\]\.sizes must have a 'type' that is one of 'discrete', "
    if key in ("recipe", "project"):
        yield "format", changed(document, "format", "x"), rf"format must be 'regolith-studio {key}'"
        yield "version", changed(document, "version", 9), "version must be [12], not 9"


@pytest.mark.parametrize("key", READERS)
def test_that_each_broken_document_is_refused_with_its_wrong_entry_named(key: str, place: Path) -> None:
    name, read = READERS[key]
    path = place / name
    good = path.read_bytes()
    assert read(path) is not None
    corpus = [*spoilt(key, good), *special(key, good)]
    assert len({kind for kind, _, _ in corpus}) == len(corpus) >= 35
    try:
        for kind, data, pattern in corpus:
            path.write_bytes(data)
            try:
                sentence = f"was read as {read(path)}"
            except RegolithError as error:
                sentence = str(error)
            assert re.search(pattern, sentence), (kind, sentence)
            assert sentence.count(name) == 1, (kind, sentence)
            assert sentence.endswith("."), (kind, sentence)
            assert len(sentence.replace(str(place), "")) < 250, (kind, sentence)
            assert not re.search(r"Error|None|\\n|Input should|object has no", sentence), (kind, sentence)
    finally:
        path.write_bytes(good)
