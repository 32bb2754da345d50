"""The present choices as a command line and as Python code."""

import shlex
from dataclasses import asdict, fields

from regolith_studio.harmonics.fit_options import FitOptions
from regolith_studio.readers.settings import ReadingSettings
from regolith_studio.resources import SAMPLE
from regolith_studio.session.choices import Choices


def as_command(choices: Choices, inputs: list[str]) -> str:
    """The ``coarsen`` command that does to all particles what the window does to one."""
    words = ["regolith-studio", "coarsen", *inputs]
    words += ["-o", "coarsened", *_stopping_options(choices), "--method", choices.method]
    words += ["--seed", str(choices.seed), "--target", choices.target]
    if choices.target == "fit":
        words += ["--l-max", str(choices.l_max)]
        options = asdict(choices.fit_options).items()
        words += [f"--{name.replace('_', '-')}={value}" for name, value in options if value]
    words += ["--preset", choices.preset]
    if choices.preset_modified:
        words += [word for key, value in choices.weights.items() for word in ("--weight", f"{key}={value:g}")]
    if choices.weights.keep is not None:
        words += ["--keep", ",".join(sorted(choices.weights.keep)) or "nothing"]
    words += [word for name, value in choices.settings for word in ("--set", f"{name}={value}")]
    return shlex.join(words + _reading_options(choices))


def as_python(choices: Choices, source: str) -> str:
    """A script that fits and coarsens one particle as the window does.

    ``source``: path of its mesh, or ``sample:`` and the name of a shipped particle; the first of them if
    there is no name.
    """
    kind, _, name = source.partition(":")
    sample = kind == "sample"
    repair = "" if choices.repair else ", repair=False"
    reading = f"read_mesh({source!r}, unit={choices.unit!r}{repair})"
    if sample:
        named = "" if source == SAMPLE or not name else f" if each.name == {name!r}"
        reading = f"next(each for each in sample_particles(){named})"
    body = "reconstruct(fit, l_max, level)" if choices.target == "fit" else "particle.mesh"
    by_error = choices.stop_at == "error"
    functions = [*([] if by_error else ["coarsen"]), "fit_harmonics", *([] if sample else ["read_mesh"])]
    lines = [
        f"from regolith_studio import {', '.join(functions)}",
        *(["from regolith_studio.coarsening.stopping_criteria import coarsen_below"] if by_error else []),
        "from regolith_studio.coarsening.coarsen import settings_of",
        "from regolith_studio.coarsening.weights import LossWeights",
        "from regolith_studio.harmonics.synthesis import reconstruct",
        *(["from regolith_studio.readers.particles import sample_particles"] if sample else []),
        "",
        f"l_max, level = {choices.l_max}, {choices.level}",
        f"particle = {reading}",
        f"fit = {_fit_call(choices)}",
        f"target = {body}",
        f"weights = LossWeights.of(**{dict(choices.weights)!r}){_keeping(choices)}",
        f"settings = settings_of({choices.method!r}, {dict(choices.settings)!r})",
        *_coarsening_call(choices),
        "print(done.n_facets, done.errors, done.jaccard_distance)",
    ]
    return "\n".join(lines) + "\n"


def _reading_options(choices: Choices) -> list[str]:
    """The unit, and what else is not as by default."""
    words = ["--unit", choices.unit]
    for each in fields(ReadingSettings):
        value = getattr(choices, each.name)
        if isinstance(value, bool) and value != each.default:
            words.append(f"--{'' if value else 'no-'}{each.name}")
    return words


def _keeping(choices: Choices) -> str:
    keep = choices.weights.keep
    return "" if keep is None else f".keeping({sorted(keep)!r})"


def _stopping_options(choices: Choices) -> list[str]:
    match choices.stop_at:
        case "triangles":
            return ["--triangles", str(choices.n_triangles)]
        case "vertices":
            return ["--vertices", str(choices.n_vertices)]
        case "error":
            return ["--max-error", f"{100 * choices.largest_error:.12g}"]
    return ["--facets", str(choices.n_facets)]


def _coarsening_call(choices: Choices) -> list[str]:
    """The call that coarsens; of a budget of triangles or vertices the number of facets that it allows."""
    function, criterion = "coarsen", f"n_facets={choices.facet_count}"
    if choices.stop_at == "error":
        function, criterion = "coarsen_below", f"limit={choices.largest_error!r}"
    return [
        f"done = {function}(",
        f"    target, {criterion}, method={choices.method!r}, weights=weights,",
        f"    seed={choices.seed}, settings=settings,",
        ")",
    ]


def _fit_call(choices: Choices) -> str:
    defaults = asdict(FitOptions())
    options = asdict(choices.fit_options).items()
    arguments = [f"{name}={value!r}" for name, value in options if value != defaults[name]]
    return f"fit_harmonics({', '.join(['particle.mesh', 'l_max=30', *arguments])})"
