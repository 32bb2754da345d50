"""The particles that ship with the program."""

import json
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from regolith_studio.errors import EnvironmentProblem
from regolith_studio.geometry.particle import Particle, Source
from regolith_studio.readers.registry import read_particles
from regolith_studio.resources import resource


def sample_particles() -> list[Particle]:
    """The shipped particles, in micrometres; an empty list in an installation without them."""
    return list(_read())


@cache
def _read() -> tuple[Particle, ...]:
    try:
        folder = resource("samples", "particles")
    except EnvironmentProblem:
        return ()
    files = sorted(folder.glob("*.stl"))
    if not files:
        return ()
    return tuple(_named(particle) for particle in read_particles(files, unit="um"))


def _named(particle: Particle) -> Particle:
    assert particle.source is not None
    source = Source(f"sample:{particle.name}", particle.source.sha256, "um")
    return replace(particle, group="sample", source=source)


def sample_manifest() -> dict[str, Any]:
    """What is known of the shipped files: how they were made, with which seed, under which licence.

    Raises
    ------
    EnvironmentProblem
        If the installation lacks them.
    """
    document: dict[str, Any] = json.loads(Path(resource("samples", "manifest.json")).read_text("utf-8"))
    return document
