"""Performs a recipe: from files to everything that it asks for, in one folder."""

from collections.abc import Generator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from regolith_studio.dataset.folder import write_dataset
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.building import dataset_of
from regolith_studio.jobs.coarsening import CoarsenedParticle, coarsen_sample
from regolith_studio.jobs.crew import Crew, hired
from regolith_studio.jobs.events import Progress, Started, Step, Steps
from regolith_studio.jobs.examining import Examined, examine_sample
from regolith_studio.jobs.fitting import fit_sample
from regolith_studio.jobs.loading import Loaded, load_particles, load_sample
from regolith_studio.jobs.studying import study_coarsening, study_lmax
from regolith_studio.session.choices import Choices
from regolith_studio.session.outputs.coarsening import write_coarsening
from regolith_studio.session.outputs.descriptors import described, descriptor_table
from regolith_studio.session.outputs.fits import FittedSample, write_fits
from regolith_studio.session.outputs.staging import json_bytes, staged_folder, write_bytes
from regolith_studio.session.outputs.studies import STUDIES
from regolith_studio.session.outputs.summary import SummaryFacts, write_summary
from regolith_studio.session.recipe import SAMPLE, Recipe
from regolith_studio.studies.tables import csv_text

Part = Generator[Step, None, Any]


@dataclass
class Performed:
    """What a recipe has led to so far.

    Parameters
    ----------
    folder
        Where everything is.
    problems
        One sentence for each file or particle that failed.
    """

    folder: Path
    recipe: Recipe
    choices: Choices
    particles: tuple[Particle, ...] = ()
    facts: tuple[Examined, ...] = ()
    outcomes: tuple[CoarsenedParticle, ...] = ()
    studies: dict[str, Any] = field(default_factory=dict)
    problems: list[str] = field(default_factory=list)

    @property
    def files(self) -> list[str]:
        """Paths of all files below the folder, relative to it."""
        found = (path for path in self.folder.rglob("*") if path.is_file())
        return sorted(path.relative_to(self.folder).as_posix() for path in found)


def perform(recipe: Recipe, base: Path, folder: Path, workers: int = 1) -> Steps:
    """Do all that `recipe` asks for; returns :class:`Performed`.

    Particles that fail are told and do not stop the others. Each part of the output appears whole or
    not at all.

    Parameters
    ----------
    base
        Folder that relative inputs are relative to.
    folder
        Where to write.
    workers
        Processes at a time; 0 for one a core. The results do not depend on it.

    Raises
    ------
    InputError
        If the recipe holds a choice that cannot be used.
    FileError
        If no input can be read or the folder cannot be written.
    """
    done = Performed(folder, recipe, recipe.choices())
    yield from _load(done, base)
    with hired(workers) as crew:
        yield from _parts(done, crew)
    write_bytes(folder / "recipe.json", recipe.to_json().encode("utf-8"))
    if recipe.outputs.summary:
        write_summary(folder, summary_facts(done))
    return done


def _parts(done: Performed, crew: Crew) -> Part:
    """Everything between reading and the last page, by one crew that stays warm."""
    wish = done.recipe.outputs
    if wish.descriptors or wish.summary:
        yield from _describe(done, crew)
    if wish.fits:
        yield from _fit(done, crew)
    if wish.meshes or wish.dataset or wish.summary:
        yield from _coarsen(done, crew)
    if wish.lmax_study:
        yield from _study(done, "lmax_study", study_lmax(done.particles, crew, done.recipe.seed))
    if wish.coarsening_study:
        steps = study_coarsening(done.particles, done.choices.order, crew)
        yield from _study(done, "coarsening_study", steps)


def summary_facts(done: Performed, pictures: tuple[tuple[str, str], ...] = ()) -> SummaryFacts:
    """What the summary page tells; `pictures` are (file, caption) pairs besides those of the studies."""
    return SummaryFacts(
        title="Regolith Studio: from particles to a dataset",
        recipe=done.recipe,
        particles=done.particles,
        facts=done.facts,
        outcomes=done.outcomes,
        studies=tuple(done.studies),
        problems=tuple(done.problems),
        pictures=pictures,
    )


def _load(done: Performed, base: Path) -> Part:
    found: list[Particle] = []
    files = [base / name for name in done.recipe.inputs if name != SAMPLE]
    if SAMPLE in done.recipe.inputs:
        sample: Loaded = yield from load_sample()
        found += sample.particles
    if files:
        loaded: Loaded = yield from load_particles(files, done.choices.unit)
        found += loaded.particles
        done.problems += [f"{problem.path}: {problem.sentence}" for problem in loaded.problems]
    done.particles = tuple(found)


def _describe(done: Performed, crew: Crew) -> Part:
    done.facts = yield from examine_sample(done.particles, done.choices.box_metric, crew)
    entries = [described(p, facts) for p, facts in zip(done.particles, done.facts, strict=True)]
    table = descriptor_table(done.particles, done.facts)
    write_bytes(done.folder / "descriptors.json", json_bytes(entries))
    write_bytes(done.folder / "descriptors.csv", csv_text(table).encode("utf-8"))


def _fit(done: Performed, crew: Crew) -> Part:
    outcomes = yield from fit_sample(done.particles, workers=crew)
    sample = FittedSample.of(done.particles, outcomes)
    done.problems += [f"{name}: {sentence}" for name, sentence in sample.failed]
    write_fits(done.folder / "fit", sample)


def _coarsen(done: Performed, crew: Crew) -> Part:
    order = done.choices.order
    done.outcomes = yield from coarsen_sample(done.particles, order, crew)
    done.problems += [f"{each.name}: {each.problem}" for each in done.outcomes if not each.coarsened]
    if done.recipe.outputs.meshes:
        with staged_folder(done.folder / "meshes") as stage:
            write_coarsening(stage, order, done.outcomes)
    if done.recipe.outputs.dataset:
        yield Started("Writing the dataset")
        preset = None if done.choices.preset_modified else done.choices.preset
        dataset = dataset_of(done.particles, done.outcomes, order, done.folder.name, preset)
        write_dataset(done.folder / "dataset", dataset)
        yield Progress(1, 1, "dataset")


def _study(done: Performed, name: str, steps: Steps) -> Part:
    try:
        done.studies[name] = yield from steps
    except RegolithError as error:
        done.problems.append(str(error))
        return
    with staged_folder(done.folder / "studies") as stage:
        STUDIES[name].write(done.studies[name], stage)
