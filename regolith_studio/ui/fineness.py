"""How fine polyhedra shall be, in words."""

from regolith_studio.session.choices import Choices
from regolith_studio.ui.translation import tr


def fineness_words(choices: Choices) -> str:
    """What each polyhedron will have, to be put behind a heading."""
    if choices.stop_at == "error":
        limit = f"{100 * choices.largest_error:g}"
        return tr("the fewest facets with all errors below {limit} %", limit=limit)
    faces = choices.facet_count
    return tr("at most {faces} facets, {triangles} triangles", faces=faces, triangles=4 * faces - 12)
