"""One row of every kind, as another package would offer them by its entry points."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np

from regolith_studio.coarsening.methods.quadric import QuadricMethod
from regolith_studio.dataset.export import Exporter
from regolith_studio.dem.engine import Availability
from regolith_studio.dem.engines.yade import YadeEngine
from regolith_studio.errors import FileError
from regolith_studio.readers.formats import MeshFormat, ParsedMesh
from regolith_studio.shape_models.models.gaussian_field import GaussianRadiusModel


class LunarMethod(QuadricMethod):
    key = "lunar_method"
    label = "Lunar method"


class LunarModel(GaussianRadiusModel):
    key = "lunar_model"
    label = "Lunar model"


class LunarEngine(YadeEngine):
    def find(self) -> Availability:
        return Availability("1.0")


def parse(data: bytes, _path: Path) -> ParsedMesh:
    try:
        content = json.loads(data)
    except ValueError:
        raise FileError("is not a lunar mesh.") from None
    return ParsedMesh(np.array(content["vertices"], dtype=float), np.array(content["faces"]))


METHOD = LunarMethod()
MODEL = LunarModel()
ENGINE = replace(LunarEngine(), key="lunar_engine", label="Lunar engine")
FORMAT = MeshFormat("lunar", "Lunar mesh", (".lunar",), lambda head: head.startswith(b'{"lunar"'), parse)
EXPORTER = Exporter(
    key="lunar_export",
    label="Lunar code",
    units="SI",
    carries=("shapes",),
    loses=(),
    load_command="lunar {shell}",
    files=lambda dataset, options: {"lunar.txt": f"{len(dataset)} shapes, {options.seed}\n".encode()},
)


CLASHING = QuadricMethod()
"""Has the key of a method of the program."""


class HalfAMethod:
    """Lacks nearly all that a method needs."""

    key = "half_a_method"


def __getattr__(name: str) -> object:
    """The page is made when it is asked for: only the window has Qt."""
    if name != "PAGE":
        raise AttributeError(name)
    from regolith_studio.ui.page import Page, PageWidget

    return Page("lunar_page", "Lunar", "sample", 1000, "Show the Moon.", lambda _context: PageWidget())
