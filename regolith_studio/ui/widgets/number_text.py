"""Numbers as they are read in narrow tables."""


def short_number(value: float, digits: int = 4) -> str:
    """`value` with so many significant digits: ``1.05e6``, not ``1.05e+06``; ``0.770``, not ``0.77``.

    Zeros at the end are kept, so that the numbers of a column can be compared at a glance.
    """
    text = f"{value:#.{digits}g}"
    if "e" not in text:
        return text.rstrip(".")
    mantissa, _, exponent = text.partition("e")
    return f"{mantissa}e{int(exponent)}"
