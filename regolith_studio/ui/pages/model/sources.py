"""What shapes are fitted to or drawn from: the open particles, materials, and files that were opened."""

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from math import exp
from pathlib import Path

from regolith_studio.errors import InputError, RegolithError
from regolith_studio.harmonics.fit_options import FIT_DEGREE
from regolith_studio.jobs.model_jobs import ModelOrigin
from regolith_studio.messages import N_
from regolith_studio.readers.shape_files import ShapeSource, read_shape_source
from regolith_studio.session.provenance import VirtualSource
from regolith_studio.session.results import ParticleEntry
from regolith_studio.session.session import Session
from regolith_studio.shape_models.materials import MaterialCard, materials
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.sample import Sample
from regolith_studio.ui.translation import in_a_sentence, tr, translate

OPEN_PARTICLES = "open"
"""Key of the open particles."""


@dataclass(frozen=True)
class SourceKind:
    """Description of a source for the controls.

    - ``brings_model``: key of the model that comes with it; empty for measured particles.
    - ``max_degree``: highest degree.
    - ``words``: one sentence.
    """

    brings_model: str
    max_degree: int
    words: str


def is_drawn(entry: ParticleEntry) -> bool:
    """Whether a particle was drawn from a model."""
    return entry.ref is not None and isinstance(entry.ref.origin, VirtualSource)


class SourceBox:
    """By key: ``open``, names of materials, and ``file:`` with a number."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._files: dict[str, ShapeSource] = {}
        self.paths: dict[str, str] = {}
        """Of all files by their keys, also of those of a project that could not be read."""

    def add(self, source: ShapeSource, path: Path) -> str:
        """Add the content of a file; returns its key."""
        known = {each.sha256: key for key, each in self._files.items()}
        numbers = (f"file:{number}" for number in itertools.count(1))
        key = known.get(source.sha256) or next(each for each in numbers if each not in self.paths)
        self._files[key], self.paths[key] = source, str(path.absolute())
        return key

    def restore(self, paths: Mapping[str, str]) -> list[str]:
        """Read the files of a project again; returns why others could not be read, in sentences."""
        problems = []
        self.paths |= paths
        for key, path in paths.items():
            try:
                self._files[key] = read_shape_source(path)
            except RegolithError as error:
                problems.append(str(error))
        return problems

    def labels(self) -> dict[str, str]:
        count = len(self._session.particles)
        found = {OPEN_PARTICLES: tr("Open particles ({count})", count=count)}
        found |= {key: source.name for key, source in self._files.items()}
        return found | {name: tr(card.label) for name, card in materials().items()}

    def kind(self, key: str) -> SourceKind:
        """The source of a key."""
        if key == OPEN_PARTICLES:
            return SourceKind("", FIT_DEGREE, self._drawn_words())
        content = self._files[key].content if key in self._files else materials()[key]
        match content:
            case MaterialCard():
                facts = (
                    (N_("Measured: {facts}."), content.measured),
                    (N_("Assumed: {facts}."), content.assumed),
                )
                known = (tr(text, facts="; ".join(given)) for text, given in facts if given)
                words = " ".join(filter(None, (translate(content.evaluated), tr(content.origin), *known)))
                return SourceKind(content.key, content.l_max, words)
            case Sample():
                words = tr("{count} particles up to l = {degree}.", count=len(content), degree=content.l_max)
                return SourceKind("", content.l_max, words)
            case _:
                words = tr("A fitted model: {name}.", name=in_a_sentence(MODELS[content.key].label))
                return SourceKind(content.key, content.l_max, words)

    def _drawn_words(self) -> str:
        """How many of the open particles are no measured ones; empty where all are."""
        entries = self._session.particles
        drawn = sum(is_drawn(entry) for entry in entries)
        if not drawn:
            return ""
        template = N_("{drawn} of the {count} open particles were drawn: a fit to them repeats a model.")
        return tr(template, drawn=drawn, count=len(entries))

    def origin(self, key: str) -> ModelOrigin:
        """The source as a job takes it."""
        if key == OPEN_PARTICLES:
            particles = self._session.open_particles
            if not particles:
                raise InputError(tr("No particle is open: open some, or choose a material."))
            return particles
        return self._files[key] if key in self._files else ShapeSource(materials()[key], key)


def usual_sizes(source: ShapeSource) -> tuple[float, float] | None:
    """Range of equivalent radii: of the particles, or two standard deviations about a card's median."""
    match source.content:
        case Sample():
            radii = source.content.equivalent_radii
            return float(radii.min()), float(radii.max())
        case MaterialCard():
            spread = exp(2 * source.content.log_deviation)
            return source.content.median_radius / spread, source.content.median_radius * spread
        case _:
            return None


def name_of(source: ShapeSource) -> str:
    """As the list of sources shows it."""
    return tr(source.content.label) if isinstance(source.content, MaterialCard) else source.name
