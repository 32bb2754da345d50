"""The commands on scans as they come: cement particles and Apollo rocks, with what is wrong with them."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

pytestmark = pytest.mark.real_data

RealData = Callable[[str], Path]


def test_that_cement_particles_become_polyhedra_of_their_volume(
    command, real_data: RealData, tmp_path: Path
) -> None:
    files = sorted(real_data("cement140/voxel").glob("*.stl"))[:3]
    result = command("coarsen", *files, "-o", tmp_path / "c", "--json")
    assert result.code == 0
    for entry in json.loads((tmp_path / "c" / "coarsening.json").read_text())["particles"]:
        assert entry["n_facets"] == 20
        assert entry["errors"]["volume"] < 0.1


def test_that_a_torn_rock_is_measured_and_its_trouble_told(command, real_data: RealData) -> None:
    result = command("describe", real_data("apollo/apollo_sample15.ply"), "--json")
    assert result.code == 0
    (entry,) = result.json
    assert entry["volume"] > 0
    assert any("separate bodies" in note for note in entry["notes"])
