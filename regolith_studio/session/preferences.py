"""What the program remembers between sittings; a file that is damaged costs the memory, nothing else."""

import json
import os
import tempfile
from pathlib import Path
from typing import Any, Self

import platformdirs
from pydantic import BaseModel, ConfigDict, Field, ValidationError

RECENT_LIMIT = 12


class Preferences(BaseModel):
    """Recent files, the unit of each folder, and settings of the window by name.

    All values are plain JSON; unknown ones in the file are kept for the version that wrote them.
    """

    model_config = ConfigDict(extra="allow", validate_assignment=True)

    recent: tuple[str, ...] = ()
    units: dict[str, str] = Field(default_factory=dict)
    window: dict[str, Any] = Field(default_factory=dict)

    @classmethod
    def load(cls, path: Path | None = None) -> Self:
        """Read them; the defaults if there is no file or it is damaged."""
        try:
            return cls.model_validate_json((path or preferences_path()).read_bytes())
        except (OSError, ValidationError, RecursionError):
            return cls()

    def save(self, path: Path | None = None) -> bool:
        """Write them in one step; says whether that was possible."""
        target = path or preferences_path()
        text = json.dumps(self.model_dump(mode="json"), indent=1, sort_keys=True)
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            handle, name = tempfile.mkstemp(dir=target.parent, prefix=target.name)
            with os.fdopen(handle, "w", encoding="utf-8") as file:
                file.write(text)
            Path(name).replace(target)
        except OSError:
            return False
        return True

    def remember_opened(self, path: Path, unit: str) -> None:
        """Put `path` first among the recent files and `unit` down for its folder."""
        full = os.path.realpath(path)  # Path.resolve() fails on links that go round in circles
        self.recent = (full, *(old for old in self.recent if old != full))[:RECENT_LIMIT]
        self.units = self.units | {_folder(path): unit}

    def unit_for(self, path: Path) -> str | None:
        """The unit in which files of this folder were opened last."""
        return self.units.get(_folder(path))


def preferences_path() -> Path:
    """Where the preferences live; ``REGOLITH_STUDIO_CONFIG`` names another folder."""
    folder = os.environ.get("REGOLITH_STUDIO_CONFIG")
    base = Path(folder) if folder else platformdirs.user_config_path("regolith-studio", appauthor=False)
    return base / "preferences.json"


def _folder(path: Path) -> str:
    full = Path(os.path.realpath(path))
    return str(full if full.is_dir() else full.parent)
