"""Numbers as short texts, for tables and legends."""


def short_number(value: float, digits: int = 4) -> str:
    """`value` with so many significant digits: ``1.05e6``, not ``1.05e+06``; ``0.770``, not ``0.77``.

    Trailing zeros are kept, so that the numbers of a column can be compared.
    """
    text = f"{value:#.{digits}g}"
    if "e" not in text:
        return text.rstrip(".")
    mantissa, _, exponent = text.partition("e")
    return f"{mantissa}e{int(exponent)}"


def grouped_number(value: float, digits: int = 4) -> str:
    """`value` with so many significant digits, its thousands apart: ``12,260``; from 1e8 on ``1.226e8``."""
    rounded = float(f"{value:.{digits}g}")
    if 10.0 ** (digits - 1) <= abs(rounded) < 1e8:
        return f"{rounded:,.0f}"
    return short_number(value, digits)
