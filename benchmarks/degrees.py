"""Degrees of a series and what they make of a particle: published volumes, levels of meshes, the round trip.

    python -m benchmarks.degrees [TABLES.npz GEOMETRY.csv] [--seed 5] [--particles 300] [-o RESULT.json]

Volume and area of particles from tables of complex coefficients (``anm``, ``name``) against published ones
(name, then 19 numbers; V, A and the degree used are the 7th, 8th and 12th), once cut at the degree that was
published, where 28 stands for 28 or 30, and once at all degrees. Then errors of ``study lmax`` against those
of meshes of 81,920 triangles, and coefficients to mesh and back.
"""

import argparse
import csv
from pathlib import Path

import numpy as np

from benchmarks.harmonics import rough_particle
from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics.coefficients import ShCoefficients, degrees, orders
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.harmonics.io import from_complex_rows
from regolith_studio.harmonics.surface import reconstruct
from regolith_studio.readers.particles import sample_particles
from regolith_studio.studies.lmax import lmax_errors

KEYS = ("sphericity", "convexity")
DEGREES = (2, 4, 8, 12, 20)
SHAPES = ("angular-1", "subangular-1", "elongated-1", "flat-1", "agglutinate-1", "bead-1")
FINEST = 6


def gaps(particle: ShCoefficients, volume: float, area: float) -> FloatArray:
    """Errors of volume and area in percent."""
    surface = reconstruct(particle, level=5)
    return 100 * np.abs(np.array([surface.volume / volume, surface.surface_area / area]) - 1)


def published(tables: Path, geometry: Path, seed: int, n: int) -> Rows:
    """Median and largest error of volume and of area, by how the tables are cut."""
    with np.load(tables) as data:
        values, names = data["anm"], data["name"]
    with geometry.open(newline="") as lines:
        known = {row[0]: [float(cell) for cell in row[1:]] for row in csv.reader(lines)}
    length = values.shape[1]
    found = []
    for index in np.random.default_rng(np.random.SeedSequence(seed)).choice(len(values), n, replace=False):
        row, complex_ones = known[str(names[index])], values[index]
        volume, area, used = row[6], row[7], int(row[11])
        pairs = np.column_stack([degrees(length), orders(length), complex_ones.real, complex_ones.imag])
        particle = from_complex_rows(pairs)
        possible = (28, particle.l_max) if used == 28 else (used,)
        cuts = [gaps(particle.truncated(k), volume, area) for k in possible]
        found.append([*min(cuts, key=max), *gaps(particle, volume, area)])
    middle, worst = np.median(found, axis=0), np.max(found, axis=0)
    rows: Rows = {}
    show_row(rows, "at the published degree", (middle[0], worst[0], middle[1], worst[1]))
    show_row(rows, "at all degrees", (middle[2], worst[2], middle[3], worst[3]))
    return rows


def levels() -> Rows:
    """RMSRE of sphericity and V/CH in percent by the study and by the finest meshes, by degree."""
    by_study, by_finest = [], []
    for mesh in (each.mesh for each in sample_particles() if each.name in SHAPES):
        wanted, fit = describe(mesh, KEYS), fit_harmonics(mesh, max(DEGREES))
        by_study.append(lmax_errors(mesh, DEGREES, KEYS))
        fine = [describe(reconstruct(fit, degree, level=FINEST), KEYS) for degree in DEGREES]
        by_finest.append([[row[key] / wanted[key] - 1 for key in KEYS] for row in fine])
    both = [100 * np.sqrt(np.mean(np.square(errors), axis=0)) for errors in (by_study, by_finest)]
    rows: Rows = {}
    for number, degree in enumerate(DEGREES):
        study, finest = both[0][number], both[1][number]
        show_row(rows, str(degree), (study[0], finest[0], study[1], finest[1]))
    return rows


def round_trip(seed: int) -> Rows:
    """Relative errors of coefficients (l = 10) to mesh and back about the same star point, in 1e-6: median
    and largest of five particles, by level."""
    rows: Rows = {}
    for level in (3, 4, 5, 6):
        errors = []
        for number in range(5):
            before = rough_particle(seed + number, 10)
            after = fit_harmonics(reconstruct(before, level=level), 10, star_point=(0, 0, 0)).coefficients
            errors.append(1e6 * np.linalg.norm(after.values - before.values) / np.linalg.norm(before.values))
        show_row(rows, str(level), (np.median(errors), max(errors)), 0)
    return rows


def main() -> None:
    """Print the tables, and keep them where a file is given."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--particles", type=int, default=300)
    parser.add_argument("-o", "--output", default="")
    options = parser.parse_args()
    seed = options.seed
    if options.files:
        rows = published(*options.files, seed, options.particles)
        add_result(options.output, "tables cut", rows, seed=seed, particles=options.particles)
    add_result(options.output, "l_max", levels(), particles=len(SHAPES))
    add_result(options.output, "level", round_trip(seed), seed=seed, particles=5)


if __name__ == "__main__":
    main()
