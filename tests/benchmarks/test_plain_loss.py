"""The plain loss is the paper's, however it is computed; and the table of quality counts what it says."""

from typing import Any

import numpy as np
import pytest

from benchmarks.coarsening_quality import public_errors, quality
from benchmarks.plain import PlainLoss, plain_annealing
from regolith_studio.coarsening.loss import LossFunction
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere

WAYS: list[dict[str, Any]] = [{}, {"lean": True}, {"exact": True}, {"lean": True, "exact": True}]


def brick(a: float, b: float, c: float) -> tuple[np.ndarray, np.ndarray]:
    """Foot points of the sides, and the same as vertices and faces."""
    solid = HalfSpaces(np.vstack([np.eye(3), -np.eye(3)]), np.array([a, b, c, a, b, c]))
    return solid.points, solid


@pytest.mark.parametrize("how", WAYS)
def test_that_every_way_gives_the_loss_of_a_brick_in_a_brick(how: dict[str, Any]) -> None:
    _, outer = brick(3.0, 2.0, 1.0)
    mesh = ConvexPolyhedron.from_half_spaces(outer).mesh
    points, _ = brick(3.0, 2.0, 0.5)
    # V and CH are half; Dmin is half; AR twice; S from volume and area of both
    sphericity = (24 / 48) ** (2 / 3) * 88 / 68
    wanted = 0.5 + 0.5 + 0.5 + 0.0 + 1.0 + abs(sphericity - 1)
    loss = PlainLoss(mesh.vertices, mesh.faces, **how)
    assert loss(points) == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize(
    ("overlap", "within"), [("boolean", 1e-6), pytest.param("points", 0.03, marks=pytest.mark.slow)]
)
def test_that_the_overlap_is_that_of_the_solids(overlap: str, within: float) -> None:
    if overlap == "boolean":
        pytest.importorskip("manifold3d")
    ball = icosphere(3)
    points, cube = brick(0.7, 0.7, 0.7)
    plain = PlainLoss(ball.vertices, ball.faces, overlap=overlap)
    target = Target.of(Mesh(ball.vertices, ball.faces))
    inside = target.in_unit_frame(cube)
    alone = PlainLoss(ball.vertices, ball.faces)(points)
    assert plain(points) - alone == pytest.approx(target.jaccard_distance(inside), abs=max(within, 5e-4))


def test_that_ours_and_the_plain_exact_one_agree() -> None:
    ball = icosphere(3)
    mesh = Mesh(ball.vertices * (1.5, 1.2, 0.8), ball.faces)
    target = Target.of(mesh)
    planes = HalfSpaces(icosphere(0).vertices, np.full(12, 0.6) * np.linspace(0.9, 1.1, 12))
    ours = LossFunction(target, LossWeights.from_preset("descriptors")).value(planes.normals, planes.offsets)
    plain = PlainLoss(target.mesh.vertices, target.mesh.faces, exact=True)
    assert plain(planes.points) == pytest.approx(ours, rel=0.03)  # the particle's own box is the heuristic


def test_that_the_plain_annealing_finds_a_smaller_loss() -> None:
    ball = icosphere(2)
    points, _ = brick(0.3, 1.0, 2.0)
    loss = PlainLoss(ball.vertices, ball.faces, lean=True)
    assert loss(plain_annealing(loss, points, 0)) < loss(points)


def test_that_quality_counts_what_is_met_and_what_is_explained() -> None:
    sphere = icosphere(3)
    x, y, z = sphere.vertices.T
    stone = Mesh(
        sphere.vertices * (1 + 0.2 * np.sin(5 * x + 1) * np.cos(4 * y) + 0.1 * np.sin(6 * z))[:, None],
        sphere.faces,
    )
    targets = [Target.of(stone), Target.of(Mesh(sphere.vertices, sphere.faces))]
    found = quality("two", targets, 1.0, "fast", 20, public_errors)
    assert (found.particles, found.met, found.explained, found.whole) == (2, 1, 1, 2)
    assert max(found.largest.values()) < 1e-6
