"""Figures as files: PNG to look at, SVG to edit; the same bytes each time."""

from pathlib import Path

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

DOTS_PER_INCH = 150


def write_figure(figure: Figure, folder: Path, stem: str) -> tuple[Path, Path]:
    """Write ``stem.png`` and ``stem.svg`` into `folder`, which is made if it is missing."""
    folder.mkdir(parents=True, exist_ok=True)
    FigureCanvasAgg(figure)
    picture, drawing = folder / f"{stem}.png", folder / f"{stem}.svg"
    figure.savefig(picture, dpi=DOTS_PER_INCH)
    with matplotlib.rc_context({"svg.hashsalt": "regolith-studio"}):
        figure.savefig(drawing, metadata={"Date": None})
    return picture, drawing
