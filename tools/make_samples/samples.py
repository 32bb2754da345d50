"""Recipes of the shipped particles and scans, and the files that are made of them."""

import hashlib
import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import tifffile

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging.volume import Volume
from regolith_studio.io.triangles import stl_bytes
from tools.make_samples.grains import AgglutinateRecipe, Recipe, StarRecipe
from tools.make_samples.strokes import N_STROKES, painted_volume
from tools.make_samples.synthetic_ct import ScanRecipe, synthetic_scan

SEED = 2026
"""Root of all shipped samples; each takes ``SeedSequence(SEED, spawn_key=(its variant,))``."""

ORIGIN = (
    "Synthesised by the generator of Regolith Studio (tools.make_samples); no measured data in it. "
    "Licence: MIT, as the program."
)

_imwrite: Any = tifffile.imwrite


@dataclass(frozen=True)
class SampleGrain:
    """A row of the list of shipped particles.

    Parameters
    ----------
    name, kind, description
        As the window shows them.
    recipe
        With all its numbers.
    variant
        Spawn key of the seed.
    """

    name: str
    kind: str
    description: str
    recipe: Recipe
    variant: int

    def mesh(self) -> Mesh:
        """The particle in micrometres."""
        return self.recipe.make(
            np.random.default_rng(np.random.SeedSequence(SEED, spawn_key=(self.variant,)))
        )


GRAINS = (
    SampleGrain(
        "angular-1",
        "angular",
        "A blocky mineral fragment with flat cleavage faces and sharp edges.",
        StarRecipe(96.0, n_planes=9, sharpness=34.0, offset_spread=0.2, roughness=0.025),
        101,
    ),
    SampleGrain(
        "angular-2",
        "angular",
        "A splintered fragment: few large faces, rough between sharp corners.",
        StarRecipe(74.0, n_planes=8, sharpness=26.0, offset_spread=0.25, roughness=0.05, decay=1.4),
        102,
    ),
    SampleGrain(
        "angular-3",
        "angular",
        "A many-faced crushed grain with a rough surface.",
        StarRecipe(118.0, n_planes=18, sharpness=24.0, offset_spread=0.18, roughness=0.06, decay=1.3),
        103,
    ),
    SampleGrain(
        "subangular-1",
        "angular",
        "A worn fragment whose edges have begun to round.",
        StarRecipe(62.0, n_planes=14, sharpness=10.0, roughness=0.07),
        104,
    ),
    SampleGrain(
        "elongated-1",
        "elongated",
        "A prism about twice as long as it is wide, with cleavage faces.",
        StarRecipe(84.0, n_planes=12, sharpness=26.0, stretch=(1.9, 1.0, 0.9), roughness=0.03),
        105,
    ),
    SampleGrain(
        "elongated-2",
        "elongated",
        "A rough needle-like shard.",
        StarRecipe(56.0, n_planes=14, sharpness=16.0, stretch=(2.6, 0.9, 0.8), roughness=0.05),
        106,
    ),
    SampleGrain(
        "flat-1",
        "flat",
        "A plate such as plagioclase leaves, about a third as thick as it is wide.",
        StarRecipe(90.0, n_planes=12, sharpness=26.0, stretch=(1.2, 1.1, 0.42), roughness=0.03),
        107,
    ),
    SampleGrain(
        "flat-2",
        "flat",
        "A thin irregular flake, longer than it is wide.",
        StarRecipe(68.0, n_planes=12, sharpness=20.0, stretch=(1.6, 1.0, 0.38), roughness=0.06),
        108,
    ),
    SampleGrain(
        "agglutinate-1",
        "agglutinate",
        "Fragments welded by impact glass, with open vesicles; not star-shaped.",
        AgglutinateRecipe(126.0),
        11,
    ),
    SampleGrain(
        "agglutinate-2",
        "agglutinate",
        "A branched aggregate with knobs, bridges and vesicles; not star-shaped.",
        AgglutinateRecipe(104.0),
        18,
    ),
    SampleGrain(
        "bead-1",
        "bead",
        "A glass bead, almost a ball.",
        StarRecipe(44.0, n_planes=0, roughness=0.006, highest=12, n_vertices=1502),
        109,
    ),
    SampleGrain(
        "bead-2",
        "bead",
        "A drop of glass that froze while it was spinning: slightly oval, smooth.",
        StarRecipe(70.0, n_planes=0, stretch=(1.22, 1.0, 0.96), roughness=0.012, highest=12, n_vertices=1502),
        110,
    ),
)


SCANS = {
    "synthetic": ScanRecipe(),
    "gradient": ScanRecipe(
        shape=(128, 128, 128),
        n_grains=30,
        diameter=(27.0, 18.0, 36.0),
        anywhere=0.4,
        attempts=4000,
        resin=92.0,
        minerals=(140.0, 152.0),
        cupping=0.15,
        rings=4.0,
        gradient=55.0,
    ),
}
"""Shipped synthetic scans by name; the second one is beyond any threshold."""
PAINTED = ("gradient",)
"""Scans that ship with strokes of a brush."""


def write_samples(
    folder: Path, grains: Sequence[SampleGrain] = GRAINS, scans: Mapping[str, ScanRecipe] = SCANS
) -> None:
    """Write ``particles/*.stl``, ``ct/*.tif`` and ``manifest.json`` into `folder`, the same each time.

    The particles come out byte for byte; the volumes voxel for voxel (zlib's bytes depend on its version).
    """
    (folder / "particles").mkdir(parents=True, exist_ok=True)
    (folder / "ct").mkdir(exist_ok=True)
    particles = [_write_grain(folder, grain) for grain in grains]
    volumes = [row for name, recipe in scans.items() for row in _write_scan(folder, name, recipe)]
    manifest = {"origin": ORIGIN, "seed": SEED, "unit": "um", "particles": particles, "volumes": volumes}
    text = json.dumps(manifest, indent=1, sort_keys=True)
    (folder / "manifest.json").write_text(text + "\n", encoding="utf-8", newline="\n")


def _write_scan(folder: Path, name: str, recipe: ScanRecipe) -> list[dict[str, Any]]:
    scan = synthetic_scan(recipe, SEED)
    labelled = f"True labels of {recipe.n_grains} angular grains: 0 between them, 1 to {recipe.n_grains}."
    seen = "Grey values of the same grains with partial volumes, blur, cupping, rings and noise."
    volumes = [("labels", scan.labels, labelled), ("grey", scan.grey, seen)]
    if name in PAINTED:
        painted = f"Voxels of {N_STROKES} strokes of a brush: 1 between grains, 2 in grains, 0 elsewhere."
        volumes.append(("strokes", painted_volume(scan.labels), painted))
    return [
        _write_volume(folder, f"{name}-{what}", volume, description)
        | {"recipe": {"type": "ScanRecipe", **asdict(recipe)}}
        for what, volume, description in volumes
    ]


def _write_volume(folder: Path, scan: str, volume: Volume, description: str) -> dict[str, Any]:
    content = tiff_bytes(volume)
    name = f"ct/{scan}.tif"
    (folder / name).write_bytes(content)
    return {
        "name": scan,
        "kind": volume.kind,
        "description": description,
        "file": name,
        "voxel_size_um": volume.voxel_size.tolist(),
        "shape_xyz": list(volume.shape),
        "sha256": hashlib.sha256(content).hexdigest(),
    }


def _write_grain(folder: Path, grain: SampleGrain) -> dict[str, Any]:
    mesh = grain.mesh()
    content = stl_bytes(mesh.triangles, f"regolith-studio sample {grain.name}, unit um")
    name = f"particles/{grain.name}.stl"
    (folder / name).write_bytes(content)
    return {
        "name": grain.name,
        "kind": grain.kind,
        "description": grain.description,
        "file": name,
        "unit": "um",
        "n_faces": len(mesh.faces),
        "recipe": {"type": type(grain.recipe).__name__, **asdict(grain.recipe)},
        "variant": grain.variant,
        "sha256": hashlib.sha256(content).hexdigest(),
    }


def tiff_bytes(volume: Volume) -> bytes:
    """The volume as a zlib-compressed TIFF stack (slices first) with ImageJ's voxel size in micrometres.

    Raises
    ------
    ValueError
        If voxels are not as wide as high, for which ImageJ's two resolution tags would be needed.
    """
    width, height, depth = volume.voxel_size
    if width != height:
        raise ValueError(f"voxels must be as wide as high, got {volume.voxel_size}")
    buffer = io.BytesIO()
    _imwrite(
        buffer,
        np.ascontiguousarray(volume.array.T),
        imagej=True,
        compression="zlib",
        compressionargs={"level": 9},
        resolution=(1 / width, 1 / height),
        metadata={"axes": "ZYX", "spacing": float(depth), "unit": "um"},
        software="regolith-studio",
    )
    return buffer.getvalue()
