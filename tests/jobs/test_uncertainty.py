"""The budget of uncertainty of a sample, resumed after a stop, and of a scan."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.stats import binomtest

from benchmarks import uncertainty_coverage
from regolith_studio.cli.entry import run
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.dem.case import ReposeCase
from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.fit_options import FitOptions
from regolith_studio.jobs import repose_jobs, uncertainty
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest
from regolith_studio.jobs.events import Partial, Progress, Steps
from regolith_studio.jobs.repose_jobs import ReposeRequest
from regolith_studio.jobs.uncertainty import UncertaintyRequest, measure_uncertainty, uncertainty_steps
from regolith_studio.jobs.uncertainty_chain import Chain, GrainSample, evaluate_rows
from regolith_studio.steps import result_of
from regolith_studio.studies.figures import repose as figures
from regolith_studio.studies.uncertainty import CONFIDENCE, KEYS, OUTPUTS
from tests.dem.cone_engine import cone_engine, true_angle, write_figure

QUICK = CoarseningRequest(LossWeights.of(volume=1.0), 12, "quadric")
SETTINGS: dict[str, Any] = {"coarsening": QUICK, "n_representatives": 3}
SMALL = UncertaintyRequest(base=4, heaps=0)


def ellipsoids(n: int) -> tuple[Particle, ...]:
    ball, rng = icosphere(2), np.random.default_rng(5)
    axes = 10.0 * np.exp(0.3 * rng.standard_normal((n, 1)) + 0.2 * rng.standard_normal((n, 3)))
    return tuple(Particle(f"e{k}", Mesh(ball.vertices * row, ball.faces)) for k, row in enumerate(axes))


@pytest.fixture(autouse=True)
def _without_exact(monkeypatch: pytest.MonkeyPatch) -> None:
    """The other method than quadric takes seconds for each polyhedron."""
    whole = Chain._coarsening_choices

    def quick(chain: Chain) -> Any:
        return {**whole(chain), "method": (("quadric", "quadric"), ("again", "quadric"))}

    monkeypatch.setattr(Chain, "_coarsening_choices", quick)


def test_that_a_sample_of_too_few_grains_is_refused_with_the_number_that_would_do(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(InputError, match="needs 20 grains or more, 4 more than the 16 that"):
        measure_uncertainty(ellipsoids(16), tmp_path, SMALL, **SETTINGS)
    assert run(["uncertainty", "sample:all", "-o", str(tmp_path / "few"), "--no-heaps"]) == 1
    assert "8 more than the 12 that there are" in capsys.readouterr().err
    with pytest.raises(InputError, match="power of two"):
        UncertaintyRequest(base=12)


@pytest.mark.slow
def test_that_the_budget_of_a_sample_is_resumed_to_the_same_bytes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(uncertainty, "ROWS_A_TASK", 5)
    chain = Chain.of(ellipsoids(24), **SETTINGS)
    budget = result_of(uncertainty_steps(chain, SMALL, tmp_path / "once"))
    found = budget.descriptors
    assert [step.key for step in budget.not_counted] == [
        *("threshold", "splitting", "digitisation", "voxel", "smoothing", "l_max", "model")
    ]
    known = [np.mean([each.mesh.volume for each in ellipsoids(24)]), 1.0]
    assert found.nominal[0] == pytest.approx(known[0], rel=1e-6)
    assert found.nominal[4] == pytest.approx(known[0], rel=1e-6)  # classes have the measured sizes
    assert np.isfinite(found.results).all()
    assert (found.intervals[:, 0] < found.nominal).all()

    steps = uncertainty_steps(chain, replace(SMALL, heaps=2), tmp_path / "twice")  # rows are the same
    partials = 0
    for step in steps:
        partials += isinstance(step, Partial)
        if partials == 3:
            break
    steps.close()
    again = result_of(uncertainty_steps(chain, SMALL, tmp_path / "twice", resume=True))
    assert np.array_equal(again.descriptors.results, found.results)
    for name in ("uncertainty.json", "uncertainty_steps.csv", "uncertainty.svg"):
        assert (tmp_path / "once" / name).read_bytes() == (tmp_path / "twice" / name).read_bytes()
    document = json.loads((tmp_path / "once" / "uncertainty.json").read_text())
    assert document["recipe"]["input_sha256"]
    assert len(document["values"]) == len(OUTPUTS)
    assert {row["step"] for row in document["steps"]} >= {"facets", "representatives", "voxel"}


@pytest.mark.slow
def test_that_grains_are_fitted_once_and_drawn_once_for_rows_of_the_same_particles(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Two tasks of rows that differ in their facets alone, and one of another bootstrap sample."""
    calls: list[str] = []
    for kind, name in ((FitOptions, "fit"), (GrainSample, "drawn")):

        def counted(*given: Any, name: str = name, function: Any = getattr(kind, name)) -> Any:  # noqa: B008
            calls.append(name)
            return function(*given)

        monkeypatch.setattr(kind, name, counted)
    request = replace(QUICK, l_max=4)
    chain = Chain.of(ellipsoids(20), coarsening=request, model="recombined", n_representatives=2)
    steps = list(evaluate_rows(chain, "these", [(-1, {}), (0, {"facets": 1})]))
    assert [str(step.message) for step in steps if isinstance(step, Progress)] == [
        "descriptors of the grains",
        *(f"fits of the grains, {k}/20" for k in range(20)),
        *["representatives and polyhedra"] * 2,
    ]
    again = result_of(evaluate_rows(chain, "these", [(1, {"facets": 2}), (2, {"representatives": 3})]))
    assert calls == ["fit"] * 20 + ["drawn"] * 2
    assert np.isfinite([again["rows"]["1"], again["rows"]["2"]]).all()


def _heaps(key: str, *task: Any) -> Steps:
    """Cones of the friction; those of another engine are a tenth higher."""
    done = yield from cone_engine(key, *task)
    factor = 1.1 if key == "rapier" else 1.0
    heap = replace(done.particles, points=done.particles.points * (1.0, 1.0, factor))
    return replace(done, particles=heap)


@pytest.mark.slow
def test_that_only_the_step_that_moves_the_angle_has_a_share_of_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(repose_jobs, "run_engine", _heaps)
    monkeypatch.setattr(figures, "write_figure", write_figure)
    case = ReposeRequest(ReposeCase(n_particles=600))
    request = UncertaintyRequest(base=4, heaps=3, repose=case)
    budget = measure_uncertainty(ellipsoids(24), tmp_path, request, **SETTINGS)
    angle = budget.angle
    assert angle is not None
    assert [effect.step.key for effect in angle.effects] == [
        *("representatives", "facets", "facets", "method", "kept", "kept"),
        *("engine", "time_step", "evaluation"),
    ]
    effects = {effect.step.key: effect for effect in angle.effects}
    known = true_angle(0.8)
    higher = np.degrees(np.arctan(1.1 * np.tan(np.radians(known)))) - known
    assert effects["engine"].change == pytest.approx(higher, abs=0.6)
    variances = angle.step_variances()
    assert [key for key, variance in variances.items() if variance > 0.01] == ["engine"]
    assert effects["time_step"].change == 0.0  # the same heaps
    assert effects["method"].change == 0.0  # the same polyhedra, whose heaps are not run again
    assert not [each.name for each in tmp_path.iterdir() if each.name.startswith("method")]
    assert angle.variance == pytest.approx(angle.filling_variance + variances["engine"], rel=0.01)
    assert any("rapier" in note.lower() for note in angle.notes)
    document = json.loads((tmp_path / "uncertainty.json").read_text())
    shares = {row["step"]: row["share"] for row in document["steps"] if row["quantity"] == "angle_of_repose"}
    assert shares["engine"] > 0.5
    assert shares["facets"] is None
    assert (tmp_path / "repose_study.csv").is_file()


@pytest.mark.slow
def test_that_intervals_of_digitised_grains_hold_the_truth_as_often_as_they_say(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A small version of the benchmark: 27 grains in one scan, 100 trials, stated errors and grains.

    Errors of AR scatter by 7 % a grain, so that the mean over 27 of them is not that of all.
    """
    monkeypatch.setattr(uncertainty_coverage, "VARIED", ("digitisation", "representatives"))
    scans = uncertainty_coverage.digitised_scans(1, 3)
    assert scans.n_grains > 22
    ends = uncertainty_coverage.intervals_of_trials(scans, 100, 3)
    counts = uncertainty_coverage.covered(ends, scans.truth)
    for key, count in zip(KEYS[:3], counts, strict=False):
        assert binomtest(count, 100, CONFIDENCE).pvalue > 0.025, (key, counts)
