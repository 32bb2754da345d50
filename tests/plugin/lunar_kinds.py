"""One row of every kind, as another package would offer them by its entry points.

None inherits from a class of the program, so that a method that the program calls but does not ask for shows.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from regolith_studio.coarsening.methods.quadric import QuadricMethod
from regolith_studio.dataset.export import Exporter
from regolith_studio.dem.engine import Availability, EngineCapabilities
from regolith_studio.errors import FileError, InputError
from regolith_studio.readers.formats import MeshFormat, ParsedMesh
from regolith_studio.shape_models.realizations import Realizations


@dataclass(frozen=True)
class NoSettings:
    """A method or engine without choices."""


class LunarMethod:
    key, label, keeps_terms, Settings = "lunar_method", "Lunar method", False, NoSettings

    def run(self, target, n_facets, weights, seed, settings, fewer=None):  # noqa: ARG002
        quadric = QuadricMethod()
        return quadric.run(target, n_facets, weights, seed, quadric.Settings())


@dataclass(frozen=True)
class LunarSettings:
    l_max: int = 2


@dataclass(frozen=True)
class LunarField:
    """Bodies of one size whose degrees from the first on have amplitude .01: no spectrum is stated."""

    radius: float
    l_max: int
    unit: str = "um"
    key: str = "lunar_model"

    def draw(self, n, seed, size_range=None):
        if size_range and not size_range[0] <= self.radius <= size_range[1]:
            raise InputError("All lunar particles have the same size.")
        rows = np.random.default_rng(seed).standard_normal((n, (self.l_max + 1) ** 2))
        rows *= 0.01 * self.radius * np.sqrt(4 * np.pi)
        rows[:, 0] = self.radius * np.sqrt(4 * np.pi)
        return Realizations(rows, "radius", self.key, seed, self.unit)

    def draw_chunks(self, n, seed, size_range=None):
        yield self.draw(n, seed, size_range)

    def stored(self):
        return {"radius": self.radius, "l_max": self.l_max, "unit": self.unit}, {}


class LunarModel:
    key, label, summary, Settings = "lunar_model", "Lunar model", "All the same size.", LunarSettings

    def fit(self, sample, settings=None):
        degree = (settings or LunarSettings()).l_max
        return LunarField(float(sample.equivalent_radii.mean()), degree, sample.unit)

    def restored(self, values, arrays):  # noqa: ARG002
        return LunarField(**values)


class LunarEngine:
    key, label, order, licence, Settings = "lunar_engine", "Lunar engine", 9, "none", NoSettings
    capabilities = EngineCapabilities("", "", "", "", "", "", "")

    def find(self):
        return Availability("1.0")

    def seconds(self, prepared, settings):  # noqa: ARG002
        return 0.0

    def simulate(self, prepared, settings):  # noqa: ARG002
        raise InputError("Nothing falls here.")


def parse(data: bytes, _path: Path) -> ParsedMesh:
    try:
        content = json.loads(data)
    except ValueError:
        raise FileError("is not a lunar mesh.") from None
    return ParsedMesh(np.array(content["vertices"], dtype=float), np.array(content["faces"]))


METHOD = LunarMethod()
MODEL = LunarModel()
ENGINE = LunarEngine()
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


CLASHING = SimpleNamespace(key="quadric")
"""Has the key of a method of the program."""


class EarlierMethod(LunarMethod):
    """Runs without a result with fewer facets to begin from, which the program hands over."""

    key = "earlier_method"

    def run(self, target, n_facets, weights, seed, settings):
        return super().run(target, n_facets, weights, seed, settings)


EARLIER = EarlierMethod()


class HalfAMethod:
    """Lacks nearly all that a method needs."""

    key = "half_a_method"


def __getattr__(name: str) -> object:
    """The page is made when it is asked for: only the window has Qt."""
    if name != "PAGE":
        raise AttributeError(name)
    from regolith_studio.ui.page import Page

    return Page("lunar_page", "Lunar", "sample", 1000, "Show the Moon.", f"{__name__}:make_page")


def make_page(_context: object) -> object:
    """An empty page."""
    from regolith_studio.ui.page import PageWidget

    return PageWidget()
