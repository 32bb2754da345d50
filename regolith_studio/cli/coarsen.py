"""``coarsen``: convex polyhedra with few faces."""

from typing import TYPE_CHECKING

import typer

from regolith_studio.cli.options import (
    Faces,
    Folder,
    Jobs,
    Json,
    LMax,
    Meshes,
    Method,
    Preset,
    RadiusRule,
    Reference,
    Seed,
    Settings,
    StarPoint,
    Target,
    Unit,
    Weights,
    as_bad_use,
    numbers,
    values,
)

if TYPE_CHECKING:
    from regolith_studio.session.choices import Choices


def coarsen(
    meshes: Meshes,
    output: Folder,
    faces: Faces = 20,
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
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Coarsen meshes to convex polyhedra that keep the chosen descriptors (section 2.4)."""
    from regolith_studio.cli.inputs import exit_code, read_inputs
    from regolith_studio.cli.terminal import complain, follow, print_json
    from regolith_studio.jobs.coarsening import coarsen_sample
    from regolith_studio.session.outputs.coarsening import coarsening_document, write_coarsening
    from regolith_studio.session.outputs.staging import staged_folder

    wish = choices_from(faces, method, preset, weight, set_, target, l_max, seed, star_point, rule, reference)
    loaded = read_inputs(meshes, unit)
    done = follow(coarsen_sample(loaded.particles, wish.order, jobs))
    with staged_folder(output) as stage:
        write_coarsening(stage, wish.order, done)
    failed = [each for each in done if each.coarsened is None]
    complain(f"{each.name}: {each.problem}" for each in failed)
    if json:
        print_json(coarsening_document(wish.order, done))
    else:
        typer.echo(f"{len(done) - len(failed)} of {len(done)} particles coarsened in {output}")
    raise typer.Exit(exit_code(meshes, loaded, len(failed)))


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
) -> "Choices":
    """The choices that the options of a coarsening stand for; a bad one is bad use."""
    from regolith_studio.coarsening.weights import LossWeights
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
    }
    with as_bad_use():
        if method:
            changes["method"] = method
        if preset:
            changes["preset"] = preset
        named = numbers(weight, "weight")
        if named and preset:
            changes["weights"] = LossWeights.from_preset(preset).replaced(**named)
        elif named:
            changes["weights"] = LossWeights.of(**named)
        return Choices().replaced(**changes)
