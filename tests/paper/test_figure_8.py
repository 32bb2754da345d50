"""Figure 8: what each loss does to the descriptors of particles with 20 faces."""

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.geometry.particle import Particle
from regolith_studio.io.tables import rows_as_text
from regolith_studio.readers.particles import read_mesh
from regolith_studio.studies.coarsening import (
    COLUMNS,
    CoarseningStudy,
    coarsening_study,
    rmsre_table,
)
from regolith_studio.studies.loss_variants import paper_variants

pytestmark = [pytest.mark.slow, pytest.mark.real_data]
N_PARTICLES = 12


def study_of(folder: Path, method: str, box_metric: str = "exact") -> CoarseningStudy:
    particles = [
        Particle(path.stem, read_mesh(path).mesh) for path in sorted(folder.glob("*.stl"))[:N_PARTICLES]
    ]
    steps = coarsening_study(particles, paper_variants(method), box_metric=box_metric)
    while True:
        try:
            next(steps)
        except StopIteration as end:
            study: CoarseningStudy = end.value
            sys.stdout.write("\n".join(map(str, rows_as_text(rmsre_table(study)))) + "\n")
            return study


@pytest.fixture(scope="module")
def exact(real_data: Callable[[str], Path]) -> CoarseningStudy:
    return study_of(real_data("cement140/smooth"), "exact")


def row(study: CoarseningStudy, start: str) -> np.ndarray:
    labels = [each.label for each in study.rows]
    return study.rmsre[next(i for i, label in enumerate(labels) if label.startswith(start))]


def test_that_the_exact_method_meets_all_but_the_hull(exact: CoarseningStudy) -> None:
    errors = row(exact, "All descriptors and overlap")
    kept = [k for k, key in enumerate(COLUMNS) if key not in ("convex_hull_volume", "jaccard_distance")]
    assert errors[kept].max() < 1e-6


def test_that_optimising_for_overlap_alone_fits_the_descriptors_poorly(exact: CoarseningStudy) -> None:
    overlap, everything = row(exact, "Overlap only"), row(exact, "All descriptors and overlap")
    assert overlap[-1] < everything[-1]
    assert overlap[COLUMNS.index("min_diameter")] > 0.02


def test_that_the_papers_annealing_brings_the_hull_nearer_than_quadric_decimation(
    real_data: Callable[[str], Path],
) -> None:
    study = study_of(real_data("cement140/smooth"), "annealing")
    quadric, descriptors = row(study, "Quadric"), row(study, "All descriptors")
    assert descriptors[COLUMNS.index("convex_hull_volume")] < quadric[COLUMNS.index("convex_hull_volume")]
