"""The Fortran of pyshtools: loaded on first use, and never in two threads at once.

Its routines keep tables and FFT plans in saved variables, yet release the interpreter while they run: two
threads in them at once corrupt memory (one run in six of a loop over four threads was killed). Everything
that the program asks of pyshtools therefore goes through :func:`call`. It is loaded late because it brings
pandas and xarray along, more than a second of every start.
"""

from importlib import import_module
from threading import RLock
from typing import Any

_one_at_a_time = RLock()


def call(routine: str, *arguments: Any, **options: Any) -> Any:
    """What a routine of SHTOOLS returns, by its place in the package: ``call("expand.SHGLQ", 60)``."""
    module, name = routine.rsplit(".", 1)
    with _one_at_a_time:
        return getattr(import_module(f"pyshtools.{module}"), name)(*arguments, **options)
