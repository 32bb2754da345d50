"""From a mesh as scanned to one closed body that faces outwards, with a sentence for each change.

Split non-manifold edges, where more than two triangles meet, so that each edge has two.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.hole_filling import fill_holes, require_closed_volume
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.mesh_health import MeshHealth, body_volumes, inspect, unit_size
from regolith_studio.geometry.topology import EdgeTable, edge_table, find_bodies, merged_vertices, neighbours
from regolith_studio.messages import N_, Message, Number, count_message

MIN_ROUNDS = 10
MAX_FACES_IN_ROUNDS = 2_000_000
"""Faces of all rounds together after the first ones: a few seconds."""


def split_non_manifold_edges(vertices: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    """Mesh data in which each pair of triangles at a non-manifold edge has an edge of its own.

    The pairs are those that bound a wedge of the solid; the surface in space stays the same.
    Vertices are doubled where that parts the pairs; where the surface closes again about both ends
    of the edge, each pair gets its own vertex in the middle of it. The faces must run
    counter-clockwise seen from outside. A triangle that finds no partner is left with an open edge.

    Raises GeometryError if that would take too much work.
    """
    vertices, faces = _split_vertices(vertices, faces)
    rounds = work = 0
    while (table := edge_table(faces, len(vertices))).non_manifold_edges:
        rounds, work = rounds + 1, work + len(faces)
        if rounds > MIN_ROUNDS and work > MAX_FACES_IN_ROUNDS:
            raise GeometryError("The mesh is a tangle: too many of its faces meet at the same edges.")
        vertices, faces = _insert_midpoints(vertices, faces, table)
    return vertices, faces


def wedge_neighbours(vertices: FloatArray, faces: IntArray, table: EdgeTable, across: IntArray) -> IntArray:
    """`across` with the triangles at non-manifold edges paired so that each pair bounds a wedge of the solid.

    The triangles must run counter-clockwise seen from outside. About an edge, in the order of their
    angle, a triangle that runs along the edge has the solid behind it, so its partner is the one
    before it, if that runs the other way.
    """
    across = across.copy()
    halves = np.argsort(table.edge, kind="stable")
    halves = halves[table.uses[table.edge[halves]] > 2]
    edge = table.edge[halves]
    low, high = vertices[table.ends[edge, 0]], vertices[table.ends[edge, 1]]
    thirds = vertices[faces.ravel()[halves - halves % 3 + (halves + 2) % 3]] - low
    halves = halves[np.lexsort((_angles(high - low, thirds), edge))]
    rings = np.split(halves, np.flatnonzero(np.diff(edge)) + 1)
    pairs = [pair for ring in rings for pair in _wedges(ring.tolist(), table.forward[ring].tolist())]
    half, behind = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    across[half], across[behind] = behind, half
    return across


def _wedges(ring: list[int], forward: list[bool]) -> list[tuple[int, int]]:
    """Forward half-edges of a ring in angular order, each with the backward one before it.

    They pair as brackets do, a backward one opening and a forward one closing, around the ring.
    """
    pairs, early, opened = [], [], []
    for half, closes in zip(ring, forward, strict=True):
        if not closes:
            opened.append(half)
        elif opened:
            pairs.append((half, opened.pop()))
        else:
            early.append(half)
    return pairs + list(zip(early, reversed(opened), strict=False))


def _angles(axes: FloatArray, spokes: FloatArray) -> FloatArray:
    """Angle of each spoke about its axis, counter-clockwise seen against it; all of shape (n, 3)."""
    # Neither vector has length 1: each product is to be divided by one length, and both are multiplied by the
    # other instead.
    first = np.cross(axes, np.eye(3)[np.argmin(np.abs(axes), axis=1)])
    second = np.cross(axes, first)
    return np.asarray(
        np.arctan2(
            (spokes * second).sum(axis=1) * np.linalg.norm(first, axis=1),
            (spokes * first).sum(axis=1) * np.linalg.norm(second, axis=1),
        )
    )


def _split_vertices(vertices: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    table = edge_table(faces, len(vertices))
    corner = _fans(faces, wedge_neighbours(vertices, faces, table, neighbours(table)))
    _, first, inverse = np.unique(corner, return_index=True, return_inverse=True)
    return vertices[faces.ravel()[first]], inverse.reshape(-1, 3).astype(np.int64)


def _fans(faces: IntArray, across: IntArray) -> IntArray:
    """A number for each corner, shape (3 m,): equal for corners at a vertex joined by neighbours."""
    half = np.flatnonzero(across >= 0)
    other = across[half]
    onward = half - half % 3 + (half + 1) % 3
    other_onward = other - other % 3 + (other + 1) % 3
    same = faces.ravel()[half] == faces.ravel()[other]
    rows = np.concatenate([half, onward])
    columns = np.concatenate([np.where(same, other, other_onward), np.where(same, other_onward, other)])
    links = coo_array((np.ones(len(rows)), (rows, columns)), (faces.size,) * 2)
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)


def _insert_midpoints(vertices: FloatArray, faces: IntArray, table: EdgeTable) -> tuple[FloatArray, IntArray]:
    """Halve the triangles at non-manifold edges, at most one edge of each triangle at a time."""
    across = wedge_neighbours(vertices, faces, table, neighbours(table))
    touched: set[int] = set()
    points: list[FloatArray] = []
    halves: list[tuple[int, int, int]] = []
    order = np.argsort(table.edge, kind="stable")
    first = np.cumsum(table.uses) - table.uses
    for edge in np.flatnonzero(table.uses > 2):
        around = order[first[edge] : first[edge] + table.uses[edge]]
        if touched.intersection((around // 3).tolist()):
            continue
        touched.update((around // 3).tolist())
        middle = vertices[table.ends[edge]].mean(axis=0)
        number: dict[int, int] = {}
        for half in around.tolist():
            number[half] = number.get(int(across[half]), len(vertices) + len(points))
            if number[half] == len(vertices) + len(points):
                points.append(middle)
            halves += _split_triangle(faces, half, number[half])
    kept = np.delete(faces, sorted(touched), axis=0)
    return np.concatenate([vertices, points]), np.concatenate([kept, np.array(halves, dtype=np.int64)])


def _split_triangle(faces: IntArray, half: int, middle: int) -> list[tuple[int, int, int]]:
    """The two triangles of a face whose half-edge gets a vertex in its middle."""
    face = faces[half // 3].tolist()
    a, b, c = (face[(half + step) % 3] for step in range(3))
    return [(a, middle, c), (middle, b, c)]


TOLERANCES = (1e-7, 1e-6, 1e-5)
"""Shares of the mesh's size within which the vertices of an open mesh may be joined."""

MIN_CHECKED_SHARE = 0.002
"""Up to this share of the surface holes are closed without asking whether there is a body about them."""

MAX_TWISTED_SHARE = 0.05
"""A mesh from which more of the surface must be cut to have two sides is one-sided."""

TWIST_ROUNDS = 5

MAX_FOLDS = 50
"""How many times the surface of its convex hull a body may have: a line crosses it twice that often."""

MIN_VOLUME = 1e-9
"""Share of its bounding cube that a mesh must enclose, or it is flat."""


@dataclass(frozen=True)
class Repair:
    """A repaired mesh and what was done to it.

    - ``mesh``: closed, of one body, facing outwards; the given mesh itself if nothing was wrong.
    - ``health_before``, ``health_after``: what the inspection found.
    - ``actions``: one plain sentence for each change; empty if there was none.
    - ``filled_area``, ``filled_share``: area of the triangles that close holes, in the square of the mesh's
      unit; its share of the surface.
    - ``holes``, ``filling_faces``: how many holes were closed, and by how many triangles: the last ones of
      `mesh`.
    - ``dropped_bodies``, ``kept_volume_share``: how many bodies were left out, and the share of the volume
      of all that the kept one has.
    - ``given``: the mesh before the repair; ``None`` if nothing was changed.
    """

    mesh: Mesh
    health_before: MeshHealth
    health_after: MeshHealth
    actions: tuple[str, ...]
    filled_area: float = 0.0
    filled_share: float = 0.0
    holes: int = 0
    filling_faces: int = 0
    dropped_bodies: int = 0
    kept_volume_share: float = 1.0
    given: Mesh | None = None

    def as_dict(self) -> dict[str, Any]:
        """What was done, as numbers and sentences, ready for JSON; lengths in micrometres."""
        return {
            "actions": list(self.actions),
            "filled_holes": self.holes,
            "filled_area": self.filled_area,
            "filled_share": self.filled_share,
            "dropped_bodies": self.dropped_bodies,
            "kept_volume_share": self.kept_volume_share,
        }


@dataclass(frozen=True)
class _Draft:
    """Mesh data on their way, in unit size, with what has been done."""

    vertices: FloatArray
    faces: IntArray
    actions: tuple[str, ...] = ()
    numbers: Mapping[str, Any] = field(default_factory=dict)
    """Fields of :class:`Repair` that a step has found out."""

    def changed(
        self,
        action: str,
        *,
        vertices: FloatArray | None = None,
        faces: IntArray | None = None,
        **numbers: float,
    ) -> "_Draft":
        return replace(
            self,
            vertices=self.vertices if vertices is None else vertices,
            faces=self.faces if faces is None else faces,
            actions=(*self.actions, action) if action else self.actions,
            numbers={**self.numbers, **numbers},
        )


def repair(mesh: Mesh) -> Repair:
    """Make one sound body of a mesh: merge vertices, clean, keep the largest body, wind, close holes.

    Raises GeometryError with one sentence if nothing sound can be saved.
    """
    before = inspect(mesh)
    if not before.faces:
        raise GeometryError("The mesh has points but no faces: a point cloud encloses no particle.")
    if before.sound and not before.duplicate_faces:
        _require_volume(unit_size(mesh)[0], mesh.faces)
        return Repair(mesh, before, before, ())
    draft = _Draft(*unit_size(mesh))
    # Merging makes faces with two equal corners, and lets double faces of rounded triangle soups be seen as
    # such. Winding splits bodies that share an edge, so that it comes before bodies are counted; only the
    # largest needs its holes closed, and only a closed one has a sign of volume.
    for step in (
        _merge_equal_vertices,
        _drop_degenerate,
        _merge_near_vertices,
        _drop_duplicates,
        _wind,
        _keep_largest,
        _require_few_folds,
        _fill,
        _face_outwards,
    ):
        draft = step(draft)
    repaired = _in_frame_of_input(draft, mesh)
    after = inspect(repaired)
    if not after.sound:
        raise GeometryError(f"The mesh cannot be repaired: {_lower(after.problems[0])}")
    return Repair(repaired, before, after, draft.actions, given=mesh, **_in_unit_of(mesh, draft.numbers))


def _in_unit_of(mesh: Mesh, numbers: Mapping[str, Any]) -> dict[str, Any]:
    return {**numbers, "filled_area": numbers.get("filled_area", 0.0) * _size(mesh) ** 2}


def _merge_equal_vertices(draft: _Draft) -> _Draft:
    used = len(np.unique(draft.faces))
    vertices, faces = merged_vertices(draft.vertices, draft.faces)
    joined = used - len(vertices)
    template = N_("Joined {count} vertices with another at the same place.")
    action = Message(template, count=Number(joined, ",")) if joined else ""
    return draft.changed(action, vertices=vertices, faces=faces)


def _drop_degenerate(draft: _Draft) -> _Draft:
    a, b, c = draft.faces.T
    proper = (a != b) & (b != c) & (c != a)
    dropped = int(np.count_nonzero(~proper))
    if not proper.any():
        raise GeometryError("The mesh is a point or a line: none of its faces has an area.")
    one, many = N_("Removed 1 face without area."), N_("Removed {count} faces without area.")
    action = count_message(one, many, dropped) if dropped else ""
    return draft.changed(action, faces=draft.faces[proper])


def _drop_duplicates(draft: _Draft) -> _Draft:
    """Of faces on the same three vertices keep one, or none where they wall off nothing."""
    _, first, group, uses = np.unique(
        np.sort(draft.faces, axis=1), axis=0, return_index=True, return_inverse=True, return_counts=True
    )
    if len(first) == len(draft.faces):
        return draft
    group = group.ravel()
    double = uses > 1
    signs = np.bincount(group, _parity(draft.faces))
    inner = double & (signs == 0) & _closed_without(draft, double[group], first)
    kept = np.sort(first[~inner])
    if not len(kept):
        raise GeometryError("The mesh is a sheet with two sides and encloses no volume.")
    dropped = len(draft.faces) - len(kept)
    action = count_message(N_("Removed 1 double face."), N_("Removed {count} double faces."), dropped)
    return draft.changed(action, faces=draft.faces[kept])


def _parity(faces: IntArray) -> IntArray:
    """+1 for faces whose vertices are an even permutation of their sorted order, else -1."""
    a, b, c = faces.T
    # Of the three cyclic comparisons two hold for an even permutation, and one for an odd.
    return np.where((a < b).astype(int) + (b < c) + (c < a) == 2, 1, -1).astype(np.int64)


def _closed_without(draft: _Draft, double: BoolArray, first: IntArray) -> BoolArray:
    """For each group's first face whether no edge needs it: both other faces are there, or none is."""
    if double.all():
        return np.zeros(len(first), dtype=np.bool_)
    table = edge_table(draft.faces, len(draft.vertices))
    single = np.bincount(table.edge[np.repeat(~double, 3)], minlength=len(table.ends))
    return np.asarray(np.isin(single[table.edge.reshape(-1, 3)[first]], (0, 2)).all(axis=1))


def _merge_near_vertices(draft: _Draft) -> _Draft:
    """Join near vertices where that closes far more edges than it makes non-manifold."""
    table = edge_table(draft.faces, len(draft.vertices))
    best, least = draft, table.open_edges
    for tolerance in TOLERANCES if least else ():
        vertices, faces = merged_vertices(draft.vertices, draft.faces, tolerance)
        a, b, c = faces.T
        faces = faces[(a != b) & (b != c) & (c != a)]
        near = edge_table(faces, len(vertices))
        non_manifold = max(near.non_manifold_edges - table.non_manifold_edges, 0)
        if len(faces) and near.open_edges < least and 4 * non_manifold < table.open_edges - near.open_edges:
            joined = len(draft.vertices) - len(vertices)
            near_by = f"within {tolerance:.0e} of the mesh's size"
            text = f"Joined {_count(joined, 'vertex', 'vertices')} with another {near_by}."
            best, least = draft.changed(text, vertices=vertices, faces=faces), near.open_edges
    return best


def _wind(draft: _Draft) -> _Draft:
    """Turn faces so that neighbours agree, the fewer of each patch; then take non-manifold edges apart."""
    draft = _make_orientable(draft)
    table = edge_table(draft.faces, len(draft.vertices))
    parts = find_bodies(neighbours(table), table.forward)
    share = np.bincount(parts.body, parts.turned) / np.bincount(parts.body)
    turned = parts.turned ^ (share > 0.5)[parts.body]
    faces = np.where(turned[:, None], draft.faces[:, ::-1], draft.faces)
    count = int(np.count_nonzero(turned))
    one = N_("Reoriented 1 face.")
    many = N_("Reoriented {count} faces.")
    text = count_message(one, many, count) if count else ""
    draft = draft.changed(text, faces=faces)
    return _split_non_manifold(draft) if table.non_manifold_edges else draft


def _make_orientable(draft: _Draft) -> _Draft:
    """Cut out the few faces over which a surface becomes one-sided, if they are few."""
    area = Mesh(draft.vertices, draft.faces).face_areas
    kept = np.arange(len(draft.faces))
    for _ in range(TWIST_ROUNDS):
        table = edge_table(draft.faces[kept], len(draft.vertices))
        across = neighbours(table)
        parts = find_bodies(across, table.forward)
        if not parts.conflicts:
            break
        half = np.flatnonzero(across >= 0)
        turn = parts.turned[half // 3] ^ parts.turned[across[half] // 3]
        clash = half[(table.forward[half] == table.forward[across[half]]) != turn]
        kept = np.delete(kept, np.unique(clash // 3))
        if area[kept].sum() < (1 - MAX_TWISTED_SHARE) * area.sum():
            raise GeometryError("The mesh is one-sided like a Möbius strip: its faces have no outside.")
    else:
        raise GeometryError("The mesh is one-sided like a Möbius strip: its faces have no outside.")
    cut = len(draft.faces) - len(kept)
    template = N_("Removed {count} faces that made the surface non-orientable.")
    text = Message(template, count=Number(cut, ",")) if cut else ""
    return draft.changed(text, faces=draft.faces[kept])


def _split_non_manifold(draft: _Draft) -> _Draft:
    """Make every edge one of two faces: each wedge of the solid at a non-manifold edge gets its own."""
    # Which pairs of faces bound a wedge of the solid is seen only from faces that look outwards.
    inside_out = float(_whole_volume(draft)) < 0.0
    faces = draft.faces[:, ::-1] if inside_out else draft.faces
    count = edge_table(faces, len(draft.vertices)).non_manifold_edges
    vertices, faces = split_non_manifold_edges(draft.vertices, faces)
    text = count_message(
        N_("Split the surface along 1 edge of more than two faces."),
        N_("Split the surface along {count} edges of more than two faces."),
        count,
    )
    return draft.changed(text, vertices=vertices, faces=faces[:, ::-1] if inside_out else faces)


def _whole_volume(draft: _Draft) -> float:
    return float(body_volumes(draft.vertices, draft.faces, np.zeros(len(draft.faces), dtype=np.int64))[0])


def _keep_largest(draft: _Draft) -> _Draft:
    table = edge_table(draft.faces, len(draft.vertices))
    parts = find_bodies(neighbours(table), table.forward)
    if parts.count == 1:
        return draft
    volumes = np.abs(body_volumes(draft.vertices, draft.faces, parts.body))
    largest = int(np.argmax(volumes))
    share = volumes[largest] / volumes.sum() if volumes.sum() > 0.0 else 1.0
    text = Message(
        N_("Kept the largest of {count} bodies, with {share} of their volume."),
        count=Number(parts.count, ","),
        share=_percent(share),
    )
    return draft.changed(
        text,
        faces=draft.faces[parts.body == largest],
        dropped_bodies=parts.count - 1,
        kept_volume_share=float(share),
    )


def _require_few_folds(draft: _Draft) -> _Draft:
    """Refuse a tangle before the work that grows with the square of how often a line crosses it."""
    used = Mesh(draft.vertices[np.unique(draft.faces)], draft.faces[:0])
    try:
        folds = Mesh(draft.vertices, draft.faces).surface_area / used.hull.surface_area
    except GeometryError:  # flat
        return draft
    if folds > MAX_FOLDS:
        raise GeometryError(
            f"The mesh is a tangle: its faces have {folds:,.0f} times the surface of a body around them."
        )
    return draft


def _fill(draft: _Draft) -> _Draft:
    holes = fill_holes(draft.vertices, draft.faces)
    if not holes.count:
        return draft
    if not (edge_table(holes.faces, len(holes.vertices)).uses == 2).all():
        # The middle of a fan is a new corner, so that no inner edge of it can be one of the mesh already.
        holes = fill_holes(draft.vertices, draft.faces, only_fans=True)
    whole = Mesh(holes.vertices, holes.faces).surface_area
    share = holes.area / whole if whole > 0.0 else 1.0
    if share > MIN_CHECKED_SHARE:
        require_closed_volume(Mesh(holes.vertices, holes.faces), len(holes.faces) - len(draft.faces), share)
    text = count_message(
        N_("Filled 1 hole with {share} of the surface."),
        N_("Filled {count} holes with {share} of the surface."),
        holes.count,
        share=_percent(share),
    )
    return draft.changed(
        text,
        vertices=holes.vertices,
        faces=holes.faces,
        filled_area=holes.area,
        filled_share=share,
        holes=holes.count,
        filling_faces=len(holes.faces) - len(draft.faces),
    )


def _face_outwards(draft: _Draft) -> _Draft:
    _require_volume(draft.vertices, draft.faces)
    if Mesh(draft.vertices, draft.faces).volume > 0.0:
        return draft
    return draft.changed(N_("Reoriented all faces: the normals pointed inwards."), faces=draft.faces[:, ::-1])


def _require_volume(vertices: FloatArray, faces: IntArray) -> None:
    if abs(Mesh(vertices, faces).volume) < MIN_VOLUME:
        raise GeometryError("The mesh is flat and encloses no volume.")


def _in_frame_of_input(draft: _Draft, mesh: Mesh) -> Mesh:
    """The draft at the place and size of the given mesh, without vertices that no face uses."""
    points = mesh.vertices[np.unique(mesh.faces)]
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    used, compact = np.unique(draft.faces, return_inverse=True)
    return Mesh(draft.vertices[used] * _size(mesh) + middle, compact.reshape(-1, 3))


def _size(mesh: Mesh) -> float:
    points = mesh.vertices[np.unique(mesh.faces)]
    return float((points.max(axis=0) - points.min(axis=0)).max()) or 1.0


def _percent(share: float) -> str:
    if share > 0.999:
        # Three digits would say 100 %, as if nothing had been left out.
        return "over 99.9 %"
    return Number(100 * share, ".3g", " %") if share > 0.9 else Number(100 * share, ".2g", " %")


def _count(count: int, one: str, many: str) -> str:
    return f"{count:,} {one if count == 1 else many}"


def _lower(sentence: str) -> str:
    return sentence[0].lower() + sentence[1:]
