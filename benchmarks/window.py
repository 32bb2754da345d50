"""What the window takes: ``python -m benchmarks.window moves|cycles|samples|cancel|blocks``.

``moves`` drags all sliders of the page *Explore*, ``cycles`` makes and draws polyhedra by the quick method,
``samples`` opens drawn particles and then the shipped ones again; all three print the megabytes at each look
and their slope with its standard error. ``cancel`` stops each kind of work and prints how long the window did
not answer, ``blocks`` goes through all pages and prints what kept it from answering for more than 50 ms.
``--views live`` needs a display.
"""

import argparse
from typing import Any

from benchmarks.window_blocks import blocks
from benchmarks.window_cancel import stops
from benchmarks.window_driving import opened
from benchmarks.window_growth import coarsened_and_drawn, samples_opened, slider_moves

GROWING = {"moves": slider_moves, "cycles": coarsened_and_drawn, "samples": samples_opened}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.window", description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["moves", "cycles", "samples", "cancel", "blocks"])
    parser.add_argument("--views", choices=["image", "live"], default="image")
    parser.add_argument("--count", type=int, default=1000)
    options = parser.parse_args()
    with opened(options.views) as window:
        if options.what in ("cancel", "blocks"):
            for line in (stops if options.what == "cancel" else blocks)(window):
                print(line, flush=True)
        else:
            _grow(window, options.what, options.count)


def _grow(window: Any, what: str, count: int) -> None:
    growth = GROWING[what](window, count)
    print(growth)
    print(*(f"{n}: {mb:.1f}" for n, mb in zip(growth.acts, growth.megabytes, strict=True)))


if __name__ == "__main__":
    main()
