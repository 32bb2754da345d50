"""Descriptors and health of particles as JSON and as a table."""

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.geometry.particle import Particle
from regolith_studio.io.tables import Column, Table
from regolith_studio.jobs.particle_jobs import MeasuredParticle

SHARES = ("hidden_surface_share", "unrepresentable_volume_share")
"""Shares that no radius function represents, of
:class:`~regolith_studio.harmonics.visibility.StarPointVisibility`."""
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


class TableItem(Protocol):
    """Anything that a row of a table can be about."""

    @property
    def name(self) -> str:
        """Unique in the table."""

    @property
    def group(self) -> str:
        """That it belongs to; may be empty."""


def descriptor_table(particles: Sequence[TableItem], facts: Sequence[MeasuredParticle]) -> Table:
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
