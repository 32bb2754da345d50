"""The shipped samples are what the generator makes, byte for byte."""

import hashlib
import json
from pathlib import Path

import numpy as np
import pytest
import tifffile

from regolith_studio.imaging.volume import sample_volume
from regolith_studio.resources import resource
from tools.make_samples.samples import GRAINS, SCANS, SEED, write_samples
from tools.make_samples.synthetic_ct import ScanRecipe, synthetic_scan


def test_that_the_shipped_particles_are_made_anew_byte_for_byte(tmp_path: Path) -> None:
    write_samples(tmp_path, GRAINS[::4], scans={})
    for grain in GRAINS[::4]:
        shipped = resource("samples", "particles", f"{grain.name}.stl")
        assert (tmp_path / "particles" / shipped.name).read_bytes() == shipped.read_bytes()


def test_that_a_scan_is_written_with_its_voxel_size_and_named_in_the_manifest(tmp_path: Path) -> None:
    recipe = ScanRecipe(shape=(40, 44, 48), n_grains=3, diameter=(14.0, 12.0, 16.0))
    write_samples(tmp_path, (), {"small": recipe})
    rows = json.loads((tmp_path / "manifest.json").read_text(encoding="utf-8"))["volumes"]
    assert [row["name"] for row in rows] == ["small-labels", "small-grey"]
    with tifffile.TiffFile(tmp_path / "ct" / "small-labels.tif") as file:
        assert file.asarray().shape == (48, 44, 40)
        assert file.imagej_metadata["unit"] == "um"
        assert file.imagej_metadata["spacing"] == 2.3


@pytest.mark.slow
def test_that_the_shipped_scan_is_made_anew_voxel_for_voxel() -> None:
    scan = synthetic_scan(SCANS["synthetic"], SEED)
    assert np.array_equal(scan.labels.array, sample_volume("labels").array)
    assert np.array_equal(scan.grey.array, sample_volume("grey").array)


def test_that_the_shipped_volumes_load_with_their_voxel_size() -> None:
    labels, grey = sample_volume("labels"), sample_volume("grey")
    assert labels.shape == grey.shape == SCANS["synthetic"].shape
    assert labels.voxel_size == pytest.approx([2.3, 2.3, 2.3])
    assert np.unique(labels.array).tolist() == list(range(61))
    inside = labels.array > 0
    assert grey.array[inside].mean() > grey.array[~inside].mean() + 60


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
