"""Sources of a shape model: the open particles, shipped materials, opened files."""

from dataclasses import dataclass
from math import exp

from regolith_studio.errors import InputError
from regolith_studio.jobs.model_jobs import ModelOrigin
from regolith_studio.jobs.particle_jobs import FIT_DEGREE
from regolith_studio.readers.shape_files import ShapeSource
from regolith_studio.session.session import Session
from regolith_studio.shape_models.materials import MaterialCard, materials
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.sample import Sample
from regolith_studio.ui.translation import tr, translate

OPEN_PARTICLES = "open"
"""Key of the open particles."""


@dataclass(frozen=True)
class SourceKind:
    """Description of a source for the controls.

    Parameters
    ----------
    brings_model
        Key of the model that comes with it; empty for measured particles.
    max_degree
        Highest degree.
    words
        One sentence.
    """

    brings_model: str
    max_degree: int
    words: str


class SourceBox:
    """By key: ``open``, names of materials, and ``file:`` with a number."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._files: dict[str, ShapeSource] = {}

    def add(self, source: ShapeSource) -> str:
        """Add the content of a file; returns its key."""
        known = {each.sha256: key for key, each in self._files.items()}
        key = known.get(source.sha256, f"file:{len(self._files) + 1}")
        self._files[key] = source
        return key

    def labels(self) -> dict[str, str]:
        """Label of each key."""
        count = len(self._session.particles)
        found = {OPEN_PARTICLES: tr("Open particles ({count})", count=count)}
        found |= {key: source.name for key, source in self._files.items()}
        return found | {name: tr(card.label) for name, card in materials().items()}

    def kind(self, key: str) -> SourceKind:
        """The source of a key."""
        if key == OPEN_PARTICLES:
            return SourceKind("", FIT_DEGREE, tr("They are expanded in spherical harmonics first."))
        content = self._files[key].content if key in self._files else materials()[key]
        match content:
            case MaterialCard():
                words = " ".join(filter(None, (translate(content.judged), tr(content.origin))))
                return SourceKind(content.key, content.l_max, words)
            case Sample():
                words = tr("{count} particles up to l = {degree}.", count=len(content), degree=content.l_max)
                return SourceKind("", content.l_max, words)
            case _:
                words = tr("A fitted model: {name}.", name=_inside(MODELS[content.key].label))
                return SourceKind(content.key, content.l_max, words)

    def origin(self, key: str) -> ModelOrigin:
        """The source as a job takes it.

        Raises
        ------
        InputError
            If no particle is open.
        """
        if key == OPEN_PARTICLES:
            particles = tuple(entry.particle for entry in self._session.particles)
            if not particles:
                raise InputError(tr("No particle is open: open some, or choose a material."))
            return particles
        return self._files[key] if key in self._files else ShapeSource(materials()[key], key)


def _inside(label: str) -> str:
    """A label within a sentence: lower case in English, unchanged in other languages."""
    words = tr(label)
    return label.lower() if words == label else words


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
