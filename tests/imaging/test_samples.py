"""The shipped samples are what the generator makes, byte for byte."""

import hashlib
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.imaging.samples import GRAINS, write_samples
from regolith_studio.imaging.stl import RECORD, stl_bytes
from regolith_studio.resources import resource


def test_that_the_shipped_particles_are_made_anew_byte_for_byte(tmp_path: Path) -> None:
    write_samples(tmp_path, GRAINS[::4])
    for grain in GRAINS[::4]:
        shipped = resource("samples", "particles", f"{grain.name}.stl")
        assert (tmp_path / "particles" / shipped.name).read_bytes() == shipped.read_bytes()


def test_that_the_manifest_names_every_file_with_its_hash() -> None:
    folder = resource("samples")
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    rows = [*manifest["particles"], *manifest["volumes"]]
    listed = {row["file"]: row["sha256"] for row in rows}
    found = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert found == {*listed, "manifest.json"}
    for name, digest in listed.items():
        assert hashlib.sha256((folder / name).read_bytes()).hexdigest() == digest
    assert manifest["unit"] == "um"
    assert [row["name"] for row in manifest["particles"]] == [grain.name for grain in GRAINS]
    assert all(len(row["description"]) > 20 for row in rows)


def test_that_all_samples_together_stay_below_ten_megabytes() -> None:
    total = sum(path.stat().st_size for path in resource("samples").rglob("*") if path.is_file())
    assert total < 10e6


def test_that_the_command_refuses_to_guess_a_folder() -> None:
    run = subprocess.run(
        [sys.executable, "-m", "regolith_studio.imaging.samples"],
        capture_output=True,
        text=True,
        check=False,
        cwd=Path(__file__).parents[2],
    )
    assert run.returncode == 2
    assert "FOLDER" in run.stderr


def test_that_stl_bytes_hold_outward_unit_normals_and_the_corners() -> None:
    mesh = GRAINS[0].mesh()
    content = stl_bytes(mesh, "a header")
    assert len(content) == 84 + 50 * len(mesh.faces)
    assert int.from_bytes(content[80:84], "little") == len(mesh.faces)
    records = np.frombuffer(content[84:], dtype=RECORD)
    assert np.linalg.norm(records["normal"], axis=1) == pytest.approx(1.0, abs=1e-6)
    assert np.abs(records["corners"] - mesh.triangles).max() < 1e-5


@pytest.mark.parametrize("header", ["solid body", "x" * 81, "µm"])
def test_that_headers_which_readers_would_misread_are_refused(header: str) -> None:
    with pytest.raises(ValueError, match="STL header"):
        stl_bytes(GRAINS[0].mesh(), header)
