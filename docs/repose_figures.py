"""Draws docs/images/repose_sections.png from a run.

Usage: python docs/repose_figures.py RUN
"""

import sys
from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg

from regolith_studio.dem.angle_of_repose import measure_repose
from regolith_studio.dem.run_io import FINAL
from regolith_studio.dem.snapshot import read_particle_state
from regolith_studio.studies.figures.repose import section_figure

PICTURE = Path(__file__).parent / "images" / "repose_sections.png"


def main(run: Path) -> None:
    """Write the picture."""
    pile = read_particle_state(run / FINAL)
    figure = section_figure(pile.points, pile.diameters, measure_repose(pile.points, pile.diameters))
    FigureCanvasAgg(figure)
    figure.savefig(PICTURE, dpi=110)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
