"""Restore the particles of a recipe into a session: read, extract and draw them."""

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from regolith_studio.errors import FileError, InputError, RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.messages import N_
from regolith_studio.readers.particles import FileProblem, LoadedParticles
from regolith_studio.session.provenance import (
    FileSource,
    ParticleRef,
    SampleSource,
    VirtualSource,
    VolumeSource,
)
from regolith_studio.session.recipe import Recipe

if TYPE_CHECKING:
    from regolith_studio.session.batch.inputs import BatchInput
    from regolith_studio.session.batch.preprocessing import PreparedInputs

MOST = 2000
"""Virtual particles that are opened at most: each becomes a mesh in memory."""


@dataclass(frozen=True)
class RestoredParticles:
    """Particles with what a recipe names them by, one place a particle."""

    loaded: LoadedParticles
    places: tuple[ParticleRef, ...]


def restore_particles(recipe: Recipe, beside: Path) -> Steps:
    """Read, extract and draw what `recipe` names; returns :class:`RestoredParticles`.

    Parameters
    ----------
    beside
        Folder that relative files are looked up in.

    Raises
    ------
    FileError
        If nothing can be read.
    InputError
        If a setting is wrong, or the population is too large to be opened.
    """
    from regolith_studio.jobs.executor import Executor
    from regolith_studio.session.batch.inputs import BatchInputs
    from regolith_studio.session.batch.preprocessing import prepare_inputs

    if recipe.population is not None and recipe.population.n > MOST:
        raise InputError(
            f"{recipe.population.n:,} virtual particles are too many to open; at most {MOST:,}. "
            "Run the recipe as a batch."
        )
    with tempfile.TemporaryDirectory(prefix="regolith-") as scratch:
        prepared: PreparedInputs = yield from prepare_inputs(
            recipe, beside.absolute(), Path(scratch) / "work" / "prepared", Executor(1)
        )
        items = BatchInputs.of(recipe, beside.absolute(), prepared)
        places = _References(recipe, beside.absolute(), prepared)
        return (yield from _read(items.members, list(items.problems), places))


def _read(members: Sequence["BatchInput"], problems: list[FileProblem], places: "_References") -> Steps:
    yield Started(N_("Bringing particles back"), len(members))
    found: list[tuple[Particle, ParticleRef]] = []
    for number, item in enumerate(members, start=1):
        try:
            found.append((item.particle(), places.of(item)))
        except RegolithError as error:
            problems.append(FileProblem(item.name, str(error)))
        yield Progress(number, len(members), item.name)
    if not found:
        raise FileError(problems[0].sentence if problems else "There is no particle in the recipe.")
    particles, known = zip(*found, strict=True)
    return RestoredParticles(LoadedParticles(particles, tuple(problems)), known)


class _References:
    """Tells of each item which particle of which origin it is."""

    def __init__(self, recipe: Recipe, base: Path, prepared: "PreparedInputs") -> None:
        from regolith_studio.session.batch.preprocessing import read_index, resolved

        named = (
            FileSource(tuple(str(base / file) for file in files), unit, repair)
            for files, unit, repair in recipe.openings
        )
        self._files = {key: each for each in named for key, _, _ in each.members()}
        self._volumes = {
            folder: VolumeSource(
                resolved(entry, base), tuple((g["name"], g["name"], g["group"]) for g in read_index(folder))
            )
            for entry, folder in zip(recipe.volumes, prepared.volumes, strict=True)
        }
        self._drawn = _drawn(recipe, prepared)

    def of(self, item: "BatchInput") -> ParticleRef:
        """The place of an item."""
        from regolith_studio.session.batch.inputs import FileInput, GrainInput, SampleInput, VirtualInput

        match item:
            case FileInput(file=file):
                return ParticleRef(self._files[str(file.path)], str(file.path))
            case GrainInput(folder=folder, entry=entry):
                return ParticleRef(self._volumes[folder], str(entry["name"]))
            case VirtualInput(index=index) if self._drawn is not None:
                return ParticleRef(self._drawn, self._drawn.members()[index][0])
            case SampleInput(original=original):
                return ParticleRef(SampleSource(), original)
        raise ValueError(f"{item!r} is no item of a recipe")


def _drawn(recipe: Recipe, prepared: "PreparedInputs") -> VirtualSource | None:
    from regolith_studio.session.batch.inputs import model_of, title_of

    population = recipe.population
    if population is None:
        return None
    told = population.model_copy(
        update={
            "name": title_of(population),
            "seed": recipe.seed if population.seed is None else population.seed,
            "level": recipe.level if population.level is None else population.level,
        }
    )
    if prepared.model is None:
        return VirtualSource(told)
    fitted = told.model_copy(update={"model": "", "settings": {}, "l_max": None})
    return VirtualSource(fitted, model_of(population, prepared.model))
