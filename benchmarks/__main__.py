"""Every heavy step against a plain program, in one run: ``python -m benchmarks -o FOLDER``.

Prints a table and writes ``benchmarks.json`` and two figures. The two sides of each row work in turns, so
that what else the machine does hits both; a ratio is taken in each round. ``--only WORD`` limits the rows
to steps that contain the word; ``--rounds`` says how often each is done.
"""

import argparse
import sys
import tempfile
import warnings
from pathlib import Path

from benchmarks.contests import Growth, Outcome, growth_table, held, table, write
from benchmarks.steps import contests, growths


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=Path("benchmark-results"), metavar="FOLDER")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--only", default="", metavar="WORD")
    parser.add_argument("--no-growth", action="store_true")
    options = parser.parse_args()
    warnings.simplefilter("ignore")  # the plain programs are full of them
    outcomes: list[Outcome] = []
    curves: list[Growth] = []
    with tempfile.TemporaryDirectory() as place:
        for contest in contests(Path(place), options.only):
            print(f"{contest.step}: {contest.title}", file=sys.stderr, flush=True)
            outcomes.append(held(contest, options.rounds))
        print(table(outcomes), flush=True)
        if not options.no_growth:
            for curve in growths(Path(place), max(1, options.rounds // 2)):
                print(f"{curve.title} against {curve.size}", file=sys.stderr, flush=True)
                curves.append(curve)
            print(growth_table(curves))
    for path in write(options.output, outcomes, curves, options.rounds):
        print(path)


if __name__ == "__main__":
    main()
