"""Draws the pictures of the guide that no window shows: of a run, and of a report.

Usage: python docs/repose_figures.py RUN [REPORT.html]

The report is photographed by Chromium, which has to be on the path.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyvista as pv
from matplotlib.backends.backend_agg import FigureCanvasAgg
from PIL import Image

from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.angle_of_repose import measure_repose
from regolith_studio.dem.run_io import FINAL, SNAPSHOTS, read_shapes
from regolith_studio.dem.snapshot import ParticleState, read_particle_state
from regolith_studio.scene import annotations, cameras, instancing, palette, plotter_setup
from regolith_studio.scene.cameras import Direction
from regolith_studio.studies.figures.repose import section_figure

IMAGES = Path(__file__).parent / "images"
VIEW = (400, 640)
"""Width and height of each moment of the heap in pixels."""
LOW_SIDE = Direction("", (0.35, -1.0, 0.3), (0.0, 0.0, 1.0))
PAGE_SIZE = (1120, 1250)
"""Of the photographed figure of the report, in pixels."""


def draw_sections(run: Path) -> None:
    """Both sections of the heap with their fits."""
    pile = read_particle_state(run / FINAL)
    figure = section_figure(pile.points, pile.diameters, measure_repose(pile.points, pile.diameters))
    FigureCanvasAgg(figure)
    figure.savefig(IMAGES / "repose_sections.png", dpi=110)


def moments(run: Path) -> dict[str, ParticleState]:
    """The filled cylinder, the cylinder half way up, and the heap, by title."""
    states = [read_particle_state(path) for path in sorted((run / SNAPSHOTS).glob("*.npz"))]
    lifted = [state for state in states if state.phase == "lift"]
    settled = [state for state in states if state.phase in ("fill", "settle")]
    return {
        "filled": settled[-1],
        "lifted": lifted[len(lifted) // 2],
        "at rest": read_particle_state(run / FINAL),
    }


def draw_moments(run: Path) -> None:
    """The three moments side by side, under one camera."""
    plotter_setup.choose_off_screen_window()
    shown, shapes, test = moments(run), read_shapes(run), LiftingCylinderTest()
    final = shown["at rest"]
    reach = 1.15 * float(np.percentile(np.hypot(final.points[:, 0], final.points[:, 1]), 98))
    top = test.height + shown["lifted"].wall
    corners = instancing.box_corners(reach / np.sqrt(2), top)
    pose = cameras.filled(
        cameras.framing_pose(corners, LOW_SIDE, VIEW[0] / VIEW[1]), corners, VIEW[0] / VIEW[1]
    )
    plotter = pv.Plotter(off_screen=True, shape=(1, 3), window_size=[3 * VIEW[0], VIEW[1]], border=False)
    for column, (title, state) in enumerate(shown.items()):
        plotter.subplot(0, column)
        plotter_setup.set_stage(plotter, palette.PAPER)
        instancing.show_heap(plotter, shapes, state)
        instancing.show_apparatus(plotter, state, test.diameter, test.height, reach, palette.PAPER)
        annotations.show_title(plotter, f"{title}, {state.time:.1f} s")
        cameras.apply_pose(plotter, pose)
    plotter.screenshot(IMAGES / "repose_heap.png")
    plotter.close()


def photograph(page: Path) -> None:
    """Fig. 7 in a report, as Chromium shows it."""
    html = page.read_text(encoding="utf-8")
    head, rest = html.split('<h2 id="section-0"', 1)
    figure = re.search(r'<h2 id="section-4".*?(?=<h2 id="section-5")', rest, re.DOTALL)
    if figure is None:
        sys.exit(f"{page} has no Fig. 7")
    style, script = head.split("<h1>", 1)[0], rest[rest.rindex("<script>") :]
    with tempfile.TemporaryDirectory() as folder:
        shown, picture = Path(folder) / "figure.html", Path(folder) / "figure.png"
        shown.write_text(style + figure[0] + script, encoding="utf-8")
        options = ["--headless", "--no-sandbox", "--hide-scrollbars", "--virtual-time-budget=8000"]
        options += [f"--window-size={PAGE_SIZE[0]},{PAGE_SIZE[1]}", f"--screenshot={picture}"]
        subprocess.run(["chromium", *options, shown.as_uri()], check=True, capture_output=True)
        with Image.open(picture) as taken:
            taken.convert("RGB").quantize(256).save(IMAGES / "report_page.png", optimize=True)


if __name__ == "__main__":
    draw_sections(Path(sys.argv[1]))
    draw_moments(Path(sys.argv[1]))
    for page in sys.argv[2:]:
        photograph(Path(page))
