"""Options of commands for thousands of meshes: in processes, on a cluster, resumed, from an archive."""

from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from regolith_studio.cli.options import ReadingOptions, usage_errors
from regolith_studio.cli.terminal import print_errors, print_json, run_with_progress
from regolith_studio.readers.settings import ReadingSettings
from regolith_studio.settings import settings_in

if TYPE_CHECKING:
    from regolith_studio.jobs.executor import Executor
    from regolith_studio.session.choices import Choices
    from regolith_studio.session.recipe import Outputs


Runner = Annotated[
    str,
    typer.Option(
        "--runner", help="Executor: processes (of this machine) or dask (a cluster).", metavar="NAME"
    ),
]
Address = Annotated[
    str,
    typer.Option(
        "--address",
        help="Dask scheduler, tcp://HOST:8786 or tls://HOST:8786; a local one is started if omitted.",
        metavar="URL",
        show_default=False,
    ),
]
Tls = Annotated[
    Path | None,
    typer.Option(
        "--tls",
        help="Folder with ca.pem, cert.pem and key.pem for a tls:// address.",
        metavar="DIR",
        show_default=False,
    ),
]


@contextmanager
def chosen_executor(runner: str, jobs: int, address: str, tls: Path | None) -> "Iterator[Executor]":
    """The executor that the options ask for, closed at the end; names the status page of a cluster."""
    from regolith_studio.jobs.executor import ExecutorSettings

    with usage_errors():
        executor = ExecutorSettings(runner, jobs, address, tls).open()
    with closing(executor):
        if executor.dashboard:
            print_errors([f"{executor.workers} workers; dashboard {executor.dashboard}"])
        yield executor


MOST_IN_MEMORY = 2000
"""Members of archives that are read into memory together; coarsening goes to the disk from here on."""
_MOST_LINES = 20
"""Problems that are printed, ``failed.csv`` has all; and notes, ``--json`` has all."""

Resume = Annotated[bool, typer.Option("--resume", help="Resume an interrupted run in the output folder.")]


@dataclass(frozen=True)
class BatchOptions:
    """Where particles are worked on, and whether a run is resumed."""

    resume: Resume = False
    runner: Runner = "processes"
    address: Address = ""
    tls: Tls = None

    def asked(self, paths: Sequence[Path]) -> bool:
        """Whether there are archives or very many files, or an option needs a run that goes to the disk."""
        from regolith_studio.readers.particles import find_files

        if self.resume or self.runner != "processes":
            return True
        files = find_files(paths, [])
        return len(files) > MOST_IN_MEMORY or any(file.member for file in files)

    def run(
        self,
        paths: Sequence[Path],
        output: Path,
        outputs: "Outputs",
        choices: "Choices",
        reading: ReadingOptions,
        jobs: int,
        json: bool,
    ) -> None:
        """Work on one particle after the other with the results on the disk, print what was written, end."""
        from regolith_studio.readers.coefficient_tables import table_convention
        from regolith_studio.readers.error_messages import plural
        from regolith_studio.readers.settings import unit_factor
        from regolith_studio.session.recipe import FilesEntry, Recipe
        from regolith_studio.session.run_recipe import run_recipe

        with usage_errors():
            unit_factor(reading.unit)
            convention = table_convention(reading.convention)
        entry = FilesEntry(
            files=[str(path.absolute()) for path in paths],
            convention=convention,
            **settings_in(ReadingSettings, reading),
        )
        recipe = Recipe.from_choices(choices, [entry], outputs)
        with chosen_executor(self.runner, jobs, self.address, self.tls) as executor:
            done = run_with_progress(run_recipe(recipe, Path(), output, executor, self.resume), logged=True)
        print_first(done.notes, "more notes")
        print_first(done.problems, "more in failed.csv")
        if json:
            counts = {"particles": done.tally.n_read, "failed": len(done.problems)}
            lists = {"problems": done.problems, "notes": done.notes}
            print_json({"folder": str(output), **counts, **lists})
        else:
            totals = plural(len(done.items.members), "particle"), plural(len(done.problems), "problem")
            typer.echo(f"{', '.join(totals)} in {output}")
        raise typer.Exit(1 if done.problems else 0)


def print_first(sentences: Sequence[str], rest: str) -> None:
    """The first of many notes or problems, and how many more there are: `rest` says where or what."""
    more = len(sentences) - _MOST_LINES
    print_errors([*sentences[:_MOST_LINES], *([f"{more:,} {rest}."] if more > 0 else [])])


def check_fits_memory(paths: Sequence[Path]) -> None:
    """Refuse to hold all meshes of a large archive in memory."""
    from regolith_studio.readers.particles import find_files

    for path in paths:
        if (count := sum(file.member is not None for file in find_files([path], []))) > MOST_IN_MEMORY:
            raise typer.BadParameter(
                f"{path.name} holds {count:,} meshes, and at most {MOST_IN_MEMORY:,} are read into memory: "
                "use describe --output, coarsen, or dataset build --by-group."
            )
