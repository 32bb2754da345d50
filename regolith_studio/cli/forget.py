"""``forget``: remove what the program keeps in the home folder, but no results."""

import shutil

import typer

from regolith_studio.cli.options import Json


def forget(json: Json = False) -> None:
    """Remove preferences and compiled code; results, also those of the window, stay."""
    from regolith_studio.cli.terminal import print_json
    from regolith_studio.errors import FileError, os_error_reason
    from regolith_studio.geometry.kernels import compiled_code
    from regolith_studio.session.preferences import preferences_path

    there = [path for path in (preferences_path(), *compiled_code()) if path.exists()]
    for path in there:
        try:
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        except OSError as error:
            raise FileError(f"{path} cannot be removed ({os_error_reason(error)}).") from error
    if json:
        print_json({"removed": list(map(str, there))})
    else:
        typer.echo("\n".join(f"Removed {path}" for path in there) or "There is nothing to remove.")
