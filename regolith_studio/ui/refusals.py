"""What the window says of files that were left out when others could be read."""

from collections.abc import Sequence

from regolith_studio.readers.particles import FileProblem
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.widgets.toast import Toast


def report_refusals(toast: Toast, problems: Sequence[FileProblem]) -> None:
    """One sentence on the screen: the only one, or the first and how many more there are; all on demand."""
    first = translate(problems[0].sentence)
    if len(problems) == 1:
        toast.problem(first, problems[0].with_path)
        return
    toast.problem(
        tr("{count} were left out. The first: {sentence}", count=len(problems), sentence=first),
        "\n".join(problem.with_path for problem in problems),
    )
