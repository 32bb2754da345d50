"""Figures and formulas of several threads: a process of its own, because what is tested for would end it."""

import subprocess
import sys

import pytest

SCRIPT = r"""
import hashlib, sys, tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from matplotlib import mathtext
from matplotlib.figure import Figure
from regolith_studio.studies.figures import write_figure
from regolith_studio.ui.widgets import formula

sys.setswitchinterval(5e-4)

def figure(number):
    made = Figure(figsize=(2, 1.5))
    axes = made.add_subplot()
    axes.set_xlabel(rf"$D_{{\min}}^{{{number}}}$")
    axes.set_ylabel(rf"$\frac{{a_{{{number}}}}}{{b}}$")
    return made

def work(number):
    if number % 3:
        with tempfile.TemporaryDirectory() as folder:
            paths = write_figure(figure(number), Path(folder), "one")
            return hashlib.sha256(b"".join(path.read_bytes() for path in paths)).hexdigest()
    formula._outlines.clear()
    mathtext.MathTextParser._parse_cached.cache_clear()
    lines = [rf"$\sqrt{{A_{{{number + k}}}}} = \sum_{{m}} c_{{{k} m}}^{{2}}$" for k in range(4)]
    return [round(formula.outline(line).length(), 6) for line in lines]

alone = [work(number) for number in range(12)]
with ThreadPoolExecutor(4) as pool:
    together = list(pool.map(work, [*range(12)] * 4))
assert together == alone * 4, "two threads got each other's letters"
"""


@pytest.mark.slow
def test_that_threads_that_draw_at_once_get_what_each_gets_alone() -> None:
    ran = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
