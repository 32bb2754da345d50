"""Export a dataset for another program: options, the interface of an exporter, and writing its folder."""

import hashlib
import math
import os
import re
import shlex
import subprocess
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.folder_io import IGNORED_FILES
from regolith_studio.dataset.parameters import (
    ContactParameters,
    ExportSettings,
    LiftingCylinderTest,
    ScriptTimes,
)
from regolith_studio.dataset.size_distributions import size_classes
from regolith_studio.errors import DatasetError, FileError, InputError, os_error_reason
from regolith_studio.io.atomic import exchange, filled_folder, recover_folder
from regolith_studio.io.own_files import canonical_json, parse_strict_json
from regolith_studio.io.tables import csv_bytes
from regolith_studio.messages import N_
from regolith_studio.settings import setting
from regolith_studio.version import __version__

FORMAT = "regolith-studio-export"
RECORD, README = "export.json", "README.txt"
PARTS = ("contact", "test", "times")
MICROMETRE = 1e-6


@dataclass(frozen=True)
class ExportOptions(ExportSettings):
    """Options of all exporters; each uses those that its format can hold.

    - ``contact``, ``test``, ``times``: of the simulated test: Tables 1 and 2, and the waiting times of
      scripts.
    - ``seed``: of the draw of particles.
    - ``rounding``: radius of rounded edges, as a share of the smallest distance between a shape's centre and
      a facet, for formats that need rounded edges.
    - ``n_spheres``: spheres per shape, for formats that have only spheres; where ``max_error`` is not 0, the
      fewest that reach it take their place.
    """

    contact: ContactParameters = field(default_factory=ContactParameters)
    test: LiftingCylinderTest = field(default_factory=LiftingCylinderTest)
    times: ScriptTimes = field(default_factory=ScriptTimes)
    seed: int = 0
    rounding: float = setting(0.02, "Rounding", minimum=1e-6, maximum=0.5)
    n_spheres: int = setting(20, "Spheres per shape", minimum=1, maximum=500)

    @property
    def to_metres(self) -> float:
        """Edge in metres of a cube with the volume of a particle of 1 um, coarse graining applied."""
        return float(self.coarse_graining_factor * MICROMETRE * (math.pi / 6) ** (1 / 3))

    def replaced(self, **changes: Any) -> "ExportOptions":
        """A copy with other values; fields of `contact`, `test` and `times` by their own names.

        Raises InputError if there is no such setting, or a value cannot be used.
        """
        own: dict[str, Any] = {}
        for name, value in changes.items():
            part = next((part for part in PARTS if name in _names(getattr(self, part))), None)
            if part is not None:
                own[part] = replace(own.get(part, getattr(self, part)), **{name: value})
            elif name in _names(self):
                own[name] = value
            else:
                raise InputError(f"An export has no setting {name!r}.")
        return replace(self, **own)


@dataclass(frozen=True)
class Exporter:
    """One format; a module of ``exporters`` that defines ``EXPORTER`` is one.

    - ``key``, ``label``: identifier in options, and name for display.
    - ``units``: units of the files, in one line.
    - ``carries``, ``loses``: what the format holds of a dataset and what it cannot hold; shown before the
      export and in the README.
    - ``load_command``: command, or line of an input file, that uses the files; ``{folder}`` is replaced by
      their folder, ``{shell}`` by the same quoted for a shell, ``{shape}`` by the name of the first shape.
    - ``files``: content of every file by its relative path; equal input gives equal bytes. The entry
      :data:`NOTES` is not a file but text for the README, such as measured errors.
    - ``alters``: how shapes are changed, in one sentence; empty if they are exact. Such an export must be
      accepted.
    - ``convex_only``: why the format cannot hold compounds, in one sentence; empty if it can. A dataset with
      compounds is refused before anything is written.
    - ``fills_mass``: whether its script makes as many particles as have the mass of the test; others list
      `n_particles`.
    - ``general``: whether it is for viewers and own programs instead of a DEM program.
    """

    key: str
    label: str
    units: str
    carries: tuple[str, ...]
    loses: tuple[str, ...]
    load_command: str
    files: Callable[[Dataset, ExportOptions], dict[str, bytes]]
    alters: str = ""
    convex_only: str = N_("Its particles are convex polyhedra.")
    fills_mass: bool = False
    general: bool = False


NOTES = "NOTES"
"""Key of an exporter's text for the README."""


@dataclass(frozen=True)
class ExportResult:
    """A written export."""

    key: str
    folder: Path
    files: tuple[str, ...]
    load_command: str


def case_settings(options: ExportOptions) -> dict[str, Any]:
    """Input of a simulation script: Tables 1 and 2, waiting times, coarse graining; SI units."""
    return {
        **{part: asdict(getattr(options, part)) for part in PARTS},
        "coarse_graining_factor": options.coarse_graining_factor,
    }


def number_row(values: Iterable[float]) -> str:
    """Numbers between blanks, with all their digits."""
    return " ".join(repr(float(value)) for value in values)


def write_export(
    dataset: Dataset,
    exporter: Exporter,
    folder: Path | str,
    options: ExportOptions | None = None,
    *,
    accept_loss: bool = False,
) -> ExportResult:
    """Write one format into `folder`, which then holds nothing else, or is unchanged if an error occurs.

    ``folder``: new, empty, or holding an export of this program and nothing else. ``accept_loss``: required
    for formats that change the shapes.

    Raises DatasetError if the format changes shapes and that was not accepted, cannot hold the dataset's
    compounds, the folder holds anything else, or something cannot be written.
    """
    with prepared_export(dataset, exporter, folder, options, accept_loss=accept_loss) as finish:
        return finish()


@contextmanager
def prepared_export(
    dataset: Dataset,
    exporter: Exporter,
    folder: Path | str,
    options: ExportOptions | None = None,
    *,
    dataset_hash: str | None = None,
    accept_loss: bool = False,
) -> Iterator[Callable[[], ExportResult]]:
    """As :func:`write_export`, complete under a hidden name; what it yields lets it take its place.

    ``dataset_hash``: of the dataset's folder, stored in the record.
    """
    chosen, target = options or ExportOptions(), Path(folder).resolve()
    check_loss_accepted(exporter, accept_loss)
    check_compounds(dataset, [exporter])
    with _reported(target):
        recover_folder(target)
        check_export_folder(target, FORMAT)
        content = _with_readme(dataset, exporter, chosen, dataset_hash)
        with filled_folder(target, content) as stage:

            def finish() -> ExportResult:
                with _reported(target):
                    exchange(stage, target)
                command = load_command(exporter, target, dataset)
                return ExportResult(exporter.key, target, tuple(sorted(content)), command)

            yield finish


@contextmanager
def _reported(target: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise DatasetError(f"The export {target} cannot be written ({os_error_reason(error)}).") from error


def load_command(exporter: Exporter, folder: Path, dataset: Dataset) -> str:
    """The exporter's command for the files of a dataset in `folder`, quoted if its path contains blanks."""
    shell = subprocess.list2cmdline([str(folder)]) if os.name == "nt" else shlex.quote(str(folder))
    return exporter.load_command.format(folder=folder, shell=shell, shape=shape_names(dataset)[0])


def check_loss_accepted(exporter: Exporter, accept_loss: bool) -> None:
    """Check that a format which changes the shapes was accepted.

    Raises DatasetError if it was not; the message says how shapes are changed.
    """
    if exporter.alters and not accept_loss:
        raise DatasetError(
            f"{exporter.label} cannot hold the shapes as they are: {exporter.alters} "
            "Allow formats that change the shapes to export it nevertheless."
        )


def check_compounds(dataset: Dataset, exporters: Sequence[Exporter]) -> None:
    """Check that formats can hold the compounds of a dataset, if it has any.

    Raises DatasetError if one cannot; the message says why.
    """
    refusing = [each for each in exporters if each.convex_only]
    if refusing and dataset.compounds:
        name = dataset.compounds[0].name
        reasons = " ".join(
            f"{each.label} cannot hold {name}, a compound of convex parts: {each.convex_only}"
            for each in refusing
        )
        keys = ", ".join(each.key for each in refusing)
        formats = f"format {keys}" if len(refusing) == 1 else f"formats {keys}"
        raise DatasetError(f"{reasons} Leave the {formats} out, or coarsen by another method.")


def _with_readme(
    dataset: Dataset, exporter: Exporter, options: ExportOptions, dataset_hash: str | None
) -> dict[str, bytes]:
    """The exporter's files with README and record."""
    content = dict(exporter.files(dataset, options))
    notes = content.pop(NOTES, b"").decode("utf-8")
    readme = _readme(dataset, exporter, options, notes, sorted(content)).encode("utf-8")
    record = {
        "format": FORMAT,
        "schema_version": 1,
        "exporter": exporter.key,
        "dataset": dataset.name,
        "dataset_sha256": dataset_hash,
        "software": f"regolith-studio {__version__}",
        "units": exporter.units,
        "options": asdict(options),
        "loses": list(exporter.loses),
        "alters": exporter.alters,
        "files": {name: hashlib.sha256(data).hexdigest() for name, data in content.items()}
        | {README: hashlib.sha256(readme).hexdigest()},
    }
    return content | {README: readme, RECORD: canonical_json(record).encode("utf-8")}


def _readme(
    dataset: Dataset, exporter: Exporter, options: ExportOptions, notes: str, names: list[str]
) -> str:
    lines = [
        f"{dataset.name} for {exporter.label}",
        "",
        f"Written by Regolith Studio {__version__} from a dataset of {len(dataset)} shapes.",
        "",
        f"Units: {exporter.units}",
        f"To use: {load_command(exporter, Path(), dataset)}",
        "",
        "Carried:",
        *(f"  - {one}" for one in exporter.carries),
        "Not carried:",
        *(f"  - {one}" for one in exporter.loses or ("nothing of the dataset is lost",)),
    ]
    if exporter.alters:
        lines += ["Shapes are changed:", f"  - {exporter.alters}"]
    lines += ["", *(notes.splitlines() or ["No further notes."])]
    lines += ["", f"Coarse-graining factor: {options.coarse_graining_factor:g}", "Files:"]
    shown = names if len(names) <= 12 else [*names[:11], f"... {len(names) - 11} more"]
    return "\n".join([*lines, *(f"  {name}" for name in shown), f"  {RECORD}", ""])


def check_export_folder(target: Path, format_name: str) -> None:
    """Check that a folder is new, empty, or holds an export of this program in a format and nothing else.

    Raises DatasetError if it holds anything else.
    """
    if not target.exists():
        return
    if not target.is_dir():
        raise DatasetError(f"{target} is a file; an export is written into a folder.")
    present = {
        path.relative_to(target).as_posix()
        for path in target.rglob("*")
        if path.is_file() and path.name not in IGNORED_FILES
    }
    if not present:
        return
    foreign = sorted(present - _own_files(target / RECORD, format_name) - {RECORD})
    if RECORD not in present or foreign:
        name = foreign[0] if foreign else RECORD
        raise DatasetError(
            f"{target} holds files that are not an export's ({name}); nothing was overwritten."
        )


def _names(settings: Any) -> set[str]:
    return {each.name for each in fields(settings)}


def _own_files(record: Path, format_name: str) -> set[str]:
    try:
        content = parse_strict_json(record.read_text(encoding="utf-8"), str(record))
    except (OSError, UnicodeDecodeError, FileError):
        return set()
    files = content.get("files") if isinstance(content, dict) else None
    if not isinstance(files, Mapping) or content.get("format") != format_name:
        return set()
    return set(files)


SIZE_COLUMNS = ("class", "name", "weight_number", "weight_mass", "diameter_um", "number_share", "mass_share")


def sizes_csv(dataset: Dataset) -> bytes:
    """CSV with one row for each class and size: class weights, diameter, and its share within the class."""
    rows: list[tuple[object, ...]] = [SIZE_COLUMNS]
    by_number, by_mass = dataset.class_weights("number"), dataset.class_weights("volume")
    for index, one in enumerate(dataset.representatives):
        sizes = size_classes(one.sizes)
        for diameter, number, mass in zip(sizes.diameters, sizes.number, sizes.mass, strict=True):
            shares = (float(by_number[index]), float(by_mass[index]), float(diameter), float(number))
            rows.append((index, one.name, *shares, float(mass)))
    return csv_bytes(rows)


MAX_SHAPE_NAME = 32
"""Letters of a particle's name in that of its shape, which stands in the 80 bytes of an STL file's head."""


def shape_names(dataset: Dataset) -> list[str]:
    """Names in order, each with that of its particle: ``shape_00_grain_1``, ``shape_01_grain_5`` ...

    They consist of letters, digits and underscores of ASCII, which every program takes for a name.
    """
    digits = max(2, len(str(len(dataset) - 1)))
    plain = (re.sub("[^A-Za-z0-9]+", "_", one.name).strip("_") for one in dataset.representatives)
    numbered = enumerate(name[:MAX_SHAPE_NAME] for name in plain)
    return [f"shape_{index:0{digits}d}_{name}".rstrip("_") for index, name in numbered]
