"""What every engine offers: it finds itself, says what it represents, and runs a prepared case."""

from collections.abc import Generator
from dataclasses import dataclass
from typing import Any, Protocol

from regolith_studio.dem.case import Prepared
from regolith_studio.dem.pile import Pile


@dataclass(frozen=True)
class Representation:
    """What an engine makes of Table 1, one sentence or word each; shown in the table of engines."""

    shape: str
    normal: str
    tangential: str
    cohesion: str
    rolling: str
    coarse_graining: str
    missing: str


@dataclass(frozen=True)
class Found:
    """Whether an engine is there: its version, or else why not in one sentence."""

    version: str = ""
    problem: str = ""

    @property
    def there(self) -> bool:
        return not self.problem


@dataclass(frozen=True, eq=False)
class Moment:
    """One picture of a run.

    Parameters
    ----------
    pile
        The particles.
    share
        Of the work that is done, 0 to 1.
    message
        What is going on.
    """

    pile: Pile
    share: float
    message: str


@dataclass(frozen=True)
class Checks:
    """What is verified after every run. Overlaps in mean diameters, energies in units of m g d a particle.

    Parameters
    ----------
    particles_in, particles_out
        Number at the beginning, and of those that still lie on or above the plate at the end.
    mean_overlap, largest_overlap
        At rest.
    energy_gain
        Largest rise of the total energy while nothing that moves touches the particles; a sound
        simulation only loses energy.
    kinetic_energy
        At the end.
    at_rest
        Whether the heap came to rest before the longest wait was over.
    fill_height
        Of the settled filling in metres.
    solid_fraction
        Of the settled filling.
    problems
        A sentence for each check that failed.
    """

    particles_in: int
    particles_out: int
    mean_overlap: float
    largest_overlap: float
    energy_gain: float
    kinetic_energy: float
    at_rest: bool
    fill_height: float
    solid_fraction: float
    problems: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Ending:
    """A finished run.

    Parameters
    ----------
    pile
        Where the particles came to rest.
    checks
        Of the run.
    steps, simulated_time
        How long it was; in seconds.
    notes
        Sentences on what the engine made of the particles.
    """

    pile: Pile
    checks: Checks
    steps: int
    simulated_time: float
    notes: tuple[str, ...] = ()


class Engine(Protocol):
    """One simulation code; `Settings` is a frozen dataclass whose fields carry label and range."""

    key: str
    label: str
    order: int
    licence: str
    represents: Representation
    Settings: type[Any]

    def find(self) -> Found:
        """Look for the code without loading it."""
        ...

    def seconds(self, prepared: Prepared, settings: Any) -> float:
        """Estimated time on one core."""
        ...

    def simulate(self, prepared: Prepared, settings: Any) -> Generator[Moment, None, Ending]:
        """Run in this process; yields moments in the order of time."""
        ...
