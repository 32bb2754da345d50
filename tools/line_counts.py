"""Print the size of the package: ``python tools/line_counts.py``.

Code lines are those without blank lines, comments, docstrings and imports.
"""

import ast
import io
import tokenize
from collections.abc import Iterable
from pathlib import Path
from statistics import median, quantiles

PACKAGE = Path(__file__).resolve().parents[1] / "regolith_studio"
NO_CODE = {
    *(tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE),
    *(tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER),
}


def main() -> None:
    """Print a row for each size."""
    texts = [path.read_text(encoding="utf-8") for path in sorted(PACKAGE.rglob("*.py"))]
    nodes = [list(ast.walk(ast.parse(text))) for text in texts]
    functions = [
        (each.end_lineno or each.lineno) - each.lineno + 1
        for tree in nodes
        for each in tree
        if isinstance(each, ast.FunctionDef | ast.AsyncFunctionDef)
    ]
    code, comments = (sum(column) for column in zip(*map(code_and_comments, texts, nodes), strict=True))
    print(f"modules {len(texts)}")
    print(
        f"lines {sum(len(text.splitlines()) for text in texts):,}, code lines {code:,}, comments {comments:,}"
    )
    print(f"length of functions, median and 90 % {median(functions):g}, {quantiles(functions, n=10)[-1]:g}")


def code_and_comments(text: str, nodes: list[ast.AST]) -> tuple[int, int]:
    """Lines of code, and lines that hold a comment alone, of one module."""
    tokens = list(tokenize.generate_tokens(io.StringIO(text).readline))
    written = lines_of((each.start[0], each.end[0]) for each in tokens if each.type not in NO_CODE)
    comments = {each.start[0] for each in tokens if each.type == tokenize.COMMENT} - written
    no_code = lines_of(
        (each.lineno, each.end_lineno or each.lineno)
        for each in nodes
        if isinstance(each, ast.Import | ast.ImportFrom) or is_bare_string(each)
        if isinstance(each, ast.stmt)
    )
    return len(written - no_code), len(comments)


def lines_of(spans: Iterable[tuple[int, int]]) -> set[int]:
    """Numbers of all lines from the first to the last of each span."""
    return {line for first, last in spans for line in range(first, last + 1)}


def is_bare_string(node: ast.AST) -> bool:
    """True for docstrings, also those below a constant or a field."""
    value = node.value if isinstance(node, ast.Expr) else None
    return isinstance(value, ast.Constant) and isinstance(value.value, str)


if __name__ == "__main__":
    main()
