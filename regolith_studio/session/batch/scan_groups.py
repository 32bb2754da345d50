"""Particles of many scans: a folder for each, and tables of all with a comparison of the scans.

Each folder appears in one step. A scan whose folder holds the result of the same voxels, settings and
versions is not extracted again, so that an interrupted run goes on where it ended.
"""

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.descriptors.distributions import (
    Distribution,
    distribution,
    kolmogorov_smirnov_distance,
    wasserstein_1,
)
from regolith_studio.errors import FileError, InputError, RegolithError
from regolith_studio.io.atomic import listed_hashes, staged_folder, write_bytes
from regolith_studio.io.file_names import file_stem, name_key, path_inside
from regolith_studio.io.own_files import read_json
from regolith_studio.io.tables import Column, Table, csv_bytes, csv_text, read_csv
from regolith_studio.jobs.events import Started, Step, Steps
from regolith_studio.jobs.executor import Executor
from regolith_studio.jobs.extraction_jobs import unfinished_file, volume_sha256
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
from regolith_studio.messages import N_, Message
from regolith_studio.readers.volumes.files import volume_files
from regolith_studio.session.outputs.particles import LISTED, RECIPE, TABLE, ExtractionFolder, input_document
from regolith_studio.steps import as_events

COMPARISON = "groups.csv"
QUANTILES = (0.1, 0.5, 0.9)
_Rows = list[dict[str, str]]


@dataclass(frozen=True)
class ScanGroups:
    """What became of many scans.

    - ``extracted``, ``kept``: names of the groups that were extracted now, and that were there from an
      earlier run.
    - ``problems``: name of each scan that gave no particles, and why.
    - ``notes``: name of each scan with a sentence about it that a user should read.
    - ``comparison``: the table that was written as ``groups.csv``; None where there is no group.
    """

    extracted: tuple[str, ...]
    kept: tuple[str, ...]
    problems: tuple[tuple[str, str], ...]
    notes: tuple[tuple[str, str], ...]
    comparison: Table | None


def find_scans(paths: Sequence[Path]) -> tuple[Path, ...]:
    """The scans that files and folders stand for, each once, in their order."""
    return tuple(dict.fromkeys(scan for path in paths for scan in volume_files(path)))


def group_names(scans: Sequence[Path]) -> tuple[str, ...]:
    """A name for each scan: that of its file, after that of its folder where several are called alike."""
    stems = [file_stem(scan.stem) for scan in scans]
    keys = list(map(name_key, stems))
    names = tuple(
        stem if keys.count(key) == 1 else file_stem(f"{scan.absolute().parent.name}_{stem}")
        for scan, stem, key in zip(scans, stems, keys, strict=True)
    )
    twice = sorted(name for name, count in Counter(map(name_key, names)).items() if count > 1)
    if twice:
        raise InputError(f"Several scans are called {twice[0]}, and so are their folders; rename one.")
    return names


def extract_groups(
    scans: Sequence[tuple[VolumeInput, GrainSettings]], output: Path, workers: int | Executor = 1
) -> Steps:
    """Extract the particles of each scan into a folder of its own; returns :class:`ScanGroups`.

    ``scans``: each with the name of its group and its settings. ``output``: folder of the groups and of the
    tables; exists already.
    """
    if (output / LISTED).exists():
        raise FileError(f"The folder {output} holds the particles of one scan; name another for several.")
    extracted, kept, problems, notes = [], [], [], []
    for number, (given, settings) in enumerate(scans, start=1):
        if not output.is_dir():
            raise FileError(f"The folder {output} was removed while it was written to.")
        try:
            group = path_inside(output, given.group)
            if _is_extracted(group, given, settings):
                kept.append(given.group)
                continue
            with staged_folder(group, "extract") as stage:
                folder = ExtractionFolder(stage)
                place = unfinished_file(group)
                steps = folder.extract(given, settings, output, workers, unfinished=place)
                done = yield from _numbered(steps, given.group, number, len(scans))
                folder.finish(given, settings, done)
            notes += [(given.group, note) for note in done.notes]
            extracted.append(given.group)
        except RegolithError as error:
            problems.append((given.group, str(error)))
    comparison = None
    if extracted or kept:
        comparison = _write_tables(
            output, [given.group for given, _ in scans if given.group in {*extracted, *kept}]
        )
    return ScanGroups(tuple(extracted), tuple(kept), tuple(problems), tuple(notes), comparison)


def _numbered(steps: Steps, name: str, number: int, count: int) -> Steps:
    """The steps of a scan, whose titles say which of all it is."""
    template = N_("{name} ({number} of {count}): {step}")

    def events_of(step: Step) -> Iterator[Step]:
        if isinstance(step, Started):
            title = Message(template, name=name, number=number, count=count, step=step.title)
            step = replace(step, title=title)
        yield step

    return as_events(steps, events_of)


def _is_extracted(folder: Path, given: VolumeInput, settings: GrainSettings) -> bool:
    """Whether a folder holds all that this scan gives with these settings and versions."""
    try:
        document = read_json(folder / RECIPE)
        expected = input_document(
            given, settings, volume_sha256(given.path), settings.region.of(given.opened())
        )
        there = {key: document[key] for key in expected}
        listed = listed_hashes(folder)
    except (FileError, OSError, ValueError, KeyError, TypeError):
        return False
    expected["volume"]["path"] = there["volume"]["path"]
    same: bool = there == json.loads(json.dumps(expected))
    return same and bool(listed) and all((folder / name).is_file() for name in listed)


def _write_tables(output: Path, groups: Sequence[str]) -> Table:
    """Write the particles of all groups as one table, and their comparison, which is returned."""
    tables = {name: _read_rows(output / name / TABLE) for name in groups}
    columns = list(dict.fromkeys(column for rows in tables.values() for row in rows for column in row))
    every = [[row.get(column, "") for column in columns] for rows in tables.values() for row in rows]
    write_bytes(output / TABLE, csv_bytes([columns, *every]))
    comparison = compare_groups(tables)
    write_bytes(output / COMPARISON, csv_text(comparison).encode("utf-8"))
    return comparison


def _read_rows(path: Path) -> _Rows:
    with path.open(encoding="utf-8", newline="") as file:
        return list(read_csv(file))


def compare_groups(tables: Mapping[str, _Rows]) -> Table:
    """Distributions of each descriptor in each group, every particle counting by its weight.

    ``tables``: rows of each group's ``particles.csv``.

    Returns a row for each descriptor and group: count, mean, standard deviation, quantiles, and, where there
    are several groups, the Kolmogorov-Smirnov and the Wasserstein-1 distance to the particles of all others.
    """
    rows: list[tuple[Any, ...]] = []
    for key, row in CATALOGUE.items():
        header = next((name for name in _headers(tables) if name.partition(" ")[0] == key), None)
        if header is None:
            continue
        for name in tables:
            own, others = _spread(tables, header, {name}), _spread(tables, header, set(tables) - {name})
            if own is None:
                continue
            distances = (
                (kolmogorov_smirnov_distance(own, others), wasserstein_1(own, others))
                if others
                else (None, None)
            )
            quantiles = map(float, own.quantile(QUANTILES))
            unit = row.unit
            rows.append(
                (key, unit, name, len(own.values), own.mean, own.standard_deviation, *quantiles, *distances)
            )
    names = ("descriptor", "unit", "group", "count", "mean", "standard_deviation")
    named = (
        *names,
        *(f"quantile_{share:.0%}".rstrip("%") for share in QUANTILES),
        "ks_distance",
        "wasserstein_1",
    )
    return Table(N_("Groups, and each against all others"), tuple(map(Column, named)), tuple(rows))


def _headers(tables: Mapping[str, _Rows]) -> list[str]:
    return [name for rows in tables.values() for row in rows[:1] for name in row]


def _spread(tables: Mapping[str, _Rows], header: str, names: set[str]) -> Distribution | None:
    """Distribution over the particles of some groups; None where none has the descriptor."""
    known = [row for name in tables if name in names for row in tables[name] if row.get(header)]
    if not known:
        return None
    weights = [float(row["weight"]) for row in known]
    return distribution([{"value": float(row[header])} for row in known], "value", multiplicity=weights)
