"""Frames as one animated file: GIF for documents everywhere, WebP for its full range of colours.

Or as a sequence of PNG files, of which any program makes a film.
"""

from collections.abc import Sequence
from pathlib import Path

from PIL import Image

from regolith_studio.errors import InputError
from regolith_studio.scene.figure import Picture

KINDS = (".gif", ".webp", ".png")


def save_animation(frames: Sequence[Picture], seconds: Sequence[float], path: Path) -> None:
    """Write frames of one size that follow each other for ever; PNG files are numbered from 000.

    Parameters
    ----------
    seconds
        How long each frame is seen.

    Raises
    ------
    InputError
        If the ending of the file is none of :data:`KINDS`.
    """
    kind = path.suffix.lower()
    if kind not in KINDS:
        raise InputError(f"Animations are written as {' or '.join(KINDS)}, not as {kind or 'that'}.")
    images = [Image.fromarray(frame[..., :3]) for frame in frames]
    if kind == ".png":
        for number, image in enumerate(images):
            image.save(path.with_name(f"{path.stem}-{number:03d}.png"))
        return
    durations = [round(1000 * each) for each in seconds]
    if kind == ".gif":
        # One palette for all frames: else the background flickers from frame to frame.
        colours = images[-1].quantize(256, method=Image.Quantize.MEDIANCUT)
        images = [image.quantize(palette=colours, dither=Image.Dither.NONE) for image in images]
    images[0].save(path, save_all=True, append_images=images[1:], duration=durations, loop=0)
