"""The house keeps its shape: imports go down, heavy libraries stay in their rooms, modules stay small."""

import ast
import copy
import graphlib
import importlib.util
import re
import statistics
from collections import defaultdict
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import grimp
import pytest
from importlinter import api
from importlinter.application.output import console
from importlinter.contracts.acyclic_siblings import AcyclicSiblingsContract
from importlinter.contracts.forbidden import ForbiddenContract
from importlinter.contracts.independence import IndependenceContract
from importlinter.contracts.layers import LayersContract
from importlinter.contracts.protected import ProtectedContract

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "regolith_studio"
MODULES = sorted(PACKAGE.rglob("*.py"))
SETTINGS = api.read_configuration(str(ROOT / "pyproject.toml"))
CONTRACTS = SETTINGS["contracts_options"]
CONTRACT_TYPES = {
    "layers": LayersContract,
    "acyclic_siblings": AcyclicSiblingsContract,
    "protected": ProtectedContract,
    "forbidden": ForbiddenContract,
    "independence": IndependenceContract,
}
NAME_FIELDS = (
    "ancestors",
    "modules",
    "source_modules",
    "forbidden_modules",
    "protected_modules",
    "allowed_importers",
)
LAYERS = {
    name.strip("() ")
    for contract in CONTRACTS
    if contract["id"] == "layers"
    for layer in contract["layers"]
    for name in layer.split("|")
}

LONGEST_MODULE = 600
LONGEST_MAIN_WINDOW = 200
MEDIAN_MODULE = 220
LONG_FUNCTION = 30


@cache
def import_graph() -> grimp.ImportGraph:
    return grimp.build_graph("regolith_studio", include_external_packages=True, cache_dir=None)


def names_of(contract: dict[str, Any]) -> list[str]:
    return [name for field in NAME_FIELDS for name in contract.get(field, [])]


def exists(name: str, graph: grimp.ImportGraph) -> bool:
    return bool(graph.find_matching_modules(name)) if "*" in name else name in graph.modules


def violations(contract: dict[str, Any], graph: grimp.ImportGraph) -> str:
    """What import-linter says about a contract, reduced to the modules that exist; empty if it is kept."""
    options = {
        key: [name for name in value if exists(name, graph)] if key in NAME_FIELDS else value
        for key, value in contract.items()
    } | {"unmatched_ignore_imports_alerting": "none"}
    if any(options.get(field) == [] for field in NAME_FIELDS if field != "allowed_importers"):
        return ""
    rule = CONTRACT_TYPES[contract["type"]](
        name=contract["name"],
        session_options=SETTINGS["session_options"],
        contract_options=options,
    )
    check = rule.check(copy.deepcopy(graph), verbose=False)
    if check.kept:
        return ""
    with console.capture() as said:
        rule.render_broken_contract(check)
    return said.get()


@pytest.mark.parametrize("contract", CONTRACTS, ids=lambda contract: contract["id"])
def test_that_the_imports_keep_the_contract(contract: dict[str, Any]) -> None:
    broken = violations(contract, import_graph())
    assert not broken, f"{contract['name']}:\n{broken}"


@pytest.mark.parametrize("contract", CONTRACTS, ids=lambda contract: contract["id"])
def test_that_a_contract_names_real_folders_and_installed_libraries(contract: dict[str, Any]) -> None:
    for name in names_of(contract):
        library, _, rest = name.partition(".")
        if library == "regolith_studio":
            assert not rest or rest.split(".")[0] in LAYERS, name
        else:
            assert importlib.util.find_spec(library), name


@pytest.mark.parametrize(
    ("contract", "importer", "imported"),
    [
        ("layers", "regolith_studio.geometry.mesh", "regolith_studio.descriptors.describe"),
        ("cycles", "regolith_studio.errors", "regolith_studio.resources"),
        ("qt", "regolith_studio.geometry.mesh", "PySide6"),
        ("vtk", "regolith_studio.geometry.mesh", "pyvista"),
        ("trimesh", "regolith_studio.descriptors.describe", "trimesh"),
        ("pyshtools", "regolith_studio.geometry.mesh", "pyshtools"),
    ],
)
def test_that_a_forbidden_import_is_noticed(contract: str, importer: str, imported: str) -> None:
    graph = copy.deepcopy(import_graph())
    if imported not in graph.modules:
        graph.add_module(imported, is_squashed=True)
    graph.add_import(importer=importer, imported=imported)
    rule = next(each for each in CONTRACTS if each["id"] == contract)
    assert importer.rpartition(".")[2] in violations(rule, graph)


def test_that_no_module_imports_itself_by_a_detour() -> None:
    graph = import_graph()
    inside = {name for name in graph.modules if name.startswith("regolith_studio.")}
    imports = {
        name: graph.find_modules_directly_imported_by(name) & inside - {name} for name in inside
    }  # a package that looks a name up in itself is no detour
    graphlib.TopologicalSorter(imports).prepare()  # a CycleError names the cycle


def test_that_every_module_is_part_of_a_package() -> None:
    """A folder without __init__.py escapes import-linter, mypy and the wheel's users alike."""
    assert not [path for path in MODULES if not (path.parent / "__init__.py").exists()]


def test_that_no_module_is_a_drawer_for_odds_and_ends() -> None:
    drawers = {"utils", "util", "helpers", "helper", "common", "misc"}
    assert not [path for path in MODULES if {path.stem.strip("_"), path.parent.name.strip("_")} & drawers]


def test_that_every_record_of_locked_arrays_keeps_its_locks_in_another_process() -> None:
    """Pickle forgets that an array is read-only: such a record is pickled by its constructor."""
    classes = [
        (path.name, each)
        for path in MODULES
        for each in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(each, ast.ClassDef) and re.search(r"\blocked_(floats|integers)\(", ast.unparse(each))
    ]
    assert len(classes) > 20
    for name, each in classes:
        own = any(isinstance(part, ast.FunctionDef) and part.name == "__reduce__" for part in each.body)
        inherited = {"LockedRecord", "SurfaceSampler"} & {ast.unparse(base) for base in each.bases}
        assert own or inherited, (name, each.name)


def line_count(path: Path) -> int:
    return len(path.read_text(encoding="utf-8").splitlines())


def test_that_a_module_is_short_enough_to_read() -> None:
    lengths = {path.relative_to(PACKAGE).as_posix(): line_count(path) for path in MODULES}
    assert {name: length for name, length in lengths.items() if length > LONGEST_MODULE} == {}
    assert lengths["ui/main_window.py"] <= LONGEST_MAIN_WINDOW


def test_that_half_of_the_modules_fit_on_a_few_pages() -> None:
    assert statistics.median(map(line_count, MODULES)) <= MEDIAN_MODULE


Function = ast.FunctionDef | ast.AsyncFunctionDef


def definitions(body: Sequence[ast.stmt]) -> Iterator[Function | ast.ClassDef]:
    """Functions and classes at any depth; expressions are not searched."""
    for node in body:
        if isinstance(node, Function | ast.ClassDef):
            yield node
        for name in ("body", "orelse", "handlers", "finalbody", "cases"):
            yield from definitions(getattr(node, name, ()))


def body_length(function: Function) -> int:
    """Lines from the first statement after the docstring to the last."""
    described = ast.get_docstring(function, clean=False) and function.body[1:]
    body = function.body[1:] if described else function.body
    return (body[-1].end_lineno or 0) - body[0].lineno + 1


def test_that_nine_functions_of_ten_fit_in_thirty_lines_and_public_classes_have_names_of_their_own() -> None:
    lengths, places = list[int](), defaultdict[str, list[str]](list)
    for path in MODULES:
        for each in definitions(ast.parse(path.read_text(encoding="utf-8")).body):
            if isinstance(each, Function):
                lengths.append(body_length(each))
            elif not each.name.startswith("_"):
                places[each.name].append(f"{path.relative_to(PACKAGE)}, line {each.lineno}")
    assert min(len(lengths), len(places)) > 300
    assert sum(length <= LONG_FUNCTION for length in lengths) >= 0.9 * len(lengths)
    assert {name: where for name, where in places.items() if len(where) > 1} == {}
