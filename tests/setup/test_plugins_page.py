"""The package on the page about plug-ins, taken from the page and installed, does what the page says."""

import json
import os
import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull, HalfspaceIntersection

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "plugins.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.DOTALL | re.MULTILINE)
AXES = (3.0, 2.0, 1.5)


def install(site: Path) -> None:
    """What pip would leave in `site` of the package on the page."""
    (project,) = (tomllib.loads(text) for language, text in BLOCK.findall(PAGE) if language == "toml")
    about = project["project"]
    record = site / f"{about['name'].replace('-', '_')}-{about['version']}.dist-info"
    record.mkdir(parents=True)
    (record / "METADATA").write_text(
        f"Metadata-Version: 2.1\nName: {about['name']}\nVersion: {about['version']}\n"
    )
    lines = []
    for group, rows in about["entry-points"].items():
        lines += [f"[{group}]", *(f"{name} = {target}" for name, target in rows.items())]
    (record / "entry_points.txt").write_text("\n".join(lines) + "\n")
    for language, text in BLOCK.findall(PAGE):
        if language == "python":
            path = site / text.splitlines()[0].removeprefix("# ")
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")


def gmsh_file(mesh: trimesh.Trimesh) -> str:
    nodes = [f"{i} {x} {y} {z}" for i, (x, y, z) in enumerate(mesh.vertices.tolist(), 1)]
    faces = [f"{i} 2 2 0 1 {a} {b} {c}" for i, (a, b, c) in enumerate((mesh.faces + 1).tolist(), 1)]
    head = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat"]
    points = ["$Nodes", str(len(nodes)), *nodes, "$EndNodes"]
    return "\n".join([*head, *points, "$Elements", str(len(faces)), *faces, "$EndElements", ""])


def run(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(folder / "site"), str(ROOT)])}
    command = [sys.executable, "-m", "regolith_studio", *words]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.slow
def test_that_reader_method_exporter_and_engine_of_the_page_work_together(tmp_path: Path) -> None:
    install(tmp_path / "site")
    ellipsoid = trimesh.creation.icosphere(3).apply_scale(AXES)
    (tmp_path / "grain.msh").write_text(gmsh_file(ellipsoid))
    (commands,) = (text for _, text in BLOCK.findall(PAGE) if "grain.msh" in text)
    described = ""
    for line in commands.splitlines():
        done = run(tmp_path, *shlex.split(line)[1:])
        assert done.returncode == 0, done.stderr
        described = described or done.stdout

    assert json.loads(described)[0]["volume"] == pytest.approx(ellipsoid.volume, rel=1e-9)

    scene = (tmp_path / "scenes" / "povray" / "shapes.inc").read_text()
    planes = re.findall(r"plane \{ <(.*), (.*), (.*)>, (.*) \}", scene)
    equations = np.array(planes, dtype=float) * (1, 1, 1, -1)
    assert len(equations) == 20
    corners = HalfspaceIntersection(equations, np.zeros(3)).intersections
    assert ConvexHull(corners).volume == pytest.approx(1.0, rel=1e-9)

    measurement = json.loads((tmp_path / "heap" / "repose.json").read_text())["measurement"]
    low, high = measurement["interval_deg"]
    assert low < np.degrees(np.arctan(0.6)) < high


@pytest.mark.slow
def test_that_the_reader_of_the_page_refuses_what_is_no_such_file(tmp_path: Path) -> None:
    install(tmp_path / "site")
    head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    (tmp_path / "grain.msh").write_text(head + "$Nodes\n1\n1 0 x 0\n$EndNodes\n")
    done = run(tmp_path, "describe", "grain.msh")
    assert done.returncode == 1
    assert "grain.msh is no Gmsh file in ASCII" in done.stderr
