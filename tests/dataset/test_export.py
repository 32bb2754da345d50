"""Exports as folders: what every format has in common."""

import hashlib
import json
import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import (
    NOTES,
    Exporter,
    ExportOptions,
    load_command,
    shape_names,
    write_export,
)
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.lifting_cylinder import particle_count
from regolith_studio.errors import DatasetError, InputError
from regolith_studio.io.output_lock import leftovers
from tests.files import contents

OPTIONS = ExportOptions(n_particles=12, n_spheres=4)
EXPECTED = {
    "aspherix", "chrono", "edem", "gltf", "half-spaces", "hoomd", "lammps", "liggghts",
    "mujoco", "multi-sphere", "pfc", "rockable", "rocky", "yade",
}  # fmt: skip


def written(dataset: Dataset, key: str, folder: Path, options: ExportOptions = OPTIONS) -> Path:
    return write_export(dataset, EXPORTERS[key], folder, options, accept_loss=True).folder


def test_that_all_formats_are_found_by_themselves() -> None:
    assert set(EXPORTERS) == EXPECTED
    assert all(exporter.key == key for key, exporter in EXPORTERS.items())


OF_SPHERES = {"liggghts", "pfc"}
"""Formats whose shapes are the spheres of the format multi-sphere, and take as long."""


@pytest.mark.parametrize(
    "key",
    [pytest.param(key, marks=[pytest.mark.slow] if key in OF_SPHERES else []) for key in sorted(EXPECTED)],
)
def test_that_an_export_says_what_it_is_and_gives_the_same_bytes_again(
    key: str, tmp_path: Path, make_dataset
) -> None:
    exporter = EXPORTERS[key]
    first = contents(written(make_dataset(3), key, tmp_path / "a"))
    assert contents(written(make_dataset(3), key, tmp_path / "b")) == first
    record = json.loads(first["export.json"])
    assert NOTES not in first
    assert set(record["files"]) == set(first) - {"export.json"}
    assert all(hashlib.sha256(first[name]).hexdigest() == digest for name, digest in record["files"].items())
    readme = first["README.txt"].decode()
    assert all(
        said in readme for said in (exporter.units, *exporter.carries, *exporter.loses, exporter.alters)
    )
    assert load_command(exporter, Path(), make_dataset(3)) in readme
    assert "{" not in readme.replace("{folder}", "")


@pytest.mark.parametrize("key", ["edem", "chrono", "multi-sphere"])
def test_that_files_and_the_command_that_loads_one_name_its_particle(key, tmp_path, make_dataset) -> None:
    result = write_export(make_dataset(2), EXPORTERS[key], tmp_path / "x", OPTIONS, accept_loss=True)
    named = re.search(r"/x/(\w+/shape_00_grain_0\.\w+)", result.load_command)
    assert named is not None
    assert named.group(1) in result.files


def test_that_names_of_shapes_are_plain_for_every_program_and_differ(make_dataset) -> None:
    dataset = make_dataset(3)
    names = ("grain 1.part2/Ä", "月の石", "x" * 90)
    pairs = zip(dataset.representatives, names, strict=True)
    renamed = replace(dataset, representatives=tuple(replace(one, name=name) for one, name in pairs))
    assert shape_names(renamed) == ["shape_00_grain_1_part2", "shape_01", "shape_02_" + "x" * 32]


@pytest.mark.parametrize("key", sorted(EXPECTED))
def test_that_shapes_are_changed_only_with_consent(key: str, tmp_path: Path, make_dataset) -> None:
    exporter = EXPORTERS[key]
    if not exporter.alters:
        write_export(make_dataset(1), exporter, tmp_path / "x", OPTIONS)
        return
    with pytest.raises(DatasetError, match="cannot hold the shapes as they are") as refused:
        write_export(make_dataset(1), exporter, tmp_path / "x", OPTIONS)
    assert exporter.alters in str(refused.value)
    assert not (tmp_path / "x").exists()


def test_that_an_export_replaces_an_export_and_nothing_else(tmp_path: Path, make_dataset) -> None:
    folder = written(make_dataset(3), "hoomd", tmp_path / "x")
    written(make_dataset(1), "aspherix", folder)
    assert not (folder / "type_shapes.json").exists()
    (folder / "log.txt").write_text("results of a week")
    with pytest.raises(DatasetError, match=r"log\.txt"):
        written(make_dataset(1), "hoomd", folder)
    assert (folder / "log.txt").read_text() == "results of a week"
    assert leftovers(folder) == []


def test_that_a_folder_of_others_and_a_file_are_refused(tmp_path: Path, make_dataset) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "export.json").write_text('{"files": {"export.json": ""}}')
    (tmp_path / "mine" / "thesis.txt").write_text("x")
    with pytest.raises(DatasetError, match="not an export's"):
        written(make_dataset(1), "hoomd", tmp_path / "mine")
    (tmp_path / "file").write_text("x")
    with pytest.raises(DatasetError, match="is a file"):
        written(make_dataset(1), "hoomd", tmp_path / "file")
    with pytest.raises(DatasetError, match="cannot be written"):
        written(make_dataset(1), "hoomd", tmp_path / "file" / "below")


def test_that_an_exporter_that_fails_leaves_the_old_export(tmp_path: Path, make_dataset) -> None:
    folder = written(make_dataset(1), "hoomd", tmp_path / "x")
    before = contents(folder)

    def fail(*_: object) -> dict[str, bytes]:
        raise DatasetError("no")

    with pytest.raises(DatasetError):
        write_export(make_dataset(1), Exporter("x", "X", "", (), (), "", fail), folder)
    assert contents(folder) == before


@pytest.mark.skipif(os.name == "nt", reason="another shell")
def test_that_commands_bear_blanks_in_paths(tmp_path: Path, make_dataset) -> None:
    folder = tmp_path / "my sets" / "it's here"
    said = write_export(make_dataset(1), EXPORTERS["half-spaces"], folder, OPTIONS).load_command
    done = subprocess.run(
        said.replace("python", sys.executable, 1), shell=True, capture_output=True, check=True
    )
    assert json.loads(done.stdout)["format"] == "half-spaces"


def test_that_settings_of_contact_and_cylinder_go_by_their_own_names() -> None:
    options = ExportOptions().replaced(seed=3, density=2900.0, restitution=0.4, mass=0.01)
    assert (options.seed, options.contact.density, options.contact.restitution) == (3, 2900.0, 0.4)
    assert options.test.mass == 0.01
    assert options.contact.youngs_modulus == 30e9


@pytest.mark.parametrize(
    "change",
    [
        {"coarse_graining_factor": 0.0},
        {"coarse_graining_factor": float("nan")},
        {"n_particles": 0},
        {"rounding": 0.0},
        {"n_spheres": 0},
        {"density": -1.0},
        {"poissons_ratio": 0.5},
        {"restitution": 1.1},
        {"static_friction": -0.1},
        {"lift_speed": 0.0},
        {"colour": 1},
    ],
)
def test_that_settings_that_make_no_sense_are_refused(change: dict[str, float]) -> None:
    with pytest.raises(InputError):
        ExportOptions().replaced(**change)


def test_that_the_number_of_particles_falls_with_the_cube_of_the_coarse_graining(make_dataset) -> None:
    dataset = make_dataset(3)
    mean = np.mean([4 / 3 * np.pi * (r.sizes.quantile(0.5) / 2 * 1e-6) ** 3 for r in dataset.representatives])
    assert particle_count(dataset, 0.01, 3000.0) == pytest.approx(0.01 / (3000 * mean))
    assert particle_count(dataset, 0.01, 3000.0, 10.0) == pytest.approx(0.01 / (3e6 * mean))
