"""What a recipe says of its dataset: which particles stand for all, their sizes, the formats it goes to."""

from dataclasses import dataclass
from typing import Literal

from pydantic import Field

from regolith_studio.session.recipe_inputs import Strict


class Representatives(Strict):
    """As ``regolith-studio dataset build`` takes them.

    Parameters
    ----------
    count
        Particles that stand for all; with 0 each stands for itself.
    weighting
        What they count: ``number`` or ``volume``.
    size_importance
        How much a standard deviation of ln d counts in their choice against one of a shape feature.
    seed
        Of the choice among very many particles; that of the recipe where left out.
    sizes
        Size distributions of the classes, such as ``measured`` or ``classes:25,37,56``.
    name
        Of the dataset; that of the folder of the results where left out.
    """

    count: int = Field(default=10, ge=0)
    weighting: Literal["number", "volume"] = "number"
    size_importance: float = Field(default=0.0, ge=0.0)
    seed: int | None = Field(default=None, ge=0, lt=2**63)
    sizes: str = "measured"
    name: str = ""


class Exports(Strict):
    """As ``regolith-studio dataset export`` takes them.

    Parameters
    ----------
    targets
        Keys of the formats, or ``all``.
    coarse_graining
        By which all diameters are enlarged.
    particles
        Bodies in formats that list single ones.
    seed
        Of their draw; that of the recipe where left out.
    settings
        Of contact, cylinder, times or formats, by their names, in SI units.
    lossy
        Whether formats that change the shapes are allowed.
    """

    targets: list[str] = Field(min_length=1)
    coarse_graining: float = 10.0
    particles: int = 200
    seed: int | None = Field(default=None, ge=0, lt=2**63)
    settings: dict[str, int | float] = Field(default_factory=dict)
    lossy: bool = False


@dataclass(frozen=True)
class Standing:
    """What the page of the dataset has chosen."""

    representatives: Representatives | None = None
    exports: Exports | None = None
