"""Response surface of the angle of repose over shape statistics: one panel a statistic, and its files."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.io.json_text import json_bytes
from regolith_studio.io.tables import write_table
from regolith_studio.studies.figures.files import with_subscript, write_figure
from regolith_studio.studies.repose_surface import ReposeSurface, surface_document, surface_table

STEM = "response_surface"


def write_surface(found: ReposeSurface, folder: Path) -> tuple[Path, ...]:
    """Table (CSV, JSON), terms and effects (JSON) and figure (PNG, SVG)."""
    terms = folder / f"{STEM}_terms.json"
    terms.write_bytes(json_bytes(surface_document(found)))
    table = write_table(surface_table(found), folder, STEM)
    return (*table, terms, *write_figure(surface_figure(found), folder, STEM))


def surface_figure(found: ReposeSurface) -> Figure:
    """The surface along each statistic, all others at their means, with its interval; the runs as dots."""
    surface, n = found.surface, len(found.surface.factors)
    figure = Figure(figsize=(3.6 * n + 0.6, 3.4), layout="constrained")
    statistics = dict(zip(found.study.values, found.statistics, strict=True))
    for k, axis in enumerate(figure.subplots(1, n, squeeze=False, sharey=True)[0]):
        places = np.tile(surface.centre, (60, 1))
        places[:, k] = np.linspace(found.statistics[:, k].min(), found.statistics[:, k].max(), 60)
        mean, half = surface.predict(places)
        axis.plot(places[:, k], mean, color="0.3")
        axis.fill_between(places[:, k], mean - half, mean + half, color="0.3", alpha=0.2)
        for run in found.study.runs:
            if run.angle is not None:
                axis.plot(statistics[run.value][k], run.angle, "o", color="#0072b2", markersize=4)
        axis.set_xlabel(with_subscript(CATALOGUE[surface.factors[k]].symbol))
        axis.grid(True, alpha=0.3)
        if k == 0:
            axis.set_ylabel("angle of repose (°)")
    return figure
