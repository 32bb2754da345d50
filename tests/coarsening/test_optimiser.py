"""The one descent: multipliers of a step, derivatives, and the same result on every processor."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest
from llvmlite.binding import get_host_cpu_features
from scipy.optimize import minimize

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.core.polyhedron_measures import tangents_of
from regolith_studio.coarsening.optimiser.body import (
    BODY_VOLUME,
    N_BOXES,
    SURFACE,
    Prices,
    body_scratch,
    cube_root_near_one,
    empty_body,
    fill_body,
)
from regolith_studio.coarsening.optimiser.descent import move
from regolith_studio.coarsening.optimiser.followed_boxes import box_memory, check_boxes
from regolith_studio.coarsening.optimiser.quadratic_model import fill_multipliers, solve_in_place
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from tests.coarsening.conftest import bumpy

WANTED = np.array([1.0, 0.9, 0.8, 1.4, 1.75, 1.0])


@pytest.mark.slow  # the solver alone is compiled for it
@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("share", [1.0, 0.1])
def test_that_multipliers_are_those_that_scipy_finds_for_the_dual(seed: int, share: float) -> None:
    rng = np.random.default_rng(seed)
    rows = rng.normal(size=(6, 20))
    products, slopes, residuals = rows @ rows.T, rng.normal(size=6) * 5.0, rng.normal(size=6)
    low, high = -rng.uniform(0.1, 1.0, 6), rng.uniform(0.1, 1.0, 6)
    found = np.zeros(6)
    fill_multipliers(products, slopes, residuals, low, high, share, np.empty((6, 7)), found)
    dual = minimize(
        lambda x: share / 2 * x @ products @ x + x @ (share * slopes - residuals),
        np.zeros(6),
        jac=lambda x: share * products @ x + share * slopes - residuals,
        bounds=list(zip(low, high, strict=True)),
        method="L-BFGS-B",
        options={"ftol": 1e-15, "gtol": 1e-12, "maxiter": 10_000},
    )
    assert found == pytest.approx(dual.x, abs=1e-5)


def test_that_a_singular_system_is_solved_where_it_can_be() -> None:
    rows = np.array([[1.0, 2.0, 0.0], [0.0, 1.0, 1.0], [1.0, 3.0, 1.0]])  # the last is the sum of the others
    matrix = rows @ rows.T
    right = matrix @ np.array([0.3, -0.2, 0.5])
    system = np.column_stack([matrix, right])
    assert solve_in_place(system)
    assert matrix @ system[:, 3] == pytest.approx(right, abs=1e-9)


@pytest.mark.parametrize("x", [0.01, 0.3, 0.999, 1.0, 1.7, 40.0])
def test_that_the_cube_root_is_that_of_numpy(x: float) -> None:
    assert cube_root_near_one(x) == pytest.approx(np.cbrt(x), rel=4e-16)


def test_that_rows_are_the_derivatives_of_the_terms() -> None:
    rng, n = np.random.default_rng(2), 16
    normals = rng.normal(size=(n, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    here, there, scratch = empty_body(n), empty_body(n), body_scratch(n)
    here.normals[:], here.offsets[:], here.tangents[:] = (
        normals,
        rng.uniform(0.5, 0.7, n),
        tangents_of(normals),
    )
    bound = np.full(6, 1.0)
    prices = Prices(WANTED, -bound, bound, 1.0)
    assert fill_body(here, WANTED, True, scratch)
    assert check_boxes(here, prices, np.eye(3), box_memory(n, 2 * n), scratch)
    here.counts[N_BOXES] = 1
    step = rng.normal(size=3 * n)
    ahead, behind = (
        (there.residuals.copy(), there.numbers.copy())
        for sign in (1.0, -1.0)
        if move(here, there, sign * 1e-6 * step, prices, True, scratch)
    )
    assert here.rows @ step == pytest.approx((ahead[0] - behind[0]) / 2e-6, rel=1e-5, abs=1e-6)
    for at in (BODY_VOLUME, SURFACE):
        assert here.numbers[at] == pytest.approx((ahead[1][at] + behind[1][at]) / 2, rel=1e-9)


NEEDED = {"Nehalem": "sse4.2", "Sandybridge": "avx", "Haswell": "avx2", "SkylakeX": "avx512f"}
HERE = get_host_cpu_features()
PROCESSORS = (
    {},
    *({"OPENBLAS_CORETYPE": name} for name, needed in NEEDED.items() if HERE.get(needed)),
    {"NUMBA_CPU_NAME": "generic"},
)
"""Those of which this machine has the instructions; the process would end with the first that is missing."""
CHILD = """
import json, sys
from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.readers.particles import sample_particles
names = ("agglutinate-2", "bead-2", "angular-3")
meshes = {each.name: each.mesh for each in sample_particles()}
found = {name: coarsen(meshes[name], 20) for name in names}
for name, joint in (("agglutinate-1", "overlap"), ("agglutinate-2", "touch")):
    found[name + joint] = coarsen(meshes[name], 40, "compound", settings={"joint": joint})
print(json.dumps({name: [each.jaccard_distance, each.n_facets] for name, each in found.items()}))
"""


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_that_results_do_not_depend_on_the_processor() -> None:
    results = []
    for settings in PROCESSORS:
        child = subprocess.run(
            [sys.executable, "-c", CHILD],
            env=os.environ | settings,
            capture_output=True,
            text=True,
            check=True,
        )
        results.append(json.loads(child.stdout))
    for name, (distance, n_facets) in results[0].items():
        for other in results[1:]:
            assert other[name][0] == pytest.approx(distance, abs=1e-9)
            assert other[name][1] == n_facets


def test_that_a_price_leaves_a_descriptor_off_where_overlap_is_worth_more() -> None:
    rough = bumpy(3, roughness=0.3)
    cheap = LossWeights.of(jaccard_distance=1.0, volume=1.0, sphericity=0.01).keeping(["volume"])
    dear = LossWeights.of(jaccard_distance=1.0, volume=1.0, sphericity=100.0).keeping(["volume"])
    loose, tight = coarsen(rough, 20, weights=cheap), coarsen(rough, 20, weights=dear)
    assert loose.errors["sphericity"] > 1e-3 > 1e-6 >= tight.errors["sphericity"]
    assert loose.jaccard_distance < tight.jaccard_distance
    assert max(loose.errors["volume"], tight.errors["volume"]) <= 1e-6


def test_that_a_convex_polyhedron_with_few_facets_is_its_own_result() -> None:
    octahedron = Mesh(np.vstack([np.eye(3), -np.eye(3)]), np.empty((0, 3), dtype=np.int64)).hull
    for n_facets in (8, 12, 100):
        found = coarsen(octahedron, n_facets)
        assert found.jaccard_distance <= 1e-9
        assert found.n_facets == 8
        assert (found.reason is None) == (n_facets == 8)


def test_that_much_overlap_lost_to_descriptors_is_a_warning_with_both_distances() -> None:
    ball = icosphere(3)
    noise = np.random.default_rng(1).normal(size=(len(ball.vertices), 1))
    found = coarsen(Mesh(ball.vertices * (1.0 + 0.06 * noise) * (1.3, 1.0, 0.8), ball.faces), 20)
    assert found.free_jaccard_distance is not None
    assert found.jaccard_distance > 1.5 * found.free_jaccard_distance
    assert found.warning is not None
    assert f"the Jaccard distance is {found.jaccard_distance:.3f}" in found.warning
    assert f"it would be {found.free_jaccard_distance:.3f}" in found.warning
