"""The results of the selected particle and of the studies, and the events that report a change of them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from psygnal import Signal

from regolith_studio.geometry.convex_compound import Polyhedron
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle

if TYPE_CHECKING:
    from regolith_studio.coarsening.progress import CoarseningProgress
    from regolith_studio.coarsening.result import CoarseningResult
    from regolith_studio.descriptors.describe import Descriptors
    from regolith_studio.geometry.mesh_health import MeshHealth
    from regolith_studio.harmonics.fit import HarmonicFit
    from regolith_studio.harmonics.star_point import StarPointVisibility
    from regolith_studio.jobs.coarsening_jobs import ParticleComparison
    from regolith_studio.session.provenance import ParticleRef
    from regolith_studio.studies.coarsening import CoarseningStudy
    from regolith_studio.studies.lmax import LmaxStudy


@dataclass(frozen=True)
class ParticleEntry:
    """One row of the particle list; `health` and `descriptors` follow a moment after opening.

    ``ref``: where a recipe finds it again; ``None`` if nowhere. ``visibility``: what its star point cannot
    see; follows with the health, ``None`` where the mesh has no inside.
    """

    id: str
    particle: Particle
    health: "MeshHealth | None" = None
    descriptors: "Descriptors | None" = None
    ref: "ParticleRef | None" = None
    visibility: "StarPointVisibility | None" = None


@dataclass(frozen=True)
class Results:
    """Everything is ``None`` (or empty) until it has been computed.

    - ``fit``: coefficients up to degree 30; hidden surface share and warnings with them.
    - ``surface``, ``surface_l_max``: the fit's surface in the particle's frame, micrometres, and the degree
      at which it is cut: the chosen one when nothing runs; while a slider is dragged, one that it has
      passed.
    - ``particle_descriptors``, ``fit_descriptors``, ``fit_errors``: of the particle, of `surface`, and the
      relative errors (Eq. 8) of the second.
    - ``coarsening_progress``: the newest step of the coarsening that runs or ran.
    - ``best``: the newest step with a polyhedron, or the finished coarsening; read :attr:`polyhedron`.
    - ``coarsened``: the finished coarsening for the present choices; ``None`` while it runs.
    - ``loss_history``: (step, loss) pairs: thinned out while it runs, complete in the end.
    - ``against_particle``: the finished polyhedron of a fit against the particle itself; ``None`` where it
      imitates the particle.
    - ``fewer_facets``: the fewest facets, tried with otherwise the same choices, that gave no larger loss;
      and that loss; ``None`` if there are none.
    - ``lmax_study``, ``coarsening_study``: of all particles that are open; `outdated` names those that no
      longer fit the choices.
    - ``failures``: why there is no result, by its kind: its own work failed, or that which it is computed
      from.
    """

    fit: "HarmonicFit | None" = None
    surface: Mesh | None = None
    surface_l_max: int = 0
    particle_descriptors: "Descriptors | None" = None
    fit_descriptors: "Descriptors | None" = None
    fit_errors: Mapping[str, float] = field(default_factory=dict)
    best: "CoarseningProgress | CoarseningResult | None" = None
    coarsening_progress: "CoarseningProgress | None" = None
    coarsened: "CoarseningResult | None" = None
    loss_history: Sequence[tuple[int, float]] = ()
    against_particle: "ParticleComparison | None" = None
    fewer_facets: tuple[int, float] | None = None
    lmax_study: "LmaxStudy | None" = None
    coarsening_study: "CoarseningStudy | None" = None
    outdated: frozenset[str] = frozenset()
    failures: Mapping[str, str] = field(default_factory=dict)

    @property
    def polyhedron(self) -> Polyhedron | None:
        """The best polyhedron so far, about its own centre (``best.centre`` in the particle's frame)."""
        return self.best.polyhedron if self.best else None


@dataclass(frozen=True)
class Failure:
    """Work that could not be done: what it was, one sentence, and the details of a report."""

    title: str
    sentence: str
    details: str = ""


class SessionEvents:
    """What can be listened to; events without an argument mean "read the session anew".

    Connected functions are called with as many of the arguments as they take. Bound methods are held weakly,
    other functions until they are disconnected.
    """

    particles = Signal()
    choices = Signal(frozenset)
    """Names of the fields of the choices that have another value now."""
    fit = Signal()
    surface = Signal()
    descriptors = Signal()
    coarsening = Signal()
    comparison = Signal()
    lmax_study = Signal()
    coarsening_study = Signal()
    tasks = Signal()
    dataset_folder = Signal()
    opened_request = Signal()
    failed = Signal(Failure)
    problems = Signal(tuple)
    """Files that were refused at opening, or particles that an export left out, as ``FileProblem``."""
    left_out = Signal(tuple)
    """Sentences about files in folders that no reader takes."""
    """Path of the folder that was written."""
