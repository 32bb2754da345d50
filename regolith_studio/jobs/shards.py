"""Shards: files that hold the results of a chunk of items, written once and whole.

A shard is an uncompressed ZIP with ``records.jsonl``, one line an item, and the byte strings of the
items under ``<index>/<name>``. It is written under another name, brought to the disk and then renamed.
"""

import hashlib
import json
import os
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from regolith_studio.errors import FileError
from regolith_studio.io.atomic import sync_folder

RECORDS = "records.jsonl"


@dataclass(frozen=True)
class Record:
    """What is known of one item of a batch.

    Parameters
    ----------
    index
        Place of the item in the batch.
    values
        Plain values, as JSON has them.
    blobs
        Byte strings by name, such as the content of a file.
    """

    index: int
    values: Mapping[str, Any]
    blobs: Mapping[str, bytes] = field(default_factory=dict)


def write_shard(path: Path, records: Sequence[Record]) -> str:
    """Write the records; the file is on the disk, whole, when this returns its SHA-256.

    Raises
    ------
    FileError
        If it cannot be written.
    """
    stage = path.with_name(f".{path.name}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with stage.open("wb") as stream:
            _pack(stream, records)
            stream.flush()
            os.fsync(stream.fileno())
        stage.replace(path)
        sync_folder(path.parent)
        return sha256(path)
    except OSError as error:
        raise FileError(f"The results {path} cannot be written ({error.strerror}).") from error
    finally:
        stage.unlink(missing_ok=True)


def read_shard(path: Path, blobs: bool = True) -> Iterator[Record]:
    """The records of a shard in their order, one in memory at a time.

    Parameters
    ----------
    blobs
        Whether to read the byte strings too.

    Raises
    ------
    FileError
        If it is missing or damaged.
    """
    try:
        with zipfile.ZipFile(path) as packed, packed.open(RECORDS) as lines:
            for line in lines:
                entry = json.loads(line)
                prefix = f"{entry['index']}/"
                names = entry["blobs"] if blobs else ()
                yield Record(
                    entry["index"], entry["values"], {name: packed.read(prefix + name) for name in names}
                )
    except (OSError, zipfile.BadZipFile, ValueError, KeyError) as error:
        raise FileError(f"The results {path} are damaged; run again with --resume to repair them.") from error


def sha256(path: Path) -> str:
    """Of a file's bytes, hexadecimal; empty where there is no such file."""
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except FileNotFoundError:
        return ""


def _pack(stream: Any, records: Sequence[Record]) -> None:
    with zipfile.ZipFile(stream, "w") as packed:
        lines = [
            json.dumps(
                {"index": each.index, "values": each.values, "blobs": sorted(each.blobs)},
                ensure_ascii=False,
                allow_nan=False,
                separators=(",", ":"),
            )
            for each in records
        ]
        packed.writestr(zipfile.ZipInfo(RECORDS), "\n".join(lines) + "\n")
        for each in records:
            for name, content in sorted(each.blobs.items()):
                packed.writestr(zipfile.ZipInfo(f"{each.index}/{name}"), content)
