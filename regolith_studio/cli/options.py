"""Options that several commands share, groups of them, and reading the particles that they name."""

import errno
import functools
import inspect
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import MISSING, Field, asdict, dataclass, fields, is_dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, get_origin, get_type_hints

import typer

from regolith_studio.cli.terminal import print_errors, run_with_progress
from regolith_studio.coarsening.settings import DEFAULT_PRESET, CoarseningSettings
from regolith_studio.errors import FileError, InputError, os_error_reason
from regolith_studio.harmonics.fit_options import FitOptions, FitSurfaceSettings
from regolith_studio.io.output_lock import output_lock
from regolith_studio.readers.settings import ReadingSettings
from regolith_studio.resources import SAMPLE, resource
from regolith_studio.settings import setting_of

if TYPE_CHECKING:
    from regolith_studio.coarsening.weights import LossWeights
    from regolith_studio.readers.particles import LoadedParticles
    from regolith_studio.session.choices import Choices


def with_dataclass_options(command: Callable[..., None]) -> Callable[..., None]:
    """The command with the options of its groups in place of the groups, for typer.

    A group is a frozen dataclass whose fields are annotated as options, are made by
    :func:`~regolith_studio.settings.setting`, or are groups themselves.
    """
    hints = get_type_hints(command, include_extras=True)
    parameters = inspect.signature(command).parameters.values()
    groups = {each.name: hints[each.name] for each in parameters if is_dataclass(hints[each.name])}

    @functools.wraps(command)
    def called(**values: Any) -> None:
        arguments = {name: _make_group(group, values) for name, group in groups.items()}
        command(**values, **arguments)

    options = [
        option for each in parameters for option in _options(each.name, hints[each.name], each.default)
    ]
    signature = inspect.Signature(options)
    called.__signature__ = signature  # type: ignore[attr-defined]
    called.__annotations__ = {each.name: each.annotation for each in options}
    return called


def _options(name: str, hint: Any, default: Any) -> Iterator[inspect.Parameter]:
    """An option, or those of a group."""
    if not is_dataclass(hint):
        yield inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=hint)
        return
    hints = get_type_hints(hint, include_extras=True)
    for each in fields(hint):
        default = inspect.Parameter.empty if each.default is MISSING else each.default
        annotation = hints[each.name]
        if "label" in each.metadata:
            plain = str if get_origin(annotation) is Literal else annotation  # the group checks its keys
            annotation = Annotated[plain, _option(each, each.name)]
        yield from _options(each.name, annotation, default)


def option_of(kind: type[Any], name: str, **changes: Any) -> Any:
    """The option of a single setting, for ``Annotated``; `changes` of its metadata, such as ``metavar``."""
    return _option(setting_of(kind, name, **changes), name)


def _option(each: Field[Any], name: str) -> Any:
    """The option of a setting; its tip and its keys are the help, its range is checked."""
    metadata = each.metadata
    keys = [str(key) for key in metadata.get("choices", ()) if key]
    help_ = metadata.get("tip") or f"{metadata['label']}."
    flag = metadata.get("option") or f"--{name.strip('_').replace('_', '-')}"
    if isinstance(each.default, bool):
        off = f"/--no-{flag.removeprefix('--')}" if each.default and "/" not in flag else ""
        return typer.Option(f"{flag}{off}", help=help_)
    limits = {end[:3]: metadata[end] for end in ("minimum", "maximum") if end in metadata}
    metavar = "KEY" if isinstance(each.default, str) else "N"
    if metadata.get("unit") == "%":
        metavar, limits = "PERCENT", {end: 100.0 * limit for end, limit in limits.items()}
    return typer.Option(
        flag,
        help=f"{help_} One of: {', '.join(keys)}." if keys else help_,
        metavar=metadata.get("metavar", metavar),
        show_default=metadata.get("shown_default", bool(each.default)),
        **limits,
    )


def _make_group(group: Any, values: dict[str, Any]) -> Any:
    """Make a group of its values, which are removed from `values`."""
    hints = get_type_hints(group)
    arguments = {}
    for name in (each.name for each in fields(group)):
        arguments[name] = _make_group(hints[name], values) if is_dataclass(hints[name]) else values.pop(name)
    try:
        return group(**arguments)
    except InputError as error:
        raise typer.BadParameter(str(error)) from error


Convention = Annotated[
    str,
    typer.Option(
        "--convention",
        help="Convention of tables of coefficients: auto, complex, shtools-4pi or shtools-ortho.",
        metavar="C",
    ),
]


@dataclass(frozen=True)
class ReadingOptions(ReadingSettings):
    """How meshes and tables are read."""

    convention: Convention = "auto"

    def read(self, paths: Sequence[Path], l_max: int | None = None) -> "LoadedParticles":
        """The particles in files and folders; unreadable files are reported on stderr.

        ``l_max``: degree above which coefficients of tables are left out.
        """
        from regolith_studio.jobs.particle_jobs import load_particles
        from regolith_studio.readers.coefficient_tables import TableReading, table_convention
        from regolith_studio.readers.settings import unit_factor

        with usage_errors():
            unit_factor(self.unit)
            tables = TableReading(l_max, table_convention(self.convention))
        steps = load_particles(tuple(paths), ReadingSettings.of(self), tables)
        loaded: LoadedParticles = run_with_progress(steps)
        print_errors(loaded.left_out)
        print_errors(problem.with_path for problem in loaded.problems)
        return loaded


def exit_code(loaded: "LoadedParticles", failures: int = 0) -> int:
    """1 if a file, named itself or in a folder, or any particle failed."""
    return 1 if failures or loaded.problems else 0


def mesh_path(text: str) -> Path:
    """The path of a mesh or a folder of meshes; ``sample:all`` is that of the shipped ones."""
    return resource("samples", "particles") if text == SAMPLE else Path(text)


Meshes = Annotated[
    list[Path],
    typer.Argument(
        metavar="MESH...",
        help="Mesh files, or folders and ZIP archives that hold some; sample:all for the shipped ones.",
        parser=mesh_path,
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")]
Seed = Annotated[int, option_of(CoarseningSettings, "seed")]
Jobs = Annotated[
    int,
    typer.Option(
        "--jobs", "-j", min=0, max=1024, help="Number of parallel processes; 0 for one per core.", metavar="N"
    ),
]


def output_path(text: str) -> Path:
    """The path of an output, which has a name."""
    if not text:
        raise typer.BadParameter("Name a place for the results, got an empty name.")
    return Path(text)


def claim_folder(context: typer.Context, folder: Path | None) -> Path | None:
    """The folder, locked against other processes, if it can be written: checked before hours of work."""
    if folder is not None:
        _check_folder(folder)
        context.with_resource(output_lock(folder))
    return folder


def claim_file(context: typer.Context, path: Path | None) -> Path | None:
    """The same for a file."""
    if path is not None:
        _check_folder(path.parent)
        if path.is_dir():
            raise FileError(f"{path} is a folder; name a file.")
        context.with_resource(output_lock(path))
    return path


def claim_labels(context: typer.Context, path: Path | None) -> Path | None:
    """The same for a label volume, whose suffix says the format."""
    if path is not None:
        from regolith_studio.imaging.label_files import label_suffix

        with usage_errors():
            label_suffix(path)
        if not path.parent.is_dir():
            raise FileError(
                f"There is no folder {path.parent} for the labels; name a file in one that is there."
            )
    return claim_file(context, path)


def claim_json(context: typer.Context, path: Path | None) -> Path | None:
    """The same for a JSON file, whose name may be given without its suffix."""
    if path is not None and path.suffix != ".json" and not path.is_dir():
        path = path.with_name(f"{path.name}.json")
    return claim_file(context, path)


def _check_folder(folder: Path) -> None:
    existing = next(place for place in (folder, *folder.absolute().parents) if os.path.lexists(place))
    if not existing.exists():
        raise FileError(f"{existing} is a link that leads nowhere; name a folder for the results.")
    if not existing.is_dir():
        raise FileError(f"{existing} is a file; name a folder for the results.")
    if not os.access(existing, os.W_OK | os.X_OK):
        read_only = hasattr(os, "statvfs") and os.statvfs(existing).f_flag & os.ST_RDONLY
        reason = os_error_reason(OSError(errno.EROFS if read_only else errno.EACCES, ""))
        raise FileError(f"The folder {existing} cannot be written ({reason}).")


def output_option(help_: str, metavar: str, claim: Callable[..., Any], *flags: str) -> Any:
    """The option of a place for results, which `claim` checks; ``--output`` unless named."""
    flags = flags or ("--output", "-o")
    return typer.Option(*flags, help=help_, metavar=metavar, parser=output_path, callback=claim)


_FOLDER = output_option("Folder to write.", "DIR", claim_folder)
Folder = Annotated[Path, _FOLDER]
OptionalFolder = Annotated[Path | None, _FOLDER]
LMax = Annotated[int, option_of(FitSurfaceSettings, "l_max")]
Degrees = Annotated[
    str, typer.Option("--degrees", help="Values of l_max, such as 1,2,5 or 1-20.", metavar="LIST")
]
Level = Annotated[int, option_of(FitSurfaceSettings, "level")]
Facets = Annotated[int, option_of(CoarseningSettings, "n_facets")]
Resume = Annotated[
    bool,
    typer.Option("--resume", help="Resume an interrupted study in the output folder."),
]
Preset = Annotated[str, option_of(CoarseningSettings, "preset", default="")]
Weights = Annotated[
    list[str] | None,
    typer.Option(
        "--weight",
        help="Weight of one term of the loss (Eq. 9); may be repeated. With --preset, or where all named "
        "weights are 0 (volume=0), the others are those of the preset, else 0.",
        metavar="KEY=VALUE",
    ),
]
Keep = Annotated[
    str,
    typer.Option(
        "--keep",
        help="Terms of the loss that are kept exactly, such as volume,sphericity, or nothing; the weights of "
        "the others are prices. Without it volume, sphericity, min_diameter, max_diameter and aspect_ratio "
        "are kept where their weight is above 0.",
        metavar="KEY,KEY",
    ),
]
Settings = Annotated[
    list[str] | None,
    typer.Option("--set", help="A setting of the method; may be repeated.", metavar="KEY=VALUE"),
]


@contextmanager
def usage_errors() -> Iterator[None]:
    """Report an :class:`InputError` raised inside as a usage error: exit code 2."""
    try:
        yield
    except InputError as error:
        raise typer.BadParameter(str(error)) from error


def numbers(entries: list[str] | None, what: str) -> dict[str, float]:
    """``KEY=VALUE`` entries with numeric values."""
    parsed = {}
    for key, text in _pairs(entries, what):
        try:
            parsed[key] = float(text)
        except ValueError:
            raise typer.BadParameter(f"The {what} {key} must be a number, got {text!r}.") from None
    return parsed


def values(entries: list[str] | None, what: str) -> dict[str, bool | int | float | str]:
    """``KEY=VALUE`` entries, each value as the simplest type that can hold it."""
    return {key: _simplest(text) for key, text in _pairs(entries, what)}


def words(text: str) -> tuple[str, ...]:
    """What stands between commas."""
    return tuple(word.strip() for word in text.split(",") if word.strip())


def whole_numbers(text: str, low: int, high: int) -> tuple[int, ...]:
    """``1,2,5`` or ``1-20`` or both, ascending, each from `low` to `high`."""
    parsed: set[int] = set()
    for part in text.split(","):
        first, dash, last = part.strip().partition("-")
        try:
            first_number, last_number = int(first), int(last if dash else first)
        except ValueError:
            raise typer.BadParameter(f"Write whole numbers as 1,2,5 or 1-20, got {text!r}.") from None
        if not low <= first_number <= last_number <= high:
            raise typer.BadParameter(f"The numbers must lie between {low} and {high}, got {text!r}.")
        parsed.update(range(first_number, last_number + 1))
    return tuple(sorted(parsed))


def _pairs(entries: list[str] | None, what: str) -> Iterator[tuple[str, str]]:
    for entry in entries or ():
        key, equals, text = entry.partition("=")
        if not equals or not key:
            raise typer.BadParameter(f"Write a {what} as KEY=VALUE, got {entry!r}.")
        yield key.strip(), text.strip()


def _simplest(text: str) -> bool | int | float | str:
    if text.lower() in ("true", "false"):
        return text.lower() == "true"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


NOTHING = "nothing"
"""Keep no term exactly."""
FACETS = CoarseningSettings.n_facets
"""Default of ``--facets``."""


@dataclass(frozen=True)
class StoppingOptions:
    """When the coarsening stops: number of facets, triangles or vertices, or largest error."""

    facets: int = setting_of(CoarseningSettings, "n_facets")
    triangles: int | None = setting_of(CoarseningSettings, "n_triangles", default=None)
    vertices: int | None = setting_of(CoarseningSettings, "n_vertices", default=None)
    max_error: float | None = setting_of(CoarseningSettings, "largest_error", default=None, minimum=1e-8)

    @property
    def changes(self) -> dict[str, object]:
        """Changes of the choices; more than one of the options is a usage error."""
        others = (self.triangles, self.vertices, self.max_error)
        if (self.facets != FACETS) + sum(each is not None for each in others) > 1:
            raise typer.BadParameter(
                "Only one of --facets, --triangles, --vertices and --max-error can say how fine to be."
            )
        if self.triangles is not None:
            return {"stop_at": "triangles", "n_triangles": self.triangles}
        if self.vertices is not None:
            return {"stop_at": "vertices", "n_vertices": self.vertices}
        if self.max_error is not None:
            return {"stop_at": "error", "largest_error": round(self.max_error / 100.0, 12)}
        return {"n_facets": self.facets}


@dataclass(frozen=True, kw_only=True)
class CoarseningOptions:
    """Options of the coarsening, without the stopping criterion and the preset."""

    method: str = setting_of(CoarseningSettings, "method")
    weight: Weights = None
    keep: Keep = ""
    set_: Settings = None
    target: str = setting_of(CoarseningSettings, "target")
    l_max: int = setting_of(FitSurfaceSettings, "l_max")
    radii: FitOptions

    def choices(self, preset: str = "", **others: object) -> "Choices":
        """The choices that the options define; a wrong value is a usage error.

        ``preset``: key of the preset whose weights ``--weight`` changes; without one, all other weights are
        0. ``others``: further choices, ``seed`` and ``n_facets`` say.
        """
        from regolith_studio.errors import InputError
        from regolith_studio.session.choices import Choices

        changes: dict[str, object] = {
            "method": self.method,
            "settings": tuple(values(self.set_, "setting").items()),
            "target": self.target,
            "l_max": self.l_max,
            **asdict(self.radii),
            **others,
        }
        with usage_errors():
            if preset:
                changes["preset"] = preset
            if (weights := self._weights(preset)) is not None:
                changes["weights"] = weights
            choices = Choices().replaced(**changes)
            if choices.weights.all_zero and not choices.weights.keep and choices.method != "quadric":
                raise InputError("All weights of the loss are 0, so there is nothing to optimise; raise one.")
            return choices

    def _weights(self, preset: str) -> "LossWeights | None":
        from regolith_studio.coarsening.weights import LossWeights

        named = numbers(self.weight, "weight")
        if not named and not self.keep:
            return None
        weights = LossWeights.of(**named)
        if preset or not any(named.values()):
            weights = LossWeights.from_preset(preset or DEFAULT_PRESET).replaced(**named)
        if not self.keep:
            return weights
        return weights.keeping(each.strip() for each in self.keep.split(",") if each.strip() != NOTHING)
