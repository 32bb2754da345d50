"""LIGGGHTS, PFC, EDEM, MFiX and MUSEN: what is written is read back by readers of the published formats."""

import csv
import re
import shlex
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, ExportOptions, shape_names, write_export
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.sampling import pack_on_lattice
from regolith_studio.errors import DatasetError
from tests.tolerance import relative

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
        for key in ("liggghts", "pfc", "edem", "mfix", "musen")
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


def mfix_phases(folder: Path) -> dict[int, np.ndarray]:
    """Component spheres of each phase: x, y, z, diameter, area, in bounding diameters."""
    version, *lines = (folder / "gsp_config.csv").read_text().splitlines()
    assert version == "#version = 1"
    rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(lines)]
    assert all(row[side] == -1 and row[f"{side}_na"] == 0 for row in rows for side in "wesntb")
    return {
        phase: np.array(
            [[row[key] for key in ("x", "y", "z", "rel_d", "rel_sa")] for row in rows if row["pid"] == phase]
        )
        for phase in sorted({int(row["pid"]) for row in rows})
    }


def test_that_particles_of_mfix_have_the_mass_and_area_of_the_polyhedra(
    dataset: Dataset, exports: dict[str, Path]
) -> None:
    phases = mfix_phases(exports["mfix"])
    assert list(phases) == list(range(1, len(dataset) + 1))
    drawn = pack_on_lattice(dataset, OPTIONS)
    with (exports["mfix"] / "particle_input.csv").open() as file:
        particles = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    assert len(particles) == OPTIONS.n_particles
    for index, row in enumerate(particles):
        spheres, shape = phases[int(row["phase_id"])], dataset.representatives[drawn.class_index[index]].shape
        mass = row["density"] * np.pi / 6 * ((spheres[:, 3] * row["diameter"]) ** 3).sum()
        assert mass == pytest.approx(DENSITY * np.pi / 6 * drawn.diameter[index] ** 3)
        area = (spheres[:, 4] * row["diameter"] ** 2).sum()
        hull = trimesh.convex.convex_hull(shape.vertices * drawn.scale[index])
        assert area == pytest.approx(hull.area)
        reach = np.linalg.norm(spheres[:, :3], axis=1) + spheres[:, 3] / 2
        assert reach.max() == pytest.approx(0.5), "the bounding ball touches the outermost sphere"
        turn = Rotation.from_quat([row[f"gsp_q{k}"] for k in (1, 2, 3, 4)], scalar_first=True)
        assert turn.as_matrix() == pytest.approx(drawn.rotation_of(index))
        assert [row[axis] for axis in "XYZ"] == pytest.approx(drawn.position[index])


def test_that_the_keywords_of_mfix_describe_every_phase_and_every_pair(
    dataset: Dataset, exports: dict[str, Path]
) -> None:
    lines = (exports["mfix"] / "solids.mfx").read_text().splitlines()
    given = dict(line.split(" = ") for line in lines if not line.startswith("#"))
    count = len(dataset)
    assert int(given["mmax"]) == count
    for phase in range(1, count + 1):
        assert given[f"solids_model({phase})"] == "'GSP'"
        assert float(given[f"ro_s0({phase})"]) < DENSITY, "overlapping spheres are added up"
    domain = [re.fullmatch(r"# domain at least (\w): (\S+) to (\S+) m", line) for line in lines[1:4]]
    placed = pack_on_lattice(dataset, OPTIONS).position
    for axis, said in enumerate(domain):
        assert said is not None
        assert float(said[2]) < placed[:, axis].min() < placed[:, axis].max() < float(said[3])
    restitution = [key for key in given if key.startswith("des_en_input(")]
    assert restitution == [f"des_en_input({k})" for k in range(1, count * (count + 1) // 2 + 1)]


def test_that_mfix_knows_the_size_of_a_phase_of_which_no_particle_was_drawn(dataset: Dataset) -> None:
    files = EXPORTERS["mfix"].files(dataset, OPTIONS.replaced(n_particles=1))
    given = dict(re.findall(r"(d_p0\(\d\)) = (\S+)", files["solids.mfx"].decode()))
    rows = list(csv.DictReader(files["gsp_config.csv"].decode().splitlines()[1:]))
    for phase, one in enumerate(dataset.representatives, start=1):
        shares = [float(row["rel_d"]) for row in rows if int(row["pid"]) == phase]
        volume = np.pi / 6 * float(given[f"d_p0({phase})"]) ** 3 * np.sum(np.power(shares, 3))
        density = float(re.search(rf"ro_s0\({phase}\) = (\S+)", files["solids.mfx"].decode())[1])
        median = COARSE * 1e-6 * one.sizes.quantile(0.5)
        assert density * volume == pytest.approx(DENSITY * np.pi / 6 * median**3)


def musen_database() -> Any:
    """The message that MUSEN publishes for its database of agglomerates, empty."""
    double, integer, text = (
        descriptor_pb2.FieldDescriptorProto.TYPE_DOUBLE,
        descriptor_pb2.FieldDescriptorProto.TYPE_INT32,
        descriptor_pb2.FieldDescriptorProto.TYPE_STRING,
    )
    messages: dict[str, list[tuple[str, int, int | str, bool]]] = {
        "Quatern": [(f"q{k}", k + 1, double, False) for k in range(4)],
        "Vect": [(axis, k, double, False) for k, axis in enumerate("xyz", start=1)],
        "Particle": [
            ("coord", 1, "Vect", False), ("radius", 2, double, False), ("compound", 3, text, False),
            ("quaternion", 5, "Quatern", False), ("contact_radius", 6, double, False),
        ],
        "Agglomerate": [
            ("name", 1, text, False), ("key", 2, text, False), ("volume", 3, double, False),
            ("particles", 4, "Particle", True), ("type", 6, integer, False),
        ],
        "Database": [("agglomerates", 1, "Agglomerate", True)],
    }  # fmt: skip
    file = descriptor_pb2.FileDescriptorProto(name="agglomerates.proto", syntax="proto3")
    for name, fields in messages.items():
        message = file.message_type.add(name=name)
        for field, number, kind, repeated in fields:
            entry = message.field.add(name=field, number=number, label=3 if repeated else 1)
            if isinstance(kind, str):
                entry.type, entry.type_name = entry.TYPE_MESSAGE, f".{kind}"
            else:
                entry.type = kind
    pool = descriptor_pool.DescriptorPool()
    pool.Add(file)
    return message_factory.GetMessageClass(pool.FindMessageTypeByName("Database"))()


def test_that_musen_reads_multispheres_with_the_volume_of_the_polyhedra(
    dataset: Dataset, exports: dict[str, Path]
) -> None:
    database = musen_database()
    database.ParseFromString((exports["musen"] / "shapes.madb").read_bytes())
    readme = (exports["musen"] / "README.txt").read_text()
    assert len(database.agglomerates) == len(dataset)
    for found, one in zip(database.agglomerates, dataset.representatives, strict=True):
        assert (found.type, found.name) == (1, found.key), "a multisphere"
        volume = np.pi / 6 * (COARSE * 1e-6 * one.sizes.quantile(0.5)) ** 3
        assert found.volume == relative(volume)
        density = re.search(rf"{found.key}: .* density of its compound (\S+)", readme)
        assert density is not None
        summed = sum(4 / 3 * np.pi * each.radius**3 for each in found.particles)
        assert float(density[1]) * summed == pytest.approx(DENSITY * volume)
        for each in found.particles:
            assert each.contact_radius == each.radius
            assert each.compound == found.key
            assert [each.quaternion.q0, each.quaternion.q1] == [1.0, 0.0]
            centre = np.array([each.coord.x, each.coord.y, each.coord.z]) / volume ** (1 / 3)
            assert (one.shape.half_spaces.normals @ centre < one.shape.half_spaces.offsets).all()


@pytest.mark.parametrize("key", ["liggghts", "pfc", "mfix", "musen"])
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
