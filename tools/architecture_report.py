"""Measure the size of the package and the length of three walks through it.

    python tools/architecture_report.py            the table of docs/architecture.md
    python tools/architecture_report.py --sizes    the sizes alone, without running the program

Code lines are those without blank lines, comments, docstrings and imports. A walk is followed by a profiler
in the thread that waits for the result: it counts the modules and functions of the package that run between
the user's act and its result.
"""

import argparse
import ast
import io
import os
import sys
import tempfile
import time
import tokenize
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from statistics import median, quantiles
from types import FrameType
from typing import Any

import regolith_studio
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.io.stl import stl_bytes

PACKAGE = Path(regolith_studio.__file__).resolve().parent
NO_CODE = {
    *(tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE),
    *(tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER),
}
MAX_WAIT = 900.0
"""Seconds after which a window that still computes, or compiles, is given up."""
AFTER_PICTURE = 0.3
"""Seconds for which plots and tables may follow the new picture; they are throttled to 0.15."""


@dataclass(frozen=True)
class SourceFile:
    """Line counts of one module.

    Parameters
    ----------
    lines, code, imports, comments
        All lines; code without docstrings and imports; imports; comments that stand alone.
    function_lengths
        Lines of each function, with signature and docstring.
    imported
        Dotted names that it imports.
    """

    name: str
    lines: int
    code: int
    imports: int
    comments: int
    function_lengths: tuple[int, ...]
    imported: frozenset[str]


def read_source(path: Path) -> SourceFile:
    """Count the lines of a module by kind."""
    text = path.read_text(encoding="utf-8")
    tokens = list(tokenize.generate_tokens(io.StringIO(text).readline))
    written = {
        line for each in tokens if each.type not in NO_CODE for line in range(each.start[0], each.end[0] + 1)
    }
    comments = {each.start[0] for each in tokens if each.type == tokenize.COMMENT} - written
    nodes = list(ast.walk(ast.parse(text)))
    imports = _covered(each for each in nodes if isinstance(each, ast.Import | ast.ImportFrom))
    docstrings = _covered(each for each in nodes if _is_bare_string(each))
    functions = [each for each in nodes if isinstance(each, ast.FunctionDef | ast.AsyncFunctionDef)]
    return SourceFile(
        _module_name(path),
        len(text.splitlines()),
        len(written - imports - docstrings),
        len(imports),
        len(comments),
        tuple((each.end_lineno or each.lineno) - each.lineno + 1 for each in functions),
        frozenset(name for each in nodes for name in _imported_names(each)),
    )


def _module_name(path: Path) -> str:
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def _covered(nodes: Iterable[ast.stmt | ast.AST]) -> set[int]:
    """Numbers of all lines of some statements."""
    return {
        line
        for each in nodes
        if isinstance(each, ast.stmt)
        for line in range(each.lineno, (each.end_lineno or each.lineno) + 1)
    }


def _is_bare_string(node: ast.AST) -> bool:
    """True for docstrings, also those below a constant or a field."""
    value = node.value if isinstance(node, ast.Expr) else None
    return isinstance(value, ast.Constant) and isinstance(value.value, str)


def _imported_names(node: ast.AST) -> Iterator[str]:
    if isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
        yield node.module
        yield from (f"{node.module}.{each.name}" for each in node.names)
    elif isinstance(node, ast.Import):
        yield from (each.name for each in node.names)


def size_rows(sources: list[SourceFile]) -> list[tuple[str, str]]:
    """Names and values of the sizes."""
    names = {each.name for each in sources}
    importers = Counter(name for each in sources for name in each.imported & names)
    lines, code, imports, comments = (
        sum(getattr(each, kind) for each in sources) for kind in ("lines", "code", "imports", "comments")
    )
    lengths = [length for each in sources for length in each.function_lengths]
    return [
        ("modules", f"{len(sources)}"),
        ("lines", f"{lines:,}"),
        ("code lines", f"{code:,}"),
        ("imports, share of lines", f"{imports / lines:.1%}"),
        ("comments, lines and share", f"{comments:,}, {comments / lines:.1%}"),
        ("length of functions, median and 90 %", f"{median(lengths):g}, {quantiles(lengths, n=10)[-1]:g}"),
        ("modules with a single importer", f"{sum(importers[name] == 1 for name in names)}"),
    ]


class Walk:
    """The modules and functions of the package that run in this thread."""

    def __init__(self) -> None:
        self._functions: set[tuple[str, str]] = set()

    def _count(self, frame: FrameType, event: str, _argument: Any) -> None:
        code = frame.f_code
        if event == "call" and code.co_filename.startswith(str(PACKAGE)) and code.co_name != "<module>":
            self._functions.add((code.co_filename, code.co_qualname))

    @contextmanager
    def followed(self) -> Iterator[None]:
        """Count what runs within."""
        sys.setprofile(self._count)
        try:
            yield
        finally:
            sys.setprofile(None)

    def __str__(self) -> str:
        modules = {module for module, _ in self._functions}
        return f"{len(modules)} modules, {len(self._functions)} functions"


def follow_command(*arguments: str) -> Walk:
    """Walk of a command; a run before it imports and compiles. ``{}`` in an argument is the run's number."""
    from regolith_studio.cli.entry import run

    walk = Walk()
    with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()) as errors:
        for number, each in enumerate((Walk(), walk)):
            with each.followed():
                code = run([argument.format(number) for argument in arguments])
            if code:
                raise RuntimeError(errors.getvalue())
    return walk


def follow_slider() -> Walk:
    """Walk from a move of the slider l_max to the new picture, in the thread of the window."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    from regolith_studio.session.preferences import Preferences
    from regolith_studio.ui.app import open_window
    from regolith_studio.ui.startup import make_application

    app = make_application(["report"])
    window = open_window(views="image", preferences=Preferences())
    window.show()
    session, surfaces, walk = window.session, [], Walk()
    session.events.surface.connect(lambda: surfaces.append(session.results.surface))
    _wait(app, lambda: session.results.coarsened is not None and not session.tasks)
    for l_max, each in ((6, Walk()), (8, walk)):
        surfaces.clear()
        with each.followed():
            session.choose(l_max=l_max)
            _wait(app, lambda: any(surface is not None for surface in surfaces))
            end = time.monotonic() + AFTER_PICTURE
            _wait(app, lambda: time.monotonic() > end)  # noqa: B023 (called at once)
        _wait(app, lambda: not session.tasks)
    window.close()
    return walk


def _wait(app: Any, condition: Callable[[], bool]) -> None:
    end = time.monotonic() + MAX_WAIT
    while not condition():
        app.processEvents()
        if time.monotonic() > end:
            raise RuntimeError("The window did not finish its work.")


def walk_rows() -> list[tuple[str, str]]:
    """Names and lengths of the three walks."""
    sphere = icosphere(4)
    corners = (sphere.vertices * (3.0, 2.0, 1.5))[sphere.faces]
    with tempfile.TemporaryDirectory() as folder:
        os.environ["REGOLITH_STUDIO_CONFIG"] = folder
        mesh = Path(folder) / "ellipsoid.stl"
        mesh.write_bytes(stl_bytes(corners, "ellipsoid"))
        return [
            ("walk from a slider to its picture", str(follow_slider())),
            ("walk from a file to its descriptors", str(follow_command("describe", str(mesh)))),
            (
                "walk from a command to a polyhedron",
                str(follow_command("coarsen", str(mesh), "-o", f"{folder}/out{{}}", "--jobs", "1")),
            ),
        ]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--sizes", action="store_true", help="leave the walks out")
    rows = size_rows([read_source(path) for path in sorted(PACKAGE.rglob("*.py"))])
    if not parser.parse_args().sizes:
        rows += walk_rows()
    for name, value in rows:
        print(f"| {name} | {value} |")


if __name__ == "__main__":
    main()
