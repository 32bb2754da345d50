"""The studies of sections 3.1 and 3.2 over a whole sample."""

from collections.abc import Sequence
from typing import Any

from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.coarsening import CoarseningOrder
from regolith_studio.jobs.events import Started, Steps


def study_lmax(particles: Sequence[Particle], **options: Any) -> Steps:
    """Fig. 3 for `particles`; returns an ``LmaxStudy``."""
    raise NotImplementedError
    yield Started("Study of l_max")


def study_coarsening(particles: Sequence[Particle], order: CoarseningOrder, **options: Any) -> Steps:
    """Fig. 8 for `particles`; returns a ``CoarseningStudy``."""
    raise NotImplementedError
    yield Started("Study of the loss weights")
