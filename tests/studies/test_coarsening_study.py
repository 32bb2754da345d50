"""Fig. 8 for small samples."""

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.studies.coarsening import (
    COLUMNS,
    CoarseningStudy,
    coarsening_study,
    particle_table,
    rmsre_table,
)
from regolith_studio.studies.figures.coarsening import coarsening_figure, write_coarsening_study
from regolith_studio.studies.loss_variants import (
    LossVariant,
    facet_count_variants,
    paper_variants,
    sensitivity_variants,
)
from tests.steps import played

ROWS = (
    LossVariant("quadric", LossWeights.of(), "quadric", 12),
    LossVariant("all", LossWeights.from_preset("all"), "exact", 12, (("retries", 3),)),
)


def egg(stretch: float) -> Mesh:
    sphere = icosphere(3)
    x, y, z = sphere.vertices.T
    bumps = 1.0 + 0.2 * np.sin(5 * x + 1) * np.cos(4 * y) + 0.1 * np.sin(6 * z)
    return Mesh(sphere.vertices * bumps[:, None] * (stretch, 1.0, 0.7), sphere.faces)


@pytest.fixture(scope="module")
def study() -> CoarseningStudy:
    particles = [Particle(f"egg {s}", egg(s)) for s in (1.2, 1.5)]
    particles.insert(1, Particle("open", Mesh(egg(1.0).vertices, egg(1.0).faces[5:])))
    return played(coarsening_study(particles, ROWS))[1]


def test_that_a_grain_has_the_same_errors_wherever_it_stands_in_a_sample() -> None:
    rows = (LossVariant("all", LossWeights.from_preset("all"), "annealing", 12, (("iterations", 10),)),)
    particles = [Particle(f"egg {s}", egg(s)) for s in (1.2, 1.5, 1.2)]
    errors = played(coarsening_study(particles, rows))[1].errors
    assert np.array_equal(errors[0], errors[2])
    assert not np.array_equal(errors[0], errors[1])


def test_that_the_rmsre_is_that_of_equation_10(study: CoarseningStudy) -> None:
    by_hand = np.sqrt((study.errors[0] ** 2 + study.errors[1] ** 2) / 2)
    assert study.rmsre[:, :-1] == pytest.approx(by_hand[:, :-1])
    assert study.rmsre[:, -1] == pytest.approx(study.errors[:, :, -1].mean(axis=0))


def test_that_the_exact_method_beats_the_baseline_on_what_it_keeps(study: CoarseningStudy) -> None:
    kept = [COLUMNS.index(key) for key in ("volume", "sphericity", "min_diameter", "max_diameter")]
    assert (study.rmsre[1, kept] < 1e-6).all()
    assert (study.rmsre[0, kept] > 1e-3).all()


def test_that_a_bad_particle_is_listed_and_stops_nothing(study: CoarseningStudy) -> None:
    assert study.names == ("egg 1.2", "egg 1.5")
    assert study.failures[0][0] == "open"
    assert "not closed" in study.failures[0][1]


@pytest.mark.parametrize("box_metric", ["exact", "trimesh"])
def test_that_the_quadric_row_is_measured_on_the_polyhedron_that_is_shown(box_metric: str) -> None:
    rows = (LossVariant("start", LossWeights.of(), "exact", 12), ROWS[0])
    study = played(coarsening_study([Particle("egg", egg(1.5))], rows, box_metric=box_metric))[1]
    shown = coarsen(egg(1.5), 12, "quadric")
    volume = COLUMNS.index("volume")
    hull = ConvexHull(shown.polyhedron.vertices)
    expected = abs(hull.volume / egg(1.5).volume - 1)
    assert study.errors[0, :, volume] == pytest.approx(expected, abs=1e-9)
    if box_metric == "exact":
        assert study.errors[0, 0] == pytest.approx(
            [*map(shown.errors.get, LOSS_KEYS), shown.jaccard_distance]
        )
    assert [line[2] for line in particle_table(study).rows] == ["quadric", "quadric"]


def test_that_the_band_holds_the_value(study: CoarseningStudy) -> None:
    low, high = study.bands
    assert (low <= study.rmsre + 1e-12).all()
    assert (study.rmsre <= high + 1e-12).all()


def test_that_tables_and_figures_are_written(study: CoarseningStudy, tmp_path: Path) -> None:
    table = rmsre_table(study)
    assert len(table.rows) == len(ROWS) * len(COLUMNS)
    particles = particle_table(study)
    assert np.allclose([row[4:] for row in particles.rows], 100 * study.errors.reshape(4, -1))
    assert {column.unit for column in particles.columns[4:]} == {"%"}
    paths = write_coarsening_study(study, tmp_path)
    assert {path.name for path in paths} >= {"coarsening_rmsre.csv", "coarsening_rmsre.png"}
    assert all(path.stat().st_size > 0 for path in paths)


def test_that_symbols_have_real_subscripts_in_figures(study: CoarseningStudy) -> None:
    marks = [label.get_text() for label in coarsening_figure(study).axes[0].get_xticklabels()]
    assert r"D$_\mathrm{min}$" in marks
    assert not any(re.search(r"\w_", mark) for mark in marks)
    assert marks[-1] == "J"


def test_that_the_rows_are_those_of_the_figure() -> None:
    assert len(paper_variants()) == 6
    assert paper_variants()[0].is_baseline
    assert [
        row.n_facets for row in facet_count_variants(LossVariant("", LossWeights.from_preset("all")), (8, 12))
    ] == [8, 12]
    changed = sensitivity_variants(
        LossVariant("", LossWeights.of(volume=1, sphericity=2), "annealing"), (3.0,)
    )
    assert [row.weights["sphericity"] for row in changed] == [2, 2, 6]


def test_that_an_empty_study_is_refused() -> None:
    with pytest.raises(InputError, match="at least one particle"):
        next(coarsening_study([], ROWS))
