"""The table of engines: what each represents, and what not."""

from dataclasses import asdict
from typing import Any

from regolith_studio.dem.engines import ENGINES

HEADINGS = {
    "shape": "Shape",
    "normal": "Normal force",
    "tangential": "Tangential force",
    "cohesion": "Cohesion",
    "rolling": "Rolling",
    "coarse_graining": "Coarse graining",
    "missing": "Not represented",
}


def engine_rows() -> list[dict[str, Any]]:
    """One dictionary an engine: key, label, licence, whether it is here, and what it represents."""
    rows = []
    for engine in ENGINES.values():
        found = engine.find()
        rows.append(
            {
                "key": engine.key,
                "label": engine.label,
                "licence": engine.licence,
                "version": found.version,
                "problem": found.problem,
                **asdict(engine.represents),
            }
        )
    return rows
