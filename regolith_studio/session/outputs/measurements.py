"""Descriptors, health and fits of particles as JSON and as tables."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from regolith_studio.descriptors.catalogue import CATALOGUE, CHORD_KEYS, LOSS_KEYS
from regolith_studio.errors import GeometryError
from regolith_studio.geometry.particle import Particle, Source
from regolith_studio.harmonics import io as fit_io
from regolith_studio.harmonics.coefficients import (
    PowerSpectrum,
    power_spectrum,
    roughness_split,
    sample_spectrum,
)
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.synthesis import reconstruct
from regolith_studio.io.atomic import staged_together, write_bytes, write_in_stage
from regolith_studio.io.file_names import file_stem
from regolith_studio.io.own_files import arrays_document, json_bytes
from regolith_studio.io.tables import Column, Table
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.particle_jobs import MeasuredParticle

SHARES = ("hidden_surface_share", "unrepresentable_volume_share")
"""Shares that no radius function represents, of
:class:`~regolith_studio.harmonics.star_point.StarPointVisibility`."""
NO_VISIBILITY = dict.fromkeys((*SHARES, "star_point", "star_point_rule"))
"""In place of ``StarPointVisibility.as_dict`` where a mesh has no inside."""


def described(particle: Particle, facts: MeasuredParticle) -> dict[str, Any]:
    """One particle as ``describe --json`` prints it: name, descriptors by key, health, source.

    ``health`` is that of the mesh that was measured, with what its star point cannot see;
    ``health_before_repair`` is that of the mesh as it was read, and ``repair`` says what was done in between.
    """
    entry: dict[str, Any] = {"name": particle.name, "group": particle.group, "unit": "um"}
    entry |= dict(facts.descriptors or {})
    entry["health"] = facts.health.as_dict() | (
        facts.visibility.as_dict() if facts.visibility else NO_VISIBILITY
    )
    entry |= _repair_document(particle, facts)
    entry["notes"] = list(particle.notes)
    if particle.weight != 1.0:
        entry["weight"] = particle.weight
    if facts.problem:
        entry["problem"] = facts.problem
    if particle.source:
        source = particle.source
        entry["source"] = {
            "path": source.path,
            "sha256": source.sha256,
            "unit": source.unit,
            "repaired": source.repaired,
            "l_max": source.l_max,
        }
    return entry


def _repair_document(particle: Particle, facts: MeasuredParticle) -> dict[str, Any]:
    done = particle.repair
    before = done.health_before if done else facts.health
    return {"health_before_repair": before.as_dict(), "repair": done.as_dict() if done else None}


def short_table(particles: Sequence[Particle], facts: Sequence[MeasuredParticle]) -> Table:
    """The descriptors of section 2.2 by their symbols, narrow enough for a terminal."""
    keys = ("volume", "equivalent_radius", "surface_area", *(key for key in LOSS_KEYS if key != "volume"))
    keys += tuple(key for key in CHORD_KEYS if any(key in (each.descriptors or ()) for each in facts))
    columns = [Column(CATALOGUE[key].symbol, CATALOGUE[key].unit) for key in keys]
    rows = [
        (particle.name, *[_value(each, key) for key in keys], _soundness(particle, each))
        for particle, each in zip(particles, facts, strict=True)
    ]
    return Table("", (Column("name"), *columns, Column("sound")), tuple(rows))


def _soundness(particle: Particle, facts: MeasuredParticle) -> str:
    if not facts.health.sound:
        return "no"
    return "repaired" if particle.repair is not None and particle.repair.actions else "yes"


def interval_cells(intervals: Mapping[str, tuple[float, float]]) -> dict[Column, float]:
    """Columns of the ends of intervals, by key and unit."""
    return {
        Column(f"{key}_{end}", CATALOGUE[key].unit): value
        for key, ends in intervals.items()
        for end, value in zip(("low", "high"), ends, strict=True)
    }


@dataclass(frozen=True)
class ParticleInfo:
    """What tables and files say of a particle whose mesh is not in memory."""

    name: str
    group: str
    source: Source | None = None
    notes: tuple[str, ...] = ()


def descriptor_table(
    particles: Sequence[Particle | ParticleInfo], facts: Sequence[MeasuredParticle]
) -> Table:
    """One row a particle, one column a descriptor with its unit."""
    keys = [key for key in CATALOGUE if any(key in (each.descriptors or ()) for each in facts)]
    rows = [
        (
            particle.name,
            particle.group,
            *[_value(each, key) for key in keys],
            *(getattr(each.visibility, key, None) for key in SHARES),
            each.health.sound,
            " ".join(filter(None, [*each.health.problems, each.problem])),
            " ".join(getattr(getattr(particle, "repair", None), "actions", ())),
        )
        for particle, each in zip(particles, facts, strict=True)
    ]
    return Table("Descriptors of the particles", table_columns(keys), tuple(rows))


def table_columns(keys: Sequence[str]) -> tuple[Column, ...]:
    """The columns of :func:`descriptor_table` where the descriptors `keys` are known."""
    named = [Column(key, CATALOGUE[key].unit) for key in keys]
    shares = [Column(key) for key in SHARES]
    words = [Column(word) for word in ("sound", "problems", "repairs")]
    return Column("name"), Column("group"), *named, *shares, *words


def table_row(entry: Mapping[str, Any], keys: Sequence[str]) -> list[Any]:
    """A row of :func:`descriptor_table` from what :func:`described` says of the particle."""
    health = entry["health"]
    problems = " ".join(filter(None, [*health["problems"], entry.get("problem", "")]))
    repairs = " ".join((entry.get("repair") or {}).get("actions", ()))
    shares = [health.get(key) for key in SHARES]
    numbers = [entry.get(key) for key in keys]
    return [entry["name"], entry["group"], *numbers, *shares, health["sound"], problems, repairs]


def _value(facts: MeasuredParticle, key: str) -> float | None:
    return facts.descriptors.get(key) if facts.descriptors else None


@dataclass(frozen=True)
class FittedSample:
    """Particles with their fits, all of the same degree, and the sentences of those that failed."""

    particles: tuple[Particle | ParticleInfo, ...]
    fits: tuple[HarmonicFit, ...]
    failed: tuple[tuple[str, str], ...] = ()

    @classmethod
    def of(cls, particles: Sequence[Particle], outcomes: Sequence[HarmonicFit | str]) -> "FittedSample":
        """From what ``fit_sample`` returned for `particles`."""
        pairs = list(zip(particles, outcomes, strict=True))
        good = [(particle, fit) for particle, fit in pairs if isinstance(fit, HarmonicFit)]
        bad = tuple((particle.name, fit) for particle, fit in pairs if isinstance(fit, str))
        return cls(tuple(p for p, _ in good), tuple(f for _, f in good), bad)

    @property
    def spectrum(self) -> PowerSpectrum | None:
        """A_l of the sample; of the particle itself if there is only one."""
        if len(self.fits) == 1:
            return power_spectrum(self.fits[0].coefficients)
        return sample_spectrum([fit.coefficients for fit in self.fits]) if self.fits else None


def write_fits(
    path: Path, sample: FittedSample, surfaces: Path | None = None, level: int = 4
) -> dict[str, str]:
    """Write a fit's JSON file, as :mod:`regolith_studio.harmonics.io` defines it, and surfaces on request.

    Both take the places of earlier ones at the same moment.

    ``surfaces``: folder for the surfaces of the fits as STL. ``level``: icosphere level of the surfaces.

    Returns why a particle has no surface, by its name.
    """
    content = json_bytes(fits_document(sample))
    if surfaces is None:
        write_bytes(path, content)
        return {}
    with staged_together(surfaces, "fit", path) as (stage, stream):
        stream.write(content)
        return _write_surfaces(stage, sample, level)


def _write_surfaces(folder: Path, sample: FittedSample, level: int) -> dict[str, str]:
    """Write ``<name>.stl``, the surface of each fit in the particle's frame; the reasons of those without."""
    reasons = {}
    for particle, fit in zip(sample.particles, sample.fits, strict=True):
        header = f"Regolith Studio, spherical-harmonics fit, l_max {fit.l_max}, micrometres"
        try:
            surface = reconstruct(fit, level=level)
        except GeometryError as error:
            reasons[particle.name] = str(error)
        else:
            write_in_stage(folder, f"{file_stem(particle.name)}.stl", stl_bytes(surface.triangles, header))
    return reasons


def fits_document(sample: FittedSample) -> dict[str, Any]:
    """What ``FIT.json`` holds: fits, coefficients, the sample's spectrum, sources, notes, and what failed."""
    names = [particle.name for particle in sample.particles]
    document = fit_io.fits_document(names, sample.fits)
    for entry, particle, fit in zip(document["particles"], sample.particles, sample.fits, strict=True):
        entry["group"] = particle.group
        entry["sha256"] = particle.source.sha256 if particle.source else None
        spectrum = power_spectrum(fit.coefficients)
        entry["power_spectrum"] = spectrum.values.tolist()
        entry["deviation_by_scale"] = roughness_split(spectrum)
        entry["notes"] = list(particle.notes)
    document["spectrum"] = _spectrum(sample.spectrum)
    document["arrays"] = arrays_document(fit_io.fits_arrays(names, sample.fits))
    document["failed"] = [{"name": name, "reason": sentence} for name, sentence in sample.failed]
    return document


def _spectrum(spectrum: PowerSpectrum | None) -> dict[str, Any] | None:
    if spectrum is None:
        return None
    return {
        "definition": "A_l = mean over m of c_lm^2; of a sample A_0 is the variance of c_00",
        "unit": "um^2",
        "mean_radius": spectrum.mean_radius,
        "values": spectrum.values.tolist(),
        "low": None if spectrum.low is None else spectrum.low.tolist(),
        "high": None if spectrum.high is None else spectrum.high.tolist(),
    }
