"""Write the shipped samples into a folder: ``python -m tools.make_samples FOLDER``."""

import sys
from pathlib import Path

from tools.make_samples.samples import write_samples

if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python -m tools.make_samples FOLDER")
    write_samples(Path(sys.argv[1]))
