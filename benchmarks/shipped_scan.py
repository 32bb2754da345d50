"""Grains found in the shipped scan with each way of denoising, and volumes of its grains, against the truth.

python -m benchmarks.shipped_scan [RESULT.json]
"""

import sys
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.imaging.extraction import ExtractionSettings, extract_particles
from regolith_studio.imaging.sample_volumes import sample_volume
from regolith_studio.imaging.segmentation.denoising import DenoiseSettings
from regolith_studio.imaging.segmentation.segment import SegmentationSettings, segment

METHODS = ("none", "gaussian", "median", "non-local-means")


def overlaps(truth: NDArray[np.integer], found: NDArray[np.integer]) -> FloatArray:
    """Voxels shared by each true and each found label, shape (true, found); label 0 is what is no grain."""
    shared = np.zeros((truth.max() + 1, found.max() + 1))
    np.add.at(shared, (truth.ravel(), found.ravel()), 1)
    return shared


def intersection_over_union(shared: FloatArray) -> FloatArray:
    """The best of each true grain, shape (grains,)."""
    union = shared.sum(axis=1, keepdims=True) + shared.sum(axis=0) - shared
    return np.asarray((shared / union)[1:, 1:].max(axis=1))


def main(result: str) -> None:
    """Print both tables."""
    truth, grey = sample_volume("labels"), sample_volume("grey")
    rows: Rows = {}
    for method in METHODS:
        settings = replace(SegmentationSettings(), denoise=DenoiseSettings(method))
        shared = overlaps(truth.array, segment(grey, settings).labels.array)
        each = intersection_over_union(shared)
        volume = 100 * (shared[:, 1:].sum() / shared[1:].sum() - 1)
        show_row(rows, method, (shared.shape[1] - 1, (each > 0.5).sum(), each.mean(), each.min(), volume), 3)
    add_result(result, "denoising", rows)
    labels = segment(grey).labels
    shared = overlaps(truth.array, labels.array)
    surfaces: Rows = {}
    for surface in ("mask", "grey"):
        found = extract_particles(labels, ExtractionSettings(surface=surface), grey=grey).found
        true = np.array([shared[shared[1:, each.label].argmax() + 1].sum() for each in found])
        volumes = np.array([each.particle.mesh.volume for each in found]) / np.prod(grey.voxel_size)
        errors = 100 * (volumes / true - 1)
        show_row(surfaces, surface, (len(found), np.sqrt(np.mean(errors**2)), np.abs(errors).max()), 1)
    add_result(result, "surface", surfaces)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "")
