"""The chain from a scan or a sample to simulated polyhedra at given levels of its steps."""

from collections.abc import Generator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.dataset.representatives import NEEDED, choose_representatives
from regolith_studio.descriptors.describe import Descriptors, describe
from regolith_studio.errors import GeometryError, RegolithError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.fit_options import FIT_DEGREE
from regolith_studio.imaging.extraction import extract_particles
from regolith_studio.imaging.grain_errors import MEAN_KEYS, mean_errors
from regolith_studio.imaging.segmentation.segment import segment
from regolith_studio.imaging.settings import DenoiseMethod
from regolith_studio.imaging.volume import Volume
from regolith_studio.imaging.volume_slabs import ScratchArrays
from regolith_studio.jobs.coarsening_jobs import CoarsenedParticle, CoarseningRequest, coarsen_particle
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
from regolith_studio.jobs.model_jobs import particles_of
from regolith_studio.jobs.scan_jobs import read_all
from regolith_studio.messages import N_, Message
from regolith_studio.readers.shape_files import radius_of
from regolith_studio.shape_models.models import MODELS, model_settings
from regolith_studio.shape_models.sample import Sample
from regolith_studio.steps import result_of
from regolith_studio.studies.uncertainty import KEYS, RESAMPLED, RESAMPLES, ChainStep

LABELS = {
    "threshold": N_("Threshold and denoising"),
    "splitting": N_("Separation of touching grains"),
    "digitisation": N_("Errors of digitised grains"),
    "voxel": N_("Size of voxels"),
    "smoothing": N_("Smoothing of surfaces"),
    RESAMPLED: N_("Grains and representatives"),
    "l_max": N_("Degree l_max"),
    "model": N_("Model of drawn particles"),
    "facets": N_("Number of facets"),
    "method": N_("Method of coarsening"),
    "kept": N_("Descriptors that are kept"),
}
RESCANNED = ("threshold", "splitting", "voxel", "smoothing")
"""Steps that need the grains to be taken from the scan again."""
SCAN_STEPS = ("digitisation", *RESCANNED)
DEVIATIONS = (0.0, 1.5**0.5, -(1.5**0.5))
"""Of the mean error of digitised grains, in its standard deviation: levels of variance 1."""
RESIDUAL_NOISE = {"none": 1.0, "gaussian": 0.21, "median": 0.24, "non-local-means": 0.24}
"""Standard deviation of denoised grey values over that of the values, for white noise."""
PROBABILITY_SHIFT = 0.1
KEPT = (("volume",), ("volume", "aspect_ratio"))
"""Terms beside the overlap, for the question of which descriptors must be kept."""
Levels = Mapping[str, int]


@dataclass(frozen=True, eq=False)
class Chain:
    """What the budget is of; picklable.

    - ``source``: particles, or a scan in memory or in a file.
    - ``grains``: settings from voxels to grains.
    - ``coarsening``: of the polyhedra, with l_max where it imitates fits.
    - ``model``: key of the model that particles are drawn from; none if representatives are measured
      grains.
    - ``n_representatives``: simulated shapes.
    - ``level``, ``noise``: of a grey scan: where grains begin, and the noise of its denoised values.
    """

    source: tuple[Particle, ...] | Volume | VolumeInput
    grains: GrainSettings = field(default_factory=GrainSettings)
    coarsening: CoarseningRequest = field(
        default_factory=lambda: CoarseningRequest(LossWeights.from_preset("all"))
    )
    model: str = ""
    n_representatives: int = 10
    seed: int = 0
    level: float = 0.0
    noise: float = 0.0
    kind: str = "particles"

    @classmethod
    def of(cls, source: tuple[Particle, ...] | Volume | VolumeInput, **settings: Any) -> "Chain":
        """With the kind of the source, and level and noise of a grey scan."""
        chain = cls(source, **settings)
        if isinstance(source, tuple):
            return chain
        volume = chain.volume
        if volume.kind == "labels":
            return replace(chain, kind="labels")
        found, how = segment(volume, chain.grains.segmentation), chain.grains.segmentation.denoise.method
        between = volume.array[found.labels.array == 0].astype(np.float64)
        spread = 1.4826 * float(np.median(np.abs(between - np.median(between))))
        return replace(chain, kind="grey", level=found.level, noise=RESIDUAL_NOISE[how] * spread)

    @property
    def volume(self) -> Volume:
        """The scan, read where it is in a file."""
        assert not isinstance(self.source, tuple)
        if isinstance(self.source, Volume):
            return self.source
        source = self.grains.region.of(self.source.opened())
        volume: Volume = result_of(read_all(source, ScratchArrays()))
        return volume

    @cached_property
    def choices(self) -> dict[str, tuple[tuple[str, Any], ...]]:
        """Levels of each step that varies, with their names; the present one first."""
        found: dict[str, tuple[tuple[str, Any], ...]] = {}
        extraction, how = self.grains.extraction, self.grains.segmentation
        if self.kind == "grey":
            found["threshold"] = self._thresholds()
            found["digitisation"] = tuple(
                ("mean error" + f" {z:+.2f} s.d." * (z != 0.0), z) for z in DEVIATIONS
            )
            if how.splitting.enabled:
                h = how.splitting.h_maxima
                found["splitting"] = tuple(
                    (f"h {each:g}", replace(how.splitting, h_maxima=each)) for each in (h, 2 * h, h / 2)
                )
        if self.kind != "particles":
            found["voxel"] = (("as scanned", 1), ("twice the edge", 2))
            band = extraction.pass_band
            found["smoothing"] = tuple(
                (f"pass band {each:.3g}", each) for each in (band, min(1.5 * band, 2.0), band / 1.5)
            )
        found[RESAMPLED] = tuple((f"sample {k}", k) for k in range(1, RESAMPLES + 1))
        if self.model:
            other = "sample_matched" if self.model == "recombined" else "recombined"
            found["model"] = tuple((key, key) for key in (self.model, other))
        return found | self._coarsening_choices()

    def _coarsening_choices(self) -> dict[str, tuple[tuple[str, Any], ...]]:
        request = self.coarsening
        found: dict[str, tuple[tuple[str, Any], ...]] = {}
        if request.target == "fit" or self.model:
            degrees = dict.fromkeys((request.l_max, max(4, round(0.75 * request.l_max))))
            higher = dict.fromkeys((*degrees, min(FIT_DEGREE, round(1.5 * request.l_max))))
            found["l_max"] = tuple((f"{degree}", degree) for degree in higher)
        n = request.n_facets
        found["facets"] = tuple((f"{k}", k) for k in (n, max(4, round(0.8 * n)), round(1.25 * n)))
        other = "quadric" if request.method != "quadric" else "exact"
        found["method"] = tuple((METHODS[key].label, key) for key in (request.method, other))
        kept = [LossWeights.of(jaccard_distance=1.0, **dict.fromkeys(keys, 1.0)) for keys in KEPT]
        names = ["overlap, " + ", ".join(keys) for keys in KEPT]
        pairs = [("as set", request.weights), *zip(names, kept, strict=True)]
        found["kept"] = tuple(pair for k, pair in enumerate(pairs) if not k or pair[1] != request.weights)
        return found

    def _thresholds(self) -> tuple[tuple[str, Any], ...]:
        """Pairs of denoising and threshold: moved by the noise, and after the other denoising."""
        how = self.grains.segmentation
        if how.threshold.method == "probability":
            values = [how.threshold.value + sign * PROBABILITY_SHIFT for sign in (0, 1, -1)]
            values = [min(max(value, 0.05), 0.95) for value in values]
            changed = [replace(how.threshold, value=value, low=0.0) for value in values]
            return tuple((f"{each.value:g}", (how.denoise, each)) for each in changed)
        moved = [
            replace(how.threshold, method="manual", value=self.level + sign * self.noise) for sign in (1, -1)
        ]
        other: DenoiseMethod = "gaussian" if how.denoise.method != "gaussian" else "median"
        return (
            (f"{self.level:g}", (how.denoise, how.threshold)),
            *((f"{each.value:g}", (how.denoise, each)) for each in moved),
            (f"denoised by {other}", (replace(how.denoise, method=other), how.threshold)),
        )

    @property
    def steps(self) -> tuple[ChainStep, ...]:
        """The steps of the design: grains with stated errors need no larger voxels."""
        unused = "voxel" if "digitisation" in self.choices else ""
        return tuple(step for step in self._all_steps if step.key != unused)

    @property
    def steps_of_shapes(self) -> tuple[ChainStep, ...]:
        """The steps that change simulated shapes; stated errors are of descriptors only."""
        return tuple(step for step in self._all_steps if step.key != "digitisation")

    @property
    def _all_steps(self) -> list[ChainStep]:
        named = {key: tuple(name for name, _ in levels) for key, levels in self.choices.items()}
        return [ChainStep(key, LABELS[key], named[key]) for key in LABELS if key in named]

    @property
    def not_counted(self) -> tuple[ChainStep, ...]:
        """The steps that the input or the settings lack."""
        reasons = {
            **dict.fromkeys(SCAN_STEPS, N_("the input is no scan of grey values")),
            "l_max": N_("the polyhedra imitate the surfaces themselves"),
            "model": N_("no particles are drawn"),
        }
        return tuple(
            ChainStep(key, LABELS[key], (), reasons[key]) for key in LABELS if key not in self.choices
        )

    def value(self, key: str, levels: Levels) -> Any:
        """What a step is set to; levels that are not named are the present ones."""
        return self.choices[key][levels.get(key, 0)][1]

    def sample(self, levels: Levels) -> "GrainSample":
        """The grains at the levels of the scan's steps."""
        if isinstance(self.source, tuple):
            return GrainSample.of(self, self.source, np.ones(len(self.source)))
        extraction, how, volume = self.grains.extraction, self.grains.segmentation, self.volume
        extraction = replace(extraction, pass_band=self.value("smoothing", levels))
        if (factor := self.value("voxel", levels)) > 1:
            volume, least = _coarser(volume), factor**3
            extraction = replace(extraction, min_voxels=extraction.min_voxels // least)
            cleaning = replace(how.cleaning, min_voxels=how.cleaning.min_voxels // least)
            how = replace(how, cleaning=cleaning)
        labels, grey = volume, None
        if volume.kind == "grey":
            denoise, threshold = self.value("threshold", levels)
            splitting = how.splitting
            if "splitting" in self.choices:
                splitting = self.value("splitting", levels)
                splitting = replace(splitting, h_maxima=splitting.h_maxima / factor)
            how = replace(how, denoise=denoise, threshold=threshold, splitting=splitting)
            labels, grey = segment(volume, how).labels, volume
        found = extract_particles(labels, extraction, grey=grey)
        return GrainSample.of(self, found.particles, np.array(found.weights))

    def request(self, levels: Levels) -> CoarseningRequest:
        """How polyhedra are made."""
        request = replace(self.coarsening, n_facets=self.value("facets", levels), largest_error=None)
        if "l_max" in self.choices:
            request = replace(request, l_max=self.value("l_max", levels))
        request = replace(request, weights=self.value("kept", levels))
        if (method := self.value("method", levels)) != request.method:
            request = replace(request, method=method, settings=(), weights=request.weights.keeping(None))
        return request


def _coarser(volume: Volume) -> Volume:
    """With voxels of twice the edge: means of grey values, every second label."""
    shape = tuple(n // 2 * 2 for n in volume.shape)
    values = volume.array[tuple(slice(n) for n in shape)]
    if volume.kind == "grey":
        blocks = values.reshape(*(n for edge in shape for n in (edge // 2, 2)))
        means = blocks.mean(axis=(1, 3, 5), dtype=np.float64)
        values = means if values.dtype.kind == "f" else np.rint(means)
        values = values.astype(volume.array.dtype)
    else:
        values = values[::2, ::2, ::2]
    return Volume(np.ascontiguousarray(values), 2 * volume.voxel_size, volume.kind, volume.name)


@dataclass(frozen=True, eq=False)
class GrainSample:
    """The grains that can be described, with their weights, and what was made of them."""

    chain: Chain
    particles: tuple[Particle, ...]
    weights: FloatArray
    descriptors: tuple[Descriptors, ...]
    _polyhedra: dict[tuple[Any, ...], FloatArray] = field(default_factory=dict)
    _fits: list[ShCoefficients] = field(default_factory=list)
    _drawn: dict[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, chain: Chain, particles: Sequence[Particle], weights: FloatArray) -> "GrainSample":
        """Describe the particles; those without descriptors are left out."""
        rows = [(k, found) for k, each in enumerate(particles) if (found := _described(each)) is not None]
        kept = [k for k, _ in rows]
        described = tuple(found for _, found in rows)
        return cls(chain, tuple(particles[k] for k in kept), weights[kept], described)

    def picks(self, levels: Levels) -> IntArray:
        """Places of the grains of a bootstrap sample; of all of them where the step is not at a level."""
        n = len(self.particles)
        if RESAMPLED not in levels:
            return np.arange(n)
        key = self.chain.value(RESAMPLED, levels)
        return np.random.default_rng((self.chain.seed, key)).integers(0, n, n)

    def means(self, levels: Levels) -> FloatArray:
        """Of grains and of polyhedra, the errors of digitised grains taken from both."""
        grains = self.grain_means(levels)
        polyhedra = self.polyhedra_means(levels) * grains / self._mean(self._table, levels)
        return np.concatenate([grains, polyhedra])

    def grain_means(self, levels: Levels) -> FloatArray:
        """Weighted means of :data:`KEYS` over the grains, without the errors of the level."""
        table = self._table
        if "digitisation" in levels:
            mean, deviation = self._mean_errors
            table = table / (1 + mean + self.chain.value("digitisation", levels) * deviation)
        return self._mean(table, levels)

    def _mean(self, table: FloatArray, levels: Levels) -> FloatArray:
        picks = self.picks(levels)
        return np.asarray(np.average(table[picks], axis=0, weights=self.weights[picks]))

    @cached_property
    def _table(self) -> FloatArray:
        return np.array([[each[key] for key in KEYS] for each in self.descriptors])

    @cached_property
    def _mean_errors(self) -> tuple[FloatArray, FloatArray]:
        """Of each grain and key, 0 where none is stated, and their standard deviation by key."""
        places = [MEAN_KEYS.index(key) for key in KEYS]
        scans = [particle.scan for particle in self.particles]
        errors, deviation = mean_errors(self.descriptors, scans)
        return np.nan_to_num(errors[:, places]), deviation[places]

    @property
    def without_errors(self) -> int:
        """Number of grains of a grey scan that have no stated errors."""
        if "digitisation" not in self.chain.choices:
            return 0
        return int((self._mean_errors[0] == 0.0).all(axis=1).sum())

    def polyhedra_means(self, levels: Levels) -> FloatArray:
        """Means of :data:`KEYS` over the simulated particles, with the sizes of their classes."""
        picks = self.picks(levels)
        particles, described = self.particles, self.descriptors
        if self.chain.model:
            particles, described = self.drawn_and_described(levels)
            picks = np.arange(len(particles))
        chosen = choose_representatives([described[k] for k in picks], self.chain.n_representatives)
        rows = []
        for place, one in zip(chosen.chosen, chosen.classes, strict=True):
            at = int(picks[place])
            volume, area = (float(np.pi / 6) ** p * one.sizes.moment(3 * p) for p in (1, 2 / 3))
            shape = self._shape(particles[at], None if self.chain.model else at, levels)
            rows.append([volume, shape[0] * area, shape[1], shape[2]])
        weights = [one.weight for one in chosen.classes]
        return np.asarray(np.average(rows, axis=0, weights=weights))

    def fits(self) -> Generator[Progress, None, None]:
        """Expand the grains for the model, once for all levels; nothing where no particles are drawn."""
        options, n = self.chain.coarsening.fit_options, len(self.particles)
        for at in range(len(self._fits), n if self.chain.model else 0):
            yield Progress(at, n, N_("fits of the grains"))
            self._fits.append(radius_of(options.fit(self.particles[at].mesh, FIT_DEGREE)))

    def drawn(self, levels: Levels) -> tuple[Particle, ...]:
        """As many particles as grains, of the model fitted to the grains of a bootstrap sample."""
        result_of(self.fits())
        key = self.chain.value("model", levels)
        settings = model_settings(key, {"l_max": self.chain.value("l_max", levels)})
        own = [self._fits[at] for at in np.unique(self.picks(levels)).tolist()]
        model = MODELS[key].fit(Sample.of(own), settings)
        seed = self.chain.seed + levels.get(RESAMPLED, 0)
        return particles_of(model.draw(len(self.particles), seed))

    def drawn_and_described(self, levels: Levels) -> tuple[tuple[Particle, ...], tuple[Descriptors, ...]]:
        """The drawn particles with what the choice of representatives needs; the last ones are kept."""
        key = draw_levels(levels)
        if self._drawn.get("levels") != key:
            particles = self.drawn(levels)
            described = tuple(describe(each, NEEDED) for each in particles)
            self._drawn.update(levels=key, particles=particles, described=described)
        return self._drawn["particles"], self._drawn["described"]

    def _shape(self, particle: Particle, at: int | None, levels: Levels) -> FloatArray:
        """Area at unit volume, sphericity and aspect ratio of the polyhedron of a particle."""
        key = (at, *(levels.get(step, 0) for step in ("l_max", "facets", "method", "kept")))
        if at is not None and key in self._polyhedra:
            return self._polyhedra[key]
        outcome: CoarsenedParticle = result_of(
            coarsen_particle(particle, self.chain.request(levels), at or 0)
        )
        if outcome.coarsened is None:
            raise GeometryError(f"{particle.name}: {outcome.problem}")
        found = describe(outcome.coarsened.polyhedron, KEYS)
        area = found["surface_area"] / found["volume"] ** (2 / 3)
        shape = np.array([area, found["sphericity"], found["aspect_ratio"]])
        if at is not None:
            self._polyhedra[key] = shape
        return shape


def _described(particle: Particle) -> Descriptors | None:
    try:
        found = describe(particle)
    except RegolithError:
        return None
    usable = all(np.isfinite(found[key]) and found[key] > 0.0 for key in {*KEYS, *NEEDED})
    return found if usable else None


def draw_levels(levels: Levels) -> tuple[int, ...]:
    """What decides which particles are drawn; -1 for all grains."""
    return tuple(levels.get(key, -1 if key == RESAMPLED else 0) for key in (RESAMPLED, "model", "l_max"))


_samples: dict[tuple[Any, ...], GrainSample] = {}
"""The last sample that this process has made, for its next task."""


def _sample_at(chain: Chain, levels: Levels, inputs: str) -> GrainSample:
    key = (inputs, *(levels.get(step, 0) for step in RESCANNED))
    if key not in _samples:
        _samples.clear()
        _samples[key] = chain.sample(levels)
    return _samples[key]


def evaluate_rows(chain: Chain, inputs: str, rows: Sequence[tuple[int, Levels]]) -> Steps:
    """Means of grains and of polyhedra by the number of the row, as a document.

    All rows are of the same levels of the scan. A row that fails has none, and ``problem`` says why.

    ``inputs``: changes when the input or a setting does.
    """
    found: dict[str, Any] = {"rows": {}, "problem": ""}
    yield Started(N_("Uncertainty of descriptors"), len(rows))
    yield Progress(0, len(rows), N_("descriptors of the grains"))
    try:
        sample = _sample_at(chain, rows[0][1], inputs)
        for step in sample.fits():
            yield Progress(0, len(rows), Message("{message}, {done}/{total}", **asdict(step)))
    except RegolithError as error:
        return found | {"problem": str(error)}
    found["n_grains"] = len(sample.particles)
    if unknown := sample.without_errors:
        found["problem"] = f"{unknown} grains are clipped, or too small for the noise, and count as measured."
    for done, (number, levels) in enumerate(rows):
        yield Progress(done, len(rows), N_("representatives and polyhedra"))
        try:
            found["rows"][str(number)] = sample.means(levels).tolist()
        except RegolithError as error:
            found["problem"] = str(error)
    return found
