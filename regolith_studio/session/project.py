"""A session on disk: the recipe that repeats it, and the project file that reopens it."""

import dataclasses
import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field

from regolith_studio.io.atomic import write_files
from regolith_studio.io.file_names import name_key, unique_name
from regolith_studio.readers.settings import ReadingSettings
from regolith_studio.resources import SAMPLE
from regolith_studio.session.choices import Choices
from regolith_studio.session.provenance import (
    FileSource,
    ParticleRef,
    ParticleSource,
    SampleSource,
    UnreadParticle,
    VirtualSource,
    VolumeSource,
)
from regolith_studio.session.recipe import (
    DatasetRequest,
    FilesEntry,
    NamedParticle,
    Outputs,
    Recipe,
    read_document,
)
from regolith_studio.session.results import ParticleEntry
from regolith_studio.session.session import Session
from regolith_studio.shape_models.models import model_bytes
from regolith_studio.shape_models.protocol import FittedModel


@dataclass(frozen=True)
class SessionRecipe:
    """The recipe of a session, its model, and the particles that it cannot restore.

    - ``recipe``: of all particles that have an origin; what is to be written, with its model, says
      :meth:`files_for`.
    - ``model``: model of its population, if that is not a shipped card.
    - ``without_source``: ids of the particles that it cannot restore.
    """

    recipe: Recipe
    model: FittedModel | None = field(default=None, repr=False)
    without_source: tuple[str, ...] = ()

    @classmethod
    def of(
        cls,
        entries: Sequence[ParticleEntry],
        choices: Choices,
        outputs: Outputs | None = None,
        dataset_request: DatasetRequest | None = None,
        unread: Sequence[UnreadParticle] = (),
    ) -> "SessionRecipe":
        """Of particles, choices and the dataset asked for; of the sample if there is no particle.

        ``unread``: particles of an earlier recipe whose files could not be read, and which it keeps.
        """
        request = (
            dataset_request if dataset_request and (outputs is None or outputs.dataset) else DatasetRequest()
        )
        refs = _with_unread([(entry.id, entry.ref) for entry in entries], unread)
        origins = _in_recipe_order([ref.origin for _, ref in refs if ref is not None])
        named = dict(_names(origins))
        pairs = [(named.get(ref), name) for name, ref in refs]
        files = [each for each in origins if isinstance(each, FileSource)]
        virtual = next((each for each in origins if isinstance(each, VirtualSource)), None)
        first = files[0] if files else None
        recipe = Recipe.from_choices(
            choices,
            _inputs(origins),
            outputs,
            **asdict(first.reading if first else ReadingSettings.of(choices)),
            volumes=[each.volume for each in origins if isinstance(each, VolumeSource)],
            population=virtual.population if virtual else None,
            particles=_selection(pairs, list(named.values())),
            representatives=request.representatives,
            exports=request.exports,
        )
        without_source = tuple(name for run_name, name in pairs if run_name is None)
        return cls(recipe, virtual.model if virtual else None, without_source)

    def files_for(self, path: Path, absolute_path: bool = False) -> tuple[Recipe, dict[Path, bytes]]:
        """The recipe to write to `path`, and the file of its model to write beside it, if it has one.

        The name of that file changes with the model, so that no recipe can name the model of another.

        ``absolute_path``: give the model by its absolute path, because the recipe is written elsewhere.
        """
        population = self.recipe.population
        if self.model is None or population is None:
            return self.recipe, {}
        content = model_bytes(self.model, {"source": population.name, "notes": []})
        model = path.with_name(f"{path.stem}-model-{hashlib.sha256(content).hexdigest()[:8]}.json")
        named = population.model_copy(update={"sources": [str(model) if absolute_path else model.name]})
        return self.recipe.model_copy(update={"population": named}), {model: content}


def _with_unread(
    refs: Sequence[tuple[str, ParticleRef | None]], unread: Sequence[UnreadParticle]
) -> list[tuple[str, ParticleRef | None]]:
    """The particles with those that could not be read, in their places and under names of their own."""
    merged = list(refs)
    taken = dict.fromkeys((name_key(name) for name, _ in refs), 1)
    for each in reversed(unread):
        names = [name for name, _ in merged]
        at = names.index(each.after) + 1 if each.after in names else 0 if not each.after else len(merged)
        merged.insert(at, (unique_name(each.id, "", taken), each.ref))
    return merged


def _in_recipe_order(origins: Sequence[ParticleSource]) -> list[ParticleSource]:
    """In the order of a recipe: the sample, files, volumes, one population."""
    kinds = (SampleSource, FileSource, VolumeSource, VirtualSource)
    ordered = [each for kind in kinds for each in dict.fromkeys(o for o in origins if isinstance(o, kind))]
    populations = [each for each in ordered if isinstance(each, VirtualSource)]
    return [each for each in ordered if each not in populations[1:]]


def _inputs(origins: Sequence[ParticleSource]) -> list[str | FilesEntry]:
    files = [each for each in origins if isinstance(each, FileSource)]
    named: list[str | FilesEntry] = [SAMPLE] if not origins or SampleSource() in origins else []
    for number, each in enumerate(files):
        entry = FilesEntry(
            files=list(each.paths),
            **asdict(each.reading),
            l_max=each.l_max,
            convention=each.convention,
        )
        plain = each.l_max is None and each.convention == "auto"
        named += each.paths if plain and not number else [entry]
    return named


def _selection(
    pairs: Sequence[tuple[str | None, str]], all_names: Sequence[str]
) -> list[str | NamedParticle] | None:
    """Names of the particles among all that a run finds; ``None`` where it is all of them in their order."""
    kept = [(run_name, name) for run_name, name in pairs if run_name is not None]
    if not kept or kept == [(name, name) for name in all_names]:
        return None
    return [
        run_name if run_name == name else NamedParticle(name=run_name, called=name) for run_name, name in kept
    ]


def _names(origins: Sequence[ParticleSource]) -> Iterator[tuple[ParticleRef | None, str]]:
    """The name that each particle of the origins gets in a run."""
    taken: dict[str, int] = {}
    for origin in origins:
        for key, name, group in origin.members():
            yield ParticleRef(origin, key), unique_name(name, group, taken)


FORMAT: Literal["regolith-studio project"] = "regolith-studio project"
SUFFIX = ".regolith"
"""Of project files."""


class Project(BaseModel):
    """The recipe of a session, and the state of the window.

    - ``recipe``: inputs and choices, as ``regolith-studio run`` takes them.
    - ``selected``: id of the particle on screen.
    - ``page``: key of the current page.
    - ``pages``: state of each page, by its key.
    - ``file``: of the project that an automatic copy belongs to; empty in a project itself, and where there
      is none.
    """

    model_config = ConfigDict(extra="ignore", frozen=True)

    format: Literal["regolith-studio project"] = FORMAT
    version: Literal[1] = 1
    recipe: Recipe = Field(default_factory=Recipe)
    selected: str = ""
    page: str = ""
    pages: dict[str, dict[str, Any]] = Field(default_factory=dict)
    file: str = ""

    @classmethod
    def of(cls, session: Session, page: str = "", pages: dict[str, dict[str, Any]] | None = None) -> Self:
        """The present state of a session."""
        recipe = SessionRecipe.of(session.particles, session.choices, unread=session.unread).recipe
        return cls(recipe=recipe, selected=session.choices.selected, page=page, pages=pages or {})

    def save(self, path: Path, model: FittedModel | None = None) -> None:
        """Write it, with the model that virtual particles were drawn from beside it."""
        recipe, models = SessionRecipe(self.recipe, model).files_for(path)
        whole = self.model_copy(update={"recipe": recipe})
        write_files({**models, path: whole.model_dump_json(indent=2).encode("utf-8") + b"\n"})

    def open_in(self, session: Session, base: Path) -> int:
        """Restore the choices and particles in a session; returns the task's id.

        ``base``: folder that relative inputs are looked up in.
        """
        chosen = self.recipe.choices()
        names = {each.name for each in dataclasses.fields(chosen)} - {"selected"}
        session.choose(**{name: getattr(chosen, name) for name in names})
        return session.open_recipe(self.recipe, base)


def read_project(path: Path) -> Project:
    """Read a project file."""
    return read_document(path, Project, "project")


FINGERPRINTED = 1 << 20
"""Bytes at each end of a file that its fingerprint covers: a scan of 50 GB is not read for it."""


def fingerprint(path: Path) -> str:
    """SHA-256 of size and both ends of a file, or of names and sizes of a folder; empty if there is none."""
    digest = hashlib.sha256()
    try:
        if path.is_dir():
            for each in sorted(path.iterdir()):
                digest.update(f"{each.name}\0{each.stat().st_size}\0".encode())
            return digest.hexdigest()
        size = path.stat().st_size
        digest.update(str(size).encode())
        with path.open("rb") as file:
            digest.update(file.read(FINGERPRINTED))
            file.seek(max(FINGERPRINTED, size - FINGERPRINTED))
            digest.update(file.read(FINGERPRINTED))
    except OSError:
        return ""
    return digest.hexdigest()


def inputs_of(session: Session) -> list[str]:
    """The files that the open particles came from, the sample by its name; the sample if there are none."""
    sources = [entry.particle.source for entry in session.particles]
    paths = [source.path for source in sources if source]
    return list(dict.fromkeys(SAMPLE if path.startswith("sample:") else path for path in paths)) or [SAMPLE]


def input_shown(session: Session) -> str:
    """Where the particle on screen came from; the sample if it came from no file."""
    source = session.selected.particle.source if session.selected else None
    return source.path if source else SAMPLE


def without_file(session: Session) -> Sequence[str]:
    """Ids of open particles that neither a recipe nor a project can restore."""
    return list(SessionRecipe.of(session.particles, session.choices).without_source)
