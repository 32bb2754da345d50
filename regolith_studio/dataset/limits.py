"""Settings whose fields carry a range in their metadata, checked in one sentence."""

from dataclasses import fields
from typing import Any

from regolith_studio.errors import InputError


def check_limits(settings: Any, what: str) -> None:
    """Every field with a ``minimum`` must lie between it and its ``maximum``.

    Parameters
    ----------
    settings
        A dataclass; a field's ``factor`` and ``unit``, where it has them, are those that users read.
    what
        Such as "MuJoCo setting".

    Raises
    ------
    InputError
        Naming the first that does not; a value that is no number does not either.
    """
    for each in fields(settings):
        limits = each.metadata
        value = getattr(settings, each.name)
        if "minimum" in limits and not limits["minimum"] <= value <= limits["maximum"]:
            factor = limits.get("factor", 1)
            unit = f" {limits['unit']}" if limits.get("unit") else ""
            raise InputError(
                f"The {what} {each.name} must lie between {factor * limits['minimum']:g} and "
                f"{factor * limits['maximum']:g}{unit}, got {factor * value:g}."
            )
