"""Export of a run of the lifting cylinder for ParaView, OVITO and viewers of glTF."""

import hashlib
import io
import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import cast
from xml.sax.saxutils import quoteattr

import numpy as np
import pyvista as pv
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

from regolith_studio.dataset.export import README, RECORD, check_export_folder
from regolith_studio.dem.run_io import (
    DOCUMENT,
    FINAL,
    SHAPES,
    RunSummary,
    read_final_state,
    read_run,
    read_shapes,
    snapshot_files,
)
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.errors import FileError, GeometryError, InputError, os_error_reason
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.convex_compound import union_of_meshes
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.io.atomic import exchange, hidden_folder, recover_folder, write_in_stage
from regolith_studio.io.own_files import canonical_json
from regolith_studio.io.triangles import Z_UP_TO_Y_UP, MeshBuffer, glb_bytes, stl_bytes
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.messages import N_
from regolith_studio.scene.heap_physics import heap_mjcf, heap_shapes, heap_usd
from regolith_studio.scene.instancing import COLOURS
from regolith_studio.steps import result_of
from regolith_studio.version import __version__

UNIT_DIAMETER = float((np.pi / 6) ** (1 / 3))
"""Factor from a body of unit volume to one of unit equivalent diameter."""
BALL_LEVEL = 2
"""Subdivisions of the icosahedron that stands for a sphere: 320 triangles, 3 % less volume."""


@dataclass(frozen=True, eq=False)
class RunShapes:
    """Shapes of a run as closed meshes of unit equivalent diameter about their centres of mass.

    ``meshes``: one for each shape; of compounds the surface of the union. One icosphere for a run with
    spheres. ``spheres``: whether all particles are spheres.
    """

    meshes: tuple[Mesh, ...]
    spheres: bool

    @property
    def names(self) -> list[str]:
        """``shape_00``, ``shape_01`` ..."""
        digits = max(2, len(str(len(self.meshes) - 1)))
        return [f"shape_{index:0{digits}d}" for index in range(len(self.meshes))]

    def index(self, pile: ParticleState) -> IntArray:
        """Index of the mesh of each particle."""
        if self.spheres:
            return np.zeros(len(pile), dtype=np.int64)
        if len(pile) and not 0 <= pile.class_index.min() <= pile.class_index.max() < len(self.meshes):
            raise FileError(f"The particles of the run have other shapes than its {len(self.meshes)}.")
        return pile.class_index


def run_shapes(run: RunSummary) -> RunShapes:
    """The shapes that the particles of a run have."""
    case = run.document.get("case")
    if isinstance(case, dict) and case.get("shapes") == "spheres":
        ball = icosphere(BALL_LEVEL)
        return RunShapes((Mesh(ball.vertices / 2, ball.faces),), spheres=True)
    try:
        meshes = tuple(_glb_surface(parts).moved(scale=UNIT_DIAMETER) for parts in read_shapes(run.folder))
    except (GeometryError, ValueError) as error:
        raise FileError(f"{run.folder} holds no shapes that can be exported.") from error
    if not meshes:
        raise FileError(f"{run.folder} holds no shapes.")
    return RunShapes(meshes, spheres=False)


def _glb_surface(parts: Sequence[FloatArray]) -> Mesh:
    """Surface of the union of convex bodies, given by their vertices."""
    hulls = [Mesh(vertices, np.empty((0, 3), dtype=np.int64)).hull for vertices in parts]
    return hulls[0] if len(hulls) == 1 else union_of_meshes(hulls)


def extended_xyz(shapes: RunShapes, pile: ParticleState) -> bytes:
    """One frame with OVITO's names of properties: type, position, radius and orientation (x, y, z, w).

    Lengths are in metres.
    """
    names = np.array(shapes.names)[shapes.index(pile)]
    numbers = np.column_stack(
        [pile.points, pile.diameters / 2, pile.orientations[:, 1:], pile.orientations[:, 0]]
    )
    text = io.StringIO()
    properties = "species:S:1:pos:R:3:radius:R:1:orientation:R:4"
    text.write(f'{len(pile)}\nProperties={properties} Time={pile.time:.9g} pbc="F F F"\n')
    line = "%s %.7g %.7g %.7g %.7g %.6g %.6g %.6g %.6g\n"
    text.writelines(line % (name, *row) for name, row in zip(names, numbers.tolist(), strict=True))
    return text.getvalue().encode("ascii")


def heap_glb(shapes: RunShapes, pile: ParticleState, colours: Sequence[Sequence[float]]) -> bytes:
    """A scene with one node for each particle, which share a mesh for each shape; in metres, y up.

    ``colours``: red, green and blue from 0 to 1, linear, for the shapes in turn.
    """
    buffer = MeshBuffer()
    for number, (name, mesh) in enumerate(zip(shapes.names, shapes.meshes, strict=True)):
        normals = mesh.face_area_vectors / mesh.face_areas[:, None]
        corners = mesh.triangles.reshape(-1, 3)
        buffer.add(name, corners, np.repeat(normals, 3, axis=0), number % len(colours))
    root = {"name": "heap", "rotation": Z_UP_TO_Y_UP, "children": list(range(1, len(pile) + 1))}
    content = {
        "asset": {"version": "2.0", "generator": "regolith-studio"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "materials": [_material(number, colour) for number, colour in enumerate(colours)],
        **buffer.document(),
    }
    head = json.dumps(content, separators=(",", ":"), allow_nan=False)[:-1]
    first = json.dumps(root, separators=(",", ":"))
    nodes = ",".join((first, *_nodes(shapes.index(pile), pile)))
    return glb_bytes(f'{head},"nodes":[{nodes}]}}'.encode("ascii"), buffer.binary)


def _nodes(index: IntArray, pile: ParticleState) -> list[str]:
    """JSON of the node of each particle, with the digits that single precision has."""
    numbers = np.column_stack(
        [index, pile.points, pile.orientations[:, 1:], pile.orientations[:, 0], *[pile.diameters] * 3]
    )
    node = (
        '{"mesh":%d,"translation":[%.7g,%.7g,%.7g],"rotation":[%.7g,%.7g,%.7g,%.7g],"scale":[%.7g,%.7g,%.7g]}'
    )
    return [node % tuple(row) for row in numbers.tolist()]


def _material(number: int, colour: Sequence[float]) -> dict[str, object]:
    surface = {"baseColorFactor": [*colour, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9}
    return {"name": f"sand_{number}", "pbrMetallicRoughness": surface}


FORMAT = "regolith-studio-repose-export"
SERIES, SHAPE_TABLE, HEAP = "particles.pvd", "shapes.vtm", "heap.glb"
MJCF, USD = "heap.xml", "heap.usda"
PARAVIEW_SCRIPT, OVITO_SCRIPT = "show_in_paraview.py", "ovito/load_shapes.py"

_README = """{name}: {n:,} particles, {moments} moments; written by Regolith Studio {version}.
Lengths are in metres, times in seconds, z is up (y in heap.glb). A shape has an equivalent diameter of 1.

ParaView: in this folder, paraview --script=show_in_paraview.py
Or open particles.pvd and shapes.vtm, hide the shapes, and show the particles as "3D Glyphs".
Orientation array: "orientation", mode Quaternion (w, x, y, z). Scale array: "diameter" with a factor of 1.
Glyph type: the shapes as "Pipeline Connection", with the glyph table by the index array "shape", and each
block of the shapes as one entry. For spheres the glyph type Sphere, which has a diameter of 1, will do.

OVITO: open the series ovito/particles.*.xyz, which has radius and orientation. For the shapes, load
ovito/<type>.stl as the shape of each particle type; or run ovito/load_shapes.py with OVITO's Python, which
saves all that as ovito/heap.ovito for the program with the window.

heap.glb is the last moment: one node for each particle, which share the meshes of the shapes. Blender and
other viewers of glTF open it; where a heap of centimetres is cut off, reduce the near clipping distance.

heap.xml (MuJoCo; millimetres, milligrams, milliseconds, or as it says) and heap.usda (USD physics; metres and
kilograms) are the last moment of polyhedra as rigid bodies of convex hulls, with mass, inertia, friction and
the plate. Some programs take hulls of at most 64 vertices; the largest here has {largest}.

export.json names the run, the versions, and the SHA-256 of all files.
"""

_PARAVIEW = '''"""Show the particles with their shapes; run it with ParaView, in this folder."""

from pathlib import Path

from paraview import simple

here = Path(globals().get("__file__", "script")).resolve().parent  # the window of ParaView sets no __file__
particles = simple.PVDReader(registrationName="particles", FileName=str(here / "particles.pvd"))
shapes = simple.XMLMultiBlockDataReader(registrationName="shapes", FileName=[str(here / "shapes.vtm")])
view = simple.GetActiveViewOrCreate("RenderView")
glyphs = simple.Show(particles, view)
glyphs.SetRepresentationType("3D Glyphs")
glyphs.Orient, glyphs.OrientationMode, glyphs.SelectOrientationVectors = 1, "Quaternion", "orientation"
glyphs.Scaling, glyphs.ScaleMode, glyphs.SelectScaleArray = 1, "Magnitude", "diameter"
glyphs.ScaleFactor = 1.0
glyphs.GlyphType = "Pipeline Connection"
glyphs.GlyphType.Input = shapes
glyphs.UseGlyphTable, glyphs.UseCompositeGlyphTable, glyphs.GlyphTableIndexArray = 1, 1, "shape"
simple.ColorBy(glyphs, ("POINTS", "shape"))
scene = simple.GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
scene.GoToLast()
camera = view.GetActiveCamera()
camera.SetPosition(0.0, -1.0, 0.4)
camera.SetFocalPoint(0.0, 0.0, 0.0)
camera.SetViewUp(0.0, 0.0, 1.0)
simple.ResetCamera(view)
simple.Render(view)
'''

_OVITO = '''"""Load particles and shapes and save them as heap.ovito; run it with OVITO's Python."""

from pathlib import Path

import ovito
from ovito.io import import_file

here = Path(__file__).resolve().parent
pipeline = import_file(str(here / "particles.*.xyz"))
types = pipeline.source.data.particles_.particle_types_
for each in list(types.types):
    if (here / f"{each.name}.stl").is_file():
        types.type_by_id_(each.id).load_shape(str(here / f"{each.name}.stl"))
pipeline.add_to_scene()
ovito.scene.save(str(here / "heap.ovito"))
'''


@dataclass(frozen=True)
class ReposeExport:
    """A written export of a run.

    - ``folder``: where it is.
    - ``times``: of its moments, in seconds.
    - ``n_particles``: number of particles of the last moment.
    - ``files``: relative paths.
    """

    folder: Path
    times: tuple[float, ...]
    n_particles: int
    files: tuple[str, ...]


def export_repose(run: Path | str, folder: Path | str, every: int = 1) -> ReposeExport:
    """Write a run as a series for ParaView, a series for OVITO, and its last moment as GLB.

    Parameters
    ----------
    run
        Folder of a run that was finished or stopped.
    folder
        New, empty, or holding an earlier export of a run and nothing else.
    every
        Write every so many snapshots; the last moment is always written.

    Raises
    ------
    RegolithError
        If there is no such run, or the folder holds anything else or cannot be written.
    """
    return cast("ReposeExport", result_of(repose_export_steps(Path(run), Path(folder), every)))


def repose_export_steps(run_folder: Path, folder: Path, every: int = 1) -> Steps:
    """Job of :func:`export_repose`; returns :class:`ReposeExport`."""
    if every < 1:
        raise InputError(f"The value of every must be at least 1, got {every}.")
    run, target = read_run(run_folder), Path(os.path.realpath(folder))
    states = _states(run_folder, every)
    if target.is_relative_to(os.path.realpath(run_folder)):
        raise FileError(f"{folder} is in the folder of the run; choose another one.")
    shapes = run_shapes(run)
    yield Started(N_("Exporting the run"), len(states) + 1)
    try:
        recover_folder(target)
        check_export_folder(target, FORMAT)
        with hidden_folder(target) as stage:
            writer = _StageWriter(stage, run, shapes)
            for number, path in enumerate(states):
                writer.add(read_final_state(path))
                yield Progress(number + 1, len(states) + 1)
            files = writer.finish(states, every)
            exchange(stage, target)
    except OSError as error:
        raise FileError(f"The export {folder} cannot be written ({os_error_reason(error)}).") from error
    return ReposeExport(target, tuple(writer.times), writer.n_particles, tuple(files))


def _states(folder: Path, every: int) -> list[Path]:
    """Every so many snapshots of a run, and its last moment."""
    snapshots = snapshot_files(folder)
    if (folder / FINAL).is_file():
        snapshots.append(folder / FINAL)
    if not snapshots:
        raise FileError(f"{folder} holds no snapshots of its run.")
    return [*snapshots[:-1:every], snapshots[-1]]


class _StageWriter:
    """Writes the files of an export into a staged folder."""

    def __init__(self, stage: Path, run: RunSummary, shapes: RunShapes) -> None:
        self.times: list[float] = []
        self.n_particles = self._largest = 0
        self._stage, self._run, self._shapes = stage, run, shapes
        self._last: ParticleState | None = None
        for name in ("particles", "shapes", "ovito"):
            (stage / name).mkdir()

    def add(self, pile: ParticleState) -> None:
        """Write a moment; it replaces the last one if it is not later."""
        if self.times and pile.time <= self.times[-1]:
            self.times.pop()
        number = len(self.times)
        _write_poly_data(self._stage / _moment(number), _points(self._shapes, pile))
        write_in_stage(self._stage, f"ovito/particles.{number:06d}.xyz", extended_xyz(self._shapes, pile))
        self.times.append(pile.time)
        self.n_particles, self._last = len(pile), pile

    def finish(self, states: Sequence[Path], every: int) -> list[str]:
        """Write the rest; relative paths of all files."""
        names = self._shapes.names
        for name, mesh in zip(names, self._shapes.meshes, strict=True):
            _write_poly_data(self._stage / f"shapes/{name}.vtp", _surface(mesh))
            if not self._shapes.spheres:
                self._write(f"ovito/{name}.stl", stl_bytes(2.0 * mesh.triangles, name))
        self._write(SERIES, _collection(self.times))
        self._write(SHAPE_TABLE, _blocks(names))
        self._write(PARAVIEW_SCRIPT, _PARAVIEW.encode("ascii"))
        self._write(OVITO_SCRIPT, _OVITO.encode("ascii"))
        if self._last is not None:
            self._write(HEAP, heap_glb(self._shapes, self._last, [_linear(each) for each in COLOURS]))
            if not self._shapes.spheres:
                shapes = heap_shapes(self._run)
                self._largest = max(len(part.vertices) for each in shapes for part in each.parts)
                self._write(MJCF, heap_mjcf(self._run, shapes, self._last))
                self._write(USD, heap_usd(self._run, shapes, self._last))
        self._write(README, self._readme().encode("utf-8", "replace"))
        hashes = {
            path.relative_to(self._stage).as_posix(): _sha256(path)
            for path in sorted(self._stage.rglob("*"))
            if path.is_file()
        }
        record = self._record(states, every) | {"files": hashes}
        self._write(RECORD, canonical_json(record).encode("ascii"))
        return [*hashes, RECORD]

    def _readme(self) -> str:
        return _README.format(
            name=self._run.folder.resolve().name,
            n=self.n_particles,
            moments=len(self.times),
            largest=self._largest,
            version=__version__,
        )

    def _record(self, states: Sequence[Path], every: int) -> dict[str, object]:
        """What the export was made from."""
        folder, document = self._run.folder, self._run.document
        inputs = [folder / DOCUMENT, *states, *([] if self._shapes.spheres else [folder / SHAPES])]
        kept = ("state", "dataset", "engine", "software", "case", "measurement")
        return {
            "format": FORMAT,
            "schema_version": 1,
            "software": f"regolith-studio {__version__}",
            "length_unit": "m",
            "every": every,
            "times_s": self.times,
            "n_particles": self.n_particles,
            "run": {key: document.get(key) for key in kept},
            "inputs": {path.relative_to(folder).as_posix(): _sha256(path) for path in inputs},
        }

    def _write(self, name: str, content: bytes) -> None:
        write_in_stage(self._stage, name, content)


def _points(shapes: RunShapes, pile: ParticleState) -> pv.PolyData:
    """Particles as points with the arrays that glyphs need."""
    data: pv.PolyData = pv.PolyData(pile.points.astype(np.float32))
    data.point_data["diameter"] = pile.diameters.astype(np.float32)
    data.point_data["orientation"] = pile.orientations.astype(np.float32)
    data.point_data["shape"] = shapes.index(pile).astype(np.int32)
    data.field_data["TimeValue"] = [pile.time]
    data.field_data["phase"] = [pile.phase]
    if np.isfinite(pile.wall):
        data.field_data["cylinder_rim"] = [pile.wall]
    return data


def _surface(mesh: Mesh) -> pv.PolyData:
    cells = np.column_stack([np.full(len(mesh.faces), 3), mesh.faces]).ravel()
    surface: pv.PolyData = pv.PolyData(mesh.vertices.astype(np.float32), faces=cells)
    return surface


def _write_poly_data(path: Path, data: pv.PolyData) -> None:
    """Write a VTP file."""
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(data)
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    if not writer.Write():
        raise FileError(f"The file {path} cannot be written.")


def _moment(number: int) -> str:
    return f"particles/particles_{number:06d}.vtp"


def _collection(times: Sequence[float]) -> bytes:
    """ParaView's list of the files of a series, with their times."""
    rows = [
        f'    <DataSet timestep="{time!r}" part="0" file={quoteattr(_moment(number))}/>'
        for number, time in enumerate(times)
    ]
    return _vtk_xml("Collection", "Collection", rows)


def _blocks(names: Sequence[str]) -> bytes:
    """The shapes as blocks of one data set."""
    rows = [
        f'    <DataSet index="{index}" name={quoteattr(name)} file={quoteattr(f"shapes/{name}.vtp")}/>'
        for index, name in enumerate(names)
    ]
    return _vtk_xml("vtkMultiBlockDataSet", "vtkMultiBlockDataSet", rows)


def _vtk_xml(kind: str, element: str, rows: Sequence[str]) -> bytes:
    head = f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian">'
    return "\n".join([head, f"  <{element}>", *rows, f"  </{element}>", "</VTKFile>", ""]).encode("ascii")


def _linear(colour: str) -> list[float]:
    """Linear red, green and blue of a colour of the screen (sRGB), as glTF stores them."""
    screen = np.array(pv.Color(colour).float_rgb)
    linear = np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055) ** 2.4)
    return [round(value, 5) for value in linear.tolist()]


def _sha256(path: Path) -> str:
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
