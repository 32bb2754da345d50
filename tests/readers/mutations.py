"""Bytes changed at random, where they are written, and what the answer to bad files must look like."""

import os
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

from regolith_studio.errors import FileError
from regolith_studio.readers.volumes.read import read_volume

WORDS = [b"", b"\0", b"\xff\xff\xff\xff", b"-1", b"1e999", b"nan", b"NaN", b"9" * 12, b"\n", b" ", b"#", b":"]
WORDS += [b"=", b",", b";", b"<", b'"', b"{", b"[", b"\\\n", b"null", b"true", b"raw", b"gzip", b"LOCAL"]
WORDS += [b"double", b"MET_LONG", b"vertex", b"list", b"ITEM:", b"l_max", b"../x", b"(1,0,0)"]
WORDS += [b"(99999999,)", b"<U9999999", b"PK\x03\x04", b"\x7f\xff\xff\xff"]


def mutated(data: bytes, rng: np.random.Generator) -> bytes:
    """`data` with one to four bytes changed, left out, doubled or replaced by a word that hurts.

    Half of the changes are within the first 400 bytes, where headers are.
    """
    for _ in range(rng.integers(1, 5)):
        reach = len(data) if rng.random() < 0.5 else min(len(data), 400)
        place = int(rng.integers(0, reach + 1))
        end = place + int(rng.choice([0, 0, 1, 1, 4, 4, 20, len(data)]))
        change = [
            rng.bytes(end - place if end - place < 30 else 1),
            WORDS[rng.integers(len(WORDS))],
            data[place:end] * 2,
            bytes([data[place - 1] ^ (1 << int(rng.integers(0, 8)))]) if place else b"",
            b"",
        ][rng.integers(5)]
        data = data[:place] + change + data[end:]
    return data


def check_sentence(sentence: str, longest: int = 250) -> None:
    """Fail unless an answer is one plain sentence, or empty."""
    assert not sentence or sentence.endswith("."), sentence
    assert "\n" not in sentence, sentence
    assert len(sentence) < longest, sentence


def check_refused(path: Path, pattern: str, **options: object) -> None:
    """Fail unless a volume is refused in one plain sentence about it that matches a pattern."""
    try:
        read_volume(path, **{"voxel_size": 1.0, "kind": "grey", **options})  # type: ignore[arg-type]
    except FileError as error:
        sentence = str(error)
    else:
        pytest.fail(f"{path.name} was read; expected: {pattern}")
    check_sentence(sentence)
    assert sentence.startswith(f"{path.name} "), sentence
    assert re.search(pattern, sentence), (path.name, pattern, sentence)


def check_answers(path: Path, answer: Callable[[], str], seed: int = 31, count: int = 400) -> None:
    """Fail unless a file is read, and changed at random is answered by values or one sentence."""
    rng, data = np.random.default_rng(seed), path.read_bytes()
    assert answer() == ""
    for _ in range(count):
        path.write_bytes(mutated(data, rng))
        check_sentence(answer())


@contextmanager
def folder_in_memory() -> Iterator[Path]:
    """A folder in memory where there is one: disks take milliseconds for a file that is written anew."""
    memory = Path("/dev/shm")
    with TemporaryDirectory(dir=memory if memory.is_dir() and os.access(memory, os.W_OK) else None) as made:
        yield Path(made)
