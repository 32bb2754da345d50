"""The interface of DEM engines: availability, capabilities, and running a prepared case."""

from collections.abc import Generator
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.snapshot import EngineState, ParticleState, Snapshot

ENGINE_THREADS = "RAYON_NUM_THREADS"
"""Environment variable with the number of threads of an engine that uses several."""


@dataclass(frozen=True)
class EngineCapabilities:
    """How an engine implements the contact model of Table 1, in phrases for the table of engines.

    `compounds` says how it simulates particles of several convex parts; empty if it does not.
    """

    shape: str
    normal: str
    tangential: str
    cohesion: str
    rolling: str
    coarse_graining: str
    missing: str
    compounds: str = ""


@dataclass(frozen=True)
class Availability:
    """Version of an installed engine, or a sentence that says why it cannot be used."""

    version: str = ""
    problem: str = ""

    @property
    def there(self) -> bool:
        return not self.problem


@dataclass(frozen=True)
class RunChecks:
    """Checks after a run. Overlaps in mean diameters, energies in units of m g d per particle.

    Parameters
    ----------
    particles_in, particles_out
        Number at the beginning, and of those on or above the plate at the end.
    mean_overlap, max_overlap
        At rest.
    deep_contacts
        Share of the overlapping contacts at rest that are deeper than 0.02 mean diameters.
    energy_gain
        Maximum rise of the total energy while no moving wall touches the particles; it should only fall.
    kinetic_energy
        At the end.
    at_rest
        Whether the heap came to rest within the maximum time.
    fill_height
        Of the settled filling in metres.
    solid_fraction
        Of the settled filling.
    plate_depth
        Of the lowest corner below the plate, at rest, in mean diameters.
    problems
        A sentence for each check that failed.
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

    Parameters
    ----------
    particles
        At rest.
    checks
        Of the run.
    steps, simulated_time
        Number of time steps, and seconds.
    notes
        Sentences on how the engine approximated the particles.
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
class ResumableEngine(Protocol):
    """An engine whose snapshots offer a state, from which it can go on after the program was killed."""

    def resume(
        self, prepared: PreparedCase, settings: Any, state: EngineState
    ) -> Generator[Snapshot, None, SimulationResult]:
        """The rest of the run: snapshots after that of the state, and the result.

        Raises
        ------
        RegolithError
            If the state is that of another case, or broken.
        """
        ...
