"""What the bundle runs: the program, or the module that the program starts in a process of its own.

The program starts Python as ``python [-P] [-B] -m module arguments`` and ``python -c text``; in a bundle
``sys.executable`` is the bundle itself, which therefore understands these.
"""

import multiprocessing
import runpy
import sys

if __name__ == "__main__":
    multiprocessing.freeze_support()
    words = sys.argv[1:]
    while words[:1] in (["-P"], ["-B"]):  # the bundle never looks into the working directory
        words = words[1:]
    if words[:1] == ["-m"]:
        sys.argv = words[1:]
        runpy.run_module(words[1], run_name="__main__", alter_sys=True)
    elif words[:1] == ["-c"]:
        sys.argv = ["-c", *words[2:]]
        exec(words[1])
    else:
        from regolith_studio.__main__ import main

        main()
