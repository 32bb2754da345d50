"""Draws docs/images/repose_*.png from the runs that docs/repose.md lists.

Usage: python docs/repose_figures.py FOLDER, where FOLDER holds the studies friction, faces, shapes, ...
"""

import sys
from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from regolith_studio.dem.angle_of_repose import measure_repose
from regolith_studio.dem.run_io import RunSummary, find_runs
from regolith_studio.dem.snapshot import read_particle_state
from regolith_studio.studies.figures.repose import section_figure

IMAGES = Path(__file__).parent / "images"
FACES = {"sample8": 8.0, "sample20": 20.0, "sample60": 60.0}


def main(folder: Path) -> None:
    """Write both pictures."""
    friction = find_runs(folder / "friction")
    usual = [run for run in friction if run.document["case"]["contact"]["static_friction"] == 0.8]
    faces = [*find_runs(folder / "faces"), *usual]
    figure = Figure(figsize=(8.4, 3.2), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    _draw(left, [(run.document["case"]["contact"]["static_friction"], run) for run in friction])
    left.set_xlabel("static friction")
    left.set_ylabel("angle of repose (°)")
    _draw(right, [(FACES[run.document["dataset"]["name"]], run) for run in faces])
    right.set_xscale("log")
    right.set_xticks(list(FACES.values()), [f"{value:g}" for value in FACES.values()])
    right.xaxis.set_minor_locator(NullLocator())
    right.set_xlabel("facets a particle")
    _save(figure, "repose_trends.png")
    pile = read_particle_state(usual[0].folder / "final.npz")
    measured = measure_repose(pile.points, pile.diameters)
    _save(section_figure(pile.points, pile.diameters, measured), "repose_sections.png")


def _draw(axis: object, runs: list[tuple[float, RunSummary]]) -> None:
    for value, run in runs:
        if run.angle is None:
            continue
        low, high = run.document["measurement"]["interval_deg"]
        reach = [[run.angle - low], [high - run.angle]]
        axis.errorbar(value, run.angle, yerr=reach, fmt="o", color="#0072b2", capsize=3)
    axis.grid(True, alpha=0.3)


def _save(figure: Figure, name: str) -> None:
    FigureCanvasAgg(figure)
    figure.savefig(IMAGES / name, dpi=110)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
