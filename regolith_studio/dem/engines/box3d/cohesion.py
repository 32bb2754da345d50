"""Cohesion between particles of Box3D."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from robox3d._ffi import ffi, lib

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.cohesion import RANGE, pull_off_forces, pulls

CONTACT = np.dtype(
    {
        "names": ["contact", "first", "second", "manifold"],
        "formats": ["i4", "i4", "i4", "u8"],
        "offsets": [0, 12, 20, 32],
        "itemsize": ffi.sizeof("b3ContactData"),
    }
)
POINTS, POINT_FLOATS, NORMAL, COUNT = 4, 14, 56, 66
"""Points of a manifold, floats of each (two anchors, then the gap), and where its normal and count stand."""


class Cohesion:
    """Pulls together what touches."""

    def __init__(self, prepared: PreparedCase, bodies: Sequence[Any], shapes: Sequence[Any]) -> None:
        self.force, self.sizes = pull_off_forces(prepared)
        self.bodies, self.capacity = bodies, 0
        numbers = [shape.index1 for shape in shapes]
        self.particle = np.full(max(numbers) + 1, -1)
        self.particle[numbers] = np.arange(len(shapes))

    def pull(self) -> None:
        """Set the forces of the next step."""
        first, second, manifolds = self._touching()
        gaps = manifolds[:, : POINTS * POINT_FLOATS].reshape(-1, POINTS, POINT_FLOATS)
        counts = manifolds.view(np.int32)[:, COUNT]
        near = (np.arange(POINTS) < counts[:, None]) & (gaps[:, :, 6] <= RANGE)
        touching = near.any(axis=1)
        weights = near[touching] / near[touching].sum(axis=1)[:, None]
        anchors = np.einsum("np,npk->nk", weights, gaps[touching, :, :6])
        pairs = np.column_stack([first[touching], second[touching]])
        normals = manifolds[touching, NORMAL : NORMAL + 3]
        forces = pulls(self.force, self.sizes, pairs, normals, (anchors[:, :3], anchors[:, 3:]))
        for body, force in zip(self.bodies, forces.tolist(), strict=True):
            lib.b3Body_ApplyForceToCenter(body, force[:3], True)
            lib.b3Body_ApplyTorque(body, force[3:], True)

    def _touching(self) -> tuple[Any, Any, Any]:
        """First and second particle of each pair that Box3D keeps, shape (m,), and its manifold as floats."""
        capacities = [lib.b3Body_GetContactCapacity(body) for body in self.bodies]
        if sum(capacities) > self.capacity:
            self.capacity = 2 * sum(capacities)
            self.buffer = ffi.new("b3ContactData[]", self.capacity)
        count = 0
        for body, capacity in zip(self.bodies, capacities, strict=True):
            count += lib.b3Body_GetContactData(body, self.buffer + count, capacity) if capacity else 0
        if count == 0:
            return np.zeros(0, dtype=int), np.zeros(0, dtype=int), np.zeros((0, COUNT + 1), dtype=np.float32)
        rows = np.frombuffer(ffi.buffer(self.buffer, count * CONTACT.itemsize), dtype=CONTACT)
        rows = rows[np.unique(rows["contact"], return_index=True)[1]]  # both bodies of a pair list it
        first, second = self._particles(rows["first"]), self._particles(rows["second"])
        pairs = (first >= 0) & (second >= 0)
        size = ffi.sizeof("b3Manifold")
        manifolds = b"".join(
            ffi.buffer(ffi.cast("char*", address), size)[:] for address in rows["manifold"][pairs].tolist()
        )
        floats = np.frombuffer(manifolds, dtype=np.float32).reshape(-1, size // 4)
        return first[pairs], second[pairs], floats

    def _particles(self, shapes: Any) -> Any:
        """Of each shape its particle, -1 for walls."""
        inside = shapes < len(self.particle)
        return np.where(inside, self.particle[np.where(inside, shapes, 0)], -1)
