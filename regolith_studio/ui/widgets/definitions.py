"""What the symbols of descriptors and of the loss mean, as tool tips."""

from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.messages import N_
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import plain_symbol

EQUATIONS = {"sphericity": 1, "aspect_ratio": 2, JACCARD: 7}
"""Numbers in the paper, by key."""
DEFINITIONS = {
    "volume": N_("volume that the surface encloses"),
    "surface_area": N_("area of the surface"),
    "convex_hull_volume": N_("volume of the convex hull"),
    JACCARD: N_("1 − volume of the intersection / volume of the union"),
}
"""In place of a formula that only repeats the symbol."""


def definition(key: str) -> str:
    """Symbol, name, definition and equation of a descriptor or of the Jaccard distance."""
    symbol = "J" if key == JACCARD else plain_symbol(CATALOGUE[key].symbol)
    name = tr("Jaccard distance") if key == JACCARD else tr(CATALOGUE[key].label)
    formula = tr(DEFINITIONS[key]) if key in DEFINITIONS else tr(CATALOGUE[key].formula)
    words = tr("{symbol}, {name}: {formula}", symbol=symbol, name=name, formula=plain_symbol(formula))
    return tr("{words} (Eq. {number})", words=words, number=EQUATIONS[key]) if key in EQUATIONS else words
