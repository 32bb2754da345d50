"""The files of a dataset folder on their way in: sizes, links and foreign files are looked at first."""

import hashlib
import os
from pathlib import Path

from regolith_studio.dataset.document import parsed_document
from regolith_studio.dataset.schema import DatasetDocument
from regolith_studio.errors import DatasetError, reason_of

DOCUMENT, README = "dataset.json", "README.txt"
UNASKED = {".DS_Store", "Thumbs.db", "desktop.ini"}
"""Files that file managers leave behind; they go with the folder."""

LARGEST_DOCUMENT = 320_000_000
"""Room for 100,000 shapes of 20 faces; reading them takes half a minute and 3 GB."""
LARGEST_MESH = 50_000_000


def read_document(folder: Path) -> DatasetDocument:
    """The checked ``dataset.json`` of a folder.

    Raises
    ------
    DatasetError
        If it is missing, too large or breaks the schema.
    """
    path = folder / DOCUMENT
    try:
        text = _read(path, LARGEST_DOCUMENT).decode("utf-8")
    except UnicodeDecodeError as error:
        raise DatasetError(f"{path} is not text in UTF-8.") from error
    return parsed_document(text, str(path))


def dataset_hash(folder: Path | str) -> str:
    """SHA-256 of ``dataset.json``, which holds those of the meshes: what DEM results refer to.

    Raises
    ------
    DatasetError
        If the folder holds no dataset.
    """
    path = Path(folder) / DOCUMENT
    return hashlib.sha256(_read(path, LARGEST_DOCUMENT)).hexdigest()


def read_mesh_bytes(folder: Path, file: str) -> bytes:
    """Content of a mesh file whose relative path the schema has admitted.

    Raises
    ------
    DatasetError
        If it is missing, too large, or leads out of the folder by a link.
    """
    path = folder.joinpath(*file.split("/"))
    if not real_path(path).is_relative_to(real_path(folder)):
        raise DatasetError(f"{path} leads out of the dataset's folder.")
    return _read(path, LARGEST_MESH)


def foreign_files(folder: Path, document: DatasetDocument) -> list[str]:
    """Files and folders below `folder` that do not belong to its dataset, as relative POSIX paths."""
    own = {DOCUMENT, README, "meshes", *(record.mesh.file for record in document.representatives)}
    found = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.name not in UNASKED}
    return sorted(found - own)


def real_path(path: Path | str) -> Path:
    """The path without links; `Path.resolve` fails where they go round in circles, this leaves them."""
    return Path(os.path.realpath(path))


def _read(path: Path, largest: int) -> bytes:
    try:
        if path.exists() and not path.is_file():
            raise DatasetError(f"{path} is no regular file.")
        if path.stat().st_size > largest:
            raise DatasetError(f"{path} is larger than {largest // 1_000_000} MB.")
        return path.read_bytes()
    except OSError as error:
        raise DatasetError(f"{path} cannot be read: {reason_of(error)}.") from error
