"""Pages of a run as HTML, with tables and pictures: the summary of a recipe, and the chain of the demo."""

import csv
import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from pathlib import Path
from typing import Any

from regolith_studio.coarsening.lower_bounds import max_sphericity
from regolith_studio.dataset.build import software_versions
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.checkpoint import CheckpointRecord
from regolith_studio.session.outputs.studies import STUDIES
from regolith_studio.session.recipe import Recipe
from regolith_studio.studies.lmax import BOX_NOTE

TITLE = "Regolith Studio: from particles to a dataset"
_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto;
  padding: 0 1rem; color: #222 }
table { border-collapse: collapse; margin: 0.5rem 0 1.5rem; font-variant-numeric: tabular-nums }
th, td { border-bottom: 1px solid #ddd; padding: 0.2rem 0.7rem; text-align: right }
th:first-child, td:first-child, .text { text-align: left }
img { max-width: 100% } figure { margin: 1rem 0 2rem } figcaption { color: #555 }
@media print {
  body { margin: 0 } .screen { display: none }
  table { font-size: 65% } th, td { padding: 0.1rem 0.3rem }
  h1, h2, h3 { break-after: avoid } h2 + p, h3 + p { break-after: avoid }
  figure, tr { break-inside: avoid } thead { display: table-header-group }
  img { max-height: 22cm }
}
"""
_SHOWN = ("equivalent_radius", "surface_area", "sphericity", "min_diameter", "max_diameter", "aspect_ratio")


SHOWN_ROWS = 200
"""Rows of a table and sentences of a list that the page shows; the files beside it hold all."""


@dataclass
class Summary:
    """Content of the page, collected particle by particle; only the first of many are kept.

    - ``n_particles``, ``n_coarse``: particles, and those of them that could be coarsened.
    - ``described``, ``coarse``: what ``descriptors.json`` and ``coarsening.json`` say of the first of them.
    - ``pictures``: (file, caption) pairs besides those of the studies, files relative to the page.
    """

    n_particles: int = 0
    n_coarse: int = 0
    described: list[Mapping[str, Any]] = field(default_factory=list)
    coarse: list[Mapping[str, Any]] = field(default_factory=list)
    pictures: Sequence[tuple[str, str]] = ()
    _squares: dict[str, float] = field(default_factory=dict)

    def add(self, record: CheckpointRecord) -> None:
        """Take one more particle."""
        self.n_particles += 1
        for key, kept in (("described", self.described), ("coarse", self.coarse)):
            if key in record.values and len(kept) < SHOWN_ROWS:
                kept.append(record.values[key])
        if coarse := record.values.get("coarse"):
            self.n_coarse += 1
            for key in LOSS_KEYS:
                self._squares[key] = self._squares.get(key, 0.0) + coarse["errors"][key] ** 2

    @property
    def rmsre(self) -> dict[str, float]:
        """Root mean square of the relative errors over all polyhedra, Eq. 10."""
        return {key: math.sqrt(total / self.n_coarse) for key, total in self._squares.items()}


def write_summary(
    folder: Path, recipe: Recipe, summary: Summary, studies: Sequence[str], problems: Sequence[str]
) -> Path:
    """Write ``summary.html``; returns its path.

    ``studies``: kinds of the studies that have been written. ``problems``: one sentence for each file or
    particle that failed.
    """
    path = folder / "summary.html"
    write_bytes(path, summary_page(recipe, summary, studies, problems).encode("utf-8"))
    return path


def summary_page(recipe: Recipe, summary: Summary, studies: Sequence[str], problems: Sequence[str]) -> str:
    """The page; pictures stand in it by their relative paths."""
    parts = [
        f"<h1>{TITLE}</h1>",
        _lead(recipe, summary),
        *[html_figure(file, caption) for file, caption in summary.pictures],
        _fidelity(summary),
        *map(_study, studies),
        _particles(summary),
        _problems(problems),
        _provenance(recipe),
    ]
    return html_page(TITLE, parts)


def html_page(title: str, parts: Sequence[str]) -> str:
    """A page of its own with the style of all pages."""
    head = f'<meta charset="utf-8"><title>{escape(title)}</title><style>{_STYLE}</style>'
    return (
        f'<!doctype html>\n<html lang="en"><head>{head}</head><body>\n{chr(10).join(parts)}\n</body></html>\n'
    )


def _lead(recipe: Recipe, summary: Summary) -> str:
    target = f"surface at l_max = {recipe.l_max}" if recipe.target == "fit" else "particle itself"
    criterion = recipe.choices().coarsening_request.stopping_criterion
    return (
        f"<p>{summary.n_particles:,} particles; {summary.n_coarse:,} convex polyhedra "
        f"with {criterion} (method {escape(recipe.method)}, weights {escape(_weights(recipe))}, "
        f"seed {recipe.seed}) that imitate the {target}. Lengths are in micrometres.{_synthetic(recipe)}</p>"
    )


def _synthetic(recipe: Recipe) -> str:
    """What ships with the program looks measured and is not."""
    names = [*recipe.named_inputs, *(volume.file for volume in recipe.volumes)]
    shipped = [name for name in names if name.startswith("sample:")]
    if not shipped:
        return ""
    return f" Synthetic, not measured on a material: {escape(', '.join(shipped))}."


def _weights(recipe: Recipe) -> str:
    if recipe.weights is None:
        return str(recipe.preset)
    return ", ".join(f"{key} {value:g}" for key, value in recipe.weights.items() if value)


def html_figure(file: str, caption: str) -> str:
    """A picture with its caption."""
    return (
        f'<figure><img src="{escape(file)}" alt="{escape(caption)}">'
        f"<figcaption>{escape(caption)}</figcaption></figure>"
    )


def _fidelity(summary: Summary) -> str:
    """Relative errors of each polyhedron (Eq. 8), and their root mean square (Eq. 10)."""
    if not summary.coarse:
        return ""
    symbols = [CATALOGUE[key].symbol for key in LOSS_KEYS]
    header = ["particle", "facets", "vertices", "triangles", *symbols, "J"]
    rows = [
        [
            each["name"],
            *[str(each[key]) for key in ("n_facets", "n_vertices", "n_triangles")],
            *[f"{each['errors'][key]:.2%}" for key in LOSS_KEYS],
            f"{each['jaccard_distance']:.3f}",
        ]
        for each in summary.coarse
    ]
    rows.append(["RMSRE (Eq. 10)", "", "", "", *[f"{summary.rmsre[key]:.2%}" for key in LOSS_KEYS], ""])
    note = (
        "<p>Relative errors against the imitated surface (Eq. 8); J is the Jaccard distance (paper: IoU)."
        f"{_more(summary.n_coarse, 'meshes/coarsening.json')}</p>"
    )
    return "<h2>How well the polyhedra keep the shape</h2>" + note + html_table(header, rows)


def _more(count: int, file: str) -> str:
    """Where the rest is, if not everything is shown."""
    if count <= SHOWN_ROWS:
        return ""
    return f" The first {SHOWN_ROWS} of {count:,} are shown; {file} holds all."


def _study(kind: str) -> str:
    title, picture = STUDIES[kind].title, STUDIES[kind].picture
    return f"<h2>{escape(title)}</h2>{html_figure(f'studies/{picture}', title)}"


def _particles(summary: Summary) -> str:
    if not summary.described:
        return ""
    header = ["particle", "group"]
    header += [f"{CATALOGUE[key].symbol} {CATALOGUE[key].unit_symbol}".strip() for key in _SHOWN]
    header.append("sound")
    rows = [
        [
            each["name"],
            each["group"],
            *[f"{each[key]:.4g}" if key in each else "" for key in _SHOWN],
            "yes" if each["health"]["sound"] else " ".join(each["health"]["problems"]) or "no",
        ]
        for each in summary.described
    ]
    note = _more(summary.n_particles, "descriptors.csv")
    return "<h2>The particles</h2>" + (f"<p>{note}</p>" if note else "") + html_table(header, rows)


def _problems(problems: Sequence[str]) -> str:
    if not problems:
        return ""
    items = "".join(f"<li>{escape(sentence)}</li>" for sentence in problems[:SHOWN_ROWS])
    if len(problems) > SHOWN_ROWS:
        items += f"<li>and {len(problems) - SHOWN_ROWS:,} more, in failed.csv.</li>"
    return f"<h2>What could not be done</h2><ul>{items}</ul>"


def _provenance(recipe: Recipe) -> str:
    versions = ", ".join(f"{name} {version}" for name, version in software_versions().items())
    inputs_named = [*recipe.named_inputs, *(f"the grains of {volume.file}" for volume in recipe.volumes)]
    if (population := recipe.population) is not None:
        inputs_named.append(f"{population.n:,} particles drawn like {', '.join(population.sources)}")
    inputs = ", ".join(inputs_named)
    return (
        f"<h2>How to repeat it</h2><p><code>regolith-studio run recipe.json -o FOLDER</code> with the "
        f"recipe beside this page. Inputs: {escape(inputs)}. Software: {escape(versions)}.</p>"
    )


_NUMBER = re.compile(r"[-+]?[\d.,]+(e[-+]?\d+)?%?")


def _is_text(cells: Sequence[str]) -> bool:
    """Whether most cells that hold something do not begin with a number."""
    words = [cell.split()[0] for cell in cells if cell.strip()]
    return 2 * sum(_NUMBER.fullmatch(word) is not None for word in words) < len(words)


def html_table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table; the first column, and others that are mostly no numbers, stand at the left."""
    columns = zip(*rows, strict=True) if rows else [()] * len(header)
    marks = [' class="text"' if _is_text(column) else "" for column in columns]
    head = "".join(f"<th{mark}>{escape(cell)}</th>" for mark, cell in zip(marks, header, strict=True))
    lines = [zip(marks, row, strict=True) for row in rows]
    cells = ["".join(f"<td{mark}>{escape(cell)}</td>" for mark, cell in line) for line in lines]
    body = "\n".join(f"<tr>{line}</tr>" for line in cells)
    return f"<table><thead><tr>{head}</tr></thead><tbody>\n{body}\n</tbody></table>"


DEMO_PAGE = "index.html"
PARTICLES, SCAN, POPULATION, HEAP = "particles", "scan", "population", "heap"
"""Folders of the steps."""
VIEWS, HEAP_PICTURE = "three-views.png", "heap.png"
DEMO_TITLE = "Regolith Studio: from a scan to a heap"


def demo_page(folder: Path, problems: Sequence[str]) -> str:
    """The page about what a folder holds; links and pictures by their relative paths.

    ``folder``: where the steps have written to. A step that left nothing has no section. ``problems``: one
    sentence for each step or particle that failed.
    """
    sections = (_scan, _fits, _polyhedra, _population, _dataset, _heap)
    parts = [f"<h1>{DEMO_TITLE}</h1>", _LEAD, *(section(folder) for section in sections)]
    return html_page(DEMO_TITLE, [*parts, _problems(problems)])


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
