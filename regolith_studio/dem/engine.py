"""The interface of DEM engines: availability, capabilities, running a prepared case, the checks after it."""

from collections.abc import Generator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from typing import Any, Protocol, runtime_checkable

import numpy as np
from scipy.spatial.transform import Rotation

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.snapshot import EngineState, ParticleState, Snapshot
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.messages import N_, Message, Number

ENGINE_THREADS = "RAYON_NUM_THREADS"
"""Environment variable with the number of threads of an engine that uses several."""


@dataclass(frozen=True)
class EngineCapabilities:
    """How an engine implements the contact model of Table 1, in phrases for the table of engines.

    `compounds` says how it simulates particles of several convex parts, `drum` how it turns a drum; these,
    `cohesion` and `rolling` are empty if it does not.
    """

    shape: str
    normal: str
    tangential: str
    cohesion: str
    rolling: str
    coarse_graining: str
    missing: str
    compounds: str = ""
    drum: str = ""


@dataclass(frozen=True)
class Availability:
    """Version of an installed engine, or a sentence that says why it cannot be used."""

    version: str = ""
    problem: str = ""

    @property
    def there(self) -> bool:
        return not self.problem

    @classmethod
    def of(cls, problem: str, *packages: str) -> "Availability":
        """Version of the first of these packages that is installed, or the problem that none is."""
        for package in packages:
            with suppress(PackageNotFoundError):
                return cls(version(package))
        return cls(problem=problem)


@dataclass(frozen=True)
class RunChecks:
    """Checks after a run. Overlaps in mean diameters, energies in m g d per particle, with the mass m
    of a particle of mean diameter d.

    - ``particles_in``, ``particles_out``: number at the beginning, and of those on or above the plate at the
      end.
    - ``mean_overlap``, ``max_overlap``: at rest.
    - ``deep_contacts``: share of the overlapping contacts at rest that are deeper than 0.02 mean diameters.
    - ``energy_gain``: maximum rise of the total energy while no moving wall touches the particles; it should
      only fall.
    - ``kinetic_energy``: at the end.
    - ``at_rest``: whether the heap came to rest within the maximum time.
    - ``fill_height``: of the settled filling in metres.
    - ``solid_fraction``: of the settled filling.
    - ``plate_depth``: of the lowest corner below the plate, at rest, in mean diameters.
    - ``problems``: a sentence for each check that failed.
    """

    particles_in: int
    particles_out: int
    mean_overlap: float
    max_overlap: float
    deep_contacts: float
    energy_gain: float
    kinetic_energy: float
    at_rest: bool
    fill_height: float
    solid_fraction: float
    plate_depth: float
    problems: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class SimulationResult:
    """Result of a finished run.

    - ``particles``: at rest.
    - ``checks``: of the run.
    - ``steps``, ``simulated_time``: number of time steps, and seconds.
    - ``notes``: sentences on how the engine approximated the particles.
    """

    particles: ParticleState
    checks: RunChecks
    steps: int
    simulated_time: float
    notes: tuple[str, ...] = ()


class Engine(Protocol):
    """One simulation code; `Settings` is a frozen dataclass whose fields carry label and range."""

    key: str
    label: str
    order: int
    licence: str
    capabilities: EngineCapabilities
    Settings: type[Any]

    def find(self) -> Availability:
        """Check for the code without loading it."""
        ...

    def seconds(self, prepared: PreparedCase, settings: Any) -> float:
        """Estimated time on one core."""
        ...

    def simulate(self, prepared: PreparedCase, settings: Any) -> Generator[Snapshot, None, SimulationResult]:
        """Run in this process; yields snapshots in the order of time."""
        ...


@runtime_checkable
class CheckedEngine(Protocol):
    """An engine that represents less than its capabilities say."""

    def check(self, prepared: PreparedCase) -> None:
        """Check a case before it is run.

        Raises InputError if the engine does not represent it.
        """
        ...


@runtime_checkable
class ResumableEngine(Protocol):
    """An engine whose snapshots offer a state, from which it can go on after the program was killed."""

    def resume(
        self, prepared: PreparedCase, settings: Any, state: EngineState
    ) -> Generator[Snapshot, None, SimulationResult]:
        """The rest of the run: snapshots after that of the state, and the result.

        Raises RegolithError if the state is that of another case, or broken.
        """
        ...


MASS = np.pi / 6
"""Of a particle of mean diameter, where that and the density are 1."""
# Settled fillings have 0.1 to 0.2 % of deep contacts; 1 % hide less than 0.3 % of the volume.
DEEP_OVERLAP, MAX_DEEP_CONTACTS = 0.02, 0.01
"""Overlap in mean diameters above which a contact is deep, and maximum accepted share of these at rest.
The share does not depend on the number of particles; docs/repose.md says why these limits."""
MAX_OVERLAP = 0.1
"""Maximum accepted overlap of any two particles at rest, in mean diameters: half the radius of the inscribed
ball of a flat particle. What is deeper has begun to pass through another."""
MAX_ENERGY_GAIN = 0.1
"""Maximum accepted rise of the energy between two samples, in m g d per particle: rounding of the solver."""


def check_run(
    heights: FloatArray,
    overlaps: FloatArray,
    *,
    energy_gain: float,
    kinetic_energy: float,
    at_rest: bool,
    filling: tuple[float, float],
    lowest: FloatArray,
    problems: Sequence[str] = (),
) -> RunChecks:
    """Results of the checks, with a sentence for each check that failed.

    - ``heights``: of the particles' centres above the plate in mean diameters, shape (n,).
    - ``overlaps``: depths at rest in mean diameters, shape (m,).
    - ``filling``: height in metres and solid fraction before the lift.
    - ``lowest``: height of each particle's lowest point above the plate in mean diameters, shape (n,).
    - ``problems``: sentences of the engine, which come first.
    """
    present, sentences = int(np.count_nonzero(heights > -1.0)), list(problems)
    if present < len(heights):
        template = N_("{lost} of {count} particles fell through the plate.")
        sentences.append(Message(template, lost=len(heights) - present, count=len(heights)))
    largest, deep = float(overlaps.max(initial=0.0)), _deep_share(overlaps)
    sentences += _overlap_problems(largest, deep)
    if energy_gain > MAX_ENERGY_GAIN:
        template = N_("The energy rose by {gain} m g d per particle without external work.")
        sentences.append(Message(template, gain=Number(energy_gain, ".2g")))
    if not at_rest:
        sentences.append(Message(N_("The heap was still moving at the end.")))
    return RunChecks(
        particles_in=len(heights),
        particles_out=present,
        mean_overlap=float(overlaps.mean()) if len(overlaps) else 0.0,
        max_overlap=largest,
        deep_contacts=deep,
        energy_gain=energy_gain,
        kinetic_energy=kinetic_energy,
        at_rest=at_rest,
        fill_height=filling[0],
        solid_fraction=filling[1],
        plate_depth=float(np.max(-lowest[heights > -1.0], initial=0.0)),
        problems=tuple(sentences),
    )


def _deep_share(overlaps: FloatArray) -> float:
    """Share of the contacts that overlap which are deeper than :data:`DEEP_OVERLAP`."""
    touching = np.count_nonzero(overlaps > 0.0)
    return float(np.count_nonzero(overlaps > DEEP_OVERLAP) / touching) if touching else 0.0


def _overlap_problems(largest: float, deep: float) -> list[str]:
    """Sentences on overlaps that are too many or too deep."""
    sentences: list[str] = []
    if deep > MAX_DEEP_CONTACTS:
        template = N_("{share} % of the contacts are deeper than {depth} % of the mean diameter.")
        depth = Number(100 * DEEP_OVERLAP, "g")
        sentences.append(Message(template, share=Number(100 * deep, ".1f"), depth=depth))
    if largest > MAX_OVERLAP:
        template = N_("Particles overlap by up to {overlap} % of the mean diameter.")
        sentences.append(Message(template, overlap=Number(100 * largest, ".1f")))
    return sentences


def measure_filling(prepared: PreparedCase, particles: ParticleState) -> tuple[float, float]:
    """Height of a filling in metres, and its solid fraction."""
    # Not the highest: a few particles lie alone on top of every filling.
    height = float(np.quantile(particles.points[:, 2] + particles.diameters / 2, 0.98))
    volume = prepared.mass / prepared.case.contact.density
    return height, volume / (prepared.case.test.area * height)


def lowest_corners(prepared: PreparedCase, particles: ParticleState) -> FloatArray:
    """Height of the lowest corner of every particle above the plate, in metres, shape (n,)."""
    downwards = Rotation.from_quat(particles.orientations, scalar_first=True).as_matrix()[:, 2]
    lowest = [
        (prepared.shapes[kind] @ way).min() for kind, way in zip(prepared.class_index, downwards, strict=True)
    ]
    return np.asarray(particles.points[:, 2] + prepared.scales * np.array(lowest))
