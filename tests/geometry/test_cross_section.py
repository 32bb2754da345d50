"""Sections of bodies whose sections are known."""

import numpy as np
import pytest

from regolith_studio.geometry import ConvexPolyhedron, HalfSpaces, Mesh
from regolith_studio.geometry.cross_section import cross_section, plane_axes
from regolith_studio.geometry.sphere_points import icosphere

CUBE = ConvexPolyhedron.from_half_spaces(HalfSpaces(np.vstack([np.eye(3), -np.eye(3)]), np.ones(6))).mesh


def test_that_a_cube_is_cut_into_a_square_a_hexagon_and_nothing() -> None:
    assert cross_section(CUBE, (0, 0, 1), 0.3).area == pytest.approx(4.0)
    assert cross_section(CUBE, (0, 0, 1), 0.3).length == pytest.approx(8.0)
    hexagon = cross_section(CUBE, (1, 1, 1), 0.0)
    assert hexagon.area == pytest.approx(3 * np.sqrt(3))
    assert hexagon.length == pytest.approx(6 * np.sqrt(2))
    assert cross_section(CUBE, (0, 0, 1), 1.5).area == 0.0
    assert cross_section(CUBE, (0, 0, 1), 1.5).loops() == []


@pytest.mark.parametrize("offset", [-0.7, 0.0, 0.4, 0.95])
def test_that_a_ball_is_cut_into_discs(offset: float) -> None:
    cut = cross_section(icosphere(5), (1.0, -2.0, 0.5), offset * np.sqrt(5.25))
    assert cut.offset == pytest.approx(offset)
    assert cut.area == pytest.approx(np.pi * (1 - offset**2), rel=1e-2)
    assert np.allclose(cut.points @ cut.normal, offset, atol=1e-14)


def test_that_the_areas_of_all_sections_add_up_to_the_volume() -> None:
    egg = icosphere(3).moved(rotation=np.diag([1.0, 0.5, 1.6]))
    heights = np.linspace(-1.6, 1.6, 4001)
    areas = [cross_section(egg, (0, 0, 1), height).area for height in heights[::10]]
    assert np.trapezoid(areas, heights[::10]) == pytest.approx(egg.volume, rel=1e-4)


def test_that_a_hollow_is_no_part_of_the_section_and_has_a_loop_of_its_own() -> None:
    outer, inner = icosphere(4), icosphere(4).moved(scale=0.5)
    hollow = Mesh(
        np.vstack([outer.vertices, inner.vertices]),
        np.vstack([outer.faces, inner.faces[:, ::-1] + len(outer.vertices)]),
    )
    cut = cross_section(hollow, (0, 0, 1), 0.013)
    assert cut.area == pytest.approx(np.pi * 0.75, rel=1e-2)
    loops = cut.loops()
    assert len(loops) == 2
    assert all(loop[0] == loop[-1] for loop in loops)
    assert sum(len(loop) - 1 for loop in loops) == len(cut.segments)


@pytest.mark.parametrize("height", [1.0, -1.0, 0.0])
def test_that_corners_on_the_plane_leave_no_gap(height: float) -> None:
    cut = cross_section(CUBE, (0, 0, 1), height)
    assert all(loop[0] == loop[-1] for loop in cut.loops())
    assert cut.area == pytest.approx(0.0 if height == -1.0 else 4.0)


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, -1, 0), (0.6, 0, 0.8)])
def test_that_the_drawing_keeps_lengths_and_turns_the_same_way(normal: tuple[float, ...]) -> None:
    unit = np.array(normal, dtype=float)
    across, up = plane_axes(unit)
    assert np.allclose(np.cross(across, up), unit)
    cut = cross_section(CUBE, unit, 0.2)
    flat = cut.flat()[cut.segments]
    assert np.linalg.norm(flat[:, 1] - flat[:, 0], axis=1).sum() == pytest.approx(cut.length)
    turning = flat[:, 0, 0] * flat[:, 1, 1] - flat[:, 0, 1] * flat[:, 1, 0]
    assert turning.sum() / 2 == pytest.approx(cut.area)


def test_that_a_plane_needs_a_normal() -> None:
    with pytest.raises(ValueError, match="normal"):
        cross_section(CUBE, (0, 0, 0), 0.0)


def test_that_outlines_of_several_loops_are_separated_by_nan() -> None:
    shifted = CUBE.vertices + np.array([5.0, 0.0, 0.0])
    faces = np.vstack([CUBE.faces, CUBE.faces + len(CUBE.vertices)])
    pair = Mesh(np.vstack([CUBE.vertices, shifted]), faces)
    cut = cross_section(pair, (0, 0, 1), 0.3)
    assert np.isnan(cut.outline()).all(axis=1).sum() == len(cut.loops()) - 1 == 1
    steps = np.linalg.norm(np.diff(cut.outline(), axis=0), axis=1)
    assert np.nansum(steps) == pytest.approx(cut.length)
    assert cross_section(CUBE, (0, 0, 1), 1.5).outline().shape == (0, 2)
