"""Make the bundle of this system: ``python -m tools.bundle FOLDER``, with the extra `bundle` installed."""

import platform
import shutil
import sys
from pathlib import Path

from PyInstaller.__main__ import run

from regolith_studio import __version__

HERE = Path(__file__).parent
WHOLE = ("imagecodecs", "mujoco", "rapier3d", "manifold3d")
"""Packages that PyInstaller does not know and whose modules are imported by name."""
LEFT_OUT = ("setuptools", "pkg_resources", "sphinx", "IPython", "jedi", "babel", "mypy", "pytest")
"""What other libraries can use, and nothing here does."""


def bundle(target: Path) -> Path:
    """Build below `target`, and pack the folder into one file; its path."""
    name = f"regolith-studio-{__version__}-{platform.system().lower()}-{platform.machine().lower()}"
    options = [f"--name={name}", "--console", "--noconfirm", "--log-level=WARN"]
    options += [f"--additional-hooks-dir={HERE / 'hooks'}", "--hidden-import=regolith_studio"]
    options += [word for package in WHOLE for word in ("--collect-all", package)]
    options += [f"--exclude-module={package}" for package in LEFT_OUT]
    for option, folder in (
        ("--distpath", target),
        ("--workpath", target / "work"),
        ("--specpath", target / "work"),
    ):
        options += [option, str(folder)]
    run([*options, str(HERE / "start.py")])
    shutil.rmtree(target / "work")
    for text in (HERE / "NOTICE.txt", HERE / "GPL-3.0.txt", HERE.parents[1] / "LICENSE"):
        shutil.copy(text, target / name)
    return Path(
        shutil.make_archive(str(target / name), "zip" if sys.platform == "win32" else "gztar", target, name)
    )


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python -m tools.bundle FOLDER")
    print(bundle(Path(sys.argv[1]).resolve()))
