"""Memory of this machine, for work whose need is known before it begins."""

import os

from regolith_studio.errors import InputError

FALLBACK = 8 * 1024**3
"""Bytes that are assumed where the system does not say how much memory there is."""


def machine_memory() -> int:
    """Bytes of memory that the machine has, used or free."""
    try:
        total = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return FALLBACK
    return total if total > 0 else FALLBACK


def check_memory(n_bytes: float, what: str) -> None:
    """Check before the work that its result can be held.

    ``n_bytes``: bytes that it needs at least. ``what``: what needs them, in the plural, as the beginning of
    a sentence.

    Raises InputError if that is more than the machine has.
    """
    if n_bytes > (there := machine_memory()):
        raise InputError(
            f"{what} need {n_bytes / 1e9:,.0f} GB of memory, and this machine has {there / 1e9:,.0f}; "
            "take fewer."
        )
