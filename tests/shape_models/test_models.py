"""What holds for every model."""

import json
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from regolith_studio.errors import FileError, InputError
from regolith_studio.geometry.mesh_health import inspect
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.harmonics.sphere_grid import harmonics
from regolith_studio.readers.shape_files import read_shape_source
from regolith_studio.shape_models.chunked_sampling import CHUNK
from regolith_studio.shape_models.models import DEFAULT_MODEL, MODELS, write_model
from regolith_studio.shape_models.protocol import FittedModel
from regolith_studio.shape_models.realizations import Realizations, virtual_mesh
from regolith_studio.shape_models.sample import Sample

keys = pytest.mark.parametrize("key", sorted(MODELS))
fitted_anew = pytest.mark.parametrize(
    "key",
    [pytest.param(key, marks=pytest.mark.slow) if key == "hull_field" else key for key in sorted(MODELS)],
)
"""A hull field takes two seconds to fit, and five to draw a chunk; its draws are tested with the others'."""


def test_that_the_models_are_found_by_themselves() -> None:
    assert set(MODELS) == {
        "gaussian_field",
        "gaussian_mixture",
        "hull_field",
        "log_field",
        "recombined",
        "sample_matched",
    }
    assert DEFAULT_MODEL in MODELS
    assert all(MODELS[key].key == key for key in MODELS)


@fitted_anew
def test_that_the_first_particles_do_not_depend_on_how_many_are_drawn(
    key: str, fitted: dict[str, FittedModel]
) -> None:
    few, many = fitted[key].draw(7, seed=3), fitted[key].draw(CHUNK + 3, seed=3)
    assert len(many) == CHUNK + 3
    assert few.coefficients.tobytes() == many.coefficients[:7].tobytes()
    assert fitted[key].draw(7, seed=4).coefficients.tobytes() != few.coefficients.tobytes()
    assert len(fitted[key].draw(0, seed=3)) == 0


@keys
def test_that_every_particle_is_a_closed_solid_with_the_volume_of_its_series(
    key: str, fitted: dict[str, FittedModel]
) -> None:
    draws = fitted[key].draw(6, seed=1)
    radii = draws.equivalent_radii()
    for index in range(6):
        mesh = virtual_mesh(draws, index, level=3)
        assert inspect(mesh).sound
        assert mesh.volume == pytest.approx(4 / 3 * np.pi * radii[index] ** 3, rel=1e-9)


def test_that_a_narrow_pit_ends_before_the_star_point() -> None:
    directions = icosphere(2).vertices
    at_first = harmonics(directions[:1], 20)[:, 0]
    bump = at_first * np.exp(-((degrees(len(at_first)) / 8) ** 2))
    draws = Realizations(-4 * bump[None] / (bump @ at_first), "log_radius", "log_field", 0)
    outward = (virtual_mesh(draws, 0, level=2).vertices * directions).sum(axis=1)
    assert 0 < outward[0] < 0.1 * np.median(outward)
    assert outward.min() > 0


@keys
def test_that_parts_are_the_same_particles_some_hundreds_at_a_time(
    key: str, fitted: dict[str, FittedModel]
) -> None:
    parts, whole = list(fitted[key].draw_chunks(1203, 4)), fitted[key].draw(1203, 4)
    assert [len(part) for part in parts] == [500, 500, 203]
    for name in ("coefficients", "parents", "components"):
        joined = np.concatenate([getattr(part, name) for part in parts])
        assert joined.tobytes() == getattr(whole, name).tobytes()
    assert sum(part.rejected for part in parts) == whole.rejected


@keys
def test_that_no_particles_are_none(key: str, fitted: dict[str, FittedModel]) -> None:
    none = fitted[key].draw(0, 1)
    assert (len(none), none.l_max, none.rejected) == (0, fitted[key].l_max, 0)


@keys
def test_that_sizes_stay_in_the_range_asked_for(key: str, fitted: dict[str, FittedModel]) -> None:
    radii = fitted[key].draw(700, seed=1, size_range=(9.0, 11.0)).equivalent_radii()
    assert radii.min() >= 9.0 * (1 - 1e-5)
    assert radii.max() <= 11.0 * (1 + 1e-5)


@pytest.mark.parametrize("size_range", [(3.0, 2.0), (0.0, 1.0), (1.0, np.inf), (-1.0, 1.0), (1.0, np.nan)])
@keys
def test_that_a_range_that_is_none_is_refused(
    key: str, size_range: tuple[float, float], fitted: dict[str, FittedModel]
) -> None:
    with pytest.raises(InputError, match="range of sizes needs two positive radii"):
        fitted[key].draw(5, 0, size_range)


@keys
def test_that_a_negative_number_of_particles_is_refused(key: str, fitted: dict[str, FittedModel]) -> None:
    with pytest.raises(InputError, match="must not be negative, got -1"):
        fitted[key].draw(-1, 0)


@keys
def test_that_a_model_read_back_draws_the_same_bytes(
    key: str, fitted: dict[str, FittedModel], tmp_path: Path
) -> None:
    first, second = tmp_path / "a.json", tmp_path / "b.json"
    write_model(first, fitted[key], {"sample": "synthetic"})
    again = read_shape_source(str(first)).content
    assert isinstance(again, type(fitted[key]))
    assert again.draw(20, 5).coefficients.tobytes() == fitted[key].draw(20, 5).coefficients.tobytes()
    write_model(second, again, {"sample": "synthetic"})
    assert first.read_bytes() == second.read_bytes()


@pytest.mark.parametrize(
    ("key", "name", "value"),
    [
        ("gaussian_field", "mean", 1e300),
        ("gaussian_field", "mean", 10**400),
        ("hull_field", "faceting", 1e300),
    ],
)
def test_that_a_model_whose_particles_overflow_is_refused_in_one_sentence(
    key: str, name: str, value: Any, fitted: dict[str, FittedModel], tmp_path: Path
) -> None:
    write_model(tmp_path / "m.json", fitted[key])
    document = json.loads((tmp_path / "m.json").read_text())
    kept = document["values"][name]
    document["values"][name] = value * len(kept) if isinstance(value, list) else value
    (tmp_path / "m.json").write_text(json.dumps(document))
    with pytest.raises(FileError, match="is a broken model"):
        read_shape_source(str(tmp_path / "m.json"))


@keys
def test_that_a_model_survives_pickling(key: str, fitted: dict[str, FittedModel]) -> None:
    again = pickle.loads(pickle.dumps(fitted[key]))
    draws = pickle.loads(pickle.dumps(again.draw(3, 1)))
    np.testing.assert_array_equal(draws.coefficients, fitted[key].draw(3, 1).coefficients)


@fitted_anew
def test_that_two_particles_are_enough(
    key: str, rough_sample: Callable[..., Sample], quick_fit: Callable[..., FittedModel]
) -> None:
    model = quick_fit(key, rough_sample(2), 3)
    assert np.isfinite(model.draw(5, 0).coefficients).all()


@fitted_anew
def test_that_particles_of_one_size_are_drawn_at_that_size(
    key: str, rough_sample: Callable[..., Sample], quick_fit: Callable[..., FittedModel]
) -> None:
    sample = rough_sample(20, 3, spread=0.0)
    radii = quick_fit(key, sample, 3).draw(100, 0).equivalent_radii()
    assert radii.mean() == pytest.approx(sample.equivalent_radii.mean(), rel=0.03)


@keys
@pytest.mark.slow
def test_that_only_gaussian_fields_of_the_radius_throw_draws_of_real_particles_away(
    key: str, cement: Sample
) -> None:
    draws = MODELS[key].fit(cement).draw(3000, 0)
    assert np.isfinite(draws.coefficients).all()
    assert (draws.rejected > 0) == key.startswith("gaussian")
