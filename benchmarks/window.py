"""What the window takes: ``python -m benchmarks.window start`` (or moves, cycles and so on).

``start`` starts windows one after the other and prints when splash, views and bodies were seen.
``moves`` drags all sliders of the page *Explore*, ``cycles`` makes and draws polyhedra by the quick
method, ``samples`` opens drawn particles and then the shipped ones again; all three print the megabytes
at each look and their slope with its standard error. ``cancel`` stops each kind of work and prints how
long the window did not answer, ``blocks`` goes through all pages and prints what kept it from answering
for more than 50 ms; ``sliders`` times the way from a move to the painted view, ``releases`` that from
the end of a drag to the polyhedron, ``rest`` what a window takes that nobody touches. ``acts`` clicks,
types and drags at random and prints the memory each minute.
``--views live`` needs a display.
"""

import argparse
from typing import Any

from benchmarks.window_blocks import blocks
from benchmarks.window_cancel import stops
from benchmarks.window_driving import opened
from benchmarks.window_growth import coarsened_and_drawn, samples_opened, slider_moves
from benchmarks.window_response import releases, responses, rest
from benchmarks.window_start import starts

GROWING = {"moves": slider_moves, "cycles": coarsened_and_drawn, "samples": samples_opened}
LISTING = {"cancel": stops, "blocks": blocks, "sliders": responses, "releases": releases}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.window", description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["start", *GROWING, *LISTING, "rest", "acts"])
    parser.add_argument("--views", choices=["image", "live"], default="image")
    parser.add_argument(
        "--count", type=int, help="of moves, cycles and samples (1000), starts (5) or minutes of acts (60)"
    )
    options = parser.parse_args()
    if options.what == "start":
        for line in starts(options.count or 5, options.views):
            print(line, flush=True)
        return
    with opened(options.views) as window:
        if options.what in LISTING:
            for line in LISTING[options.what](window):
                print(line, flush=True)
        elif options.what == "rest":
            print(rest(window))
        elif options.what == "acts":
            from benchmarks.window_acts import act_for  # imports Qt, which `opened` sets up

            for line in act_for(window, options.count or 60):
                print(line, flush=True)
        else:
            _grow(window, options.what, options.count or 1000)


def _grow(window: Any, what: str, count: int) -> None:
    growth = GROWING[what](window, count)
    print(growth)
    print(*(f"{n}: {mb:.1f}" for n, mb in zip(growth.acts, growth.megabytes, strict=True)))


if __name__ == "__main__":
    main()
