"""The functions for notebooks take what the readers give."""

from pathlib import Path

import numpy as np
import pytest

import regolith_studio as rs
from regolith_studio.errors import DatasetError, InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.imaging.volume import Volume


@pytest.mark.parametrize("work", ["describe", "fit_harmonics", "coarsen"])
def test_that_a_particle_counts_as_its_mesh(work):
    particle = next(each for each in rs.sample_particles() if each.name == "angular-1")
    of_particle, of_mesh = getattr(rs, work)(particle), getattr(rs, work)(particle.mesh)
    if work == "describe":
        assert of_particle == of_mesh
    elif work == "fit_harmonics":
        assert np.array_equal(of_particle.coefficients.values, of_mesh.coefficients.values)
    else:
        assert np.array_equal(of_particle.polyhedron.vertices, of_mesh.polyhedron.vertices)


def ellipsoid(*semi_axes: float) -> Particle:
    ball = icosphere(3)
    return Particle("x".join(map(str, semi_axes)), Mesh(ball.vertices * np.array(semi_axes), ball.faces))


@pytest.mark.parametrize("kind", ["grey", "labels"])
def test_that_a_ball_in_a_scan_is_extracted_with_its_volume(kind: str) -> None:
    """A ball of 10 voxels of 2 micrometres, in the middle of 32; smoothing restores the count of voxels."""
    places = np.indices((32, 32, 32)) - 15.5
    inside = (places**2).sum(axis=0) < 10**2
    values = inside.astype(np.int32) if kind == "labels" else (100 + 100 * inside).astype(np.uint8)
    (grain,) = rs.extract(Volume(values, np.full(3, 2.0), kind, "ball", (0.0, 0.0, 0.0)))
    assert grain.mesh.volume == pytest.approx(4 / 3 * np.pi * 20**3, rel=0.02)


def test_that_a_model_is_fitted_by_its_name_and_draws_particles_of_the_sizes_asked_for() -> None:
    sizes = np.linspace(10.0, 30.0, 12)
    fits = [rs.fit_harmonics(ellipsoid(1.2 * r, r, 0.9 * r), l_max=4, sampling_degree=12) for r in sizes]
    model = rs.fit_model(fits, "log_field")
    assert model.l_max == 4
    drawn = rs.draw_particles(model, 5, seed=3, size_range=(15.0, 20.0))
    radii = [np.cbrt(3 * particle.mesh.volume / (4 * np.pi)) for particle in drawn]
    assert all(14.9 < radius < 20.1 for radius in radii)
    with pytest.raises(InputError, match="no model called 'nothing'"):
        rs.fit_model(fits, "nothing")


def test_that_a_dataset_is_exported_by_the_name_of_the_code(tmp_path: Path) -> None:
    particle = ellipsoid(12.0, 10.0, 9.0)
    dataset = rs.build_dataset([(particle, rs.coarsen(particle, 8, "quadric"))])
    done = rs.export_dataset(dataset, "multi-sphere", tmp_path / "multi-sphere", accept_loss=True)
    assert {path.name for path in done.folder.iterdir()} >= {"README.txt", "export.json"}
    with pytest.raises(InputError, match="no exporter 'abaqus'"):
        rs.export_dataset(dataset, "abaqus", tmp_path / "abaqus")
    with pytest.raises(DatasetError, match="not an export's"):
        rs.export_dataset(dataset, "multi-sphere", tmp_path, accept_loss=True)


@pytest.mark.parametrize("name", sorted(set(rs.__all__) - {"__version__"}))
def test_that_each_name_is_explained(name: str) -> None:
    assert (getattr(rs, name).__doc__ or "").strip()
