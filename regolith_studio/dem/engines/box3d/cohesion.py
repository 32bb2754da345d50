"""Cohesion between particles of Box3D: a pull-off force along the normal of each pair that touches."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from robox3d._ffi import ffi, lib

from regolith_studio.dem.case import PreparedCase, bond_number

RANGE = 0.004
"""Gap in mean diameters across which particles attract: Box3D keeps the points of a contact within it."""
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
    """Pulls together what touches, with one force for a pair, wherever and in how many points it touches.

    The force is the Bond number times the weight of a mean particle, in proportion to the reduced diameter of
    the pair, as that of Johnson, Kendall and Roberts is.
    """

    def __init__(self, prepared: PreparedCase, bodies: Sequence[Any], shapes: Sequence[Any]) -> None:
        contact, test = prepared.case.contact, prepared.case.test
        mean = prepared.mean_diameter
        bond = bond_number(prepared.surface_energy, mean, contact.density, test.gravity)
        self.force, self.sizes = bond * np.pi / 6, prepared.diameters / mean
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
        first, second = first[touching], second[touching]
        reduced = 2 * self.sizes[first] * self.sizes[second] / (self.sizes[first] + self.sizes[second])
        pulls = (self.force * reduced)[:, None] * manifolds[touching, NORMAL : NORMAL + 3]
        forces = np.zeros((len(self.bodies), 6))
        np.add.at(forces, first, np.column_stack([pulls, np.cross(anchors[:, :3], pulls)]))
        np.add.at(forces, second, np.column_stack([-pulls, -np.cross(anchors[:, 3:], pulls)]))
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
