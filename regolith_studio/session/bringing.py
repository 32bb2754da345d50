"""Brings the particles of a recipe into a session: read, extracted and drawn, as a run would take them."""

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from regolith_studio.errors import FileError, InputError, RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.readers.particles import FileProblem, LoadedParticles
from regolith_studio.session.origins import Drawn, Files, Grains, Place, Shipped
from regolith_studio.session.recipe import Recipe

if TYPE_CHECKING:
    from regolith_studio.session.batch.items import Item
    from regolith_studio.session.batch.prepared import Prepared

MOST = 2000
"""Virtual particles that are opened at most: each becomes a mesh in memory."""


@dataclass(frozen=True)
class Brought:
    """Particles with what a recipe names them by, one place a particle."""

    loaded: LoadedParticles
    places: tuple[Place, ...]


def bring_back(recipe: Recipe, beside: Path) -> Steps:
    """Read, extract and draw what `recipe` names; returns :class:`Brought`.

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
    from regolith_studio.session.batch.items import Items
    from regolith_studio.session.batch.prepared import prepare

    if recipe.population is not None and recipe.population.n > MOST:
        raise InputError(
            f"{recipe.population.n:,} virtual particles are too many to open; at most {MOST:,}. "
            "Run the recipe as a batch."
        )
    with tempfile.TemporaryDirectory(prefix="regolith-") as scratch:
        prepared: Prepared = yield from prepare(
            recipe, beside.absolute(), Path(scratch) / "work" / "prepared", Executor(1)
        )
        items = Items.of(recipe, beside.absolute(), prepared)
        places = _Places(recipe, beside.absolute(), prepared)
        return (yield from _read(items.members, list(items.problems), places))


def _read(members: Sequence["Item"], problems: list[FileProblem], places: "_Places") -> Steps:
    yield Started("Bringing particles back", len(members))
    found: list[tuple[Particle, Place]] = []
    for number, item in enumerate(members, start=1):
        try:
            found.append((item.particle(), places.of(item)))
        except RegolithError as error:
            problems.append(FileProblem(item.name, str(error)))
        yield Progress(number, len(members), item.name)
    if not found:
        raise FileError(problems[0].sentence if problems else "There is no particle in the recipe.")
    particles, known = zip(*found, strict=True)
    return Brought(LoadedParticles(particles, tuple(problems)), known)


class _Places:
    """Tells of each item which particle of which origin it is."""

    def __init__(self, recipe: Recipe, base: Path, prepared: "Prepared") -> None:
        from regolith_studio.session.batch.prepared import read_index, resolved

        named = (
            Files(tuple(str(base / file) for file in files), unit, repair)
            for files, unit, repair in recipe.openings
        )
        self._files = {key: each for each in named for key, _, _ in each.members()}
        self._volumes = {
            folder: Grains(
                resolved(entry, base), tuple((g["name"], g["name"], g["group"]) for g in read_index(folder))
            )
            for entry, folder in zip(recipe.volumes, prepared.volumes, strict=True)
        }
        self._drawn = _drawn(recipe, prepared)

    def of(self, item: "Item") -> Place:
        """The place of an item."""
        from regolith_studio.session.batch.items import DrawnItem, FileItem, GrainItem, SampleItem

        match item:
            case FileItem(file=file):
                return Place(self._files[str(file.path)], str(file.path))
            case GrainItem(folder=folder, entry=entry):
                return Place(self._volumes[folder], str(entry["name"]))
            case DrawnItem(index=index) if self._drawn is not None:
                return Place(self._drawn, self._drawn.members()[index][0])
            case SampleItem(original=original):
                return Place(Shipped(), original)
        raise ValueError(f"{item!r} is no item of a recipe")


def _drawn(recipe: Recipe, prepared: "Prepared") -> Drawn | None:
    from regolith_studio.session.batch.items import model_of, title_of

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
        return Drawn(told)
    fitted = told.model_copy(update={"model": "", "settings": {}, "l_max": None})
    return Drawn(fitted, model_of(population, prepared.model))
