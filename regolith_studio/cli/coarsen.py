"""``coarsen``: convex polyhedra with few faces."""

from typing import TYPE_CHECKING

import typer

from regolith_studio.cli.options import (
    Faces,
    Folder,
    Jobs,
    Json,
    LMax,
    MaxError,
    Meshes,
    Method,
    Preset,
    RadiusRule,
    Reference,
    Repair,
    Seed,
    Settings,
    StarPoint,
    Target,
    Triangles,
    Unit,
    Weights,
    as_bad_use,
    numbers,
    values,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from regolith_studio.session.choices import Choices

FACES = 20
"""Of the command; the options tell by it whether another number was asked for."""


def coarsen(
    meshes: Meshes,
    output: Folder,
    faces: Faces = FACES,
    triangles: Triangles = None,
    max_error: MaxError = None,
    method: Method = "",
    preset: Preset = "",
    weight: Weights = None,
    set_: Settings = None,
    target: Target = "fit",
    l_max: LMax = 10,
    star_point: StarPoint = "",
    rule: RadiusRule = "volume",
    reference: Reference = "sphere",
    unit: Unit = "um",
    repair: Repair = True,
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Coarsen meshes to convex polyhedra that keep the chosen descriptors (section 2.4)."""
    from regolith_studio.cli.inputs import exit_code, read_inputs
    from regolith_studio.cli.terminal import complain, follow, print_json, print_table
    from regolith_studio.jobs.coarsening import coarsen_sample
    from regolith_studio.session.outputs.coarsening import coarsening_document, error_table, write_coarsening
    from regolith_studio.session.outputs.staging import staged_folder

    wish = choices_from(
        *(faces, method, preset, weight, set_, target, l_max, seed, star_point, rule, reference),
        fineness=fineness_from(faces, triangles, max_error),
    )
    order = wish.order
    loaded = read_inputs(meshes, unit, repair)
    done = follow(coarsen_sample(loaded.particles, order, jobs))
    with staged_folder(output) as stage:
        write_coarsening(stage, order, done)
    failed = [each for each in done if each.coarsened is None]
    complain(f"{each.name}: {each.problem}" for each in failed)
    if json:
        print_json(coarsening_document(order, done))
    else:
        if len(done) > len(failed):
            print_table(error_table(done))
        results = [(each.name, each.coarsened) for each in done if each.coarsened]
        complain(f"{name}: {coarse.reason}" for name, coarse in results if coarse.reason)
        typer.echo(f"{len(done) - len(failed)} of {len(done)} particles coarsened in {output}")
    raise typer.Exit(exit_code(meshes, loaded, len(failed)))


def fineness_from(faces: int, triangles: int | None, max_error: float | None) -> dict[str, object]:
    """The choices that the options stand for which say how fine to be; more than one is bad use."""
    if (faces != FACES) + (triangles is not None) + (max_error is not None) > 1:
        raise typer.BadParameter("Only one of --faces, --triangles and --max-error can say how fine to be.")
    if triangles is not None:
        return {"stop_at": "triangles", "n_triangles": triangles}
    if max_error is not None:
        return {"stop_at": "error", "largest_error": round(max_error / 100.0, 12)}
    return {}


def choices_from(
    faces: int,
    method: str,
    preset: str,
    weight: list[str] | None,
    settings: list[str] | None,
    target: str,
    l_max: int,
    seed: int,
    star_point: str,
    rule: str,
    reference: str,
    fineness: "Mapping[str, object] | None" = None,
) -> "Choices":
    """The choices that the options of a coarsening stand for; a bad one is bad use.

    Parameters
    ----------
    fineness
        From :func:`fineness_from`, where more than the number of facets can be asked for.
    """
    from regolith_studio.coarsening.coarsen import DEFAULT_PRESET
    from regolith_studio.coarsening.weights import LossWeights
    from regolith_studio.errors import InputError
    from regolith_studio.session.choices import Choices

    changes: dict[str, object] = {
        "n_faces": faces,
        "settings": tuple(values(settings, "setting").items()),
        "target": target,
        "l_max": l_max,
        "star_point": star_point,
        "rule": rule,
        "reference": reference,
        "seed": seed,
        **(fineness or {}),
    }
    with as_bad_use():
        if method:
            changes["method"] = method
        if preset:
            changes["preset"] = preset
        named = numbers(weight, "weight")
        if named and preset:
            changes["weights"] = LossWeights.from_preset(preset).replaced(**named)
        elif named and not any(named.values()):
            changes["weights"] = LossWeights.from_preset(DEFAULT_PRESET).replaced(**named)
        elif named:
            changes["weights"] = LossWeights.of(**named)
        made = Choices().replaced(**changes)
        if made.weights.all_zero and made.method != "quadric":
            raise InputError("All weights of the loss are 0, so there is nothing to optimise; raise one.")
        return made
