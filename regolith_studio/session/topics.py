"""What a session says: one signal a topic, all without arguments but those that say otherwise."""

from dataclasses import dataclass, field
from pathlib import Path

from regolith_studio.readers.particles import FileProblem
from regolith_studio.session.signal import Signal


@dataclass(frozen=True)
class Failure:
    """Work that could not be done: what it was, one sentence, and the details of a report."""

    title: str
    sentence: str
    details: str = ""


@dataclass(frozen=True)
class Topics:
    """Signals of a session; those without arguments mean "read it anew"."""

    particles: Signal[[]] = field(default_factory=Signal)
    choices: Signal[[]] = field(default_factory=Signal)
    fit: Signal[[]] = field(default_factory=Signal)
    surface: Signal[[]] = field(default_factory=Signal)
    descriptors: Signal[[]] = field(default_factory=Signal)
    coarsening: Signal[[]] = field(default_factory=Signal)
    lmax_study: Signal[[]] = field(default_factory=Signal)
    coarsening_study: Signal[[]] = field(default_factory=Signal)
    tasks: Signal[[]] = field(default_factory=Signal)
    shelf: Signal[[str]] = field(default_factory=Signal)
    """The name of what was put on the shelf."""
    failed: Signal[[Failure]] = field(default_factory=Signal)
    problems: Signal[[tuple[FileProblem, ...]]] = field(default_factory=Signal)
    """Files that were refused at opening, or particles that an export left out."""
    exported: Signal[[Path]] = field(default_factory=Signal)
    """The folder that was written."""
