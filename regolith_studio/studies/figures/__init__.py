"""Figures of studies, drawn by matplotlib and written as PNG and SVG, the same bytes each time."""

import re
from io import BytesIO
from pathlib import Path
from threading import RLock

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

DOTS_PER_INCH = 150


def write_figure(figure: Figure, folder: Path, stem: str) -> tuple[Path, Path]:
    """Write ``stem.png`` and ``stem.svg`` into `folder`, which is made if it is missing."""
    folder.mkdir(parents=True, exist_ok=True)
    FigureCanvasAgg(figure)
    picture, drawing = folder / f"{stem}.png", folder / f"{stem}.svg"
    with MATPLOTLIB_LOCK:
        figure.savefig(picture, dpi=DOTS_PER_INCH)
        # Identifiers are random and the date is that of the day otherwise.
        with matplotlib.rc_context({"svg.hashsalt": "regolith-studio"}):
            figure.savefig(drawing, metadata={"Date": None})
    return picture, drawing


def png_of(figure: Figure) -> bytes:
    """The figure as it is shown in a window."""
    FigureCanvasAgg(figure)
    stream = BytesIO()
    with MATPLOTLIB_LOCK:
        figure.savefig(stream, dpi=DOTS_PER_INCH)
    return stream.getvalue()


def as_written(name: str) -> str:
    """A name as matplotlib shows it as it is: between two dollars it would set mathematics."""
    return name.replace("$", r"\$")


def with_subscript(symbol: str) -> str:
    """A symbol such as ``D_min`` as matplotlib sets it, with a real subscript."""
    return re.sub(r"_(\w+)", r"$_\\mathrm{\1}$", symbol)


# Four threads that set formulas and save figures at a time ended the process by a damaged heap.
MATPLOTLIB_LOCK = RLock()
