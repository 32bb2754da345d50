"""Preferences and presets that are kept between sessions; a damaged file counts as none."""

import contextlib
import json
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Self

import platformdirs
from pydantic import BaseModel, ConfigDict, Field, PrivateAttr, ValidationError

from regolith_studio.errors import FileError, InputError, os_error_reason
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.output_lock import output_lock

RECENT_LIMIT = 12
LOCK_TRIES = 50


class Preferences(BaseModel):
    """Recent files, the unit of each folder, and settings of the window by name.

    All values are plain JSON; unknown ones in the file are kept for the version that wrote them.
    """

    model_config = ConfigDict(extra="allow", validate_assignment=True)

    recent: tuple[str, ...] = ()
    units: dict[str, str] = Field(default_factory=dict)
    window: dict[str, Any] = Field(default_factory=dict)

    _on_disk: dict[str, Any] = PrivateAttr(default_factory=dict)
    """As the file was when it was last read or written."""

    @classmethod
    def load(cls, path: Path | None = None) -> Self:
        """Read them; the defaults if there is no file or it is damaged."""
        try:
            preferences = cls.model_validate_json((path or preferences_path()).read_bytes())
        except (OSError, ValidationError, RecursionError):
            return cls()
        preferences._on_disk = preferences.model_dump(mode="json")
        return preferences

    def save(self, path: Path | None = None) -> bool:
        """Write what has changed here into the file, which other windows share; whether that was possible.

        Of the lists of recent files, that of the window that saves last is kept.
        """
        target = path or preferences_path()
        try:
            with _locked(target):
                there = type(self).load(target).model_dump(mode="json")
                ours = self.model_dump(mode="json")
                tables = {name: _merged(there, ours, self._on_disk, name) for name in ("units", "window")}
                merged = there | tables | {"recent": ours["recent"]}
                write_bytes(target, json.dumps(merged, indent=1, sort_keys=True).encode("utf-8"))
        except (OSError, FileError):
            return False
        self._on_disk = merged
        for name, value in merged.items():
            setattr(self, name, value)
        return True

    def add_recent(self, path: Path, unit: str | None = None) -> None:
        """Put `path` first among the recent files, and the unit of its meshes down for its folder."""
        full = os.path.realpath(path)  # Path.resolve() fails on links that go round in circles
        self.recent = (full, *(old for old in self.recent if old != full))[:RECENT_LIMIT]
        if unit is not None:
            self.units = self.units | {_folder(path): unit}

    def unit_for(self, path: Path) -> str | None:
        """The unit in which files of this folder were opened last."""
        return self.units.get(_folder(path))


@contextmanager
def _locked(target: Path) -> Iterator[None]:
    """The lock of the file, waited for as long as another window may take to save."""
    for _ in range(LOCK_TRIES):
        with contextlib.ExitStack() as stack:
            try:
                stack.enter_context(output_lock(target))
            except FileError:
                time.sleep(0.02)
                continue
            yield
            return
    raise FileError(f"Another process is writing to {target}.")


def _merged(there: dict[str, Any], ours: dict[str, Any], before: dict[str, Any], name: str) -> dict[str, Any]:
    """A table of the file with the entries that have changed here since it was read."""
    changed = {key: value for key, value in ours[name].items() if value != before.get(name, {}).get(key)}
    return {**there[name], **changed}


def preferences_path() -> Path:
    """Where the preferences live; ``REGOLITH_STUDIO_CONFIG`` names another folder."""
    folder = os.environ.get("REGOLITH_STUDIO_CONFIG")
    base = Path(folder) if folder else platformdirs.user_config_path("regolith-studio", appauthor=False)
    return base / "preferences.json"


def _folder(path: Path) -> str:
    full = Path(os.path.realpath(path))
    return str(full if full.is_dir() else full.parent)


MAX_NAME_LENGTH = 40
MAX_PRESETS = 200


class _File(BaseModel):
    presets: dict[str, dict[str, Any]] = Field(default_factory=dict)


class UserPresets:
    """Those of one kind.

    A damaged file counts as none, and is replaced at the next saving.

    ``kind``: such as ``weights``; names the file. ``folder``: where it lies; beside the preferences if left
    out.
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
        """Keep `values`, which are plain JSON, under this name; one of the same name is replaced."""
        if not name or len(name) > MAX_NAME_LENGTH or not name.isprintable():
            raise InputError(f"A preset needs a name of 1 to {MAX_NAME_LENGTH} characters.")
        with self._changes() as presets:
            if len(presets) >= MAX_PRESETS and name not in presets:
                raise InputError(f"There are {MAX_PRESETS} own presets already; delete one first.")
            presets[name] = values

    def remove(self, name: str) -> None:
        """Forget one; harmless if there is none of this name."""
        with self._changes() as presets:
            presets.pop(name, None)

    @contextmanager
    def _changes(self) -> Iterator[dict[str, dict[str, Any]]]:
        """All presets, to be changed inside and then written, while other windows wait."""
        try:
            with _locked(self.path):
                presets = self.all()
                yield presets
                text = json.dumps({"presets": presets}, indent=1, ensure_ascii=False, allow_nan=False)
                write_bytes(self.path, text.encode("utf-8") + b"\n")
        except OSError as error:
            raise FileError(f"The file {self.path} cannot be written ({os_error_reason(error)}).") from error
