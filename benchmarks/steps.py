"""The heavy steps of the program, each against its plain reference, and how they grow."""

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from types import SimpleNamespace

import fast_simplification
import numpy as np
import pyshtools
import trimesh
from scipy.spatial import ConvexHull

from benchmarks import plain
from benchmarks.coarsening import annealed, plain_loss
from benchmarks.contests import Contest, Growth, Work, grown
from benchmarks.independent import least_box
from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.loss import LossFunction
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.folder_io import write_dataset
from regolith_studio.dem.angle_of_repose import measure_repose
from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.oriented_box import minimum_volume_box
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import fibonacci_directions, icosphere
from regolith_studio.harmonics.coefficients import ShCoefficients, degrees, to_pyshtools
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.harmonics.synthesis import radii_on_icosphere, reconstruct
from regolith_studio.imaging.extraction import extract_particles
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.readers.particles import read_mesh
from regolith_studio.shape_models.materials import materials
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.sample import Sample
from tools.make_samples.synthetic_ct import ScanRecipe, synthetic_scan

L_MAX, DEGREE = 10, 60
KEYS = tuple(CATALOGUE)[:8]


def stone(level: int, seed: int = 0) -> Mesh:
    """An angular star-shaped particle: a ball with bumps, cut by random planes; level 4 has 5,120 faces."""
    rng = np.random.default_rng(seed)
    sphere = icosphere(level)
    u = sphere.vertices
    bumps = sum(0.04 * np.sin(u @ rng.normal(size=3) * k + rng.uniform(0, 6)) for k in range(2, 9))
    cuts = HalfSpaces(rng.normal(size=(18, 3)), rng.uniform(0.7, 1.1, 18))
    radius = np.minimum(1.0 + bumps, cuts.radii(u))
    return Mesh(u * radius[:, None] * [1.2, 1.0, 0.8], sphere.faces)


def polyhedron(n_facets: int, seed: int = 0) -> ConvexPolyhedron:
    """A random polyhedron of the kind that coarsening returns."""
    directions = fibonacci_directions(n_facets) + 0.1 * np.random.default_rng(seed).normal(size=(n_facets, 3))
    return ConvexPolyhedron.from_half_spaces(HalfSpaces(directions, np.linspace(0.8, 1.2, n_facets)))


def fresh(mesh: Mesh) -> Mesh:
    """A copy without cached results."""
    return Mesh(mesh.vertices, mesh.faces)


def rough_particle(seed: int, l_max: int = 30) -> ShCoefficients:
    """A star-shaped particle with the amplitudes of real cement grains, mean radius 10."""
    rng = np.random.default_rng(seed)
    degree = degrees((l_max + 1) ** 2)
    values = rng.normal(size=len(degree)) * 0.35 * (degree + 1.0) ** -2 * np.sqrt(4 * np.pi)
    values[0] = np.sqrt(4 * np.pi)
    return ShCoefficients(values * 10)


def contests(place: Path, only: str = "") -> Iterator[Contest]:
    """Every step in the order of the work.

    Parameters
    ----------
    place
        A folder for files.
    only
        Just the steps that contain this word; nothing is prepared for the others.
    """
    groups: dict[tuple[str, ...], Callable[[], Iterable[Contest]]] = {
        ("reading",): lambda: _reading(place),
        ("extraction",): _extraction,
        ("descriptors", "exact box"): _measuring,
        ("SH fit", "synthesis"): _harmonics,
        ("model fit", "drawing"): _model,
        ("loss evaluation",): _loss,
        ("coarsening",): _coarsening,
        ("dataset writing",): lambda: _writing(place),
        ("angle of repose",): _repose,
    }
    for steps, prepared in groups.items():
        if any(only in step for step in steps):
            yield from (contest for contest in prepared() if only in contest.step)


def _reading(place: Path) -> Iterator[Contest]:
    for level in (4, 6):
        mesh = stone(level)
        path = place / f"stone-{level}.stl"
        path.write_bytes(stl_bytes(mesh.triangles, "benchmark"))
        yield Contest(
            "reading",
            f"STL of {len(mesh.faces):,} faces, guarded and repaired",
            lambda p=path: read_mesh(p),
            lambda p=path: plain.read(p),
            "trimesh.load, is_watertight",
            whole=True,
        )


def _extraction() -> Iterator[Contest]:
    volume = synthetic_scan(
        ScanRecipe(shape=(96, 96, 96), n_grains=20, diameter=(24.0, 18.0, 30.0)), 0
    ).labels
    array, voxel = np.asarray(volume.array), float(volume.voxel_size[0])
    yield Contest(
        "extraction",
        f"{int(array.max())} labels in {'x'.join(map(str, array.shape))} voxels",
        lambda: extract_particles(volume),
        lambda: plain.extract(array, voxel),
        "skimage.marching_cubes, trimesh's Taubin filter",
    )


def _measuring() -> Iterator[Contest]:
    mesh, coarse = stone(4), polyhedron(20)
    solid, hull = coarse.mesh, mesh.hull
    yield Contest(
        "descriptors",
        f"eight descriptors, {len(mesh.faces):,} faces",
        lambda: describe(fresh(mesh), KEYS),
        lambda: plain.by_trimesh(mesh.vertices, mesh.faces),
        "trimesh, its oriented box is no minimum",
    )
    yield Contest(
        "descriptors",
        "eight descriptors, 20 facets",
        lambda: describe(ConvexPolyhedron(coarse.half_spaces, coarse.vertices, coarse.facets), KEYS),
        lambda: plain.by_trimesh(solid.vertices, solid.faces),
        "trimesh, its oriented box is no minimum",
    )
    yield Contest(
        "exact box",
        "hull of 20 facets, minimum volume",
        lambda: minimum_volume_box(coarse),
        lambda: least_box(ConvexHull(coarse.vertices), 1.0),
        "O'Rourke by scipy, steps of 1 degree",
    )
    yield Contest(
        "exact box",
        f"hull of {len(hull.faces):,} faces, minimum volume",
        lambda: minimum_volume_box(Mesh(hull.vertices, hull.faces)),
        lambda: trimesh.bounds.oriented_bounds(hull.vertices),
        "trimesh's heuristic, which is no minimum",
    )


def _harmonics() -> Iterator[Contest]:
    particle = rough_particle(1)
    surface = reconstruct(particle, level=4)
    loaded = trimesh.Trimesh(surface.vertices, surface.faces, process=False)
    yield Contest(
        "SH fit",
        f"l = 30, rays of degree {DEGREE}, {len(surface.faces):,} faces",
        lambda: fit_harmonics(fresh(surface)),
        (lambda: plain.fit_harmonics(loaded.copy(), DEGREE, 30)) if plain.can_cast(loaded) else None,
        "trimesh's rays, pyshtools' expansion",
    )
    for level, l_max in ((4, 10), (5, 30)):
        cut, directions = particle.truncated(l_max), icosphere(level).vertices
        theirs = pyshtools.SHCoeffs.from_array(to_pyshtools(cut), normalization="ortho", csphase=1)
        yield Contest(
            "synthesis",
            f"l = {l_max}, {len(directions):,} vertices",
            lambda c=cut, k=level: radii_on_icosphere(c, k),
            lambda t=theirs, d=directions: plain.radii_of(t, d),
            "pyshtools.SHCoeffs.expand",
        )
    yield Contest(
        "synthesis", f"closed mesh at l = {L_MAX}, exact volume", lambda: reconstruct(particle, L_MAX)
    )


def _sample(n: int) -> Sample:
    draws = materials()["ma165"].model(L_MAX).draw(n, 0)
    return Sample(np.stack([draws.particle(index).values for index in range(n)]))


def _model() -> Iterator[Contest]:
    sample = _sample(200)
    rows = np.asarray(sample.coefficients)
    fitted = MODELS["gaussian_field"].fit(sample)
    power, _ = plain.fit_field(rows, L_MAX)
    yield Contest(
        "model fit",
        f"Gaussian field, 200 particles at l = {L_MAX}",
        lambda: MODELS["gaussian_field"].fit(sample),
        lambda: plain.fit_field(rows, L_MAX),
        "pyshtools' spectra, scipy.stats.lognorm",
    )
    yield Contest(
        "drawing",
        "100 particles with a positive radius",
        lambda: fitted.draw(100, 0),
        lambda: plain.draw_field(power, float(rows[:, 0].mean()), 100, 0),
        "pyshtools' random coefficients and grids",
    )


def _loss() -> Iterator[Contest]:
    target = Target.of(stone(4))
    planes = target.in_unit_frame(coarsen(target, 20).half_spaces)
    points, normals, offsets = np.array(planes.points), planes.normals, planes.offsets
    for preset, how, by in (
        ("descriptors", {}, "scipy's half-spaces, trimesh, whose box is no minimum"),
        ("descriptors", {"lean": True, "exact": True}, "scipy, O'Rourke in steps of 1 degree"),
        ("all", {"overlap": "boolean"}, "the first, manifold3d's boolean"),
    ):
        if how.get("overlap") == "boolean" and not plain.HAS_BOOLEANS:
            continue
        ours = LossFunction(target, LossWeights.from_preset(preset))
        theirs = plain_loss(target, **how)
        yield Contest(
            "loss evaluation",
            f"20 faces{', Jaccard distance' if preset == 'all' else ''}",
            lambda f=ours: f.value(normals, offsets),
            lambda f=theirs: f(points),
            by,
        )


def _coarsening() -> Iterator[Contest]:
    mesh = stone(4)
    target = Target.of(mesh)
    full = plain_loss(target, overlap="points")

    def paper() -> HalfSpaces:
        return annealed(target, 20, full, 0)

    rows = (
        ("annealing", {}, paper, "the paper's 100 steps, scipy, trimesh, 4,000 points"),
        ("exact", {"level": "fast"}, paper, "annealing as above"),
        ("exact", {"level": "best"}, paper, "annealing as above"),
        ("quadric", {}, lambda: _decimated(mesh), "fast-simplification, trimesh's descriptors"),
    )
    for method, settings, theirs, by in rows:
        level = f", {settings['level']}" if settings else ""
        yield Contest(
            "coarsening",
            f"{method}{level}: 5,120 faces to 20",
            lambda m=method, s=settings: coarsen(fresh(mesh), 20, m, settings=s),
            theirs,
            by,
        )


def _decimated(mesh: Mesh) -> object:
    vertices, _ = fast_simplification.simplify(np.array(mesh.vertices), np.array(mesh.faces), target_count=36)
    hull = ConvexHull(vertices)
    return plain.by_trimesh(hull.points, hull.simplices)


def _shapes(count: int) -> list[tuple[Particle, SimpleNamespace]]:
    pairs = []
    for index in range(count):
        shape = polyhedron(20, index)
        coarse = SimpleNamespace(
            polyhedron=shape,
            centre=np.zeros(3),
            errors={"volume": 0.0},
            jaccard_distance=0.1,
            loss=0.1,
            method="exact",
            n_facets_asked=20,
            reason=None,
        )
        pairs.append((Particle(f"grain-{index}", shape.mesh), coarse))
    return pairs


def _writing(place: Path) -> Iterator[Contest]:
    pairs = _shapes(100)
    bare = [
        (p.mesh.vertices, p.mesh.faces, c.polyhedron.half_spaces.normals, c.polyhedron.half_spaces.offsets)
        for p, c in pairs
    ]
    yield Contest(
        "dataset writing",
        "100 shapes: aligned, checked, hashed, on the disk",
        lambda: write_dataset(place / "ours", build_dataset(pairs)),
        lambda: plain.write_dataset(place / "plain", bare),
        "trimesh's export and json: no check",
        whole=True,
    )


def cone(n: int, angle: float = 30.0) -> tuple[np.ndarray, float]:
    """`n` grains of one diameter in a cone of that slope, and the diameter."""
    rng = np.random.default_rng(0)
    slope = np.tan(np.radians(angle))
    height = 1.0 - np.cbrt(rng.random(n))
    radius = (1.0 - height) * np.sqrt(rng.random(n))
    turn = rng.uniform(0, 2 * np.pi, n)
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn), slope * height], axis=1)
    return points, float(np.cbrt(np.pi * slope / 3 / n / (np.pi / 6) * 0.6))


def _repose() -> Iterator[Contest]:
    points, diameter = cone(10_000)
    yield Contest(
        "angle of repose",
        "10,000 grains, both models, interval",
        lambda: measure_repose(points, diameter),
        lambda: plain.repose_angle(points, diameter, 18),
        "numpy's bins, scipy.stats.linregress: one model, no interval",
    )


def _measured_cone(n: int) -> Work:
    points, diameter = cone(n)
    return lambda: measure_repose(points, diameter)


def growths(place: Path, rounds: int) -> Iterator[Growth]:
    """Time against face count, l_max, mesh size and number of particles."""
    meshes = {level: stone(level) for level in (3, 4, 5, 6)}
    sizes = {len(mesh.faces): mesh for mesh in meshes.values()}
    target = Target.of(meshes[4])
    for level in ("fast", "best"):
        yield grown(
            f"exact, {level}",
            "faces of the polyhedron",
            (12, 20, 40) if level == "best" else (12, 20, 40, 80),
            lambda n, k=level: lambda: coarsen(target, n, "exact", settings={"level": k}),
            min(rounds, 3),
        )
    particle = rough_particle(1)
    surface = reconstruct(particle, level=4)
    yield grown(
        "SH fit", "l_max", (5, 10, 20, 30), lambda n: lambda: fit_harmonics(fresh(surface), n), rounds
    )
    yield grown("surface", "l_max", (5, 10, 20, 30), lambda n: lambda: reconstruct(particle, n), rounds)
    yield grown(
        "descriptors", "faces of the mesh", tuple(sizes), lambda n: lambda: describe(fresh(sizes[n])), rounds
    )
    yield grown(
        "SH fit", "faces of the mesh", tuple(sizes), lambda n: lambda: fit_harmonics(fresh(sizes[n])), rounds
    )
    yield grown(
        "target of a coarsening",
        "faces of the mesh",
        tuple(sizes),
        lambda n: lambda: Target.of(fresh(sizes[n])),
        rounds,
    )
    pairs = _shapes(400)
    yield grown(
        "dataset writing",
        "particles",
        (50, 100, 200, 400),
        lambda n: lambda: write_dataset(place / f"grown-{n}", build_dataset(pairs[:n])),
        min(rounds, 3),
    )
    model = materials()["ma165"].model(L_MAX)
    yield grown("drawing", "particles", (500, 1000, 2000, 4000), lambda n: lambda: model.draw(n, 0), rounds)
    yield grown(
        "angle of repose",
        "particles",
        (2000, 5000, 10_000, 20_000),
        _measured_cone,
        min(rounds, 3),
    )
