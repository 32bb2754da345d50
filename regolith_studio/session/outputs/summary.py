"""The one-page summary: what was done with which numbers, in tables and pictures, as HTML."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

from regolith_studio.dataset.build import software_versions
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.descriptors.comparison import rmsre
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.coarsening import CoarsenedParticle
from regolith_studio.jobs.examining import Examined
from regolith_studio.session.outputs.staging import write_bytes
from regolith_studio.session.outputs.studies import STUDIES
from regolith_studio.session.recipe import Recipe

_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto;
  padding: 0 1rem; color: #222 }
table { border-collapse: collapse; margin: 0.5rem 0 1.5rem; font-variant-numeric: tabular-nums }
th, td { border-bottom: 1px solid #ddd; padding: 0.2rem 0.7rem; text-align: right }
th:first-child, td:first-child { text-align: left }
img { max-width: 100% } figure { margin: 1rem 0 2rem } figcaption { color: #555 }
"""
_SHOWN = ("equivalent_radius", "surface_area", "sphericity", "min_diameter", "max_diameter", "aspect_ratio")
_LENGTH = {0: "", 1: "µm", 2: "µm²", 3: "µm³"}


@dataclass(frozen=True)
class SummaryFacts:
    """Everything that the page tells.

    Parameters
    ----------
    studies
        Kinds of the studies that have been written.
    problems
        One sentence for each file or particle that failed.
    pictures
        (file, caption) pairs, files relative to the page.
    """

    title: str
    recipe: Recipe
    particles: Sequence[Particle] = ()
    facts: Sequence[Examined] = ()
    outcomes: Sequence[CoarsenedParticle] = ()
    studies: Sequence[str] = ()
    problems: Sequence[str] = ()
    pictures: Sequence[tuple[str, str]] = ()


def write_summary(folder: Path, facts: SummaryFacts) -> Path:
    """Write ``summary.html``; returns its path."""
    path = folder / "summary.html"
    write_bytes(path, summary_page(facts).encode("utf-8"))
    return path


def summary_page(facts: SummaryFacts) -> str:
    """The page; pictures stand in it by their relative paths."""
    parts = [
        f"<h1>{escape(facts.title)}</h1>",
        _lead(facts),
        *[_figure(file, caption) for file, caption in facts.pictures],
        _fidelity(facts.outcomes),
        *map(_study, facts.studies),
        _particles(facts),
        _problems(facts.problems),
        _provenance(facts.recipe),
    ]
    head = f'<meta charset="utf-8"><title>{escape(facts.title)}</title><style>{_STYLE}</style>'
    return (
        f'<!doctype html>\n<html lang="en"><head>{head}</head><body>\n{chr(10).join(parts)}\n</body></html>\n'
    )


def _lead(facts: SummaryFacts) -> str:
    good = [each for each in facts.outcomes if each.coarsened]
    recipe = facts.recipe
    target = f"surface at l_max = {recipe.l_max}" if recipe.target == "fit" else "measured surface"
    return (
        f"<p>{len(facts.particles)} particles; {len(good)} convex polyhedra of {recipe.n_faces} faces "
        f"(method {escape(recipe.method)}, weights {escape(_weights(recipe))}, seed {recipe.seed}) that "
        f"imitate the {target}. Lengths are in micrometres.</p>"
    )


def _weights(recipe: Recipe) -> str:
    if recipe.weights is None:
        return recipe.preset
    return ", ".join(f"{key} {value:g}" for key, value in recipe.weights.items() if value)


def _figure(file: str, caption: str) -> str:
    return (
        f'<figure><img src="{escape(file)}" alt="{escape(caption)}">'
        f"<figcaption>{escape(caption)}</figcaption></figure>"
    )


def _fidelity(outcomes: Sequence[CoarsenedParticle]) -> str:
    """Relative errors of each polyhedron (Eq. 8), and their root mean square (Eq. 10)."""
    good = [(each, each.coarsened) for each in outcomes if each.coarsened]
    if not good:
        return ""
    header = [
        "particle",
        "faces",
        "vertices",
        "triangles",
        *[CATALOGUE[key].symbol for key in LOSS_KEYS],
        "J",
    ]
    rows = [
        [
            each.name,
            str(coarse.n_faces),
            str(coarse.n_vertices),
            str(coarse.n_triangles),
            *[f"{coarse.errors[key]:.2%}" for key in LOSS_KEYS],
            f"{coarse.jaccard_distance:.3f}",
        ]
        for each, coarse in good
    ]
    sample = rmsre([coarse.target for _, coarse in good], [coarse.achieved for _, coarse in good])
    rows.append(["RMSRE (Eq. 10)", "", "", "", *[f"{sample[key]:.2%}" for key in LOSS_KEYS], ""])
    note = (
        "<p>Relative errors against the imitated surface (Eq. 8); J is the Jaccard distance (paper: IoU).</p>"
    )
    return "<h2>How well the polyhedra keep the shape</h2>" + note + _table(header, rows)


def _study(kind: str) -> str:
    title, picture = STUDIES[kind].title, STUDIES[kind].picture
    return f"<h2>{escape(title)}</h2>{_figure(f'studies/{picture}', title)}"


def _particles(facts: SummaryFacts) -> str:
    if not facts.facts:
        return ""
    header = ["particle", "group"]
    header += [f"{CATALOGUE[key].symbol} {_LENGTH[CATALOGUE[key].dimension]}".strip() for key in _SHOWN]
    header.append("sound")
    rows = [
        [
            particle.name,
            particle.group,
            *[f"{each.descriptors[key]:.4g}" if each.descriptors else "" for key in _SHOWN],
            "yes" if each.health.sound else " ".join(each.health.problems) or "no",
        ]
        for particle, each in zip(facts.particles, facts.facts, strict=True)
    ]
    return "<h2>The particles as measured</h2>" + _table(header, rows)


def _problems(problems: Sequence[str]) -> str:
    if not problems:
        return ""
    items = "".join(f"<li>{escape(sentence)}</li>" for sentence in problems)
    return f"<h2>What could not be done</h2><ul>{items}</ul>"


def _provenance(recipe: Recipe) -> str:
    versions = ", ".join(f"{name} {version}" for name, version in software_versions().items())
    inputs = ", ".join(recipe.inputs)
    return (
        f"<h2>How to repeat it</h2><p><code>regolith-studio run recipe.json -o FOLDER</code> with the "
        f"recipe beside this page. Inputs: {escape(inputs)}. Software: {escape(versions)}.</p>"
    )


def _table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    head = "".join(f"<th>{escape(cell)}</th>" for cell in header)
    body = "\n".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>\n{body}\n</tbody></table>"
