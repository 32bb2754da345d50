"""A sample as a table: filters, words on health, statistics against numpy."""

from dataclasses import replace

import numpy as np
import pytest

from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.mesh_health import inspect
from regolith_studio.geometry.particle import Particle, ScanOfGrain
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.imaging.grain_errors import intervals
from regolith_studio.session.results import ParticleEntry
from regolith_studio.session.sample_table import (
    EVERYTHING,
    filter_of,
    form_of,
    health_sentences,
    health_word,
    sample_table,
    statistics_of_keys,
    statistics_table,
)


def entry(name: str, axes: tuple[float, float, float], group: str = "") -> ParticleEntry:
    sphere = icosphere(2)
    mesh = Mesh(sphere.vertices * np.array(axes), sphere.faces)
    return ParticleEntry(name, Particle(name, mesh, group=group), inspect(mesh), describe(mesh))


@pytest.fixture(scope="module")
def sample() -> tuple[ParticleEntry, ...]:
    return (
        entry("ball", (10, 10, 10), "fine"),
        entry("plate", (10, 10, 2), "fine"),
        entry("needle", (30, 5, 5), "coarse"),
        entry("lath", (30, 10, 2), "coarse"),
    )


def kept(sample: tuple[ParticleEntry, ...], text: str) -> list[str]:
    return [each.id for each in sample if filter_of(text)(each)]


def test_that_ellipsoids_have_the_forms_that_zingg_gave_them(sample: tuple[ParticleEntry, ...]) -> None:
    assert [form_of(each) for each in sample] == ["equant", "disc", "rod", "blade"]


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("", ["ball", "plate", "needle", "lath"]),
        ("l", ["ball", "plate", "needle", "lath"]),
        ("ball", ["ball"]),
        ("FINE", ["ball", "plate"]),
        ("coarse blade", ["lath"]),
        ("sound AR>4", ["plate", "needle", "lath"]),
        ("D_max<=21 S<0.9", ["plate"]),
        ("Dmax>=50", ["needle", "lath"]),
        ("aspect_ratio<1.1", ["ball"]),
        ("volume>1e9", []),
    ],
)
def test_that_words_and_comparisons_must_all_hold(
    sample: tuple[ParticleEntry, ...], text: str, names: list[str]
) -> None:
    assert kept(sample, text) == names


@pytest.mark.parametrize(
    ("text", "sentence"),
    [("weight>3", "no descriptor called 'weight'"), ("S<", "without blanks"), ("S<1e", "not a number")],
)
def test_that_a_comparison_that_makes_no_sense_is_told(text: str, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        filter_of(text)


def test_that_what_is_not_measured_fails_every_comparison_but_no_word() -> None:
    bare = ParticleEntry("bare", Particle("bare", icosphere(1)))
    assert not filter_of("S>0")(bare)
    assert filter_of("bar unknown")(bare)
    assert health_sentences(bare) == ("Measuring …",)


def test_that_health_is_one_word(sample: tuple[ParticleEntry, ...]) -> None:
    whole = sample[0].particle.mesh
    torn = Mesh(whole.vertices, whole.faces[1:])
    assert health_word(sample[0]) == "sound"
    assert health_word(ParticleEntry("a", Particle("a", torn), inspect(torn))) == "unsound"
    noted = Particle("a", whole, notes=("A hole was closed.",))
    assert health_word(ParticleEntry("a", noted, inspect(whole))) == "repaired"
    drawn = Particle("a", whole, notes=("Virtual particle (model recombined, seed 0).",))
    assert health_word(ParticleEntry("a", drawn, inspect(whole))) == "sound"
    few = Particle("a", whole, notes=("Only 9.8 voxels in diameter: coarse.",))
    assert health_word(ParticleEntry("a", few, inspect(whole))) == "coarse"
    both = Particle("a", whole, notes=(*few.notes, *noted.notes))
    assert health_word(ParticleEntry("a", both, inspect(whole))) == "repaired"
    through = replace(inspect(whole), problems=("It has 1 tunnel through it.",))
    assert health_word(ParticleEntry("a", both, through)) == "doubtful"
    assert health_word(ParticleEntry("a", noted)) == "unknown"


def test_that_statistics_weigh_by_number_or_by_volume(sample: tuple[ParticleEntry, ...]) -> None:
    values = np.array([each.descriptors["max_diameter"] for each in sample if each.descriptors])
    volumes = np.array([each.descriptors["volume"] for each in sample if each.descriptors])
    rows = {row[0]: row for row in statistics_table(sample, "max_diameter").rows}
    assert set(rows) == {"fine", "coarse", EVERYTHING}
    assert rows[EVERYTHING][1] == 4
    assert rows[EVERYTHING][2] == pytest.approx(values.mean())
    assert rows[EVERYTHING][3] == pytest.approx(values.std())
    heavy = {row[0]: row for row in statistics_table(sample, "max_diameter", "volume").rows}
    assert heavy[EVERYTHING][2] == pytest.approx(np.average(values, weights=volumes))
    assert heavy["fine"][2] == pytest.approx(np.average(values[:2], weights=volumes[:2]))


def test_that_the_table_has_units_and_a_row_a_particle(sample: tuple[ParticleEntry, ...]) -> None:
    table = sample_table(sample)
    headers = [column.header for column in table.columns]
    assert {"name", "group", "volume [um^3]", "surface_area [um^2]", "max_diameter [um]"} <= set(headers)
    assert [row[0] for row in table.rows] == ["ball", "plate", "needle", "lath"]
    unmeasured = ParticleEntry("bare", Particle("bare", icosphere(1)))
    assert len(sample_table((*sample, unmeasured)).rows) == 4


def test_that_weights_count_a_particle_as_often_as_it_stands_for(sample: tuple[ParticleEntry, ...]) -> None:
    weights = (1.0, 3.0, 1.0, 2.0)
    heavy = [
        replace(each, particle=replace(each.particle, weight=weight))
        for each, weight in zip(sample, weights, strict=True)
    ]
    repeated = [each for each, weight in zip(sample, weights, strict=True) for _ in range(int(weight))]
    for weighting in ("number", "volume"):
        found = statistics_table(heavy, "max_diameter", weighting).rows[-1]
        expected = statistics_table(repeated, "max_diameter", weighting).rows[-1]
        assert found[2:] == pytest.approx(expected[2:])
        assert found[1] == 4
    assert statistics_table(heavy, "volume", "number", False).rows == statistics_table(sample, "volume").rows
    table = sample_table(heavy)
    assert table.column("weight") == weights
    assert "weight" not in [column.name for column in sample_table(sample).columns]


def test_that_statistics_of_several_descriptors_name_them_with_their_units(
    sample: tuple[ParticleEntry, ...],
) -> None:
    table = statistics_of_keys(sample, ["volume", "sphericity"])
    assert table.column("descriptor") == ("volume [um^3]",) * 3 + ("sphericity",) * 3
    assert table.rows[2][1:] == statistics_table(sample, "volume").rows[2]


def test_that_the_table_holds_the_intervals_of_grains_of_scans(sample: tuple[ParticleEntry, ...]) -> None:
    scan = ScanOfGrain(18.0, 0.1, follows_grey=True)
    grain = replace(sample[1], particle=replace(sample[1].particle, scan=scan))
    table = sample_table((sample[0], grain))
    (other, low), (nothing, high) = table.column("volume_low"), table.column("volume_high")
    assert grain.descriptors is not None
    assert (low, high) == intervals(grain.descriptors, scan)["volume"]
    assert low < grain.descriptors["volume"] < high
    assert other is nothing is None
    assert "volume_low" not in [column.name for column in sample_table(sample).columns]
