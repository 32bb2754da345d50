"""Colours of the scene and of the plots: safe for colour-blind readers (Okabe and Ito, 2008)."""

from dataclasses import dataclass

PARTICLE = "#8d8a84"
FIT = "#0072b2"
POLYHEDRON = "#e69f00"

DESCRIPTOR_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8d8a84", "#b5a900")
"""One for each curve of a descriptor, in the order of the catalogue."""

HIDDEN_COLOUR = "#d55e00"
"""What cannot be seen from the star point."""
ERROR_MAP = "RdBu_r"
"""Diverging: blue where the fit lies inside the particle, red where outside."""


@dataclass(frozen=True)
class Material:
    """Shading of a surface.

    ``colour``: hexadecimal RGB. ``ambient``, ``diffuse``, ``specular``, ``specular_power``: of the Phong
    model.
    """

    colour: str
    ambient: float = 0.24
    diffuse: float = 0.78
    specular: float = 0.06
    specular_power: float = 8.0


PARTICLE_MATERIAL = Material("#cfcac0")
FIT_MATERIAL = Material("#86b9e3")
POLYHEDRON_MATERIAL = Material("#f6c56d", ambient=0.30, specular=0.0)
PART_TONES = ("#fff2cc", "#f6c56d", "#b9a04c", "#8f5f45")
"""From the first part of a compound to the last: light changes neither hue nor saturation."""


@dataclass(frozen=True)
class ThemeColors:
    """Colours around a surface: background, text and lines.

    - ``background_low``, ``background_high``: colours at the bottom and at the top of the picture.
    - ``ink``: titles, scale bar.
    - ``outline``: edges of facets.
    """

    background_low: str
    background_high: str
    ink: str
    outline: str


LIGHT = ThemeColors("#e9edf1", "#fbfcfd", "#2b2f36", "#4a3306")
DARK = ThemeColors("#1d2126", "#2d333b", "#dfe3e8", "#2a1d04")
PAPER = ThemeColors("#ffffff", "#ffffff", "#20242a", "#4a3306")
"""For figures that go into a document."""
