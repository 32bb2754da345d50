"""Distances between fit and particle, computed in the background and kept while both are shown."""

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QObject, Signal

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.jobs.events import Job, Started, Steps
from regolith_studio.messages import N_
from regolith_studio.scene.distance import signed_distances

Follow = Callable[[Job, Callable[[Any], None], Callable[[str], None]], None]
"""Submits a job with functions that show its result, or the sentence of its failure."""


class Distances(QObject):
    """The last distances; ``measured`` is emitted for new ones, ``refused`` with the reason for none.

    Parameters
    ----------
    follow
        Does the work.
    """

    measured = Signal()
    refused = Signal(str)

    def __init__(self, follow: Follow, parent: QObject) -> None:
        super().__init__(parent)
        self._follow = follow
        self._known: tuple[Mesh, Mesh, FloatArray] | None = None
        self._wanted: tuple[Mesh, Mesh] | None = None

    def between(self, fit: Mesh, particle: Mesh) -> FloatArray | None:
        """Of each vertex of the fit, shape (n,), positive outside; nothing while they are being measured."""
        if self._known is not None and self._known[0] is fit and self._known[1] is particle:
            return self._known[2]
        if self._wanted is None or self._wanted[0] is not fit or self._wanted[1] is not particle:
            self._wanted = fit, particle
            job = Job(measure_distances, (fit, particle))
            self._follow(job, lambda found: self._take(fit, particle, found), self.refused.emit)
        return None

    def _take(self, fit: Mesh, particle: Mesh, found: FloatArray) -> None:
        self._known = fit, particle, found
        self.measured.emit()


def measure_distances(fit: Mesh, particle: Mesh) -> Steps:
    """A job: :func:`~regolith_studio.scene.distance.signed_distances` of a fit's vertices."""
    yield Started(N_("Measuring distances"))
    return signed_distances(fit.vertices, particle)
