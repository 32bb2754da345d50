"""The recipe of a session: all that is open and chosen, so that ``run`` writes the same bytes."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from regolith_studio.readers.particles import unique_name
from regolith_studio.session.choices import Choices
from regolith_studio.session.provenance import (
    FileSource,
    ParticleRef,
    ParticleSource,
    SampleSource,
    VirtualSource,
    VolumeSource,
)
from regolith_studio.session.recipe import SAMPLE, DatasetRequest, FilesEntry, NamedParticle, Outputs, Recipe
from regolith_studio.session.results import ParticleEntry
from regolith_studio.shape_models.io import write_model
from regolith_studio.shape_models.protocol import FittedModel


@dataclass(frozen=True)
class SessionRecipe:
    """A recipe, and what it cannot hold by itself.

    Parameters
    ----------
    recipe
        Of all particles that have an origin; with models beside it, it must be written by :meth:`beside`.
    model
        What its population is drawn from, if no shipped card is.
    lost
        Ids of the particles that it cannot bring back.
    """

    recipe: Recipe
    model: FittedModel | None = field(default=None, repr=False)
    lost: tuple[str, ...] = ()

    @classmethod
    def of(
        cls,
        entries: Sequence[ParticleEntry],
        choices: Choices,
        outputs: Outputs | None = None,
        standing: DatasetRequest | None = None,
    ) -> "SessionRecipe":
        """Of particles and choices, and of the wish for a dataset; without any particle, of the sample."""
        wish = standing if standing and (outputs is None or outputs.dataset) else DatasetRequest()
        placed = [(entry.id, entry.place) for entry in entries]
        origins = _in_order([place.origin for _, place in placed if place is not None])
        named = dict(_names(origins))
        pairs = [(named.get(place), name) for name, place in placed]
        files = [each for each in origins if isinstance(each, FileSource)]
        drawn = next((each for each in origins if isinstance(each, VirtualSource)), None)
        first = files[0] if files else None
        recipe = Recipe.from_choices(
            choices,
            _inputs(origins),
            outputs,
            unit=first.unit if first else choices.unit,
            repair=first.repair if first else choices.repair,
            volumes=[each.volume for each in origins if isinstance(each, VolumeSource)],
            population=drawn.population if drawn else None,
            particles=_selection(pairs, list(named.values())),
            representatives=wish.representatives,
            exports=wish.exports,
        )
        lost = tuple(name for known, name in pairs if known is None)
        return cls(recipe, drawn.model if drawn else None, lost)

    def beside(self, path: Path, whole_path: bool = False) -> Recipe:
        """The recipe as it can be written to `path`; a model is written beside it.

        Parameters
        ----------
        whole_path
            Name the model by its whole path: the recipe will lie elsewhere.

        Raises
        ------
        FileError
            If the model cannot be written.
        """
        population = self.recipe.population
        if self.model is None or population is None:
            return self.recipe
        model = path.with_name(f"{path.stem}-model.json")
        write_model(model, self.model, {"source": population.name, "notes": []})
        told = population.model_copy(update={"sources": [str(model) if whole_path else model.name]})
        return self.recipe.model_copy(update={"population": told})


def _in_order(origins: Sequence[ParticleSource]) -> list[ParticleSource]:
    """As a recipe takes them: the sample, files, volumes, one population."""
    kinds = (SampleSource, FileSource, VolumeSource, VirtualSource)
    found = [each for kind in kinds for each in dict.fromkeys(o for o in origins if isinstance(o, kind))]
    populations = [each for each in found if isinstance(each, VirtualSource)]
    return [each for each in found if each not in populations[1:]]


def _inputs(origins: Sequence[ParticleSource]) -> list[str | FilesEntry]:
    files = [each for each in origins if isinstance(each, FileSource)]
    named: list[str | FilesEntry] = [SAMPLE] if not origins or SampleSource() in origins else []
    for number, each in enumerate(files):
        entry = FilesEntry(files=list(each.paths), unit=each.unit, repair=each.repair)
        named += [entry] if number else each.paths
    return named


def _selection(
    pairs: Sequence[tuple[str | None, str]], all_names: Sequence[str]
) -> list[str | NamedParticle] | None:
    """Names of the particles among all that a run finds; ``None`` where it is all of them in their order."""
    found = [(known, name) for known, name in pairs if known is not None]
    if not found or found == [(name, name) for name in all_names]:
        return None
    return [known if known == name else NamedParticle(name=known, called=name) for known, name in found]


def _names(origins: Sequence[ParticleSource]) -> Iterator[tuple[ParticleRef | None, str]]:
    """The name that each particle of the origins gets in a run."""
    taken: set[str] = set()
    for origin in origins:
        for key, name, group in origin.members():
            yield ParticleRef(origin, key), unique_name(name, group, taken)
