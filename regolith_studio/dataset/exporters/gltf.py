"""glTF for Blender and other viewers: the drawn particles as instances of the shapes."""

import json

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, shape_names
from regolith_studio.dataset.sampling import pack_on_lattice
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import Polyhedron
from regolith_studio.io.triangles import Z_UP_TO_Y_UP, MeshBuffer, glb_bytes
from regolith_studio.messages import N_

_NOTE = b"""particles.glb: lengths are in metres, as glTF demands; scale the node 'particles' up to see it.
The file is y up as glTF demands; Blender turns it back to z up. Facets are shaded flat.
Of compounds the surface of the union is drawn.
Each particle is a node with its mesh's key, diameter and dataset name under 'extras'."""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    keys, meshes = shape_names(dataset), MeshBuffer()
    for key, one in zip(keys, dataset.representatives, strict=True):
        meshes.add(key, *_corners(one.shape))
    content = {
        "asset": {"version": "2.0", "generator": "regolith-studio"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": _nodes(dataset, options, keys),
        "materials": [
            {
                "name": "regolith",
                "pbrMetallicRoughness": {
                    "baseColorFactor": [0.5, 0.48, 0.45, 1.0],
                    "metallicFactor": 0.0,
                    "roughnessFactor": 0.9,
                },
            }
        ],
        **meshes.document(),
    }
    text = json.dumps(content, separators=(",", ":"), allow_nan=False).encode("utf-8")
    return {"particles.glb": glb_bytes(text, meshes.binary), NOTES: _NOTE}


def _nodes(dataset: Dataset, options: ExportOptions, keys: list[str]) -> list[dict[str, object]]:
    bodies = pack_on_lattice(dataset, options)
    nodes: list[dict[str, object]] = [
        {"name": "particles", "rotation": list(Z_UP_TO_Y_UP), "children": list(range(1, len(bodies) + 1))}
    ]
    for index, (which, place, turn, scale) in enumerate(
        zip(bodies.class_index, bodies.position, bodies.orientation, bodies.scale, strict=True)
    ):
        nodes.append(
            {
                "name": f"particle_{index:06d}",
                "mesh": int(which),
                "translation": place.tolist(),
                "rotation": turn[[1, 2, 3, 0]].tolist(),
                "scale": [float(scale)] * 3,
                "extras": {
                    "shape": keys[which],
                    "name": dataset.representatives[which].name,
                    "diameter_um": float(bodies.diameter[index] * 1e6),
                },
            }
        )
    return nodes


def _corners(shape: Polyhedron) -> tuple[FloatArray, FloatArray]:
    """Three corners a triangle and the normal of its facet at each, shape (3 t, 3)."""
    normals = shape.facet_normals[shape.triangle_facets]
    return shape.mesh.triangles.reshape(-1, 3), np.repeat(normals, 3, axis=0)


_LOAD = "blender --python-expr \"import bpy; bpy.ops.import_scene.gltf(filepath=r'{folder}/particles.glb')\""

EXPORTER = Exporter(
    key="gltf",
    label="glTF (Blender)",
    general=True,
    units=N_("m, coarse graining applied; y up"),
    carries=(N_("drawn particles: shape, size, orientation"), N_("flat shading of facets")),
    loses=(
        N_("exact half-spaces: float32 triangles"),
        N_("weights and size distributions: only a sample is drawn"),
    ),
    load_command=_LOAD,
    files=_files,
    convex_only="",
)
