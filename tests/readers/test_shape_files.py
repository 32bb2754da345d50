"""Fits, models and cards read back, and what is refused."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from regolith_studio.errors import FileError, InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.harmonics.synthesis import radii
from regolith_studio.io.own_files import arrays_document, arrays_from
from regolith_studio.readers.shape_files import is_shape_source, radius_of, read_shape_source
from regolith_studio.session.outputs.measurements import FittedSample, write_fits
from regolith_studio.shape_models.materials import MaterialCard, materials, write_card
from regolith_studio.shape_models.models import MODELS, write_model
from regolith_studio.shape_models.sample import Sample


def ellipsoid(*axes: float) -> Mesh:
    sphere = icosphere(3)
    return Mesh(sphere.vertices * axes, sphere.faces)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A fit, a fitted model and a card."""
    place = tmp_path_factory.mktemp("shapes")
    bodies = {"a": (3.0, 2.0, 1.5), "b": (2.0, 2.0, 1.0), "c": (4.0, 3.0, 2.0)}
    fits = [fit_harmonics(ellipsoid(*axes), 6, sampling_degree=20) for axes in bodies.values()]
    particles = [Particle(name, ellipsoid(*axes)) for name, axes in bodies.items()]
    write_fits(place / "fit.json", FittedSample.of(particles, fits))
    sample = Sample(np.stack([fit.coefficients.values for fit in fits]))
    model = MODELS["gaussian_field"]
    write_model(place / "model.json", model.fit(sample, model.Settings(4)))
    write_card(materials()["ma165"], place / "card.json")
    return place


def test_that_surfaces_that_cannot_be_written_leave_the_earlier_fit(tmp_path: Path) -> None:
    bodies = [Particle("a", ellipsoid(3.0, 2.0, 1.5))]
    fits = [fit_harmonics(bodies[0].mesh, l_max, sampling_degree=20) for l_max in (4, 6)]
    path = tmp_path / "fit.json"
    write_fits(path, FittedSample.of(bodies, fits[:1]))
    earlier = path.read_bytes()
    with pytest.raises(FileError):
        write_fits(path, FittedSample.of(bodies, fits[1:]), path / "surfaces", 2)
    assert path.read_bytes() == earlier
    assert write_fits(path, FittedSample.of(bodies, fits[1:]), tmp_path / "surfaces", 2) == {}
    assert path.read_bytes() != earlier
    assert (tmp_path / "surfaces" / "a.stl").is_file()


@pytest.mark.parametrize("name", ["fit", "fit.json"])
def test_that_a_fit_is_read_by_its_name_with_or_without_suffix(folder: Path, name: str) -> None:
    found = read_shape_source(str(folder / name))
    assert isinstance(found.content, Sample)
    assert found.content.names == ("a", "b", "c")
    assert found.content.equivalent_radii**3 == pytest.approx([9, 4, 24], rel=0.03)
    assert len(found.sha256) == 64


def test_that_a_fit_over_an_ellipsoid_becomes_the_radius_of_the_ellipsoid() -> None:
    axes = np.array([3.0, 2.0, 1.5])
    fit = fit_harmonics(ellipsoid(*axes), 8, sampling_degree=30, reference="ellipsoid")
    assert fit.reference is not None
    directions = icosphere(1).vertices
    expected = np.linalg.norm(directions / axes, axis=1) ** -1
    assert radii(radius_of(fit), directions) == pytest.approx(expected, rel=0.03)


def test_that_a_card_in_millimetres_is_read_in_micrometres(folder: Path, tmp_path: Path) -> None:
    card = materials()["ma165"].model_copy(update={"unit": "mm"})
    found = read_shape_source(str(write_card(card, tmp_path / "m.json"))).content
    assert isinstance(found, MaterialCard)
    assert found.unit == "um"
    assert found.median_radius == pytest.approx(1000 * card.median_radius)
    assert read_shape_source(str(folder / "card")).content == read_shape_source("ma165").content


def test_that_names_of_sources_and_of_meshes_are_told_apart(folder: Path) -> None:
    for name in ("fit", "fit.json", "card", "nothing.json"):
        assert is_shape_source(str(folder / name))
    assert is_shape_source("ma165")
    for name in (str(folder), str(folder / "grain.stl"), "no-material"):
        assert not is_shape_source(name)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"base64": "A" * 64}, "its SHA-256 is another"),
        ({"base64": "Ä"}, "has no bytes, type or shape"),
        ({"shape": [10**9, 10**9]}, "has no bytes, type or shape"),
        ({"dtype": "|O"}, "not of plain numbers"),
        ({"dtype": "nothing"}, "has no bytes, type or shape"),
        ({"sha256": "0"}, "sha256"),
    ],
)
def test_that_a_file_with_changed_arrays_is_refused(
    folder: Path, tmp_path: Path, change: dict[str, Any], words: str
) -> None:
    document = json.loads((folder / "fit.json").read_text())
    document["arrays"]["names"] |= change
    (tmp_path / "x.json").write_text(json.dumps(document))
    with pytest.raises(FileError, match=f"is a broken fit: .*{words}"):
        read_shape_source(str(tmp_path / "x"))


def test_that_arrays_are_read_as_they_were_written() -> None:
    arrays = {
        "rows": np.asfortranarray(np.random.default_rng(0).normal(size=(4, 3))),
        "names": np.array(["a", "grain-ü"]),
        "none": np.empty((0, 9)),
        "flags": np.array([True, False]),
        "big": np.arange(3, dtype=">i4"),
    }
    found = arrays_from(json.loads(json.dumps(arrays_document(arrays))))
    for name, array in arrays.items():
        np.testing.assert_array_equal(found[name], array)
        assert found[name].dtype == array.dtype.newbyteorder("=")


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", "is empty"),
        ("[1]", "is not a fit, a model"),
        ("{}", "is not a fit, a model"),
        ('{"format": "regolith-studio model"}', "is a broken model: version is missing"),
        ('{"format": "regolith-studio fit", "particles": 3}', "is a broken fit"),
        ('{"relative_amplitudes": []}', "is no material card"),
        ("[" * 100_000, "is not JSON"),
        ('{"format": "regolith-studio model", "model": "x", "arrays": 3, "values": 1}', "is a broken model"),
    ],
)
def test_that_a_file_that_is_no_source_is_refused_in_one_sentence(
    content: str, words: str, tmp_path: Path
) -> None:
    (tmp_path / "x.json").write_text(content)
    with pytest.raises(FileError, match=words):
        read_shape_source(str(tmp_path / "x"))


def test_that_what_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"y\.json cannot be opened"):
        read_shape_source(str(tmp_path / "y"))


def test_that_a_fit_document_with_numbers_that_are_none_is_refused(folder: Path, tmp_path: Path) -> None:
    document = json.loads((folder / "fit.json").read_text())
    arrays = arrays_from(document["arrays"])
    arrays["coefficients"][1, 3] = np.nan
    document["arrays"] = arrays_document(arrays)
    (tmp_path / "n.json").write_text(json.dumps(document))
    with pytest.raises(FileError, match=r"n\.json"):
        read_shape_source(str(tmp_path / "n"))
