"""Positions, tables, fits, models, cards, recipes, projects, datasets, slices with bytes changed at random.

Every reader gives values or one sentence, nothing else; all are asked in this process, so that nothing
but the error of a bad file passes for an answer.
"""

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import imageio.v3 as imageio
import numpy as np
import pytest

from regolith_studio.dataset.folder_io import dataset_files, read_document
from regolith_studio.errors import DatasetError, FileError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.readers import coefficient_tables
from regolith_studio.readers.coefficient_tables import read_coefficients
from regolith_studio.readers.sandbox.tasks import (
    open_volume_file,
    parse_positions,
    read_checked_slices,
    read_number_rows,
)
from regolith_studio.readers.shape_files import read_shape_source
from regolith_studio.session.outputs.measurements import FittedSample, write_fits
from regolith_studio.session.project import Project, read_project
from regolith_studio.session.recipe import Recipe, read_recipe
from regolith_studio.shape_models.materials import materials, write_card
from regolith_studio.shape_models.models import MODELS, write_model
from regolith_studio.shape_models.sample import Sample
from tests.dataset.example import example_dataset
from tests.readers.mutations import check_sentence, folder_in_memory, mutated
from tests.readers.test_bad_tables import SEEDS

Reader = Callable[[Path], Any]


class InProcess:
    """Answers as the sandbox does, without a child."""

    def request(self, task: str, path: Path, **options: Any) -> Any:
        assert task == "numbers"
        return read_number_rows({"path": str(path), **options})


def source(path: Path) -> Any:
    return read_shape_source(str(path))


def slices(path: Path) -> Any:
    volume, _ = open_volume_file(path.parent, {"names": sorted(each.name for each in path.parent.iterdir())})
    try:
        return read_checked_slices(volume, 0, 2)
    finally:
        volume.close()


def detached(path: Path) -> Any:
    volume, _ = open_volume_file(path, {})
    try:
        return read_checked_slices(volume, 0, 2)
    finally:
        volume.close()


def dataset(path: Path) -> Any:
    return read_document(path.parent)


def positions(path: Path) -> Any:
    """Finite positions."""
    parsed, _ = parse_positions(path.read_bytes(), path)
    assert np.isfinite(parsed.points).all()
    return parsed


CASES: dict[str, Reader] = {
    **{f"positions/{name}": positions for name in SEEDS},
    "complex/grain.anm": read_coefficients,
    "shtools/grain.shc": read_coefficients,
    "fit/fit.json": source,
    "model/model.json": source,
    "card/card.json": source,
    "recipe/recipe.json": read_recipe,
    "project/a.regolith": read_project,
    "dataset/dataset.json": dataset,
    "png/slice_1.png": slices,
    "bmp/slice_1.bmp": slices,
    "nhdr/voxels.nhdr": detached,
    "mhd/voxels.mhd": detached,
}


def coefficients(separator: str, lowest: Callable[[int], int]) -> str:
    values = {(0, 0): 3.5, (2, 0): 0.2, (2, 1): 0.1, (2, -1): -0.1}
    rows = [(l, m, values.get((l, m), 0.0), 0.0) for l in range(4) for m in range(lowest(l), l + 1)]  # noqa: E741
    return "".join(separator.join(map(str, row)) + "\n" for row in rows)


def write_all(place: Path) -> None:
    """A well-formed file of each kind in a folder of its own, with what belongs to it."""
    for name in CASES:
        (place / name).parent.mkdir(exist_ok=True)
    for name, data in SEEDS.items():
        (place / "positions" / name).write_bytes(data)
    (place / "complex/grain.anm").write_text(coefficients(" ", lambda degree: -degree))
    (place / "shtools/grain.shc").write_text(coefficients(", ", lambda _: 0))
    sphere = icosphere(2)
    bodies = [Mesh(sphere.vertices * axes, sphere.faces) for axes in ((3, 2, 1.5), (2, 2, 1), (4, 3, 2))]
    fits = [fit_harmonics(body, 3, sampling_degree=8) for body in bodies]
    write_fits(
        place / "fit/fit.json",
        FittedSample.of([Particle(name, body) for name, body in zip("abc", bodies, strict=True)], fits),
    )
    sample = Sample(np.stack([fit.coefficients.values for fit in fits]))
    model = MODELS["gaussian_field"]
    write_model(place / "model/model.json", model.fit(sample, model.Settings(3)))
    write_card(materials()["ma165"], place / "card/card.json")
    recipe = Recipe.model_validate({"volumes": [{"file": "a.tif"}], "population": {"sources": ["x"], "n": 5}})
    (place / "recipe/recipe.json").write_text(recipe.to_json())
    (place / "project/a.regolith").write_text(Project(recipe=recipe).model_dump_json(indent=1))
    (place / "dataset/dataset.json").write_bytes(dataset_files(example_dataset(2))["dataset.json"])
    voxels = np.random.default_rng(1).integers(0, 9, (4, 5, 6)).astype(np.uint8)
    for suffix in ("png", "bmp"):
        for number, image in enumerate(voxels):
            imageio.imwrite(place / suffix / f"slice_{number}.{suffix}", image)
    for folder in ("nhdr", "mhd"):
        (place / folder / "voxels.raw").write_bytes(voxels.tobytes())
    (place / "nhdr/voxels.nhdr").write_text(
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 6 5 4\nencoding: raw\nspacings: 1 1 2\n"
        "data file: voxels.raw\n\n"
    )
    (place / "mhd/voxels.mhd").write_text(
        "ObjectType = Image\nNDims = 3\nDimSize = 6 5 4\nElementSpacing = 1 1 2\n"
        "ElementType = MET_UCHAR\nElementDataFile = voxels.raw\n"
    )


@pytest.fixture(autouse=True)
def in_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(coefficient_tables, "shared_sandbox", InProcess)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("written")
    write_all(place)
    return place


@pytest.fixture
def folder(written: Path) -> Iterator[Path]:
    with folder_in_memory() as made:
        shutil.copytree(written, made, dirs_exist_ok=True)
        yield made


def survive(name: str, count: int, seed: int, folder: Path) -> SimpleNamespace:
    """Values or a sentence for so many changed files, and nothing else."""
    rng, path, read = np.random.default_rng(seed), folder / name, CASES[name]
    data = path.read_bytes()
    assert read(path) is not None
    said = SimpleNamespace(read=0, refused=0)
    for _ in range(count):
        path.write_bytes(mutated(data, rng))
        try:
            read(path)
            said.read += 1
        except (FileError, DatasetError) as error:
            said.refused += 1
            check_sentence(str(error), 400)
    return said


@pytest.mark.parametrize(("count", "seed"), [(200, 41), pytest.param(40_000, 42, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", CASES)
def test_that_mutations_give_values_or_a_sentence(name: str, count: int, seed: int, folder: Path) -> None:
    """The kinds of file of one reader share the many."""
    shared = sum(reader is CASES[name] for reader in CASES.values()) if count > 200 else 1
    assert survive(name, count // shared, seed, folder).refused > 0
