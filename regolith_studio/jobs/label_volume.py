"""Reads a label volume (TIFF stack) in a process of its own, which may hang or die of it."""

import contextlib
import logging
import multiprocessing
import os
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError, InputError
from regolith_studio.imaging.volume import Volume

LARGEST_VOLUME = 4 * 1024**3
"""Bytes that a volume may have in memory, whatever its file has on disk."""
_MEMORY = 8 * 1024**3
_BASE_SECONDS, _SECONDS_PER_BYTE = 30.0, 1e-7
_MICROMETRES = {"um": 1.0, "µm": 1.0, "\\u00b5m": 1.0, "micron": 1.0, "nm": 1e-3, "mm": 1e3, "cm": 1e4}


def read_label_volume(path: Path, voxel_size: float | None = None) -> Volume:
    """The labels in a TIFF stack, slices first.

    Parameters
    ----------
    voxel_size
        Edge of a voxel in micrometres; by default what the file says (ImageJ's tags).

    Raises
    ------
    FileError
        If the file is no TIFF stack of labels, is damaged or too large.
    InputError
        If no voxel size is given and the file names none.
    """
    if not path.is_file():
        raise FileError(f"{path} is not a file.")
    array, stated = _asked_child(path)
    size = (voxel_size,) * 3 if voxel_size else stated
    if size is None:
        raise InputError(f"{path.name} does not say how large a voxel is; give the size in micrometres.")
    return Volume(array.T, np.array(size, dtype=np.float64), "labels", path.name)


def _asked_child(path: Path) -> tuple[NDArray[Any], tuple[float, float, float] | None]:
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe(duplex=False)
    child = context.Process(target=_read, args=(str(path), there), daemon=True)
    child.start()
    there.close()
    seconds = _BASE_SECONDS + path.stat().st_size * _SECONDS_PER_BYTE
    try:
        if not here.poll(seconds):
            raise FileError(
                f"{path.name} was given up after {seconds:.0f} s: it is damaged or far too large."
            )
        answer = here.recv()
    except EOFError:
        raise FileError(f"{path.name} is damaged: it ended the process that tried to read it.") from None
    finally:
        child.kill()
        child.join()
        here.close()
    if isinstance(answer, str):
        raise FileError(answer)
    array, stated = answer
    return array, stated


def _read(path: str, answer: Connection) -> None:
    """In the child: send the array (z, y, x) and the voxel's edges in micrometres, or a sentence."""
    _limit_memory()
    logging.disable(logging.CRITICAL)
    name = Path(path).name
    try:
        answer.send(_parsed(path))
    except FileError as error:
        answer.send(str(error))
    except MemoryError:
        answer.send(f"{name} needs more memory than a reader may use.")
    except Exception:  # noqa: BLE001  whatever the parser trips over is the file's fault
        answer.send(f"{name} is no TIFF file, or is damaged; export it again.")


def _parsed(path: str) -> tuple[NDArray[Any], tuple[float, float, float] | None]:
    import tifffile

    name = Path(path).name
    with tifffile.TiffFile(path) as file:
        series = file.series[0]
        if series.nbytes > LARGEST_VOLUME:
            raise FileError(
                f"{name} has {series.nbytes / 1024**3:.0f} GiB of voxels; 4 GiB are read at most."
            )
        if len(series.shape) != 3:
            raise FileError(f"{name} is no stack of slices: its shape is {series.shape}.")
        array = series.asarray()
        if array.dtype.kind not in "uib":
            raise FileError(f"{name} holds {array.dtype} values; labels are whole numbers.")
        return array, _stated_size(file)


def _stated_size(file: Any) -> tuple[float, float, float] | None:
    metadata = file.imagej_metadata or {}
    tags = file.pages.first.tags
    factor = _MICROMETRES.get(str(metadata.get("unit", "")).strip())
    if factor is None or "XResolution" not in tags or "YResolution" not in tags:
        return None
    edges = [tags[key].value[1] / tags[key].value[0] * factor for key in ("XResolution", "YResolution")]
    return edges[0], edges[1], float(metadata.get("spacing", edges[0] / factor)) * factor


def _limit_memory() -> None:
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
