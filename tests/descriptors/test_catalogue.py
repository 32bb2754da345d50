"""Every descriptor: its value for known solids, how it scales, and that rotation leaves it alone."""

import numpy as np
import pytest
from scipy.integrate import dblquad

from regolith_studio.descriptors.catalogue import (
    CATALOGUE,
    DEFAULT_KEYS,
    LOSS_KEYS,
    ShapeCache,
    mean_incidence,
)
from regolith_studio.geometry import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from tests.geometry.solids import cuboid, random_polyhedron, rotation, rough_stone

SOLIDS = {
    "stone": rough_stone(3, level=3),
    "cut stone": rough_stone(8, level=2, roughness=0.4),
    "polyhedron": random_polyhedron(5, n_facets=16, stretch=0.4),
}


def value(key: str, mesh: Mesh) -> float:
    return CATALOGUE[key].compute(ShapeCache(mesh))


@pytest.mark.parametrize("scale", [1e-9, 1e-3, 1e9])
@pytest.mark.parametrize("name", SOLIDS)
@pytest.mark.parametrize("key", CATALOGUE)
def test_that_a_descriptor_scales_by_its_dimension_and_ignores_rotation(
    key: str, name: str, scale: float
) -> None:
    solid = SOLIDS[name]
    moved = solid.moved(rotation=rotation(len(key)), shift=(0.7, -0.4, 0.2), scale=scale)
    wanted = value(key, solid) * scale ** CATALOGUE[key].dimension
    assert value(key, moved) == pytest.approx(wanted, rel=1e-6)


A, B, C = 3.0, 2.0, 1.0
INCIDENCE = sum(
    2 * dblquad(lambda x, y, h=h: h / np.sqrt(h * h + x * x + y * y), -p, p, -q, q)[0]
    for h, p, q in ((C / 2, A / 2, B / 2), (B / 2, A / 2, C / 2), (A / 2, B / 2, C / 2))
)
CUBOID = {
    "volume": 6.0,
    "equivalent_radius": (18.0 / (4.0 * np.pi)) ** (1 / 3),
    "surface_area": 22.0,
    "sphericity": np.pi ** (1 / 3) * 36.0 ** (2 / 3) / 22.0,
    "min_diameter": C,
    "max_diameter": A,
    "aspect_ratio": A / C,
    "convex_hull_volume": 6.0,
    "intermediate_diameter": B,
    "convexity": 1.0,
    "elongation": B / A,
    "flatness": C / B,
    "corey_shape_factor": C / np.sqrt(A * B),
    "krumbein_sphericity": (B * C / A**2) ** (1 / 3),
    "max_feret_diameter": np.sqrt(14.0),
    "min_feret_diameter": C,
    "roundness": INCIDENCE / 22.0,
    "roughness": 1.0,
    "principal_moment_min": 6.0 * (B**2 + C**2) / 12.0,
    "principal_moment_mid": 6.0 * (A**2 + C**2) / 12.0,
    "principal_moment_max": 6.0 * (A**2 + B**2) / 12.0,
}


@pytest.mark.parametrize("key", CUBOID)
def test_that_a_cuboid_has_the_descriptor_of_the_closed_form(key: str) -> None:
    assert value(key, cuboid(A, B, C).moved(rotation=rotation(2))) == pytest.approx(CUBOID[key], rel=1e-9)


def test_that_the_angularity_of_a_cube_is_its_area_over_that_of_the_equal_ball() -> None:
    ball = 4.0 * np.pi * (3.0 / (4.0 * np.pi)) ** (2 / 3)
    assert value("angularity", cuboid(1.0, 1.0, 1.0)) == pytest.approx(6.0 / ball, rel=1e-9)


# Coarser where the box is needed: all boxes of a ball tie, and the search takes 5 s at 2,562 corners.
@pytest.mark.parametrize(
    ("key", "fineness"),
    [
        *(("sphericity", 4), ("convexity", 4), ("roundness", 4), ("angularity", 4)),
        *(("elongation", 3), ("flatness", 3)),
    ],
)
def test_that_a_ball_has_one_for_every_measure_of_form(key: str, fineness: int) -> None:
    assert value(key, icosphere(fineness)) == pytest.approx(1.0, abs=1e-3)


def test_that_the_first_rows_and_the_loss_are_those_of_the_paper() -> None:
    assert list(CATALOGUE)[:8] == [
        "volume",
        "equivalent_radius",
        "surface_area",
        "sphericity",
        "min_diameter",
        "max_diameter",
        "aspect_ratio",
        "convex_hull_volume",
    ]
    assert set(LOSS_KEYS) == set(list(CATALOGUE)[:8]) - {"equivalent_radius", "surface_area"}


def test_that_every_row_can_be_shown() -> None:
    for key, row in CATALOGUE.items():
        assert row.key == key
        assert all([row.symbol, row.label, row.formula])
        assert row.label[0].isupper()
    chords = ["width", "thickness", "width_over_length", "thickness_over_width"]
    assert [key for key in CATALOGUE if key not in DEFAULT_KEYS] == ["min_feret_diameter", *chords]


@pytest.mark.parametrize(
    ("key", "unit", "symbol"),
    [
        ("sphericity", "", ""),
        ("equivalent_radius", "um", "µm"),
        ("volume", "um^3", "µm³"),
        ("principal_moment_max", "um^5", "µm⁵"),
    ],
)
def test_that_a_descriptor_states_the_power_of_its_length(key, unit, symbol):
    row = CATALOGUE[key]
    assert (row.unit, row.unit_symbol) == (unit, symbol)
    assert row.unit_suffix == (f" [{symbol}]" if symbol else "")


def test_that_a_ball_is_met_squarely() -> None:
    assert mean_incidence(icosphere(5), np.zeros(3)) == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize("centre", [(0.0, 0.0, 0.0), (0.1, -0.3, 0.2), (0.9, 0.0, 0.6), (0.5, 0.1, 0.1)])
def test_that_a_cube_agrees_with_quadrature(centre: tuple[float, ...]) -> None:
    total = 0.0
    for axis in range(3):
        p, q = (centre[k] for k in range(3) if k != axis)
        for height in (abs(0.5 - centre[axis]), abs(0.5 + centre[axis])):
            if height == 0.0:
                continue
            total += dblquad(
                lambda x, y, h=height: h / np.sqrt(h * h + x * x + y * y),
                -0.5 - p,
                0.5 - p,
                -0.5 - q,
                0.5 - q,
            )[0]
    turn = rotation(2)
    cube = cuboid(1.0, 1.0, 1.0).moved(rotation=turn)
    assert mean_incidence(cube, turn @ centre) == pytest.approx(total / 6.0, rel=1e-7)


def test_that_cutting_faces_in_smaller_ones_changes_nothing() -> None:
    stone = rough_stone(1, level=1)
    a, b, c = np.moveaxis(stone.triangles, 1, 0)
    middle = (a + b + c) / 3.0
    pieces = np.concatenate(
        [np.stack(corner, 1) for corner in ((a, b, middle), (b, c, middle), (c, a, middle))]
    )
    finer = Mesh(pieces.reshape(-1, 3), np.arange(3 * len(pieces)).reshape(-1, 3))
    centre = np.array([0.05, 0.02, -0.1])
    assert mean_incidence(finer, centre) == pytest.approx(mean_incidence(stone, centre), rel=1e-12)
