"""Jobs that measure the materials that are compared with a soil, and compare them."""

import contextlib
from collections import Counter
from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from regolith_studio.descriptors.catalogue import DEFAULT_KEYS
from regolith_studio.descriptors.describe import Descriptors, describe
from regolith_studio.errors import FileError, GeometryError, InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.io.atomic import staged_folder
from regolith_studio.io.tables import write_table
from regolith_studio.jobs.compile_kernels import compile_first
from regolith_studio.jobs.events import Failed, Job, Progress, Started, Step, Steps
from regolith_studio.jobs.executor import Executor, open_executor, value_of
from regolith_studio.messages import N_
from regolith_studio.readers.particles import FileProblem, MeshFile, find_files, read_file
from regolith_studio.readers.settings import ReadingSettings
from regolith_studio.readers.shape_tables import SUFFIXES, read_shape_table
from regolith_studio.shape_models.materials import materials
from regolith_studio.studies.matching import SHAPES, SIZES, ComparedMaterial, Match, check_count, match
from regolith_studio.studies.population import descriptors_of

N_DRAWN = 1000
"""Particles that a material card is compared by."""
_CHORDS = ("width", "width_over_length", "thickness_over_width")


@dataclass(frozen=True)
class MatchRequest:
    """How materials are measured and compared.

    - ``most``: particles of a group that are measured, chosen at random.
    - ``weighting``: as in :func:`~regolith_studio.studies.matching.match`.
    """

    unit: str = "um"
    most: int = 1000
    weighting: str = "number"
    seed: int = 0


@dataclass(frozen=True, eq=False)
class DrawnMatch:
    """A comparison, what could not be read, what is noted on tables, and its picture as PNG."""

    match: Match
    problems: tuple[FileProblem, ...]
    notes: tuple[str, ...] = ()
    picture: bytes = b""

    def written(self, folder: Path, mass: float = 100.0) -> Steps:
        """Write table and picture in one step; returns the folder."""
        from regolith_studio.studies.figures import write_figure
        from regolith_studio.studies.figures.population import matching_figure  # matplotlib

        yield Started(N_("Saving"))
        with staged_folder(folder, "match") as stage:
            write_table(self.match.table(mass), stage, "match")
            write_figure(matching_figure(self.match), stage, "match")
        return folder


def draw_match(
    target: str | tuple[Particle, ...], candidates: Sequence[str], request: MatchRequest = MatchRequest()
) -> Steps:
    """:func:`match_materials` with a picture; returns :class:`DrawnMatch`."""
    found = yield from match_materials(target, candidates, request)
    from regolith_studio.studies.figures import png_of
    from regolith_studio.studies.figures.population import matching_figure  # matplotlib

    return replace(found, picture=png_of(matching_figure(found.match)))


def match_materials(
    target: str | tuple[Particle, ...],
    candidates: Sequence[str],
    request: MatchRequest = MatchRequest(),
    workers: int | Executor = 1,
) -> Steps:
    """Compare a target with candidates; returns :class:`DrawnMatch` without the picture.

    A target may be open particles. Else each is a folder or archive of meshes, whose groups are fractions
    (those of the target count together), a table of descriptors or of length, width and thickness, or the
    name of a shipped card.
    """
    yield from compile_first("describe")
    names = [name for name in (target, *candidates) if isinstance(name, str)]
    chords = any(Path(name).suffix.lower() in SUFFIXES for name in names)
    keys = (
        "volume",
        *(key for key in (*SIZES, *SHAPES) if key in DEFAULT_KEYS),
        *(_CHORDS if chords else ()),
    )
    problems: list[FileProblem] = []
    notes: list[str] = []
    sources = {name: _source(name, request, problems, notes) for name in names}  # before the long work
    for name in candidates:
        if isinstance(files := sources[name], list) and Path(name).exists():
            for group, count in Counter(each.group for each in files).items():
                check_count(_title(name, group), count)
    if not isinstance(target, str):
        check_count("The sample", len(target))
    with open_executor(workers) as executor:
        if isinstance(target, str):
            groups = yield from _measured(target, sources[target], keys, request, executor, problems)
            soil = ComparedMaterial(Path(target).name, _joined(list(groups.values())))
        else:
            soil = ComparedMaterial("sample", (yield from _measured_particles(target, keys, request)))
        parts: list[ComparedMaterial] = []
        for name in candidates:
            measured = yield from _measured(name, sources[name], keys, request, executor, problems)
            parts += [ComparedMaterial(_title(name, group), columns) for group, columns in measured.items()]
    yield Started(N_("Comparing"))
    try:
        found = match(soil, parts, request.weighting, request.seed)
    except InputError as error:
        lost = f" {len(problems):,} not read, the first: {problems[0].with_path}" if problems else ""
        raise InputError(f"{error}{lost}") from error
    return DrawnMatch(found, tuple(problems), tuple(notes))


def _title(name: str, group: str) -> str:
    """Name of a group of a candidate."""
    title = Path(name).name.removesuffix(".zip")
    return title if group in ("", title) else f"{title}/{group}"


_Columns = Mapping[str, np.ndarray]


def _source(
    name: str, request: MatchRequest, problems: list[FileProblem], notes: list[str]
) -> _Columns | list[MeshFile] | None:
    """What a name stands for: the columns of a table, files of meshes, or none for a card.

    Raises FileError or InputError if it is a table of something else, or holds no mesh.
    """
    path = Path(name)
    if name in materials() and not path.exists():
        return None
    if path.suffix.lower() in SUFFIXES:
        table = read_shape_table(path, request.unit)
        notes += [f"{path.name}: {note}" for note in table.notes]
        return table.columns
    found: list[FileProblem] = []
    files = _chosen(find_files([path], found), request)
    if not files:
        raise FileError(found[0].sentence if found else f"{path.name} holds no mesh.")
    problems += found
    return files


def _measured(
    name: str,
    source: _Columns | list[MeshFile] | None,
    keys: tuple[str, ...],
    request: MatchRequest,
    executor: Executor,
    problems: list[FileProblem],
) -> Steps:
    """Columns of each group of what a name stands for."""
    if source is None:
        yield Started(N_("Drawing"), N_DRAWN)
        draws = materials()[name].model().draw(min(N_DRAWN, request.most), request.seed)
        return {"": _columns(descriptors_of(draws, keys), keys)}
    if isinstance(source, Mapping):
        return {"": source}
    files = source
    found: list[FileProblem] = []
    yield Started(N_("Measuring"), len(files))
    jobs = [Job(_measure_file, (file, request.unit, keys)) for file in files]
    results = yield from executor.run_all(jobs, [file.path.name for file in files])
    rows: dict[str, list[list[float]]] = {}
    for file, result in zip(files, results, strict=True):
        if isinstance(result, Failed):
            found.append(FileProblem(str(file.path), result.sentence))
        else:
            rows.setdefault(file.group, []).append([value_of(result)[key] for key in keys])
    problems += found
    if not rows:
        raise FileError(found[0].sentence)
    return {group: _columns(np.array(table), keys) for group, table in rows.items()}


def _measured_particles(
    particles: Sequence[Particle], keys: tuple[str, ...], request: MatchRequest
) -> Generator[Step, None, _Columns]:
    """Columns of particles that are open; those without descriptors are left out."""
    chosen = np.random.default_rng(request.seed).permutation(len(particles))[: request.most]
    yield Started(N_("Measuring"), len(chosen))
    rows = []
    for done, index in enumerate(sorted(chosen.tolist()), 1):
        with contextlib.suppress(GeometryError):
            measured = describe(particles[index], keys)
            rows.append([measured[key] for key in keys])
        yield Progress(done, len(chosen), particles[index].name)
    return _columns(np.array(rows).reshape(-1, len(keys)), keys)


def _chosen(files: Sequence[MeshFile], request: MatchRequest) -> list[MeshFile]:
    """At most so many files of each group, at random, in their order."""
    rng = np.random.default_rng(request.seed)
    groups: dict[str, list[int]] = {}
    for index, file in enumerate(files):
        groups.setdefault(file.group, []).append(index)
    picks = [
        index
        for indices in groups.values()
        for index in rng.choice(indices, min(request.most, len(indices)), replace=False)
    ]
    return [files[index] for index in sorted(picks)]


def _measure_file(file: MeshFile, unit: str, keys: tuple[str, ...]) -> Steps:
    yield Started(N_("Measuring"))
    measured: Descriptors = describe(read_file(file, ReadingSettings(unit)), keys)
    return measured


def _columns(table: np.ndarray, keys: Sequence[str]) -> _Columns:
    good = table[np.isfinite(table).all(axis=1)]
    if not len(good):
        raise InputError("No particle of it bounds a solid.")
    return dict(zip(keys, good.T, strict=True))


def _joined(groups: Sequence[_Columns]) -> _Columns:
    return {key: np.concatenate([group[key] for group in groups]) for key in groups[0]}
