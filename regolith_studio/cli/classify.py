"""``classify``: classifiers of voxels, their maps of probabilities, and classifiers of segmented objects."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from regolith_studio.cli.options import (
    Json,
    Seed,
    claim_json,
    claim_labels,
    option_of,
    output_option,
    usage_errors,
    with_dataclass_options,
)
from regolith_studio.cli.terminal import command_group, print_result, run_with_progress
from regolith_studio.cli.volume_options import GrainOptions, VolumeOptions
from regolith_studio.readers.volumes.region import RegionSettings

if TYPE_CHECKING:
    from regolith_studio.imaging.segmentation.pixel_classifier import PixelClass, TrainingSet

app = command_group("Classifiers of voxels, trained on painted ones, and of segmented objects (section 2.1).")
ClassifierFile = Annotated[
    Path, typer.Argument(metavar="CLASSIFIER", help="File of `classify train` or of the window.")
]
Scan = Annotated[Path, typer.Argument(metavar="SCAN", help="Volume of grey values.")]
Outside = Annotated[str, option_of(RegionSettings, "outside")]


@app.command("train")
@with_dataclass_options
def train(
    *,
    scan: Scan,
    labels: Annotated[
        Path,
        typer.Argument(
            metavar="LABELS",
            help="Volume of as many voxels: 0 where nothing is painted, else the number of a class, as label "
            "editors and ilastik keep it.",
        ),
    ],
    output: Annotated[Path, output_option("File of the classifier.", "FILE.json", claim_json)],
    contents: VolumeOptions,
    labels_dataset: Annotated[
        str,
        typer.Option("--labels-dataset", help="Name of the labels' dataset in an HDF5 file.", metavar="NAME"),
    ] = "",
    grain: Annotated[
        str, typer.Option("--grain", help="Labels that are grain, such as 2 or 2,3.", metavar="LIST")
    ] = "2",
    model: Annotated[
        str, typer.Option("--model", help="Classifier: network or logistic.", metavar="MODEL")
    ] = "network",
    sigmas: Annotated[
        str,
        typer.Option(
            "--sigmas", help="Standard deviations of the Gaussians in voxels, ascending.", metavar="LIST"
        ),
    ] = "1,2,4,8",
    planar: Annotated[
        bool, typer.Option("--planar", help="Filter within slices along z only (2-D features).")
    ] = False,
    hessian: Annotated[
        bool,
        typer.Option(
            "--hessian/--no-hessian", help="Take the eigenvalues of the second derivatives as features."
        ),
    ] = True,
    outside: Outside = "auto",
    json: Json = False,
    seed: Seed = 0,
) -> None:
    """Train a classifier on painted voxels, for `extract --classifier`."""
    import numpy as np

    from regolith_studio.imaging.segmentation.pixel_classifier import ClassifierSettings
    from regolith_studio.imaging.segmentation.pixel_features import FeatureSettings
    from regolith_studio.jobs.classifier_jobs import train_on_labels, write_training
    from regolith_studio.jobs.extraction_settings import VolumeInput

    with usage_errors():
        given, region = contents.of(scan), RegionSettings(outside=outside)
        features = FeatureSettings(_numbers(sigmas, "--sigmas"), planar, hessian)
        settings = ClassifierSettings(features, model, seed=seed)  # type: ignore[arg-type]  # checked there
        classes = _classes(grain)
    edges = tuple(np.ravel(np.asarray(given.opened().voxel_size, dtype=float)).tolist())
    painted = VolumeInput(labels, edges, "um", "labels", labels_dataset or None, axes=given.axes)
    training: TrainingSet = run_with_progress(
        train_on_labels(given, painted, classes, settings, region.outside)
    )
    write_training(output, training)
    counts = {
        each.name: int(np.count_nonzero(training.labels == k)) for k, each in enumerate(training.classes)
    }
    words = ", ".join(f"{count:,} of {name}" for name, count in counts.items() if count)
    print_result(
        {"classifier": str(output), "painted_voxels": counts},
        f"Trained on {words} voxels. Written to {output}.",
        json,
    )


@app.command("map")
@with_dataclass_options
def map_scan(
    *,
    scan: Scan,
    classifier: ClassifierFile,
    output: Annotated[
        Path,
        output_option(
            "File for the probability of grain, 0 to 255, as TIFF, NRRD or HDF5.",
            "FILE",
            claim_labels,
        ),
    ],
    contents: VolumeOptions,
    outside: Outside = "auto",
    json: Json = False,
) -> None:
    """Write the map of probabilities that a classifier makes of a scan."""
    from regolith_studio.jobs.classifier_jobs import map_probabilities
    from regolith_studio.jobs.extraction_settings import read_classifier

    with usage_errors():
        given, training = contents.of(scan), read_classifier(classifier)
        region = RegionSettings(outside=outside)
    run_with_progress(map_probabilities(given, training, output, output.parent, region.outside))
    print_result({"probabilities": str(output)}, f"Written to {output}.", json)


@app.command("labels")
@with_dataclass_options
def painted_labels(
    *,
    scan: Scan,
    classifier: ClassifierFile,
    output: Annotated[
        Path,
        output_option("File for the painted voxels, as TIFF, NRRD or HDF5.", "FILE", claim_labels),
    ],
    contents: VolumeOptions,
    json: Json = False,
) -> None:
    """Write the painted voxels of a classifier as labels, which ilastik and `classify train` take."""
    from regolith_studio.jobs.classifier_jobs import write_painted
    from regolith_studio.jobs.extraction_settings import read_classifier

    with usage_errors():
        given, training = contents.of(scan), read_classifier(classifier)
    run_with_progress(write_painted(given, training, output))
    classes = {each.name: number for number, each in enumerate(training.classes, start=1)}
    print_result(
        {"labels": str(output), "classes": classes},
        f"Written to {output}: {', '.join(f'{k} {name}' for name, k in classes.items())}.",
        json,
    )


@app.command("objects")
@with_dataclass_options
def train_objects(
    *,
    scan: Scan,
    examples: Annotated[
        Path,
        typer.Argument(
            metavar="EXAMPLES",
            help="CSV file with the columns x, y, z and class: voxels in objects, counted from 0 in the "
            "region of interest, and grain, several grains or artefact.",
        ),
    ],
    output: Annotated[Path, output_option("File of the object classifier.", "FILE.json", claim_json)],
    contents: VolumeOptions,
    grains: GrainOptions,
    json: Json = False,
) -> None:
    """Train a classifier of segmented objects on a few examples, for `extract --objects`."""
    from regolith_studio.imaging.segmentation.object_classifier import OBJECT_CLASSES
    from regolith_studio.jobs.classifier_jobs import ClassifiedObjects, train_on_objects, write_training
    from regolith_studio.jobs.scan_jobs import scratch_folder
    from regolith_studio.readers.shape_tables import read_object_examples

    with usage_errors():
        given, settings = contents.of(scan), grains.recipe
    chosen = read_object_examples(examples, OBJECT_CLASSES)
    objects: ClassifiedObjects = run_with_progress(
        train_on_objects(given, settings, chosen, scratch_folder())
    )
    assert objects.training is not None
    write_training(output, objects.training)
    words = ", ".join(f"{count:,} {name}" for name, count in objects.counts().items())
    print_result(
        {"objects": str(output), "classified": objects.counts()},
        f"Classified as {words}. Written to {output}.",
        json,
    )


def _numbers(text: str, option: str) -> tuple[float, ...]:
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        raise typer.BadParameter(f"{option} takes numbers such as 1,2,4, got {text!r}.") from None


def _classes(grain: str) -> tuple["PixelClass", ...]:
    """The classes up to the highest label that may be painted, those in the list `grain` being grains."""
    from regolith_studio.imaging.segmentation.pixel_classifier import MAX_CLASSES, PixelClass

    try:
        chosen = {int(part) for part in grain.split(",")}
    except ValueError:
        chosen = set()
    if not chosen or not chosen <= set(range(1, MAX_CLASSES + 1)):
        raise typer.BadParameter(f"--grain takes labels from 1 to {MAX_CLASSES}, such as 2,3, got {grain!r}.")
    return tuple(PixelClass(f"label {k}", k in chosen) for k in range(1, MAX_CLASSES + 1))
