"""Angle of repose over facets, what is kept of the particles, convexity and friction: docs/repose_results.md.

    python -m benchmarks.shape_heaps RUNS RESULT.json [SEEDS] [PARTICLES] [CASES] [ENGINE] [WORKERS]

The twelve shipped particles; by default 20 seeds, 1,000 particles, all shapes (names of cases with commas
between; after @ stands another friction than 0.8), Rapier, one heap at a time. Datasets and heaps that are in
the folder RUNS already are kept. RESULT has a row a heap, and the differences of :data:`QUESTIONS` on the
same seeds, of angles and of solid fractions of the fillings, with the scatter of the heaps of all cases:
number of pairs, difference, ends of its interval of 95 %, and how many pairs would decide one whose interval
holds 0, if it is as large as it seems.
"""

import json
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.dem.case import ReposeCase
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest
from regolith_studio.jobs.dataset_jobs import DatasetOptions, build_dataset_folder
from regolith_studio.jobs.events import Partial
from regolith_studio.jobs.repose_jobs import ReposeRequest
from regolith_studio.jobs.repose_study import ReposeVariant, study_repose
from regolith_studio.readers.particles import sample_particles
from regolith_studio.steps import result_of
from regolith_studio.studies.repose import ReposeStudy, ReposeStudyRun
from regolith_studio.studies.uncertainty import AngleBudget, ChainStep

ALL, FRICTION = LossWeights.from_preset("all"), 0.8
TWENTY = CoarseningRequest(ALL, 20)


def keeping(*keys: str) -> CoarseningRequest:
    """Twenty facets with the largest overlap that these descriptors leave."""
    return replace(TWENTY, weights=LossWeights.of(jaccard_distance=1.0, **dict.fromkeys(keys, 1.0)))


SHAPES = {
    **{str(n): CoarseningRequest(ALL, n) for n in (8, 12, 20, 40, 60)},
    "20 by quadrics": replace(TWENTY, method="quadric", weights=ALL.keeping(None)),
    "20 with overlap": keeping(),
    "20 with V": keeping("volume"),
    "20 with V and AR": keeping("volume", "aspect_ratio"),
    "20 as compounds": replace(TWENTY, method="compound"),
}
QUESTIONS = {
    "V kept, not all": ("20 with V", "20"),
    "V and AR kept, not all": ("20 with V and AR", "20"),
    "V and AR kept, not V": ("20 with V and AR", "20 with V"),
    "compounds, not convex": ("20 as compounds", "20"),
    "none kept, not all": ("20 with overlap", "20"),
    "8 facets, not 20": ("8", "20"),
    "8 facets, not 20, friction 0.4": ("8@0.4", "20@0.4"),
    "friction 0.8, not 0.4": ("20", "20@0.4"),
    "friction 0.8, not 0.4, 8 facets": ("8", "8@0.4"),
}
"""What is changed and from what, where both have been run."""


def main(
    runs: Path, result: Path, n_seeds: int, n_particles: int, chosen: list[str], engine: str, workers: int
) -> None:
    """Make what is missing, all cases of the first seed first, and write what is known after each heap."""
    variants = []
    for seed in range(1, n_seeds + 1):
        for name in chosen:
            shapes, _, friction = name.partition("@")
            case = ReposeCase(n_particles=n_particles, seed=seed)
            contact = replace(case.contact, static_friction=float(friction or FRICTION))
            request = ReposeRequest(replace(case, contact=contact), engine)
            variants.append(ReposeVariant("case", name, dataset(runs, shapes), request))
    for step in study_repose(variants, runs, executor=workers):
        if isinstance(step, Partial):
            study: ReposeStudy = step.value
            rows = [row(run) for run in study.runs]
            table = differences(rows)
            fillings = {"rows": differences(rows, "solid_fraction", 4)}
            content = {"engine": engine, "runs": rows, "differences": {"rows": table}, "fillings": fillings}
            result.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    for name, numbers in table.items():
        print(name, numbers)


def dataset(runs: Path, name: str) -> Path:
    """The dataset of these shapes, made where it is not there."""
    folder = runs / "datasets" / name
    if not folder.is_dir():
        result_of(build_dataset_folder(sample_particles(), SHAPES[name], folder, DatasetOptions()))
    return folder


def row(run: ReposeStudyRun) -> dict[str, Any]:
    """The numbers of one heap."""
    measured = run.document["measurement"] or {}
    packing, checks = (run.document["packing"] or {}).get("heap") or {}, run.document["checks"] or {}
    shapes, _, friction = str(run.value).partition("@")
    refusal = measured.get("reason") or run.document["problem"]
    return {
        "coarsening": shapes,
        "friction": float(friction or FRICTION),
        "particles": run.document["case"]["n_particles"],
        "seed": run.seed,
        "angle_deg": rounded(run.angle, 2),
        "interval_deg": [rounded(each, 2) for each in measured.get("interval_deg") or []],
        "solid_fraction": rounded(checks.get("solid_fraction"), 4),
        "coordination_number": rounded(packing.get("coordination_number"), 3),
        "problems": [*checks.get("problems", ()), *([refusal] if refusal else [])],
    }


def differences(
    heaps: Sequence[dict[str, Any]], key: str = "angle_deg", digits: int = 2
) -> dict[str, list[float | int | None]]:
    """By question: pairs of heaps, difference, ends of its interval, pairs that would decide."""
    values: dict[str, dict[int, float]] = {}
    for heap in heaps:
        friction = heap.get("friction", FRICTION)
        case = heap["coarsening"] + (f"@{friction}" if friction != FRICTION else "")
        value = heap[key]
        values.setdefault(case, {})[heap["seed"]] = np.nan if value is None else value
    seeds = sorted(set().union(*values.values()))
    table = {case: np.array([of.get(seed, np.nan) for seed in seeds]) for case, of in values.items()}
    rows: dict[str, list[float | int | None]] = {}
    for question, (changed, base) in QUESTIONS.items():
        step = ChainStep(question, "", (base, *(case for case in table if case != base)))
        if {changed, base} <= set(table):
            budget = AngleBudget((step,), table[base], {(question, case): table[case] for case in table})
            for found in (effect for effect in budget.effects if effect.level == changed):
                numbers = [round(each, digits) for each in (found.change, found.low, found.high)]
                rows[question] = [found.n, *numbers, found.heaps_needed]
    return rows


def rounded(value: float | None, digits: int) -> float | None:
    """A number of a row, where there is one."""
    return None if value is None else round(value, digits)


if __name__ == "__main__":
    given = dict(enumerate(sys.argv))
    names = given[5].split(",") if given.get(5) else list(SHAPES)
    numbers = int(given.get(3, 20)), int(given.get(4, 1000))
    main(Path(given[1]), Path(given[2]), *numbers, names, given.get(6, "rapier"), int(given.get(7, 1)))
