"""How many representatives are enough, as a table: one row a number, the noise of the population last."""

from regolith_studio.dataset.quality import QualityCurve
from regolith_studio.io.tables import Column, Table


def quality_table(curve: QualityCurve) -> Table:
    """Errors over the number of representatives; the row whose number is missing is the sampling noise."""
    keys = tuple(curve.points[0].errors)
    rows = [(point.count, point.mean, *(float(point.errors[key]) for key in keys)) for point in curve.points]
    noise = (None, curve.noise_mean, *(float(curve.noise[key]) for key in keys))
    enough = (
        "no number looked at"
        if curve.sufficient_count is None
        else f"{curve.sufficient_count} representatives"
    )
    return Table(
        f"Wasserstein distance between {curve.n_particles} particles and their representatives",
        (Column("representatives"), Column("mean"), *(Column(key) for key in keys)),
        (*rows, noise),
        (
            "In standard deviations of each descriptor. Last row: the same between random halves of the "
            "population.",
            f"The mean error falls to that noise at {enough}; weighted by {curve.weighting}.",
        ),
    )
