"""Each public class name is defined once in the package, so that a name says which class is meant."""

import ast
from collections import defaultdict
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1] / "regolith_studio"


def public_classes():
    """Modules that define a class of each public name, at any depth but inside functions."""
    places = defaultdict(list)
    for path in sorted(PACKAGE.rglob("*.py")):
        module = ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts)
        for node in ast.parse(path.read_text(encoding="utf-8"), str(path)).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                places[node.name].append(f"{module}, line {node.lineno}")
    return places


def test_that_every_public_class_has_a_name_of_its_own():
    places = public_classes()
    assert len(places) > 300, "the package is not where this test looks for it"
    twice = {name: where for name, where in places.items() if len(where) > 1}
    message = "\n".join(f"{name}: {'; '.join(where)}" for name, where in sorted(twice.items()))
    assert not twice, f"rename all but one of these classes:\n{message}"
