"""A sample as a table: health, filters such as ``flat S<0.8``, statistics of groups."""

import operator
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.descriptors.distributions import Distribution, distribution, zingg_class
from regolith_studio.errors import InputError
from regolith_studio.imaging.extraction import is_hint
from regolith_studio.imaging.grain_errors import stated_intervals
from regolith_studio.io.tables import Column, Table
from regolith_studio.jobs.model_jobs import is_origin
from regolith_studio.jobs.particle_jobs import MeasuredParticle
from regolith_studio.messages import N_
from regolith_studio.session.outputs.measurements import descriptor_table, interval_cells
from regolith_studio.session.results import ParticleEntry

QUANTILES = (0.1, 0.5, 0.9)
EVERYTHING = "all"
"""Name of the group that every particle belongs to."""

_COMPARISON = re.compile(r"^([^<>=!]+)(<=|>=|!=|<|>|=)([-+0-9.eE]+)$")
_OPERATORS: dict[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "=": operator.eq,
    "!=": operator.ne,
}
Filter = Callable[[ParticleEntry], bool]


def health_word(entry: ParticleEntry) -> str:
    """One word that says most: ``sound``, ``coarse``, ``repaired``, ``doubtful`` or ``unsound``.

    Coarse: of few voxels. Repaired: with a note on what was changed. Doubtful: with faults that leave a
    volume and an area, such as tunnels and crossing faces. ``unknown`` until it is measured.
    """
    if entry.health is None:
        return "unknown"
    if not entry.health.sound:
        return "unsound"
    if entry.health.problems:
        return "doubtful"
    notes = [note for note in entry.particle.notes if not is_origin(note)]
    if all(is_hint(note) for note in notes):
        return "coarse" if notes else "sound"
    return "repaired"


def health_sentences(entry: ParticleEntry) -> tuple[str, ...]:
    """All that is known about the mesh."""
    if entry.health is None:
        return (N_("Measuring …"),)
    sentences = dict.fromkeys((*entry.health.problems, *entry.particle.notes))  # a repair may name one too
    return tuple(sentences) or (N_("A closed mesh without faults."),)


def form_of(entry: ParticleEntry) -> str:
    """Zingg's class; empty until it is measured."""
    return str(zingg_class(entry.descriptors)) if entry.descriptors else ""


def filter_of(text: str) -> Filter:
    """What a line of words and comparisons keeps: all of them must hold.

    A word is looked for in name, group, form and health; a comparison has a key or symbol of the
    catalogue on its left: ``flat S<0.8 volume>=1e5``.
    """
    tests = [_test(word) for word in text.split()]
    return lambda entry: all(test(entry) for test in tests)


def has_weights(entries: Iterable[ParticleEntry]) -> bool:
    """Whether the weight of some particle differs from 1."""
    return any(entry.particle.weight != 1.0 for entry in entries)


def statistics_table(
    entries: Sequence[ParticleEntry], key: str, weighting: str = "number", border_weights: bool = True
) -> Table:
    """One row a group and one for all: count, mean, standard deviation and quantiles of a descriptor.

    ``weighting``: ``number`` or ``volume``. ``border_weights``: let each particle count as often as its
    weight says, which undoes the loss of large grains at the border of a scan.
    """
    measured = [entry for entry in entries if entry.descriptors and key in entry.descriptors]
    groups = list(dict.fromkeys(entry.particle.group for entry in measured))
    named = [
        (group or N_("(no group)"), [e for e in measured if e.particle.group == group]) for group in groups
    ]
    if len(groups) != 1:
        named.append((EVERYTHING, measured))
    unit = CATALOGUE[key].unit
    columns = (
        Column("group"),
        Column("count"),
        *(Column(name, unit) for name in ("mean", "standard deviation")),
        *(Column(f"{share:.0%} quantile", unit) for share in QUANTILES),
    )
    rows = tuple(
        _statistics(name, members, key, weighting, border_weights) for name, members in named if members
    )
    title = f"{CATALOGUE[key].label}, each particle weighing by {weighting}"
    return Table(title, columns, rows)


def statistics_distribution(
    entries: Sequence[ParticleEntry], key: str, weighting: str = "number", border_weights: bool = True
) -> Distribution | None:
    """What :func:`statistics_table` tells of all particles; ``None`` where none has a value."""
    known = [each for each in entries if np.isfinite(_value(each, key))]
    return _distribution(known, key, weighting, border_weights) if known else None


def _value(entry: ParticleEntry, key: str) -> float:
    """Of a descriptor; NaN until it is measured."""
    return entry.descriptors[key] if entry.descriptors and key in entry.descriptors else np.nan


def statistics_of_keys(
    entries: Sequence[ParticleEntry],
    keys: Sequence[str],
    weighting: str = "number",
    border_weights: bool = True,
) -> Table:
    """:func:`statistics_table` of several descriptors, one under the other, each with its unit."""
    tables = {key: statistics_table(entries, key, weighting, border_weights) for key in keys}
    first = next(iter(tables.values()))
    columns = (Column("descriptor"), *(Column(column.name) for column in first.columns))
    rows = tuple(
        (Column(key, CATALOGUE[key].unit).header, *row) for key, table in tables.items() for row in table.rows
    )
    return Table(f"Statistics, each particle weighing by {weighting}", columns, rows)


def sample_table(entries: Iterable[ParticleEntry]) -> Table:
    """Every descriptor of the particles that have been measured, with units, as the CSV file has it.

    The intervals of grains of scans follow, and weights where there are some.
    """
    measured = [(entry, entry.health) for entry in entries if entry.health is not None]
    named = [replace(entry.particle, name=entry.id) for entry, _health in measured]
    facts = [
        MeasuredParticle(health, entry.descriptors, visibility=entry.visibility) for entry, health in measured
    ]
    table = descriptor_table(named, facts)
    more: list[dict[Column, float]] = [interval_cells(intervals_of(entry)) for entry, _health in measured]
    if has_weights(entry for entry, _health in measured):
        more = [cells | {Column("weight"): each.weight} for cells, each in zip(more, named, strict=True)]
    columns = tuple(dict.fromkeys(column for cells in more for column in cells))
    rows = tuple((*row, *map(cells.get, columns)) for row, cells in zip(table.rows, more, strict=True))
    return Table(table.title, (*table.columns, *columns), rows)


def intervals_of(entry: ParticleEntry) -> dict[str, tuple[float, float]]:
    """Between which values descriptors of a grain of a scan lie in 90 % of cases, as far as that is known."""
    return stated_intervals(entry.particle, entry.descriptors)


@dataclass(frozen=True)
class _Comparison:
    key: str
    compare: Callable[[float, float], bool]
    number: float

    def __call__(self, entry: ParticleEntry) -> bool:
        known = entry.descriptors
        return known is not None and self.key in known and self.compare(known[self.key], self.number)


def _test(word: str) -> Filter:
    if match := _COMPARISON.match(word):
        name, sign, number = match.groups()
        try:
            return _Comparison(_key_of(name), _OPERATORS[sign], float(number))
        except ValueError as error:
            raise InputError(f"{number!r} is not a number that {name} can be compared with.") from error
    if re.search("[<>=]", word):
        raise InputError(f"Write a comparison without blanks and with a number, such as S<0.8; got {word!r}.")
    lowered = word.lower()
    return lambda entry: any(
        lowered in text.lower()
        for text in (entry.id, entry.particle.group, form_of(entry), health_word(entry))
    )


def _key_of(name: str) -> str:
    for key, row in CATALOGUE.items():
        if name in (key, row.symbol, row.symbol.replace("_", "")):
            return key
    symbols = ", ".join(row.symbol for row in CATALOGUE.values() if not row.costly)
    raise InputError(f"There is no descriptor called {name!r}; there are {symbols}.")


def _distribution(
    members: Sequence[ParticleEntry], key: str, weighting: str, border_weights: bool
) -> Distribution:
    weights = [entry.particle.weight for entry in members] if border_weights else None
    return distribution([entry.descriptors or {} for entry in members], key, weighting, weights)


def _statistics(
    name: str, members: Sequence[ParticleEntry], key: str, weighting: str, border_weights: bool
) -> tuple[str | int | float, ...]:
    spread = _distribution(members, key, weighting, border_weights)
    quantiles = (float(value) for value in spread.quantile(QUANTILES))
    return (name, len(members), spread.mean, spread.standard_deviation, *quantiles)
