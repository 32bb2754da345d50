"""The numbers of Figs. 4 to 6: how far each model is from the sample, and which is nearest."""

import numpy as np

from regolith_studio.studies.population import N_FLOOR_SPLITS, PopulationStudy
from regolith_studio.studies.population_distances import CONFIDENCE, N_RESAMPLES, WEIGHTINGS
from regolith_studio.studies.tables import Column, Table

PERCENTAGES = (
    "wasserstein",
    "wasserstein_low",
    "wasserstein_high",
    "floor",
    "floor_p5",
    "floor_p95",
    "kolmogorov_smirnov",
    "kolmogorov_smirnov_low",
    "kolmogorov_smirnov_high",
    "kolmogorov_smirnov_floor",
)


def distance_table(study: PopulationStudy) -> Table:
    """Figs. 4 and 5 as numbers: a row for each model, weighting and descriptor."""
    rows = []
    low, high = (np.percentile(study.floor.wasserstein, p, axis=0) for p in (5, 95))
    floor, gap = study.floor.wasserstein.mean(axis=0), study.floor.kolmogorov.mean(axis=0)
    for model in study.models:
        far, ks = model.distances.wasserstein, model.distances.kolmogorov
        for w, weighting in enumerate(WEIGHTINGS):
            for k, key in enumerate(study.keys):
                mean, spread = far[:, w, k].mean(), model.intervals.wasserstein[:, w, k]
                noise = (floor[w, k], low[w, k], high[w, k])
                shares = [100 * value for value in (mean, *spread, *noise)]
                ends = 100 * model.intervals.kolmogorov[:, w, k]
                gaps = (100 * ks[:, w, k].mean(), *ends, 100 * gap[w, k])
                floors = (mean / floor[w, k], ks[:, w, k].mean() / gap[w, k])
                rows.append((model.key, weighting, key, *shares, *gaps, *floors))
    columns = (
        *map(Column, ("model", "weighting", "descriptor")),
        *(Column(name, "%") for name in PERCENTAGES),
        Column("wasserstein_in_floors"),
        Column("kolmogorov_smirnov_in_floors"),
    )
    return Table("Distances of drawn from measured particles", columns, tuple(rows), _notes(study))


def pair_table(study: PopulationStudy) -> Table:
    """Fig. 6 as numbers: energy distance of each pair of descriptors."""
    rows = [
        (model.key, *pair, 100 * model.distances.energy[:, p].mean(), 100 * study.floor.energy[:, p].mean())
        for model in study.models
        for p, pair in enumerate(study.pairs)
    ]
    columns = (
        *map(Column, ("model", "first", "second")),
        Column("energy_distance", "%"),
        Column("floor", "%"),
    )
    return Table("Energy distances of pairs of descriptors", columns, tuple(rows), _notes(study))


def ranking_table(study: PopulationStudy) -> Table:
    """The models, the nearest to the sample first: by their mean Wasserstein distance in floors."""
    floor = study.floor.wasserstein.mean(axis=0)
    rows = [
        (
            model.key,
            (model.distances.wasserstein.mean(axis=0) / floor).mean(),
            (model.distances.kolmogorov.mean(axis=0) / study.floor.kolmogorov.mean(axis=0)).mean(),
            100 * model.distances.energy.mean(),
            model.distances.accuracy.mean(),
            model.novelty.mean(),
            100 * model.rejected.mean(),
        )
        for model in study.models
    ]
    columns = (
        Column("model"),
        Column("wasserstein_in_floors"),
        Column("kolmogorov_smirnov_in_floors"),
        Column("energy_distance", "%"),
        Column("classifier_accuracy"),
        Column("novelty"),
        Column("rejected", "%"),
    )
    ranked = tuple(sorted(rows, key=lambda row: row[1]))
    return Table("Models by their distance to held-out particles", columns, ranked, _notes(study))


def _notes(study: PopulationStudy) -> tuple[str, ...]:
    splits = len(study.models[0].novelty) if study.models else 0
    return (
        f"{len(study.measured)} measured particles at l_max = {study.l_max}, {study.left_out} left out; "
        f"fitted to one half, judged on the other; {splits} {'split' if splits == 1 else 'splits'}, "
        f"{study.n_draws} draws {study.n_repeats} times from each fit, seed {study.seed}.",
        "Wasserstein distances are shares of the measured mean; the floor is the distance between random "
        f"halves, {N_FLOOR_SPLITS} of them; by volume means weighted with the cube of the equivalent radius.",
        f"Low and high hold the distance of one round in {CONFIDENCE:.0%} of {N_RESAMPLES} resamples of "
        "measured and drawn particles, shifted back by what resampling adds.",
        "Energy distances are unbiased, of standardised columns; a classifier at 0.5 cannot tell measured "
        "from drawn; novelty is the distance to the nearest measured particle, 1 for the same source.",
    )
