"""The one-page summary of a run as HTML, with tables and pictures."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from pathlib import Path
from typing import Any

from regolith_studio.dataset.build import software_versions
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.checkpoint import CheckpointRecord
from regolith_studio.session.outputs.studies import STUDIES
from regolith_studio.session.recipe import Recipe

TITLE = "Regolith Studio: from particles to a dataset"
_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto;
  padding: 0 1rem; color: #222 }
table { border-collapse: collapse; margin: 0.5rem 0 1.5rem; font-variant-numeric: tabular-nums }
th, td { border-bottom: 1px solid #ddd; padding: 0.2rem 0.7rem; text-align: right }
th:first-child, td:first-child, .text { text-align: left }
img { max-width: 100% } figure { margin: 1rem 0 2rem } figcaption { color: #555 }
"""
_SHOWN = ("equivalent_radius", "surface_area", "sphericity", "min_diameter", "max_diameter", "aspect_ratio")


SHOWN_ROWS = 200
"""Rows of a table and sentences of a list that the page shows; the files beside it hold all."""


@dataclass
class Summary:
    """Content of the page, collected particle by particle; only the first of many are kept.

    Parameters
    ----------
    n_particles, n_coarse
        Particles, and those of them that could be coarsened.
    described, coarse
        What ``descriptors.json`` and ``coarsening.json`` say of the first of them.
    pictures
        (file, caption) pairs besides those of the studies, files relative to the page.
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

    Parameters
    ----------
    studies
        Kinds of the studies that have been written.
    problems
        One sentence for each file or particle that failed.
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
