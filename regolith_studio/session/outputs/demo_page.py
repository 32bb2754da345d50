"""The page of the demo: the chain step by step, with pictures, links, and what cannot be met."""

import csv
import json
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any

from regolith_studio.coarsening.lower_bounds import max_sphericity
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.session.outputs.summary import html_figure, html_page, html_table
from regolith_studio.studies.lmax import BOX_NOTE

PAGE = "index.html"
PARTICLES, SCAN, POPULATION, HEAP = "particles", "scan", "population", "heap"
"""Folders of the steps."""
VIEWS, HEAP_PICTURE = "three-views.png", "heap.png"
TITLE = "Regolith Studio: from a scan to a heap"


def demo_page(folder: Path, problems: Sequence[str]) -> str:
    """The page about what a folder holds; links and pictures by their relative paths.

    Parameters
    ----------
    folder
        Where the steps have written to. A step that left nothing has no section.
    problems
        One sentence for each step or particle that failed.
    """
    sections = (_scan, _fits, _polyhedra, _population, _dataset, _heap)
    parts = [f"<h1>{TITLE}</h1>", _LEAD, *(section(folder) for section in sections)]
    if problems:
        items = "".join(f"<li>{escape(sentence)}</li>" for sentence in problems)
        parts.append(f"<h2>What could not be done</h2><ul>{items}</ul>")
    return html_page(TITLE, parts)


_LEAD = (
    "<p>Every step of the program on what ships with it: a synthetic scan of about 60 grains, and twelve "
    "synthetic particles. Nothing here was measured on a material. Lengths are in micrometres.</p>"
)


def _scan(folder: Path) -> str:
    document = _json(folder / SCAN / "volumes" / "sample-grey.json")
    if document is None:
        return ""
    size = " x ".join(map(str, document["volume"]["shape_xyz"]))
    return (
        f"<h2>1. From the scan to grains</h2><p>The scan of {size} voxels holds "
        f"{document['segmented']['n_grains']} grains; {document['n_particles']} of them are whole, the "
        f"others are cut by its border. {_link(SCAN, 'descriptors.csv', 'Their descriptors')}, "
        f"{_link(SCAN, 'volumes/sample-grey.json', 'all settings')}.</p>"
    )


def _fits(folder: Path) -> str:
    grains = _link(SCAN, "fit.json", "of the grains")
    particles = _link(PARTICLES, "fit.json", "of the particles")
    return (
        f"<h2>2. Spherical harmonics</h2><p>The fits up to l_max = 30 {grains} and {particles}. "
        "The errors of the descriptors against l_max for the particles (Fig. 3):</p>"
        + _picture(folder, f"{PARTICLES}/studies/lmax_rmsre.png", f"Errors against l_max. {BOX_NOTE}")
    )


def _polyhedra(folder: Path) -> str:
    document = _json(folder / PARTICLES / "meshes" / "coarsening.json")
    if document is None:
        return ""
    made = document["particles"]
    table = _link(PARTICLES, "summary.html", "errors of each, and Fig. 8")
    parts = [
        f"<h2>3. Convex polyhedra</h2><p>{len(made)} particles with {made[0]['n_facets_asked']} facets each: "
        f"{table}, {_link(PARTICLES, 'meshes', 'meshes')}.</p>",
        _picture(folder, f"{PARTICLES}/{VIEWS}", "A particle, its fit and its polyhedron"),
    ]
    if missed := [each for each in made if each["reason"]]:
        bounds = ", ".join(f"{max_sphericity(n):.3f} with {n}" for n in (12, 20, 50, 100))
        rows = [[each["name"], each["reason"]] for each in missed]
        parts.append(
            "<h3>What cannot be met</h3><p>A polyhedron with few facets cannot be as round as a bead. "
            "Goldberg (1935) gave the bound for the sphericity of a convex polyhedron by its number of "
            f"facets: {bounds}. The beads are above it, so that no method keeps their sphericity: more "
            f"facets help, other weights do not.</p>{html_table(['particle', 'reason'], rows)}"
        )
    return "".join(parts)


def _population(folder: Path) -> str:
    document = _json(folder / POPULATION / "generation.json")
    if document is None:
        return ""
    return (
        f"<h2>4. Virtual particles</h2><p>{document['n_particles']} particles with the shapes and sizes of "
        f"the grains, drawn by the model {escape(document['model'])}: "
        f"{_link(POPULATION, 'particles.csv', 'descriptors')}, {_link(POPULATION, '', 'meshes')}.</p>"
    )


def _dataset(folder: Path) -> str:
    place = folder / SCAN / "dataset"
    if not place.is_dir():
        return ""
    with (folder / SCAN / "descriptors.csv").open(encoding="utf-8", newline="") as table:
        n_grains = len(list(csv.reader(table))) - 1
    exports = sorted(path.name for path in (folder / SCAN / "exports").glob("*"))
    links = [_link(SCAN, f"exports/{key}", f"export for {EXPORTERS[key].label}") for key in exports]
    return (
        f"<h2>5. Dataset and export</h2><p>{len(list((place / 'meshes').iterdir()))} polyhedra represent the "
        f"{n_grains} grains, each with its weight and sizes: "
        f"{', '.join([_link(SCAN, 'dataset/dataset.json', 'dataset'), *links])}.</p>"
    )


def _heap(folder: Path) -> str:
    document = _json(folder / HEAP / "repose.json")
    if document is None:
        return ""
    measured, n = document["measurement"], document["case"]["n_particles"]
    if measured["angle_deg"] is None:
        result = escape(measured["reason"])
    else:
        low, high = measured["interval_deg"]
        two = measured["paper_sections"]["asymmetric"]["mean_deg"]
        result = (
            f"Its evaluation: {measured['angle_deg']:.1f} degrees, between {low:.1f} and {high:.1f}, of "
            f"{len(measured['sections'])} sections; {two:.1f} of the two of Fig. 9."
        )
    return (
        f"<h2>6. A heap</h2><p><strong>This is an illustration.</strong> {n} particles, enlarged "
        f"{document['particles']['coarse_graining']:.0f} times and simulated with long time steps, make a "
        "heap a few particles high: its angle says nothing about the material. Take 10,000 and more, and "
        f"several seeds. {result} {_link(HEAP, 'repose.json', 'The run')}.</p>"
        + _picture(folder, f"{HEAP}/{HEAP_PICTURE}", f"Illustration: a heap of {n} particles")
        + _picture(folder, f"{HEAP}/sections.png", f"Its sections (Fig. 9): an illustration, {n} particles")
    )


def _json(path: Path) -> dict[str, Any] | None:
    if not path.is_file():
        return None
    document: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return document


def _link(step: str, file: str, text: str) -> str:
    return f'<a href="{escape(f"{step}/{file}")}">{escape(text)}</a>'


def _picture(folder: Path, file: str, caption: str) -> str:
    return html_figure(file, caption) if (folder / file).is_file() else ""
