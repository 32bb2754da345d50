"""Fits, models and cards read back, and what is refused."""

import io
import json
import shutil
import zipfile
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.errors import FileError, InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.harmonics.surface import radii
from regolith_studio.readers.file_bytes import read_npz
from regolith_studio.readers.shape_files import is_shape_source, radius_of, read_shape_source
from regolith_studio.session.outputs.fits import FittedSample, write_fits
from regolith_studio.shape_models.io import write_model
from regolith_studio.shape_models.materials import MaterialCard, materials, write_card
from regolith_studio.shape_models.models import MODELS
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
    write_fits(place / "fit", FittedSample.of(particles, fits))
    sample = Sample(np.stack([fit.coefficients.values for fit in fits]))
    write_model(place / "model", MODELS["gaussian_field"].fit(sample, MODELS["gaussian_field"].Settings(4)))
    write_card(materials()["ma165"], place / "card.json")
    return place


@pytest.mark.parametrize("name", ["fit", "fit.json", "fit.npz"])
def test_that_a_fit_is_read_by_its_stem_or_either_of_its_files(folder: Path, name: str) -> None:
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
    for name in ("fit", "fit.json", "fit.npz", "card", "nothing.json"):
        assert is_shape_source(str(folder / name))
    assert is_shape_source("ma165")
    for name in (str(folder), str(folder / "grain.stl"), "no-material"):
        assert not is_shape_source(name)


def test_that_half_a_fit_is_refused(folder: Path, tmp_path: Path) -> None:
    shutil.copy(folder / "fit.json", tmp_path)
    with pytest.raises(FileError, match=r"fit\.npz cannot be opened"):
        read_shape_source(str(tmp_path / "fit"))
    np.savez(tmp_path / "fit.npz", coefficients=np.ones((2, 49)), star_points=np.zeros((2, 3)))
    with pytest.raises(FileError, match="do not belong together"):
        read_shape_source(str(tmp_path / "fit"))
    np.savez(tmp_path / "fit.npz", rows=np.ones(3))
    with pytest.raises(FileError, match="is a broken fit"):
        read_shape_source(str(tmp_path / "fit"))


def test_that_files_of_different_models_are_not_mixed(folder: Path, tmp_path: Path) -> None:
    shutil.copy(folder / "model.json", tmp_path)
    np.savez(tmp_path / "model.npz", other=np.ones(3))
    with pytest.raises(FileError, match="do not belong together"):
        read_shape_source(str(tmp_path / "model"))


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
    np.savez(tmp_path / "x.npz", coefficients=np.ones((1, 4)), star_points=np.ones((1, 3)))
    with pytest.raises(FileError, match=words):
        read_shape_source(str(tmp_path / "x"))


def test_that_what_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"y\.json cannot be opened"):
        read_shape_source(str(tmp_path / "y"))


def packed(entries: dict[str, bytes]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in entries.items():
            archive.writestr(name, content)
    return stream.getvalue()


def npy(header: str, body: bytes = b"") -> bytes:
    text = header.encode().ljust(117) + b"\n"
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text + body


PLAIN = "{'descr': '<f8', 'fortran_order': False, 'shape': (2,)}"


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "is not an NPZ archive"),
        (b"PK\x03\x04 and nothing", "is not an NPZ archive"),
        (packed({"readme.txt": b"hello"}), "something else than arrays"),
        (packed({f"a{i}.npy": b"" for i in range(70)}), "holds 70 entries"),
        (packed({"a.npy": b"no array"}), "is not an NPZ archive"),
        (packed({"a.npy": npy(PLAIN, bytes(8))}), "declares an array of 16 bytes|ends in the middle"),
        (packed({"a.npy": npy(PLAIN.replace("(2,)", "(10**9,)"), bytes(16))}), "is not an NPZ archive"),
        (packed({"a.npy": npy(PLAIN.replace("(2,)", "(99999999999,)"), bytes(16))}), "declares an array"),
        (packed({"a.npy": npy(PLAIN.replace("<f8", "|O"), bytes(16))}), "not of plain numbers"),
        (packed({"a.npy": npy(PLAIN.replace("'<f8'", "[('a', '<f8')]"), bytes(16))}), "not of plain numbers"),
        (packed({"a.npy": npy(PLAIN.replace("(2,)", "(-2,)"), bytes(16))}), "declares an array"),
    ],
)
def test_that_a_harmful_archive_is_refused(content: bytes, words: str, tmp_path: Path) -> None:
    (tmp_path / "x.npz").write_bytes(content)
    with pytest.raises(FileError, match=words):
        read_npz(tmp_path / "x.npz")


def test_that_an_archive_that_unpacks_to_gigabytes_is_refused_unread(tmp_path: Path) -> None:
    """The size that the archive's directory claims counts before anything is unpacked."""
    content = bytearray(packed({"a.npy": npy(PLAIN, bytes(16))}))
    place = content.rindex(b"PK\x01\x02") + 24
    content[place : place + 4] = (2**32 - 2).to_bytes(4, "little")
    (tmp_path / "x.npz").write_bytes(bytes(content))
    with pytest.raises(FileError, match=r"unpacks to 4\.0 GiB"):
        read_npz(tmp_path / "x.npz")


def test_that_arrays_are_read_as_numpy_reads_them(tmp_path: Path) -> None:
    arrays = {
        "rows": np.asfortranarray(np.random.default_rng(0).normal(size=(4, 3))),
        "names": np.array(["a", "grain-ü"]),
        "none": np.empty((0, 9)),
        "flags": np.array([True, False]),
    }
    np.savez_compressed(tmp_path / "x.npz", **arrays)
    found, digest = read_npz(tmp_path / "x.npz")
    assert len(digest) == 64
    for name, array in arrays.items():
        np.testing.assert_array_equal(found[name], array)
        assert found[name].dtype == array.dtype


def test_that_a_fit_document_with_numbers_that_are_none_is_refused(folder: Path, tmp_path: Path) -> None:
    document = json.loads((folder / "fit.json").read_text())
    with np.load(folder / "fit.npz") as stored:
        arrays = dict(stored)
    arrays["coefficients"][1, 3] = np.nan
    (tmp_path / "n.json").write_text(json.dumps(document))
    np.savez(tmp_path / "n.npz", **arrays)
    with pytest.raises(FileError, match=r"n\.json"):
        read_shape_source(str(tmp_path / "n"))
