"""``run``: a recipe, as the window saves it; ``demo``: all steps for what ships, without a screen."""

import shutil
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from regolith_studio.cli.batch_options import Address, Resume, Runner, Tls, chosen_executor, print_first
from regolith_studio.cli.generate import write_particles
from regolith_studio.cli.offscreen_process import draw_in_process, draw_three_views
from regolith_studio.cli.options import Folder, Jobs, Json, Seed, option_of
from regolith_studio.cli.terminal import print_errors, print_json, print_result, run_with_progress
from regolith_studio.coarsening.settings import CoarseningSettings
from regolith_studio.errors import RegolithError

if TYPE_CHECKING:
    from regolith_studio.jobs.events import Steps
    from regolith_studio.jobs.executor import Executor
    from regolith_studio.session.run_recipe import RecipeRun


def run(
    recipe: Annotated[
        Path, typer.Argument(metavar="RECIPE.json", help="A recipe file, as the window saves it.")
    ],
    output: Folder = Path("regolith-results"),
    json: Json = False,
    jobs: Jobs = 1,
    resume: Resume = False,
    chunk: Annotated[
        int | None,
        typer.Option(
            "--chunk",
            min=1,
            max=1_000_000,
            help="Particles per chunk; by default 1, and 25 to 200 in batches of 200 or more.",
            metavar="N",
            show_default=False,
        ),
    ] = None,
    runner: Runner = "processes",
    address: Address = "",
    tls: Tls = None,
    seed: Annotated[
        int | None,
        option_of(
            CoarseningSettings, "seed", tip="Seed of the random numbers, instead of that of the recipe."
        ),
    ] = None,
) -> None:
    """Run a recipe: descriptors, fits, meshes, dataset, studies and summary."""
    from regolith_studio.session.recipe import read_recipe
    from regolith_studio.session.run_recipe import run_recipe

    wish = read_recipe(recipe)
    if seed is not None:
        wish = wish.model_copy(update={"seed": seed})
    with chosen_executor(runner, jobs, address, tls) as executor:
        done = run_with_progress(
            run_recipe(wish, recipe.parent, output, executor, resume, chunk), logged=True
        )
    print_first(done.notes, "more notes")
    print_first(done.problems, "more problems: failed.csv has those of particles, --json all")
    if json:
        lists = {"files": done.files, "problems": done.problems, "notes": done.notes}
        print_json({"folder": str(output), **lists})
    else:
        typer.echo(f"{len(done.files)} files in {output}")
    raise typer.Exit(1 if done.problems else 0)


N_REPRESENTATIVES, N_DRAWN, N_HEAP = 12, 20, 300
EXPORTER = "rocky"


def demo(
    output: Folder = Path("regolith-demo"),
    json: Json = False,
    jobs: Jobs = 0,
    seed: Seed = 0,
) -> None:
    """Run the whole chain on the shipped scan and particles, with Figs. 3 and 8 and one page about it."""
    from regolith_studio.io.atomic import staged_folder, write_bytes
    from regolith_studio.jobs.events import Progress
    from regolith_studio.jobs.executor import open_executor
    from regolith_studio.session.outputs import summary as page

    problems: list[str] = []
    with staged_folder(output, "demo") as stage, open_executor(jobs) as executor:
        _shipped_scan(stage / page.SCAN, executor, seed, problems)
        with closing(_heap(stage / page.SCAN / "dataset", stage / page.HEAP, seed, problems)) as heap:
            if executor.workers > 1:  # the engine is a process of its own: it works during the next steps
                next((step for step in heap if isinstance(step, Progress)), None)
            _shipped_particles(stage / page.PARTICLES, executor, seed, problems)
            with _noted(problems):
                _draw_population(stage / page.SCAN / "fit.json", stage / page.POPULATION, executor, seed)
            run_with_progress(heap)
        problems = [each.replace(str(stage), str(output)) for each in problems]
        write_bytes(stage / page.DEMO_PAGE, page.demo_page(stage, problems).encode("utf-8"))
        files = sorted(path.relative_to(stage).as_posix() for path in stage.rglob("*") if path.is_file())
    print_errors(problems)
    print_result(
        {"folder": str(output), "files": files, "problems": problems},
        f"{len(files)} files in {output}; begin with {output / page.DEMO_PAGE}",
        json,
    )
    raise typer.Exit(1 if problems else 0)


@contextmanager
def _noted(problems: list[str]) -> Iterator[None]:
    """Note what goes wrong in a step, and go on without it."""
    try:
        yield
    except RegolithError as error:
        problems.append(str(error))


def _run_recipe(folder: Path, executor: "Executor", problems: list[str], **entries: Any) -> "RecipeRun":
    """Run a recipe that nobody will resume."""
    from regolith_studio.io.atomic import JOURNAL
    from regolith_studio.session.recipe import recipe_of
    from regolith_studio.session.run_recipe import run_recipe

    done: RecipeRun = run_with_progress(run_recipe(recipe_of(**entries), Path(), folder, executor))
    shutil.rmtree(folder / JOURNAL)
    problems += done.problems
    return done


def _shipped_particles(folder: Path, executor: "Executor", seed: int, problems: list[str]) -> None:
    """Fits, polyhedra, dataset, Figs. 3 and 8 and the summary of the shipped particles."""
    from regolith_studio.session.outputs.summary import write_summary
    from regolith_studio.session.recipe import Outputs

    outputs = Outputs(fits=True, lmax_study=True, coarsening_study=True, summary=False)
    done = _run_recipe(folder, executor, problems, seed=seed, outputs=outputs)
    with _noted(problems):
        done.summary.pictures = _pictures(done)
    write_summary(folder, done.recipe, done.summary, done.studies, done.problems)


def _pictures(done: "RecipeRun") -> tuple[tuple[str, str], ...]:
    """The three views of the first particle."""
    from regolith_studio.jobs.coarsening_jobs import coarsen_particle
    from regolith_studio.session.outputs.summary import VIEWS

    index = done.tally.first_coarse
    if index is None:
        return ()
    particle = done.items.members[index].particle()
    first = run_with_progress(coarsen_particle(particle, done.choices.coarsening_request, index))
    draw_three_views(particle, first, done.choices, done.folder / VIEWS)
    caption = f"{first.name}: synthetic particle, its spherical-harmonics fit and coarsened polyhedron"
    return ((VIEWS, caption),)


def _shipped_scan(folder: Path, executor: "Executor", seed: int, problems: list[str]) -> None:
    """Grains of the shipped scan, their fits, a dataset of their representatives, and an export."""
    from regolith_studio.session.recipe import Exports, Outputs, Representatives, VolumeEntry

    _run_recipe(
        folder,
        executor,
        problems,
        seed=seed,
        volumes=[VolumeEntry(file="sample:grey")],
        outputs=Outputs(fits=True, meshes=False, summary=False),
        representatives=Representatives.model_validate({"count": N_REPRESENTATIVES, "name": "demo"}),
        exports=Exports(targets=[EXPORTER]),
    )


def _draw_population(fit: Path, folder: Path, executor: "Executor", seed: int) -> None:
    """Virtual particles like the grains."""
    from regolith_studio.io.atomic import staged_folder
    from regolith_studio.jobs.model_jobs import GenerationRequest, draw, fit_model, groups_of
    from regolith_studio.readers.shape_files import read_shape_source
    from regolith_studio.session.outputs.particles import GeneratedParticles

    source, request = read_shape_source(str(fit)), GenerationRequest(n=N_DRAWN, seed=seed)
    model = run_with_progress(fit_model(source, request))
    draws = run_with_progress(draw(model, request))
    made = GeneratedParticles(source, request, model, draws, groups_of(draws, model))
    with staged_folder(folder, "generate") as stage:
        write_particles(stage, made, "stl", None, executor)


def _heap(dataset: Path, folder: Path, seed: int, problems: list[str]) -> "Steps":
    """The lifting cylinder with few particles, and a picture of the heap."""
    from regolith_studio.dem.case import ReposeCase
    from regolith_studio.dem.engines.mujoco.settings import MujocoSettings
    from regolith_studio.dem.run_io import TIMES, read_shapes
    from regolith_studio.jobs.repose_jobs import ReposeRequest, repose_steps
    from regolith_studio.session.outputs.summary import HEAP_PICTURE

    settings = MujocoSettings(time_step=0.04, iterations=15, rest_energy=2e-3)
    case = ReposeCase(n_particles=N_HEAP, seed=seed + 1)  # the heap of seed 0 has no angle
    request = ReposeRequest(case, settings=settings)
    with _noted(problems):
        done = yield from repose_steps(dataset, folder, request)
        (folder / TIMES).unlink()
        title = f"Illustration: {N_HEAP} particles are too few for an angle of repose"
        given = (read_shapes(folder), done.ending.particles, request.case.test, title)
        draw_in_process("regolith_studio.scene.figure:heap_picture", given, folder / HEAP_PICTURE)
