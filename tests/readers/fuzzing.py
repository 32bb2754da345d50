"""Coverage-guided fuzzing of one reader: ``python tests/readers/fuzzing.py binary.stl 300 findings``.

Run by hand; needs atheris, which nothing else does (``pip install atheris``; CPython 3.11 to 3.13). The
arguments are the name of a well-formed file of the mutation tests, seconds, and a folder for what is found:
files that end in an error of no kind meant for users, in a sentence that is none, or after more than a second
of work. Each finding belongs into ``crashes`` or ``crashes_volumes``, with its answer in ``test_crashes.py``.
"""

import hashlib
import importlib
import re
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import mkdtemp

import atheris
import numpy  # noqa: F401 (imported before the readers are instrumented)
import pydantic  # noqa: F401

sys.path.insert(0, str(Path(__file__).parents[2]))
import regolith_studio.shape_models.models  # noqa: F401 (numba must not see instrumented code)

with atheris.instrument_imports(include=["regolith_studio.readers", "zipfile", "tifffile"]):
    from regolith_studio.errors import RegolithError
    from regolith_studio.readers.formats import MESH_FORMATS
    from regolith_studio.readers.position_formats import POSITION_FORMATS
    from regolith_studio.readers.sandbox.tasks import parse_mesh
    from regolith_studio.readers.volume_formats import VOLUME_FORMATS

    len(MESH_FORMATS), len(VOLUME_FORMATS), len(POSITION_FORMATS)

JARGON = re.compile(r"Error\b|NoneType|Traceback|invalid literal|could not convert|object has no|<class")
MAX_WORK = 1.0

Reader = Callable[[Path, bytes], object]


def target(name: str) -> tuple[bytes, Reader]:
    """A well-formed file, and what reads it from its path and its bytes."""
    meshes = importlib.import_module("tests.readers.test_mutations")
    cube = importlib.import_module("tests.readers.conftest").Cube()
    if name in meshes.NAMES:
        return meshes.seeds(cube)[name], lambda path, data: parse_mesh(data, path)
    volumes = importlib.import_module("tests.readers.test_volume_mutations")
    tables = importlib.import_module("tests.readers.test_table_mutations")
    for makers in (volumes.OWN, volumes.LIBRARIES):
        if name in makers:
            return makers[name](), lambda path, _: refuse(volumes.answer_of(path))
    folder = Path(mkdtemp())
    tables.write_all(folder)
    return (folder / name).read_bytes(), lambda path, _: tables.CASES[name](path)


def refuse(sentence: str) -> None:
    if sentence:
        raise RegolithError(sentence)


def fault(read: Reader, path: Path, data: bytes) -> str:
    """What is wrong with the answer to a file; empty if nothing is."""
    start = time.process_time()
    try:
        read(path, data)
    except RegolithError as error:
        said = str(error)
        if JARGON.search(said) or "\n" in said or not said.endswith("."):
            return f"sentence {re.sub(r'[0-9]+', '#', said)[:60]}"
    except Exception as error:  # noqa: BLE001 (this is what is looked for)
        return f"error {type(error).__name__}"
    return "slow" if time.process_time() - start > MAX_WORK else ""


def main(name: str, seconds: str, findings: Path) -> None:
    seed, read = target(name)
    path = Path(mkdtemp(dir="/dev/shm")) / Path(name).name
    corpus = Path(mkdtemp())
    (corpus / "seed").write_bytes(seed)
    findings.mkdir(parents=True, exist_ok=True)
    known: set[str] = set()

    def one(data: bytes) -> None:
        path.write_bytes(data)
        found = fault(read, path, data)
        if found and found not in known:
            known.add(found)
            kept = findings / f"{hashlib.sha1(data, usedforsecurity=False).hexdigest()[:10]}{path.suffix}"
            kept.write_bytes(data)
            sys.stdout.write(f"FOUND {found}: {kept}\n")

    atheris.Setup([sys.argv[0], str(corpus), f"-max_total_time={seconds}", "-max_len=6000"], one)
    atheris.Fuzz()


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], Path(sys.argv[3]))
