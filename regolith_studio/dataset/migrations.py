"""Documents of older schema versions, brought up to date one version after another while they are read."""

import json
from collections.abc import Callable, Mapping
from typing import Any

from regolith_studio.dataset.schema import SCHEMA_VERSION
from regolith_studio.errors import DatasetError

Document = dict[str, Any]


def _from_1(document: Document) -> Document:
    """Version 2 says how well the representatives stand for their population."""
    metadata = document.get("metadata")
    if not isinstance(metadata, dict):
        return document
    return document | {"metadata": {"representation": None} | metadata}


STEPS: Mapping[int, Callable[[Document], Document]] = {1: _from_1}
"""From each older version to the next."""


def migrated(document: Document, text: str, where: str) -> str:
    """The text of a document as the present version has it; a present one's text is not touched.

    Parameters
    ----------
    document
        The parsed text.

    Raises
    ------
    DatasetError
        If the version is none, or newer than this program.
    """
    version = document.get("schema_version")
    known = (*STEPS, SCHEMA_VERSION)
    if isinstance(version, bool) or version not in known:
        raise DatasetError(
            f"{where} has {'no schema version' if version is None else f'schema version {version!r}'}; "
            f"this program reads versions {min(known)} to {max(known)}."
        )
    if version == SCHEMA_VERSION:
        return text
    while version != SCHEMA_VERSION:
        document = STEPS[version](document) | {"schema_version": version + 1}
        version += 1
    return json.dumps(document, allow_nan=False)
