"""Presets that a user has saved: named sets of numbers, one JSON file a kind beside the preferences."""

import contextlib
import json
from pathlib import Path
from typing import Any

from pydantic import BaseModel, Field, ValidationError

from regolith_studio.errors import InputError
from regolith_studio.io.atomic import write_bytes
from regolith_studio.session.preferences import preferences_path

LONGEST_NAME = 40
MOST = 200


class _File(BaseModel):
    presets: dict[str, dict[str, Any]] = Field(default_factory=dict)


class OwnPresets:
    """Those of one kind.

    A damaged file counts as none, and is replaced at the next saving.

    Parameters
    ----------
    kind
        Such as ``weights``; names the file.
    folder
        Where it lies; beside the preferences if left out.
    """

    def __init__(self, kind: str, folder: Path | None = None) -> None:
        self._kind, self._folder = kind, folder

    @property
    def path(self) -> Path:
        """Of the file."""
        return (self._folder or preferences_path().parent) / f"presets-{self._kind}.json"

    def all(self) -> dict[str, dict[str, Any]]:
        """Values of each preset by its name, in the order of their saving."""
        try:
            return _File.model_validate_json(self.path.read_bytes()).presets
        except (OSError, ValidationError, RecursionError):
            return {}

    def save(self, name: str, values: dict[str, Any]) -> None:
        """Keep `values`, which are plain JSON, under this name; one of the same name is replaced.

        Raises
        ------
        InputError
            If the name is empty or too long, or there are too many.
        FileError
            If the file cannot be written.
        """
        known = self.all()
        if not name or len(name) > LONGEST_NAME or not name.isprintable():
            raise InputError(f"A preset needs a name of 1 to {LONGEST_NAME} characters.")
        if len(known) >= MOST and name not in known:
            raise InputError(f"There are {MOST} own presets already; delete one first.")
        self._write(known | {name: values})

    def remove(self, name: str) -> None:
        """Forget one; harmless if there is none of this name.

        Raises
        ------
        FileError
            If the file cannot be written.
        """
        self._write({key: values for key, values in self.all().items() if key != name})

    def _write(self, presets: dict[str, dict[str, Any]]) -> None:
        text = json.dumps({"presets": presets}, indent=1, ensure_ascii=False, allow_nan=False)
        with contextlib.suppress(OSError):  # the writing says why
            self.path.parent.mkdir(parents=True, exist_ok=True)
        write_bytes(self.path, text.encode("utf-8") + b"\n")
