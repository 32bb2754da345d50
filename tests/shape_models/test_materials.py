import json
import re
from collections.abc import Callable
from functools import partial
from multiprocessing.pool import ThreadPool
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from scipy.stats import norm

from regolith_studio.errors import FileError, InputError
from regolith_studio.harmonics.sphere_grid import sphere_grid
from regolith_studio.shape_models.inertia_ellipsoid import principal_axes
from regolith_studio.shape_models.materials import MaterialCard, materials, read_card, write_card
from regolith_studio.shape_models.models.log_field import MODEL, LogFieldSettings
from regolith_studio.shape_models.realizations import Realizations, virtual_mesh
from regolith_studio.shape_models.sample import Sample, sized
from regolith_studio.shape_models.size_law import LogNormalSizes, size_law_from
from regolith_studio.studies.population import descriptors_of
from tools.make_material_cards import MATERIALS, published_card, size_law


def test_that_at_least_five_materials_ship_and_say_that_they_are_synthesised() -> None:
    assert len(materials()) >= 5
    for name, card in materials().items():
        assert card.name == name
        assert card.origin.startswith("Synthesised by Regolith Studio")
        assert "no measured particle is contained" in card.origin


@pytest.mark.parametrize("name", sorted(materials()))
def test_that_a_material_draws_particles_with_its_sizes_and_amplitudes(name: str) -> None:
    card = materials()[name]
    draws = card.model(10).draw(500, 0)
    logs = np.log(draws.equivalent_radii())
    assert np.exp(logs.mean()) == pytest.approx(card.median_radius, rel=0.03)
    assert logs.std() == pytest.approx(card.log_deviation, rel=0.06)
    assert draws.rejected == 0
    field = card.field(10).draw(100, 0)
    radii = np.stack([field.particle(i).values for i in range(100)])
    relative = radii / radii[:, :1]
    amplitude = np.sqrt((relative[:, 4:9] ** 2).mean())
    assert amplitude == pytest.approx(card.relative_amplitudes[1], rel=0.15)


@pytest.mark.slow
def test_that_drawn_lunar_particles_have_the_published_axial_ratios() -> None:
    """Ten Apollo and Luna soils (Earth, Planets and Space 74, 2022), within the errors given there."""
    draws = materials()["lunar_soil"].model(10).draw(10_000, 2)
    parts = [draws.chosen(range(i, i + 100)) for i in range(0, 10_000, 100)]
    with ThreadPool() as pool:
        tables = pool.map(partial(descriptors_of, keys=("flatness", "elongation"), level=3), parts)
    flatness, elongation = np.concatenate(tables).T
    assert flatness.mean() == pytest.approx(0.770, abs=0.008)
    assert elongation.mean() == pytest.approx(0.758, abs=0.010)
    assert (flatness * elongation).mean() == pytest.approx(0.581, abs=0.011)


def test_that_lunar_sizes_are_the_sieved_ones() -> None:
    """Soil 10084 (Basu et al. 2001): by mass 4.28 +/- 2.23 phi, here between diameters of 10 and 1,000 um."""
    law = size_law_from((materials()["lunar_soil"].hull_field or {})["sizes"])
    radii, _ = law.draw(100_000, np.random.default_rng(0))
    assert 5 <= radii.min() < radii.max() <= 500
    fine, _ = law.draw(100_000, np.random.default_rng(0), (5, 50))  # the rest is few and heavy
    phi = -np.log2([0.1, 0.05, 0.02, 0.01])  # of the diameter in mm
    below = norm.cdf(phi, 4.28, 2.23)
    found = [(fine[2 * fine > size] ** 3).sum() / (fine**3).sum() for size in (50, 20)]
    np.testing.assert_allclose(found, (below[1:3] - below[0]) / (below[3] - below[0]), atol=0.01)


@pytest.mark.slow
def test_that_the_tool_makes_a_card_with_the_ratios_that_it_aims_at() -> None:
    card = published_card("lunar_soil", n_particles=60, rounds=1)
    assert card.hull_field is not None
    assert card.hull_field["sizes"] == size_law(*MATERIALS["lunar_soil"].sizes).stored()
    assert card.evaluation is None
    assert set(card.drawn) == set(card.stated) == {"elongation", "flatness", "S/L"}


@pytest.mark.parametrize(("name", "size", "share"), [("chang_e_5", 57.5, 0.5), ("chang_e_6", 48.4, 0.6)])
def test_that_the_sizes_of_a_card_have_the_published_quantile_by_mass(
    name: str, size: float, share: float
) -> None:
    law = size_law_from((materials()[name].hull_field or {})["sizes"])
    assert isinstance(law, LogNormalSizes)
    edges = np.geomspace(10, 1000, 20_001) / 2
    density = norm.pdf((np.log(edges) - law.means[0]) / law.deviations[0]) * edges**3
    mass = np.cumsum(density) / density.sum()
    assert np.interp(size / 2, edges, mass) == pytest.approx(share, abs=0.003)


def test_that_cards_say_what_is_measured_what_is_assumed_and_what_they_miss() -> None:
    cards = [materials()[name] for name in MATERIALS]
    for card in cards:
        assert card.measured
        assert card.assumed
        assert card.stated.keys() == card.drawn.keys()
        missed = [k for k, (mean, spread) in card.stated.items() if abs(card.drawn[k] - mean) > spread]
        assert ("cannot be met within its own spread" in card.evaluated) == bool(missed)
        assert all(f"{key} = " in card.evaluated for key in missed)
    assert materials()["lunar_soil"].evaluated == ""
    drawn = {"flatness": 0.6}
    worse = materials()["lunar_soil"].model_copy(update={"drawn": drawn})
    assert "flatness = 0.6 (stated 0.77 ± 0.008)" in worse.evaluated


@pytest.mark.slow
def test_that_the_card_of_drawn_particles_is_the_card_that_drew_them() -> None:
    card = materials()["ma165"]
    draws = card.model(6).draw(800, 0)
    wide = sized(np.pad(draws.coefficients, ((0, 0), (0, 13**2 - 49))), draws.equivalent_radii())
    fine = Realizations(wide, "log_radius", "test", 0)
    sample = Sample(np.stack([fine.particle(i).values for i in range(800)]))
    again = MaterialCard.of(sample, "again", "Again", "A test.", l_max=6)
    assert again.median_radius == pytest.approx(card.median_radius, rel=0.05)
    assert again.log_deviation == pytest.approx(card.log_deviation, rel=0.08)
    np.testing.assert_allclose(again.relative_amplitudes, card.relative_amplitudes[:6], rtol=0.08)


def test_that_a_card_read_back_is_the_card_that_was_written(
    rough_sample: Callable[..., Sample], tmp_path: Path
) -> None:
    card = MaterialCard.of(rough_sample(20, 4), "rough", "Rough", "Synthetic, for a test.")
    assert read_card(write_card(card, tmp_path / "rough.json")) == card
    field = MODEL.fit(rough_sample(20, 4), LogFieldSettings(4, "pooled", "log_normal", False))
    np.testing.assert_allclose(card.model(4).spectrum, field.spectrum, rtol=0.02, atol=1e-12)


@pytest.mark.slow
def test_that_the_card_of_a_sample_draws_its_shapes_and_says_how_well() -> None:
    """Half ellipsoids of 2 : 1.4 : 1, half spheres: no field with random phases has such aspect ratios."""
    drawn = materials()["ma165"].field(6).draw(120, 0)
    rows = np.stack([drawn.particle(i).values for i in range(120)])
    grid = sphere_grid(24, 6)
    stretched = np.linalg.norm(grid.directions / [2.0, 1.4, 1.0], axis=1) ** -1
    rows[::2] = grid.expanded(grid.values(rows[::2]) * stretched)
    sample = Sample(rows)
    card = MaterialCard.of(sample, "mixed", "Mixed", "Synthetic, for a test.")
    assert card.key == "hull_field"
    assert card.evaluation is not None
    assert card.evaluation["convexity"] < 2.0
    assert card.evaluation["aspect_ratio"] < 6.0
    assert card.stated["equivalent_radius"][0] == pytest.approx(sample.equivalent_radii.mean(), rel=0.002)
    assert not card.missed
    other = card.model_copy(update={"drawn": {"sphericity": 0.5}})
    assert other.evaluated == f"{card.evaluated} {other.missed}"
    assert "sphericity = 0.5 (stated " in other.missed
    draws = card.model(6).draw(400, 1)
    axes = np.exp(np.abs(principal_axes(np.stack([draws.particle(i).values for i in range(400)])).log_ratios))
    measured = np.exp(np.abs(principal_axes(rows).log_ratios))
    assert axes.mean() == pytest.approx(measured.mean(), rel=0.03)
    assert materials()["ma165"].key == "log_field"


@pytest.mark.slow
def test_that_the_card_of_a_sample_fills_its_hulls_as_the_particles_do_with_all_their_degrees() -> None:
    """Those cut at the tenth degree fill more of theirs."""
    drawn = materials()["ma165"].field(16).draw(150, 0)
    sample = Sample(np.stack([drawn.particle(i).values for i in range(150)]))
    card = MaterialCard.of(sample, "fine", "Fine", "Synthetic, for a test.")
    draws = card.model().draw(300, 1)
    assert draws.l_max == 16

    def shares(rows: Realizations) -> float:
        meshes = [virtual_mesh(rows, i, 3) for i in range(150)]
        return float(np.mean([mesh.volume / ConvexHull(mesh.vertices).volume for mesh in meshes]))

    wanted = shares(Realizations(sample.coefficients, "radius", "measured", 0))
    assert shares(draws) == pytest.approx(wanted, rel=0.005)
    assert shares(Realizations(sample.truncated(10).coefficients, "radius", "cut", 0)) > 1.01 * wanted
    assert card.evaluation is not None
    assert f"{card.evaluation['sphericity']:.2g} % in S" in card.evaluated


@pytest.mark.parametrize("l_max", [0, 31])
def test_that_a_degree_that_the_card_lacks_is_refused(l_max: int) -> None:
    with pytest.raises(InputError, match="reaches from l = 1 to 30"):
        materials()["ma165"].model(l_max)


@pytest.mark.parametrize("l_max", [5, 20])
def test_that_a_degree_that_the_hull_field_of_a_card_lacks_is_refused_with_the_right_one(l_max: int) -> None:
    with pytest.raises(InputError, match=f"drawn with l_max = 10 only, got l_max = {l_max}"):
        materials()["lunar_soil"].model(l_max)


def test_that_a_card_of_a_spectrum_says_how_far_its_draws_are_from_the_material() -> None:
    """Against the benchmark that the sentence is taken from."""
    file = Path(__file__).parents[2] / "benchmarks/results/shape_models.json"
    rows = json.loads(file.read_text("utf-8"))["draws of a card"]["rows"]
    _, _, *measured = rows["pooled field, l_max = 10"]
    said = re.search(r"about (\d+) % in AR, (\d+) % in S and (\d+) % in V/CH", materials()["ma165"].evaluated)
    assert said is not None
    np.testing.assert_allclose([float(number) for number in said.groups()], measured, atol=1.0)
    assert materials()["lunar_soil"].evaluated == ""


@pytest.mark.parametrize(
    "content",
    [b"", b"{}", b'{"name": "x"', b"\xff\xfe", b'{"median_radius": NaN}', b"[" * 50000],
)
def test_that_a_file_that_is_no_card_is_refused_in_one_sentence(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "x.json"
    path.write_bytes(content)
    with pytest.raises(FileError, match=r"x\.json is no material card"):
        read_card(path)
    with pytest.raises(FileError, match="cannot be read"):
        read_card(tmp_path / "missing.json")
