"""What PyInstaller takes of the program: its modules, as sources for numba's cache, and its resources."""

from pathlib import Path

from PyInstaller.utils.hooks import collect_data_files, collect_submodules, copy_metadata

ROOT = Path(__file__).parents[3]

hiddenimports = [*collect_submodules("regolith_studio"), "pyshtools", "vtkmodules.all"]
module_collection_mode = {"regolith_studio": "py"}
datas = [
    (str(ROOT / "resources"), "regolith_studio/_resources"),
    (str(ROOT / "docs"), "regolith_studio/_resources/guide"),
    (str(ROOT / "benchmarks" / "results"), "regolith_studio/_resources/results"),
    *collect_data_files("pyshtools"),
    *copy_metadata("regolith-studio", recursive=True),
]
