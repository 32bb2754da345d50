"""Angles of repose in a few lines for a person."""

from typing import Any


def in_words(document: dict[str, Any]) -> str:
    """A measurement."""
    paper = document["paper_sections"]
    low, high = document["interval_deg"]
    lines = [
        f"angle of repose      {document['angle_deg']:.1f} deg ({low:.1f} to {high:.1f}, "
        f"{100 * document['settings']['confidence']:g} % interval, {len(document['sections'])} sections)"
    ]
    for section in document["sections"][:2]:
        two = section["asymmetric"]
        lines.append(
            f"section {section['plane']}          left {two['left_deg']:.1f}  right {two['right_deg']:.1f}  "
            f"symmetric {section['symmetric']['angle_deg']:.1f}"
        )
    lines.append(
        f"these two sections   asymmetric {paper['asymmetric']['mean_deg']:.1f}  "
        f"symmetric {paper['symmetric']['mean_deg']:.1f}"
    )
    return "\n".join(lines)


def run_remarks(document: dict[str, Any]) -> list[str]:
    """Sentences about a run that its user should read."""
    return [
        *document["particles"]["sentences"],
        *document["run"]["notes"],
        *document["checks"]["problems"],
    ]


def run_in_words(document: dict[str, Any]) -> str:
    """The result of a run."""
    checks, measurement = document["checks"], document["measurement"]
    lines = [
        in_words(measurement) if measurement["status"] == "pile" else measurement["reason"],
        f"filled to            {100 * checks['fill_height']:.2f} cm, packed {checks['solid_fraction']:.2f}",
        f"particles            {checks['particles_out']} of {checks['particles_in']}",
        f"overlap at rest      {100 * checks['max_overlap']:.2f} % of the mean diameter at most",
        f"energy gained        {checks['energy_gain']:.1e} m g d a particle",
        f"time                 {document['run']['seconds']:.0f} s",
    ]
    return "\n".join(lines)
