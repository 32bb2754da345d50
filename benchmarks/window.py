"""Whether the window grows while it is used: ``python -m benchmarks.window moves|cycles``.

``moves`` drags all sliders of the page *Explore*, ``cycles`` makes and draws polyhedra by the quick method;
``--views live`` needs a display. Prints the megabytes at each look and their slope with its standard error.
"""

import argparse

from benchmarks.window_driving import opened
from benchmarks.window_growth import coarsened_and_drawn, slider_moves


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.window", description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["moves", "cycles"])
    parser.add_argument("--views", choices=["image", "live"], default="image")
    parser.add_argument("--count", type=int, default=1000)
    options = parser.parse_args()
    with opened(options.views) as window:
        growth = {"moves": slider_moves, "cycles": coarsened_and_drawn}[options.what](window, options.count)
        print(growth)
        print(*(f"{n}: {mb:.1f}" for n, mb in zip(growth.acts, growth.megabytes, strict=True)))


if __name__ == "__main__":
    main()
