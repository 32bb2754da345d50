"""What is written of a union of convex parts, read back by trimesh; and what refuses it."""

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.jobs.coarsening_jobs import CoarsenedParticle, CoarseningRequest
from regolith_studio.session.outputs.coarsening import write_coarsening
from tests.coarsening.compound.unions import dumbbell


@pytest.fixture(scope="module")
def mesh() -> Mesh:
    return dumbbell()


@pytest.fixture(scope="module")
def found(mesh: Mesh) -> CoarseningResult:
    return coarsen(mesh, 16, "compound")


def test_that_the_union_and_its_parts_are_files_that_trimesh_measures_alike(
    found: CoarseningResult, tmp_path: Path
) -> None:
    done = [CoarsenedParticle("rock", 0, found, "", None, (), 0.0)]
    write_coarsening(tmp_path, CoarseningRequest(LossWeights.from_preset("all"), 16, "compound"), done)
    (entry,) = json.loads((tmp_path / "coarsening.json").read_text())["particles"]
    union = trimesh.load_mesh(tmp_path / entry["file"])
    assert union.is_watertight
    assert union.volume == pytest.approx(entry["achieved"]["volume"], rel=1e-5)
    assert union.center_mass == pytest.approx(entry["centroid"], rel=1e-5)
    assert union.moment_inertia == pytest.approx(np.array(entry["inertia"]), rel=1e-4, abs=1.0)
    assert [part["file"] for part in entry["parts"]] == ["rock.part1.stl", "rock.part2.stl"]
    for part in entry["parts"]:
        solid = trimesh.load_mesh(tmp_path / part["file"])
        gap = (solid.vertices - part["origin"]) @ np.array(part["normals"]).T - part["offsets"]
        assert solid.is_convex
        assert gap.max() < 1e-4
        assert len(part["offsets"]) == part["n_facets"]
    assert sum(part["n_facets"] for part in entry["parts"]) == entry["n_facets"] <= 16
