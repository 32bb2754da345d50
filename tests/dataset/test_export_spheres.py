"""LIGGGHTS, PFC and EDEM: what is written is read back by readers of the published formats."""

import re
import shlex
from pathlib import Path

import numpy as np
import pytest
import trimesh

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, ExportOptions, shape_names, write_export
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.errors import DatasetError

from .example import entry

OPTIONS = ExportOptions(coarse_graining_factor=10.0, n_spheres=6)
DENSITY, COARSE = OPTIONS.contact.density, OPTIONS.coarse_graining_factor


@pytest.fixture(scope="module")
def dataset() -> Dataset:
    return build_dataset([entry(seed) for seed in range(3)], name="shapes")


@pytest.fixture(scope="module")
def exports(dataset: Dataset, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    base = tmp_path_factory.mktemp("exports")
    return {
        key: write_export(dataset, EXPORTERS[key], base / key, OPTIONS, accept_loss=True).folder
        for key in ("liggghts", "pfc", "edem")
    }


def liggghts_fixes(path: Path) -> dict[str, tuple[str, list[str]]]:
    """Style and arguments of each fix, by its name."""
    words = [line.split("#")[0].split() for line in path.read_text().splitlines()]
    return {line[1]: (line[3], line[4:]) for line in words if line and line[0] == "fix"}


def after(words: list[str], keyword: str, count: int = 1) -> list[float]:
    start = words.index(keyword) + 1
    return [float(word) for word in words[start : start + count]]


def test_that_liggghts_gets_the_mass_and_inertia_of_the_true_particles(
    dataset: Dataset, exports: dict[str, Path]
) -> None:
    fixes = liggghts_fixes(exports["liggghts"] / "templates.in")
    templates = [words for style, words in fixes.values() if style == "particletemplate/multisphere"]
    assert len(templates) == len(dataset)
    for place, (words, one) in enumerate(zip(templates, dataset.representatives, strict=True)):
        diameter = COARSE * 1e-6 * one.sizes.quantile(0.5)
        mass = DENSITY * np.pi / 6 * diameter**3
        assert after(words, "mass") == [pytest.approx(mass)]
        stone = trimesh.convex.convex_hull(one.shape.vertices * after(words, "scale")[0])
        stone.density = DENSITY
        xx, xy, xz, yy, yz, zz = after(words, "inertia_tensor", 6)
        given = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        assert given == pytest.approx(stone.moment_inertia, rel=1e-6, abs=1e-9 * zz)
        assert "use_density" in words  # asked for where mass and inertia are given
        assert after(words, "type") == [place + 1]  # consecutive, from 1
        file = exports["liggghts"] / words[words.index("file") + 1]
        spheres = np.loadtxt(file, ndmin=2)
        assert spheres.shape == (after(words, "nspheres")[0], 4)
        inside = one.shape.half_spaces.normals @ spheres[:, :3].T < one.shape.half_spaces.offsets[:, None]
        assert inside.all(), "the centre of each sphere lies in the polyhedron"


def test_that_the_distribution_of_liggghts_names_every_template_once_and_adds_up_to_all_mass(
    dataset: Dataset, exports: dict[str, Path]
) -> None:
    fixes = liggghts_fixes(exports["liggghts"] / "templates.in")
    style, words = fixes.pop("pdd")
    seed, count, *pairs = words
    assert style == "particledistribution/discrete"
    assert int(count) == len(fixes) == len(pairs) / 2
    assert all(int(seed) % each for each in range(2, int(int(seed) ** 0.5) + 1)), "a prime"
    assert pairs[::2] == list(fixes)
    shares = [float(share) for share in pairs[1::2]]
    assert sum(shares) == pytest.approx(1.0)
    assert shares == pytest.approx(dataset.class_weights("volume"))


def pfc_commands(path: Path) -> list[list[str]]:
    """Words of each command; ``...`` at the end of a line goes on, ``;`` begins a comment."""
    lines = (line.split(";")[0].rstrip() for line in path.read_text().splitlines())
    joined = re.sub(r"\s*\.\.\.\n\s*", " ", "\n".join(lines))
    return [shlex.split(line) for line in joined.splitlines() if line.strip()]


def test_that_pfc_imports_each_polyhedron_and_gives_its_template_the_same_mass_properties(
    dataset: Dataset, exports: dict[str, Path]
) -> None:
    commands = pfc_commands(exports["pfc"] / "templates.dat")
    imports = [words for words in commands if words[:2] == ["geometry", "import"]]
    templates = [words for words in commands if words[:3] == ["clump", "template", "create"]]
    assert len(commands) == len(imports) + len(templates)
    for read, made, one in zip(imports, templates, dataset.representatives, strict=True):
        assert read[3:6] == ["format", "stl", "set"]
        assert made[made.index("name") + 1] == made[made.index("geometry") + 1] == read[6]
        body = trimesh.load_mesh(exports["pfc"] / read[2])
        assert body.is_watertight
        assert after(made, "volume") == [pytest.approx(body.volume, rel=1e-5)] == [pytest.approx(1.0)]
        tensor = after(made, "inertia", 6)
        assert tensor[:3] == pytest.approx(np.diag(body.moment_inertia), rel=1e-5)
        assert tensor[3:] == [0, 0, 0]
        assert body.moment_inertia == pytest.approx(np.diag(tensor[:3]), abs=1e-6)
        count = int(after(made, "pebbles")[0])
        pebbles = np.reshape(after(made, "pebbles", 1 + 4 * count)[1:], (count, 4))
        assert made[made.index("pebbles") + 2 + 4 * count] == "volume"
        inside = one.shape.half_spaces.normals @ pebbles[:, 1:].T < one.shape.half_spaces.offsets[:, None]
        assert inside.all(), "the centre of each pebble lies in the polyhedron"


def test_that_edem_gets_closed_convex_bodies_of_volume_one_in_their_principal_axes(
    dataset: Dataset, exports: dict[str, Path]
) -> None:
    for name in shape_names(dataset):
        body = trimesh.load_mesh(exports["edem"] / "meshes" / f"{name}.stl")
        assert body.is_watertight
        assert body.convex_hull.volume == pytest.approx(body.volume, rel=1e-5)
        assert body.volume == pytest.approx(1.0, rel=1e-5)
        assert np.abs(body.center_mass).max() < 1e-5
        assert np.abs(body.moment_inertia - np.diag(np.diag(body.moment_inertia))).max() < 1e-5


@pytest.mark.parametrize("key", ["liggghts", "pfc"])
def test_that_spheres_in_place_of_polyhedra_must_be_accepted(
    dataset: Dataset, tmp_path: Path, key: str
) -> None:
    with pytest.raises(DatasetError, match="overlapping spheres"):
        write_export(dataset, EXPORTERS[key], tmp_path / "x", OPTIONS)


@pytest.mark.slow
@pytest.mark.parametrize("key", ["liggghts", "pfc"])
def test_that_an_error_of_the_spheres_takes_the_place_of_their_number(dataset: Dataset, key: str) -> None:
    few = EXPORTERS[key].files(dataset, ExportOptions(max_error=0.45))
    many = EXPORTERS[key].files(dataset, ExportOptions(max_error=0.25))
    spheres = [re.findall(rb": (\d+) (?:spheres|pebbles)", files[NOTES]) for files in (few, many)]
    assert all(int(a) < int(b) for a, b in zip(*spheres, strict=True))
