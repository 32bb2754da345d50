"""Archives of meshes: which members they have, and where the bytes of each are."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path, PurePosixPath
from typing import Any
from zipfile import ZIP_STORED

from regolith_studio.errors import FileError
from regolith_studio.io.file_names import natural_key
from regolith_studio.readers.error_messages import display_name, printable
from regolith_studio.readers.formats import mesh_suffixes
from regolith_studio.readers.sandbox import SandboxMessage
from regolith_studio.readers.sandbox.parent import (
    BASE_SECONDS,
    MAX_FILE_BYTES,
    SECONDS_PER_BYTE,
    WORK_SECONDS,
    checked_size,
    shared_sandbox,
)
from regolith_studio.readers.zip_members import SUFFIX, Place, left_out_sentence

WEIGHTS_FILE = "particles.csv"
"""Weights of the meshes in a folder, written by ``extract``."""
MAX_DEPTH = 4
"""Of archives in archives."""
MAX_ARCHIVES = 1000
"""In one archive, at any depth."""
_UNPACKED_PER_SECOND = 20e6
"""Bytes of an archive in an archive that are surely passed in a second."""


@dataclass(frozen=True, slots=True)
class ArchiveMember:
    """A file in an archive on the disk.

    - ``archive``: the archive.
    - ``chain``: place of each archive in an archive, and of the file at the end.
    - ``name``: path from the archive on, with those of archives in it.
    """

    archive: Path
    chain: tuple[Place, ...]
    name: str

    @property
    def path(self) -> Path:
        """That the member has if archives count as folders."""
        return self.archive / self.name

    @property
    def group(self) -> str:
        """Its folder in the archive; empty where it is in none."""
        folders = PurePosixPath(self.name).parent.parts
        stems = [part[: -len(SUFFIX)] if part.lower().endswith(SUFFIX) else part for part in folders]
        return printable("/".join(stems))

    def request(self) -> SandboxMessage:
        """Its mesh, parsed by the sandbox.

        Raises FileError if it is refused, or its reader crashes or exceeds its limits.
        """
        size = self.chain[-1].size
        if size > MAX_FILE_BYTES:
            reason = f"has {size / 1024**3:.1f} GiB; at most 2 GiB are read."
            raise FileError(f"{display_name(self.path)} {reason}")
        more = size * SECONDS_PER_BYTE + _passing(self.chain[:-1])
        options = {"archive": str(self.archive.absolute()), "chain": self.chain}
        seconds, work = BASE_SECONDS + more, WORK_SECONDS + more
        return shared_sandbox().request_within("mesh", self.path, seconds, work, **options)


@dataclass(frozen=True)
class ArchiveContent:
    """Meshes of an archive, and sentences about members that are refused.

    They are in the order of their names, those of a compressed archive in an archive as they lie in it: that
    one can only be unpacked from its beginning on, which any other order would do once for each mesh.

    ``tables``: names of the tables of weights, which are not read.
    """

    members: tuple[ArchiveMember, ...]
    problems: tuple[tuple[str, str], ...]
    tables: tuple[str, ...] = ()


def is_archive(path: Path) -> bool:
    """Whether a file is an archive by its name."""
    return path.suffix.lower() == SUFFIX


def archive_of(path: Path) -> Path | None:
    """The archive that a path leads into; ``None`` if there is something at the path itself, or none."""
    if not path.exists():
        return next((above for above in path.parents if is_archive(above) and above.is_file()), None)
    return None


def archive_content(path: Path) -> ArchiveContent:
    """The meshes of an archive and of archives in it.

    Raises FileError with one sentence if it cannot be read.
    """
    size, state = checked_size(path, None), path.stat()
    return _content(path, size, state.st_mtime_ns)


@lru_cache(maxsize=1)
def _content(path: Path, _size: int, _time: int) -> ArchiveContent:
    walk = _Walk(path)
    members = tuple(walk.members((), ""))
    if walk.beyond:
        reason = f"more than {MAX_DEPTH} archives in each other or {MAX_ARCHIVES:,} in one are not read"
        walk.problems.append((str(path), f"{display_name(path)} {left_out_sentence(reason, walk.beyond)}"))
    return ArchiveContent(members, tuple(walk.problems), tuple(walk.tables))


@dataclass
class _Walk:
    """Through an archive and those in it; ``beyond`` the limits of depth and number none is opened."""

    path: Path
    problems: list[tuple[str, str]] = field(default_factory=list)
    beyond: list[str] = field(default_factory=list)
    tables: list[str] = field(default_factory=list)
    n_opened: int = 0

    def members(self, chain: tuple[Place, ...], prefix: str) -> Iterator[ArchiveMember]:
        """The members of an archive, and of those in it."""
        here = self.path / prefix
        names, places, refused = _listed(self.path, chain, prefix)
        self.problems += [(str(here), f"{display_name(here)} {sentence}") for sentence in refused]
        for name, place in _in_order(names, places, all(each.method == ZIP_STORED for each in chain)):
            inner = (*chain, place)
            if name.lower().endswith(".csv"):
                self.tables += [prefix + name] if PurePosixPath(name).name == WEIGHTS_FILE else []
            elif not is_archive(Path(name)):
                yield ArchiveMember(self.path, inner, prefix + name)
            elif len(inner) > MAX_DEPTH or self.n_opened == MAX_ARCHIVES:
                self.beyond.append(prefix + name)
            else:
                self.n_opened += 1
                try:
                    yield from self.members(inner, f"{prefix}{name}/")
                except FileError as error:
                    self.problems.append((f"{here / name}", str(error)))


def _in_order(names: list[str], places: list[Place], by_name: bool) -> list[tuple[str, Place]]:
    members = list(zip(names, places, strict=True))
    if by_name:
        return sorted(members, key=lambda member: [natural_key(part) for part in member[0].split("/")])
    return sorted(members, key=lambda member: member[1].offset)


def _listed(path: Path, chain: tuple[Place, ...], prefix: str) -> tuple[list[str], list[Place], list[str]]:
    size = chain[-1].size if chain else checked_size(path, None)
    more = size * SECONDS_PER_BYTE + _passing(chain)
    options: dict[str, Any] = {"archive": str(path.absolute()), "chain": chain}
    options["suffixes"] = sorted({*mesh_suffixes(), SUFFIX, ".csv"})
    answer = shared_sandbox().request_within(
        "archive", path / prefix, BASE_SECONDS + more, 10.0 + more, **options
    )
    names, rows = answer.arrays
    texts = names.tobytes().decode("utf-8", "replace").split("\0") if len(rows) else []
    return texts, [Place(*map(int, row)) for row in rows], answer.header["refused"]


def _passing(chain: tuple[Place, ...]) -> float:
    """Seconds that it may take to come to a member of archives in archives."""
    return sum(place.size for place in chain) / _UNPACKED_PER_SECOND
