"""The picture of a match: sizes by mass, distances of each material, and shares of the mixture."""

import numpy as np
from matplotlib.figure import Figure

from regolith_studio.studies.figures.files import as_written
from regolith_studio.studies.matching import QUANTILES, Match


def matching_figure(found: Match) -> Figure:
    """Energy distances in floors, masses of the mixture, and quantiles of the size by mass."""
    parts = (*found.parts, found.mixture)
    rows, names = np.arange(len(parts)), [as_written(part.name) for part in parts]
    figure = Figure(figsize=(11, 1.8 + 0.35 * len(parts)), layout="constrained")
    near, masses, sizes = figure.subplots(1, 3, sharey=True)
    for row, part in zip(rows, parts, strict=True):
        low, high = (end / part.energy_floor for end in part.energy_interval)
        near.plot([low, high], [row, row], color="#0072b2")
        near.plot(part.energy / part.energy_floor, row, "o", color="#0072b2")
        sizes.plot(part.sizes, [row] * len(QUANTILES), "o-", color="#009e73")
        if part is not found.mixture:
            masses.barh(row, 100 * part.mass_share, color="#e69f00")
            masses.plot([100 * end for end in part.mass_interval], [row, row], color="black")
    near.axvspan(-1, 1, color="#e4e4e4")
    near.set_xlabel(f"energy distance to {as_written(found.target)}, in floors")
    masses.set_xlabel("mass in the mixture, %")
    for size in found.target_sizes:
        sizes.axvline(size, color="#888888", linestyle=":")
    sizes.set(xscale="log", xlabel=f"{found.keys[0]}, um: 10, 50, 90 % of the mass".replace("%", r"\%"))
    near.set_yticks(rows, names)
    near.invert_yaxis()
    return figure
