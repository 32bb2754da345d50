"""Files of the program that are damaged, exchanged or of another are one sentence, and nothing waits."""

import contextlib
import json
import os
import zipfile
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.dem.run_io import DOCUMENT, FINAL, SHAPES, read_final_state, read_run, read_shapes
from regolith_studio.dem.snapshot import EngineState, engine_state_bytes, read_engine_state
from regolith_studio.errors import FileError
from regolith_studio.io import own_files
from regolith_studio.io.own_files import read_arrays, read_json
from regolith_studio.session.project import read_project
from regolith_studio.session.recipe import read_recipe

STATE = engine_state_bytes(EngineState({"steps": 3}, bytes(range(256)) * 40), "key", 7)


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """A run with the shape of a tetrahedron."""
    np.savez_compressed(tmp_path / SHAPES, **{"shape_00000.part_00": np.eye(4, 3)})
    return tmp_path


def test_that_shapes_are_read_back(run: Path) -> None:
    ((part,),) = read_shapes(run)
    assert (part == np.eye(4, 3)).all()


def test_that_shapes_of_another_run_are_refused(run: Path) -> None:
    document = {"format": "regolith-studio-repose", "shapes_sha256": "0" * 64}
    (run / DOCUMENT).write_text(json.dumps(document))
    with pytest.raises(FileError, match="are not the shapes of the run"):
        read_shapes(run)


@pytest.mark.parametrize("seed", range(40))
def test_that_a_damaged_archive_is_one_sentence_and_a_damaged_state_is_none(run: Path, seed: int) -> None:
    random = np.random.default_rng(seed)
    for content in ((run / SHAPES).read_bytes(), STATE):
        damaged = np.frombuffer(content, np.uint8).copy()
        damaged[random.integers(0, len(damaged), 1 + seed % 5)] ^= random.integers(1, 256, dtype=np.uint8)
        cut = damaged.tobytes()[: len(damaged) - (seed % 3) * 20]
        (run / "damaged.npz").write_bytes(cut)
        with contextlib.suppress(FileError):
            read_arrays(run / "damaged.npz", "shapes of a run")
        found = read_engine_state(run / "damaged.npz", "key")
        assert found is None or found[0].records == {"steps": 3}


def test_that_methods_and_passwords_that_are_not_ours_are_no_mistake_of_the_program(run: Path) -> None:
    content = bytearray((run / SHAPES).read_bytes())
    for offset, byte in ((8, 99), (6, 1)):  # method, and the bit of encryption, of the first file
        changed = bytearray(content)
        for signature, shift in ((b"PK\x03\x04", 0), (b"PK\x01\x02", 2)):
            changed[changed.index(signature) + offset + shift] = byte
        (run / SHAPES).write_bytes(changed)
        with pytest.raises(FileError, match="holds no shapes of a run"):
            read_shapes(run)


def test_that_an_archive_that_unpacks_to_too_much_is_refused_by_its_size(
    run: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(own_files, "MAX_UNPACKED_BYTES", 10**6)
    with zipfile.ZipFile(run / SHAPES, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("shape_00000.part_00.npy", bytes(2 * 10**6))
    with pytest.raises(FileError, match="would unpack to more than"):
        read_shapes(run)
    assert read_engine_state(run / SHAPES, "key") is None


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="This system has no pipes with names.")
def test_that_pipes_are_refused_and_not_waited_for(tmp_path: Path) -> None:
    for name in (SHAPES, FINAL, DOCUMENT, "state.zip", "recipe.json"):
        os.mkfifo(tmp_path / name)
    for read in (read_shapes, read_run):
        with pytest.raises(FileError):
            read(tmp_path)
    with pytest.raises(FileError, match="pipe"):
        read_final_state(tmp_path / FINAL)
    assert read_engine_state(tmp_path / "state.zip", "key") is None
    for read_document in (read_recipe, read_project, read_json):
        with pytest.raises(FileError, match="pipe"):
            read_document(tmp_path / "recipe.json")


@pytest.mark.parametrize("path", ["a\0b", "x" * 300])
def test_that_what_cannot_be_a_name_of_a_file_is_a_sentence(path: str) -> None:
    for read in (read_json, read_recipe, read_project):
        with pytest.raises(FileError):
            read(Path(path))


@pytest.mark.parametrize("read", [read_recipe, read_project])
@pytest.mark.parametrize("entry", ['"seed": 1, "seed": 2', '"facets": NaN', '"settings": {"a": 1, "a": 2}'])
def test_that_a_repeated_key_and_nan_are_refused_in_recipes_and_projects(
    tmp_path: Path, read: object, entry: str
) -> None:
    recipe = f'{{"format": "regolith-studio recipe", "version": 2, {entry}}}'
    whole = recipe if read is read_recipe else f'{{"recipe": {recipe}}}'
    (tmp_path / "r.json").write_text(whole)
    with pytest.raises(FileError):
        (read_recipe if read is read_recipe else read_project)(tmp_path / "r.json")


def test_that_two_million_inputs_are_refused(tmp_path: Path) -> None:
    content = {"format": "regolith-studio recipe", "version": 2, "inputs": ["a"] * 2_000_000}
    (tmp_path / "r.json").write_text(json.dumps(content, separators=(",", ":")))
    with pytest.raises(FileError, match=r"inputs is too long.* at most 100000"):
        read_recipe(tmp_path / "r.json")
