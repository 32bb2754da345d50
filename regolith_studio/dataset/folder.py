"""A dataset as a folder: ``dataset.json``, ``meshes/*.stl`` and a README, written as a whole (2.5)."""

import hashlib
from pathlib import Path

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.document import dataset_of, document_text, mesh_files
from regolith_studio.dataset.reading import (
    DOCUMENT,
    README,
    foreign_files,
    read_document,
    read_mesh_bytes,
    real_path,
)
from regolith_studio.dataset.readme_text import readme_text
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.errors import DatasetError
from regolith_studio.io.atomic import recover_folder, replace_folder

__all__ = ["dataset_files", "read_dataset", "validate_dataset", "write_dataset"]


def write_dataset(folder: Path | str, dataset: Dataset, *, overwrite: bool = True) -> Path:
    """Write the dataset; the folder then holds it and nothing else, or is as it was before.

    Parameters
    ----------
    folder
        New, empty, or holding a dataset of this program and nothing else.
    overwrite
        Whether a dataset that is there already may be replaced.

    Returns
    -------
    Path
        The folder.

    Raises
    ------
    DatasetError
        If the folder holds anything else, or something cannot be written.
    """
    target = Path(folder).resolve()
    files = dataset_files(dataset)
    try:
        recover_folder(target)
        check_replaceable(target, overwrite)
        replace_folder(target, files)
    except OSError as error:
        reason = error.strerror or str(error)
        raise DatasetError(f"The dataset could not be written to {target}: {reason}.") from error
    return target


def dataset_files(dataset: Dataset) -> dict[str, bytes]:
    """Every file of the folder by its relative path, the same bytes for the same dataset."""
    meshes = mesh_files(dataset)
    texts = {DOCUMENT: document_text(dataset, meshes), README: readme_text(dataset)}
    return meshes | {name: text.encode("utf-8") for name, text in texts.items()}


def read_dataset(folder: Path | str) -> Dataset:
    """The dataset of a folder; shapes from their exact half-spaces, meshes checked against their hashes.

    Raises
    ------
    DatasetError
        If the folder holds no dataset, or one that is broken, with the place named.
    """
    target = recover_folder(real_path(folder))
    document = read_document(target)
    for record in document.representatives:
        if hashlib.sha256(read_mesh_bytes(target, record.mesh.file)).hexdigest() != record.mesh.sha256:
            raise DatasetError(f"{target / record.mesh.file} is not the file that dataset.json describes.")
    return dataset_of(document, str(target / DOCUMENT))


def check_replaceable(target: Path, overwrite: bool) -> None:
    """Refuse a folder that holds anything else than a dataset, or one that may not be replaced.

    Raises
    ------
    DatasetError
        Saying what stands there.
    """
    if not target.exists():
        return
    if not target.is_dir():
        raise DatasetError(f"{target} is a file; a dataset is written into a folder.")
    if not any(target.iterdir()):
        return
    try:
        document = read_document(target)
    except DatasetError as error:
        raise DatasetError(
            f"{target} is not empty and holds no dataset that could be replaced; choose another folder."
        ) from error
    if foreign := foreign_files(target, document):
        raise DatasetError(
            f"{target} also holds files that are not the dataset's ({foreign[0]}); nothing was overwritten."
        )
    if not overwrite:
        raise DatasetError(f"{target} holds a dataset already; nothing was overwritten.")
