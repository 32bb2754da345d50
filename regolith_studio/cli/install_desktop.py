"""``install-desktop``: an entry in the menu of a desktop, its icon, and the types of files that it opens."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Annotated

import typer

from regolith_studio.cli.options import Json

FILES = {
    "applications/regolith-studio.desktop": ("desktop", "regolith-studio.desktop"),
    "icons/hicolor/scalable/apps/regolith-studio.svg": ("icons", "app.svg"),
    "mime/packages/regolith-studio.xml": ("desktop", "regolith-studio.xml"),
}
"""Place of each file below the data folder, and the shipped file."""
DATABASES = {"update-mime-database": "mime", "update-desktop-database": "applications"}
"""Programs that make the caches of a desktop, and the folders that they read."""


def install_desktop(
    remove: Annotated[bool, typer.Option("--remove", help="Remove what was installed.")] = False,
    json: Json = False,
) -> None:
    """Add the program to the menu of a Linux desktop, with icon and file types, for this user."""
    from regolith_studio.cli.terminal import print_json
    from regolith_studio.errors import FileError, MissingRequirement, os_error_reason

    if sys.platform in ("win32", "darwin"):
        raise MissingRequirement("Menu entries are made on desktops that follow freedesktop.org only.")
    paths = {data_folder() / place: parts for place, parts in FILES.items()}
    changed = [path for path in paths if path.exists()] if remove else list(paths)
    for path in changed:
        try:
            path.unlink() if remove else _install(path, paths[path])
        except OSError as error:
            raise FileError(f"{path} cannot be changed ({os_error_reason(error)}).") from error
    if changed:
        _update_databases()
    verb = "removed" if remove else "installed"
    if json:
        print_json({verb: list(map(str, changed))})
    else:
        typer.echo(
            "\n".join(f"{verb.capitalize()} {path}" for path in changed) or "There is nothing to remove."
        )


def data_folder() -> Path:
    """``XDG_DATA_HOME``, which counts only if it is absolute, or its default."""
    named = Path(os.environ.get("XDG_DATA_HOME", ""))
    return named if named.is_absolute() else Path.home() / ".local" / "share"


def _install(path: Path, parts: tuple[str, ...]) -> None:
    from regolith_studio.io.atomic import write_bytes
    from regolith_studio.resources import resource

    content = resource(*parts).read_bytes()
    path.parent.mkdir(parents=True, exist_ok=True)
    write_bytes(path, content.replace(b"@PYTHON@", _quoted(sys.executable).encode("utf-8")))


def _quoted(word: str) -> str:
    """A word of the key Exec, which is unescaped twice: as a string and as a quoted argument."""
    escaped = re.sub(r'(["`$\\])', r"\\\1", word).replace("\\", r"\\").replace("%", "%%")
    return f'"{escaped}"'


def _update_databases() -> None:
    """Make the caches of the desktop anew."""
    from regolith_studio.cli.terminal import print_errors

    for program, name in DATABASES.items():
        folder = data_folder() / name
        if found := shutil.which(program):
            subprocess.run([found, str(folder)], capture_output=True, check=False)
        else:
            print_errors(
                [f"{program} was not found: types of files count once `{program} {folder}` has run."]
            )
