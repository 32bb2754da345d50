"""Angle of repose of drawn populations over their shape statistics (docs/repose_results.md).

    python -m benchmarks.population_heaps RUNS RESULT.json [REPEATS] [ENGINE]

Particles of a shipped material whose spectrum is changed: the amplitudes of degree 2, which elongate and
flatten, and those of higher degrees, which roughen, each times a factor. All populations have one size
distribution and polyhedra of 20 facets. Datasets and runs that are in the folder RUNS already are kept.
"""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np

import regolith_studio as rs
from regolith_studio.dataset.size_distributions import LogNormalSizeDistribution
from regolith_studio.geometry.particle import Particle
from regolith_studio.shape_models.materials import materials
from regolith_studio.shape_models.realizations import virtual_mesh

MATERIAL, PARTICLES, FACETS, SEED = "lunar_soil", 40, 20, 1
FACTORS = ((1.0, 1.0), (0.3, 1.0), (1.8, 1.0), (1.0, 0.3), (1.0, 1.6), (0.3, 0.3), (1.8, 1.6))
"""On the amplitudes of degree 2 and of those above, one population each."""
SIZES = LogNormalSizeDistribution(median_um=60.0, log_deviation=0.3, weighting="number")
AGAINST = "aspect_ratio,sphericity"


def main(runs: Path, result: Path, repeats: int, engine: str) -> None:
    """Make what is missing, and write the rows and the terms of the response surface."""
    folders = []
    for form, roughness in FACTORS:
        folders.append(runs / f"form_{form:g}_roughness_{roughness:g}")
        if not folders[-1].is_dir():
            rs.write_dataset(folders[-1], population(form, roughness))
    study = runs / "study"
    how = ["--repeats", repeats, "--engine", engine, "--against", AGAINST]
    words = ["repose", "study", *folders, "-o", study, *how]
    subprocess.run([sys.executable, "-m", "regolith_studio", *map(str, words)], check=True)
    content = {name: read(study, name) for name in ("response_surface.json", "response_surface_terms.json")}
    result.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def population(form: float, roughness: float) -> Any:
    """A dataset of drawn particles."""
    model = materials()[MATERIAL].field()
    amplitudes = model.relative_amplitudes()
    degrees = np.arange(1, len(amplitudes) + 1)
    changed = model.with_amplitudes(amplitudes * np.where(degrees <= 2, form, roughness))
    drawn = changed.draw(PARTICLES, seed=SEED)
    meshes = [virtual_mesh(drawn, k) for k in range(PARTICLES)]
    particles = [Particle(f"drawn-{k}", mesh) for k, mesh in enumerate(meshes)]
    entries = [(each, rs.coarsen(each, n_facets=FACETS, seed=SEED)) for each in particles]
    return rs.build_dataset(entries, name=f"form {form:g}, roughness {roughness:g}", sizes=SIZES)


def read(study: Path, name: str) -> Any:
    """One file of the study."""
    return json.loads((study / name).read_text("utf-8"))


if __name__ == "__main__":
    repeats, engine = [*sys.argv[3:], *("3", "rapier")[len(sys.argv) - 3 :]]
    main(Path(sys.argv[1]), Path(sys.argv[2]), int(repeats), engine)
