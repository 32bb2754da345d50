"""Steps of the paper as one call each, for notebooks, where the folders below offer jobs or parts."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any, cast

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import ExportOptions, ExportResult, write_export
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.errors import InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.imaging.extraction import extract_particles
from regolith_studio.imaging.segmentation.segment import SegmentationSettings, segment
from regolith_studio.imaging.settings import ExtractionSettings
from regolith_studio.imaging.volume import Volume
from regolith_studio.io.output_lock import output_lock
from regolith_studio.jobs.model_jobs import compare_distributions, make_particles
from regolith_studio.jobs.repose_jobs import ReposeRequest, ReposeRun, repose_steps
from regolith_studio.readers.shape_files import radius_of
from regolith_studio.shape_models.models import DEFAULT_MODEL, MODELS, model_settings
from regolith_studio.shape_models.protocol import FittedModel, SizeRange
from regolith_studio.shape_models.sample import Sample
from regolith_studio.steps import result_of
from regolith_studio.studies.population_distances import DistributionComparison


def extract(
    volume: Volume,
    settings: ExtractionSettings | None = None,
    segmentation: SegmentationSettings | None = None,
) -> list[Particle]:
    """The grains of a scan as closed surfaces (section 2.1).

    Parameters
    ----------
    volume
        Of :func:`read_volume`: grey values, which are segmented first, or labels.
    settings
        Which labels become particles, and how they are contoured.
    segmentation
        Threshold, cleaning and separation of touching grains; only for grey values.

    Returns
    -------
    Particles in micrometres, at their places in the volume; those at its border are left out.

    Raises
    ------
    InputError
        If no grain is found, or the grey values are too uniform for a threshold.

    Examples
    --------
    >>> grains = rs.extract(rs.read_volume("scan.tif", voxel_size=2.3))
    """
    if volume.kind == "labels":
        return list(extract_particles(volume, settings).particles)
    labels = segment(volume, segmentation).labels
    return list(extract_particles(labels, settings, grey=volume).particles)


def fit_model(fits: Iterable[HarmonicFit], model: str = DEFAULT_MODEL, **settings: Any) -> FittedModel:
    """A stochastic model of particle shape, fitted to the particles of one sample (section 2.3).

    Parameters
    ----------
    fits
        Of :func:`fit_harmonics`, all with the same l_max, in micrometres; 20 or more are advised.
    model
        ``recombined``, ``sample_matched``, ``log_field``, ``hull_field``, ``gaussian_field`` (the paper's),
        ``gaussian_mixture``, or one of another package.
    settings
        Fields of the model's ``Settings`` that differ from the default, ``l_max`` among them.

    Raises
    ------
    InputError
        If there is no such model or setting, or the sample is too small or not expanded so far.

    Examples
    --------
    >>> model = rs.fit_model([rs.fit_harmonics(grain) for grain in grains], "gaussian_field", l_max=10)
    """
    chosen = model_settings(model, settings)
    sample = Sample.of([radius_of(fit) for fit in fits])
    if "l_max" not in settings and chosen.l_max > sample.l_max:
        chosen = model_settings(model, {**settings, "l_max": sample.l_max})
    return MODELS[model].fit(sample, chosen)


def draw_particles(
    model: FittedModel, n: int, seed: int = 0, size_range: SizeRange | None = None
) -> list[Particle]:
    """Virtual particles of a fitted model as closed surfaces (sections 2.3 and 3.1).

    Parameters
    ----------
    model
        Of :func:`fit_model`.
    n, seed
        How many; the first of a longer draw with the same seed are those of a shorter one.
    size_range
        Smallest and largest equivalent radius in micrometres.

    Raises
    ------
    InputError
        If hardly any draw has a positive radius and the size asked for, or the memory does not suffice.

    Examples
    --------
    >>> virtual = rs.draw_particles(model, 100, size_range=(20, 200))
    """
    draws = model.draw(n, seed, size_range)
    return list(result_of(make_particles(draws, model, "virtual")))


def compare_draws(
    model: FittedModel,
    fits: Iterable[HarmonicFit],
    n: int = 300,
    seed: int = 0,
    size_range: SizeRange | None = None,
) -> DistributionComparison:
    """Descriptors of drawn particles against those of a sample, in units of sampling noise.

    Parameters
    ----------
    model
        Of :func:`fit_model`.
    fits
        Of the sample, with all their degrees.
    n, seed, size_range
        Of the draws, as in :func:`draw_particles`; 300 are measured at most.

    Returns
    -------
    With ``table()``, what is farthest first, and ``assessment()``, a sentence.

    Examples
    --------
    >>> print(rs.compare_draws(model, fits).assessment())
    """
    sample = Sample.of([radius_of(fit) for fit in fits])
    steps = compare_distributions(sample, model.draw(n, seed, size_range), size_range)
    return cast("DistributionComparison", result_of(steps))


def export_dataset(
    dataset: Dataset,
    code: str,
    folder: Path | str,
    options: ExportOptions | None = None,
    *,
    accept_loss: bool = False,
) -> ExportResult:
    """Write a dataset in the format of a DEM code (section 2.5).

    Parameters
    ----------
    code
        Key of ``regolith_studio.dataset.exporters.EXPORTERS``: ``rocky``, ``yade``, ``lammps`` and others.
    folder
        New, empty, or holding such an export and nothing else.
    accept_loss
        Required for codes whose particles are not the polyhedra themselves.

    Raises
    ------
    InputError
        If there is no such code.
    DatasetError
        If the format changes shapes and that was not accepted, or the folder holds anything else.

    Examples
    --------
    >>> rs.export_dataset(dataset, "yade", "grains-yade").load_command
    """
    if code not in EXPORTERS:
        raise InputError(f"There is no exporter {code!r}; there are {', '.join(EXPORTERS)}.")
    return write_export(dataset, EXPORTERS[code], folder, options, accept_loss=accept_loss)


def simulate_repose(
    dataset: Path | str, folder: Path | str, request: ReposeRequest | None = None
) -> ReposeRun:
    """Simulate the lifting-cylinder test with a dataset, and measure the angle of repose (section 2.6).

    A case with a ``drum`` turns the cylinder on its side instead and measures its dynamic angle.

    Parameters
    ----------
    dataset
        Its folder, in micrometres; the simulation itself is in SI units.
    folder
        For the run: positions, ``repose.json`` and the shapes.
    request
        Contact parameters, number of particles, engine; 1,000 particles on the default engine if omitted.

    Returns
    -------
    The run; its ``measurement`` has the angles in degrees, or says why there is none.

    Raises
    ------
    RegolithError
        If the dataset or the folder cannot be used, or the engine is not installed.

    Examples
    --------
    >>> rs.simulate_repose("grains-20", "heap").measurement.angle
    >>> case = rs.ReposeCase.in_drum(rs.DrumRotation(rpm=10))
    >>> rs.simulate_repose("grains-20", "drum", rs.ReposeRequest(case, engine="rapier")).measurement.upper
    """
    with output_lock(Path(folder)):
        steps = repose_steps(Path(dataset), Path(folder), request or ReposeRequest())
        return cast("ReposeRun", result_of(steps))
