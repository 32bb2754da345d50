"""Inputs that were made to harm: names that lead elsewhere, damage, pipes, and files that unpack to too much.

Part of ``python -m benchmarks.attack``; by itself ``python -m benchmarks.attack_inputs``. Each case is a
command in a process of its own. It prints a line for each kind of input:

runs
    How many.
sentences
    How many were refused with one sentence. Unclear ends have a traceback, more lines, or no end in a minute.
outside
    How many wrote, changed or removed anything outside of the output.
"""

import hashlib
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.cli.entry import run
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.resources import resource


def write_inputs(folder: Path) -> None:
    """Fill a folder."""
    rng = np.random.default_rng(0)
    _write_ellipsoids(folder / "meshes", 3, rng)
    _write_ellipsoids(folder / "many", 20, rng)  # as few as models are judged by
    np.save(folder / "labels.npy", _labels())
    recipe = {"inputs": ["meshes"], "method": "quadric", "n_facets": 12, "outputs": {"summary": True}}
    (folder / "recipe.json").write_text(json.dumps(recipe))
    (folder / "heap.csv").write_text(_heap(rng))
    meshes = str(folder / "meshes")
    for words in (
        ["fit", meshes, "-o", str(folder / "fit.json"), "--l-max", "6"],
        ["fit", str(folder / "many"), "-o", str(folder / "many.json"), "--l-max", "3"],
        ["dataset", "build", meshes, "-o", str(folder / "dataset"), "--method", "quadric", "--facets", "8"],
    ):
        if run(words):
            raise SystemExit(f"{' '.join(words)} failed")


def _write_ellipsoids(folder: Path, count: int, rng: np.random.Generator) -> None:
    folder.mkdir()
    ball = icosphere(2)
    for k in range(count):
        mesh = Mesh(ball.vertices * rng.uniform(10.0, 40.0, 3), ball.faces)
        (folder / f"grain-{k}.stl").write_bytes(stl_bytes(mesh.triangles, "grain"))


def _labels() -> np.ndarray:
    """Balls of 16 voxels in a grid."""
    z, y, x = np.indices((20, 40, 40))
    inside = (z % 20 - 10) ** 2 + (y % 20 - 10) ** 2 + (x % 20 - 10) ** 2 < 64
    number = 1 + z // 20 + 3 * (y // 20) + 9 * (x // 20)
    return (inside * number).astype(np.uint8)


def _heap(rng: np.random.Generator) -> str:
    """Centres of 3,000 particles in a cone of 30 degrees, metres."""
    points = rng.uniform([-0.02, -0.02, 0.0], [0.02, 0.02, 0.0116], (60_000, 3))
    radius = np.hypot(points[:, 0], points[:, 1])
    points = points[points[:, 2] < np.tan(np.radians(30.0)) * (0.02 - radius)][:3000]
    lines = [f"{x:.6f},{y:.6f},{z:.6f},0.0006" for x, y, z in points]
    return "\n".join(["x,y,z,diameter", *lines]) + "\n"


PATIENCE = 60.0
PROGRESS = re.compile(r".*: [\d,]+ of [\d,]+(, |$)")
"""A line of progress that long work prints where there is no terminal."""
NAMES = (
    *("../../escaped", "/tmp/regolith-escaped", "..", "a\\..\\..\\b", "C:\\x", "CON", "", "n\nl", "x" * 5000),
    *("\u0000", "=1+1", "<img src='file:///x'>", "\ud800"),
)
HEAD = "| input | runs | sentences | unclear ends | outside |\n| --- | --- | --- | --- | --- |"

Case = tuple[str, Sequence[str]]


def cases(folder: Path) -> Iterator[Case]:
    """Kind and command of each case; the inputs are written to `folder`."""
    yield from _names(folder)
    yield from _documents(folder)
    yield from _datasets(folder)
    yield from _positions(folder)
    yield from _runs(folder)


def _names(folder: Path) -> Iterator[Case]:
    mesh = str(resource("samples", "particles") / "bead-1.stl")
    quick: dict[str, Any] = {"method": "quadric", "level": 2, "l_max": 4, "facets": 12}
    outputs = {"outputs": {"fits": True}}
    for number, name in enumerate(NAMES):
        particle = {"inputs": [mesh], "particles": [{"name": "bead-1", "called": name}]}
        population = {"inputs": [], "population": {"sources": ["lunar_soil"], "n": 2, "name": name}}
        for kind, entries in (("recipe", particle), ("population", population)):
            path = _recipe(folder / f"{kind}-{number}.json", quick | outputs | entries)
            yield f"names, {kind}", ["run", str(path), "-o", "OUT"]


def _documents(folder: Path) -> Iterator[Case]:
    head = '"format": "regolith-studio recipe", "version": 2'
    contents = {
        "twice": f'{{{head}, "seed": 1, "seed": 2}}',
        "nan": f'{{{head}, "seed": NaN}}',
        "deep": f'{{{head}, "inputs": {"[" * 100_000}',
        "many": json.dumps({"format": "regolith-studio recipe", "version": 2, "inputs": ["a"] * 2_000_000}),
        "nul": f'{{{head}, "inputs": ["a\\u0000b.stl"]}}',
    }
    for name, content in contents.items():
        (folder / f"{name}.json").write_text(content)
        yield "recipes", ["run", str(folder / f"{name}.json"), "-o", "OUT"]
    os.mkfifo(folder / "pipe.json")
    yield "pipes", ["run", str(folder / "pipe.json"), "-o", "OUT"]


def _datasets(folder: Path) -> Iterator[Case]:
    """Datasets whose names and files lead elsewhere."""
    mesh = str(resource("samples", "particles") / "bead-1.stl")
    with redirect_stdout(io.StringIO()):
        run(["dataset", "build", mesh, "-o", str(folder / "set"), "--method", "quadric", "--facets", "12"])
    document = (folder / "set" / "dataset.json").read_text()
    for key in ("name", "file"):
        for number, name in enumerate(NAMES[:7]):
            copy = folder / f"set-{key}-{number}"
            shutil.copytree(folder / "set", copy)
            changed = re.sub(
                rf'"{key}": "[^"]*"', lambda _, key=key, name=name: f'"{key}": {json.dumps(name)}', document
            )
            (copy / "dataset.json").write_text(changed)
            yield (
                f"{key}s, dataset",
                ["dataset", "export", str(copy), "--to", "half-spaces,gltf", "-o", "OUT"],
            )


def _positions(folder: Path) -> Iterator[Case]:
    """Positions that are noise, cut off, or a pipe."""
    random = np.random.default_rng(0)
    table = "x,y,z,diameter\n" + "0.001,0.002,0.003,0.0004\n" * 50
    for suffix in ("csv", "xyz", "txt"):
        for name, content in (("noise", random.bytes(3000)), ("cut", table.encode()[:-7]), ("none", b"")):
            path = folder / f"{name}.{suffix}"
            path.write_bytes(content)
            yield "positions", ["repose", "measure", str(path), "-o", "OUT"]
    os.mkfifo(folder / "heap.csv")
    yield "pipes", ["repose", "measure", str(folder / "heap.csv"), "-o", "OUT"]


def _runs(folder: Path) -> Iterator[Case]:
    state = {
        "points_m": np.zeros((3, 3)),
        "diameters_m": np.full(3, 1e-4),
        "orientations": np.tile(np.float32([1, 0, 0, 0]), (3, 1)),
        "class_index": np.zeros(3, np.int32),
        "time_s": np.float64(0),
        "wall_m": np.float64(0),
        "phase": np.array("rest"),
    }
    for seed in range(8):
        place = folder / f"run-{seed}"
        (place / "snapshots").mkdir(parents=True)
        (place / "repose.json").write_text('{"format": "regolith-studio-repose", "state": "finished"}')
        np.savez_compressed(place / "final.npz", **state)  # type: ignore[arg-type]
        np.savez_compressed(place / "shapes.npz", **{"shape_00000.part_00": np.eye(4, 3)})
        random = np.random.default_rng(seed)
        path = place / ("shapes.npz" if seed % 2 else "final.npz")
        content = np.frombuffer(path.read_bytes(), np.uint8).copy()
        content[random.integers(0, len(content), 4)] ^= np.uint8(85)
        path.write_bytes(content.tobytes()[: len(content) - 30 * (seed % 3)])
        yield "damage", ["repose", "export", str(place), "-o", "OUT"]
    with (
        zipfile.ZipFile(place / "shapes.npz", "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive,
        archive.open("shape_00000.part_00.npy", "w", force_zip64=True) as stream,
    ):
        for _ in range(3000):
            stream.write(bytes(10**6))
    np.savez_compressed(place / "final.npz", **state)  # type: ignore[arg-type]
    yield "size", ["repose", "export", str(place), "-o", "OUT"]
    for name in ("shapes.npz", "final.npz", "repose.json"):
        (place / name).unlink()
        os.mkfifo(place / name)
        yield "pipes", ["repose", "export", str(place), "-o", "OUT"]


def _recipe(path: Path, entries: dict[str, Any]) -> Path:
    path.write_text(json.dumps({"format": "regolith-studio recipe", "version": 2} | entries))
    return path


def attack_inputs(folder: Path, share: float = 1.0, seed: int = 0) -> dict[str, list[int]]:
    """Runs, sentences, unclear ends and writes outside of the output, by the kind of input."""
    rows: dict[str, list[int]] = {}
    random = np.random.default_rng(seed)
    inputs, place = folder / "inputs", folder / "place" / "deep"
    inputs.mkdir()
    with redirect_stdout(io.StringIO()):
        run(["warm-up"])  # kernels, which take longer than a minute once after an installation
    for number, (kind, words) in enumerate(cases(inputs)):
        if random.random() >= share:
            continue
        output = place / str(number) / "out"
        output.parent.mkdir(parents=True)
        before = _files(folder, output)
        ended = _run([str(output) if word == "OUT" else word for word in words])
        row = rows.setdefault(kind, [0, 0, 0, 0])
        row[0] += 1
        row[1] += ended == "sentence"
        row[2] += ended == "unclear"
        row[3] += _files(folder, output) != before
    return rows


def _run(words: Sequence[str]) -> str:
    command = [sys.executable, "-m", "regolith_studio", *words]
    try:
        ended = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)
    except subprocess.TimeoutExpired:
        return "unclear"
    said = "\n".join(line for line in ended.stderr.strip().splitlines() if not PROGRESS.match(line))
    if not ended.returncode:
        return "done"
    is_sentence = "\n" not in said and "made a mistake" not in said and ended.returncode in (1, 2)
    if not is_sentence:
        print(f"  {' '.join(words)[:80]}: {ended.returncode}, {said[-300:]!r}", file=sys.stderr)
    return "sentence" if is_sentence else "unclear"


def _files(folder: Path, output: Path) -> dict[str, str]:
    places = [*folder.rglob("*"), *Path("/tmp").glob("regolith-escaped*")]
    return {
        str(path): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in places
        if path.is_file() and not path.is_relative_to(output)
    }


def lines(rows: dict[str, list[int]]) -> list[str]:
    """The table in Markdown."""
    return [HEAD, *(f"| {kind} | {' | '.join(map(str, row))} |" for kind, row in rows.items())]


def main() -> None:
    """Run all cases and print the table."""
    with tempfile.TemporaryDirectory() as folder:
        rows = attack_inputs(Path(folder))
    print("\n".join(lines(rows)))
    if any(row[2] or row[3] for row in rows.values()):
        raise SystemExit(1)


if __name__ == "__main__":
    main()
