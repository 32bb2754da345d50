"""The order in which people expect numbered names."""

import re


def natural_key(name: str) -> list[tuple[int, int, str]]:
    """Sort key by which ``slice10`` comes after ``slice9``."""
    parts = re.split(r"(\d+)", name)
    return [(1, int(part), "") if part.isdigit() and part.isascii() else (0, 0, part) for part in parts]
