"""Small bodies on disk, and a way to run a command without a process of its own."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from regolith_studio.cli.entry import run
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.io.triangles import stl_bytes

AXES = {"grain-a": (30.0, 20.0, 15.0), "grain-b": (22.0, 21.0, 20.0), "grain-c": (40.0, 25.0, 12.0)}


def ellipsoid(a: float, b: float, c: float) -> Mesh:
    sphere = icosphere(3)
    return Mesh(sphere.vertices * [a, b, c], sphere.faces)


@pytest.fixture(scope="session")
def grains(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with three ellipsoids as STL."""
    folder = tmp_path_factory.mktemp("grains")
    for name, axes in AXES.items():
        (folder / f"{name}.stl").write_bytes(stl_bytes(ellipsoid(*axes).triangles, "test"))
    return folder


@dataclass(frozen=True)
class Said:
    """What a command left behind on its way out."""

    code: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        return json.loads(self.out)


@pytest.fixture
def command(capsys: pytest.CaptureFixture[str]) -> Callable[..., Said]:
    """Runs a command and returns exit code and output."""

    def call(*arguments: object) -> Said:
        code = run([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return Said(code, captured.out, captured.err)

    return call
