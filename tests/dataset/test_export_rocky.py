"""The Rocky script against a recorder that knows Rocky's method names, and the paper's Tables 1 and 2."""

import json
import runpy
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import trimesh

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import ExportOptions, write_export
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.lifting_cylinder import particle_count
from regolith_studio.dataset.size_distributions import (
    PAPER_CLASSES_UM,
    DiscreteSizeDistribution,
    LogNormalSizeDistribution,
    ShapeClass,
)
from regolith_studio.readers.positions import read_positions

from .example import entry
from .rocky_recorder import Recorder

NUMBER_SHARES = (85.5, 12.6, 1.7, 0.23, 0.03)
"""A power law through the paper's sizes (per cent by number)."""


def paper_dataset(count: int = 10) -> Dataset:
    sizes = DiscreteSizeDistribution.of(PAPER_CLASSES_UM, NUMBER_SHARES)
    return build_dataset([entry(seed) for seed in range(count)], sizes=sizes, name="Table 1")


PAPER = ExportOptions(coarse_graining_factor=10.0)


def recorded(dataset: Dataset, folder: Path, options: ExportOptions = PAPER) -> Recorder:
    """What the script of an export tells Rocky."""
    exported = write_export(dataset, EXPORTERS["rocky"], folder, options)
    application = Recorder("app")
    runpy.run_path(str(exported.folder / "rocky_case.py"), {"app": application}, "script")
    return application


def inlets(study: Recorder) -> list[tuple[Recorder, float]]:
    """Particle and mass of each inlet."""
    made = [dict(inlet.calls[0][1]) for inlet in study.of("inlet")]
    return [(one["particle"], one["mass"]) for one in made]


def rows(particle: Recorder) -> np.ndarray:
    """Sizes in metres and cumulative percentages, as Rocky was told."""
    table = []
    for size in particle.of("size"):
        value, unit = size.told("SetSize")
        assert unit == "m"
        table.append((value, size.told("SetCumulativePercentage")))
    return np.array(table)


def simulated_particles(study: Recorder, density: float) -> float:
    """Number of particles that Rocky would make: mass by size over the mass of one, coarse graining on."""
    total = 0.0
    for particle, mass in inlets(study):
        table, (sizes,) = rows(particle), particle.of("sizes")
        factor = sizes.told("SetCgmScaleFactor")
        shares = -np.diff(np.append(table[:, 1], 0.0)) / 100
        total += (mass * shares / (density * np.pi / 6 * (factor * table[:, 0]) ** 3)).sum()
    return total


def test_that_the_papers_378000_particles_weigh_15_grams(tmp_path: Path) -> None:
    study = recorded(paper_dataset(), tmp_path / "x").of("study")[0]
    assert sum(mass for _, mass in inlets(study)) == pytest.approx(0.015)
    assert simulated_particles(study, 3075.0) == pytest.approx(378_000, rel=0.02)
    assert particle_count(paper_dataset(), 0.015, 3075.0, 10.0) == pytest.approx(
        simulated_particles(study, 3075.0), rel=1e-9
    )
    solid_height = 0.015 / 3075.0 / (np.pi / 4 * 0.02**2)
    assert solid_height / 0.025 == pytest.approx(0.62, abs=0.005)
    assert solid_height / 0.030 == pytest.approx(0.52, abs=0.005)


def test_that_percentages_are_by_mass_descending_and_end_at_100(tmp_path: Path) -> None:
    study = recorded(paper_dataset(2), tmp_path / "x").of("study")[0]
    mass = np.array(NUMBER_SHARES) * np.array(PAPER_CLASSES_UM) ** 3
    for particle, _ in inlets(study):
        table = rows(particle)
        assert table[:, 0] == pytest.approx(np.array(PAPER_CLASSES_UM[::-1]) * 1e-6)
        assert table[0, 1] == 100.0
        assert table[::-1, 1] == pytest.approx(100 * np.cumsum(mass) / mass.sum())
        assert particle.of("sizes")[0].told("SetSizeType") == "equivalent_diameter"


def test_that_a_class_weight_by_number_becomes_a_share_of_the_mass(tmp_path: Path) -> None:
    classes = [
        ShapeClass(3, DiscreteSizeDistribution.empirical([20.0])),
        ShapeClass(1, DiscreteSizeDistribution.empirical([40.0])),
    ]
    study = recorded(build_dataset([entry(0), entry(1)], classes), tmp_path / "x").of("study")[0]
    masses = [mass for _, mass in inlets(study)]
    assert masses == pytest.approx([0.015 * 3 / 11, 0.015 * 8 / 11])


def test_that_a_continuous_distribution_keeps_number_and_mass(tmp_path: Path) -> None:
    sizes = LogNormalSizeDistribution(median_um=50.0, log_deviation=0.4)
    dataset = build_dataset([entry(0)], sizes=sizes)
    study = recorded(dataset, tmp_path / "x").of("study")[0]
    cube = 50.0**3 * np.exp(9 * 0.4**2 / 2)
    expected = 0.015 / (3075 * np.pi / 6 * (10e-6) ** 3 * cube)
    assert simulated_particles(study, 3075.0) == pytest.approx(expected, rel=2e-3)


def test_that_contacts_are_those_of_table_1(tmp_path: Path) -> None:
    study = recorded(paper_dataset(1), tmp_path / "x").of("study")[0]
    (physics,) = study.of("physics")
    assert physics.told("SetNormalForceModel") == "damped_hertzian"
    assert physics.told("SetTangentialForceModel") == "mindlin_deresiewicz"
    assert physics.told("SetAdhesionModel") == "JKR"
    assert physics.told("SetEnableCoarseGrainModeling") is True
    assert physics.told("SetGravityZDirection") == (-9.81, "m/s2")
    material = study.of("material")[0]
    assert material.told("SetDensity") == (3075.0, "kg/m3")
    assert material.told("SetYoungsModulus") == (30e9, "N/m2")
    assert material.told("SetPoissonRatio") == 0.2
    pair = study.of("interaction")[0]
    assert pair.calls[0][1] == {"material_1": "regolith", "material_2": "regolith"}
    assert (pair.told("SetStaticFriction"), pair.told("SetDynamicFriction")) == (0.8, 0.8)
    assert pair.told("SetSurfaceEnergy") == (0.010, "J/m2")
    frictions = {
        one.calls[0][1]["material_2"]: one.told("SetStaticFriction") for one in study.of("interaction")
    }
    assert frictions == {"regolith": 0.8, "tube": 0.3, "plate": 0.8}
    assert [wall.told("SetMaterial") for wall in study.of("wall")] == ["plate", "tube"]


def test_that_the_tube_of_table_2_is_lifted_clear_after_settling(tmp_path: Path) -> None:
    study = recorded(paper_dataset(1), tmp_path / "x").of("study")[0]
    plate, tube = study.of("wall")
    (frame,) = study.of("frame")
    assert frame.told("ApplyTo") is tube
    motion = dict(frame.of("motion")[0].calls[0][1])
    (start, _), (stop, _), (velocity, _) = motion["start_time"], motion["stop_time"], motion["velocity"]
    assert (stop - start) * velocity[2] == pytest.approx(0.08)
    assert study.of("solver")[0].told("SetSimulationDuration")[0] >= stop
    mesh = trimesh.load_mesh(tube.calls[0][1]["custom_filename"])
    assert mesh.is_watertight
    assert mesh.bounds[:, 2] == pytest.approx([0.0, 0.08])
    inner = np.linalg.norm(mesh.vertices[:, :2], axis=1).min()
    assert inner == pytest.approx(0.01, rel=2e-3)
    floor = trimesh.load_mesh(plate.calls[0][1]["custom_filename"])
    assert floor.is_watertight
    assert floor.bounds[1, 2] == pytest.approx(0.0, abs=1e-9)


def test_that_every_shape_is_imported_from_an_stl_of_volume_one(tmp_path: Path) -> None:
    study = recorded(paper_dataset(3), tmp_path / "x").of("study")[0]
    for particle in study.of("particle"):
        file, as_concave = particle.told("ImportFromSTL")
        assert as_concave is False
        mesh = trimesh.load_mesh(file)
        assert mesh.is_watertight
        assert mesh.volume == pytest.approx(1.0, rel=1e-6)
        assert np.abs(mesh.center_mass).max() < 1e-6


def test_that_without_coarse_graining_none_is_switched_on(tmp_path: Path) -> None:
    study = recorded(paper_dataset(1), tmp_path / "x", ExportOptions(coarse_graining_factor=1.0)).of("study")[
        0
    ]
    assert study.of("physics")[0].told("SetEnableCoarseGrainModeling") is False
    assert all(name != "SetCgmScaleFactor" for sizes in study.of("sizes") for name, _ in sizes.calls)


def test_that_narrow_rows_leave_only_the_diameters_of_the_dataset(tmp_path: Path) -> None:
    """Sizes drawn evenly between neighbouring rows, as an interpolating reader would, are the dataset's."""
    folder = write_export(paper_dataset(1), EXPORTERS["rocky"], tmp_path / "x").folder
    space: dict = {"__file__": str(folder / "rocky_case.py"), "__name__": "script"}
    exec((folder / "rocky_case.py").read_text(), space)
    space["NARROW"], application = True, Recorder("app")
    space["main"](application)
    table = rows(application.of("particle")[0])[::-1]
    assert len(table) == 10
    drawn = np.interp(np.random.default_rng(0).uniform(0, 100, 5000), table[:, 1], table[:, 0])
    nearest = np.abs(drawn[:, None] / (np.array(PAPER_CLASSES_UM) * 1e-6) - 1).min(axis=1)
    assert nearest.max() < 2e-4


def test_that_a_shape_that_rocky_cannot_import_stops_the_script(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(Recorder, "_answer", _refusing(Recorder._answer))
    with pytest.raises(RuntimeError, match="could not import"):
        recorded(paper_dataset(1), tmp_path / "x")


def test_that_the_simulation_waits_for_the_user(tmp_path: Path) -> None:
    study = recorded(paper_dataset(1), tmp_path / "x").of("study")[0]
    assert all(name != "StartSimulation" for name, _ in study.calls)
    assert json.loads((tmp_path / "x" / "case.json").read_text())["project"].endswith(".rocky")


class SimulatedApp:
    """Rocky's ``app`` with a finished simulation, by the names of the scripting manual."""

    def __init__(self, rows: np.ndarray) -> None:
        self.rows = rows

    def GetStudy(self) -> "SimulatedApp":  # noqa: N802
        return self

    def GetParticles(self) -> "SimulatedApp":  # noqa: N802
        return self

    def GetCurve(self, name: str) -> "SimulatedApp":  # noqa: N802
        assert name == "Particles Count"
        return self

    def GetY(self) -> np.ndarray:  # noqa: N802
        return np.array([0, 1, len(self.rows)])

    def IterParticles(self, time_step: int) -> Iterator[SimpleNamespace]:  # noqa: N802
        assert time_step == 2
        return (SimpleNamespace(x=x, y=y, z=z, size=size) for x, y, z, size in self.rows)


@pytest.mark.parametrize("told", [1.0, 10.0])
def test_that_positions_come_back_from_rocky_enlarged_once(tmp_path: Path, told: float) -> None:
    """Whether Rocky tells sizes with the coarse graining or without, the largest asked for decides."""
    folder = write_export(paper_dataset(1), EXPORTERS["rocky"], tmp_path / "x", PAPER).folder
    places = np.random.default_rng(0).uniform(-0.01, 0.01, (50, 3))
    diameters = 1e-6 * np.resize(PAPER_CLASSES_UM, 50)
    application = SimulatedApp(np.column_stack([places, told * diameters]))
    runpy.run_path(str(folder / "rocky_positions.py"), {"app": application}, "script")
    found = read_positions(folder / "positions.csv", "mm")
    assert found.points == pytest.approx(places)
    assert found.diameters == pytest.approx(10 * diameters)


def _refusing(answer):
    def refuse(self: Recorder, name: str, gives: str, arguments: dict) -> object:
        return False if gives == "true" else answer(self, name, gives, arguments)

    return refuse
