"""Numbers as the document prints them."""

import math


def number(value: float, digits: int) -> str:
    """A number with so many digits, or a dash where there is none."""
    return "-" if math.isnan(value) else f"{value:.{digits}f}"


def scans(value: float) -> str:
    """A number of scans; NaN is never."""
    return "never" if math.isnan(value) else f"{value:.0f}"


def percent(share: float) -> str:
    """A share 0..1 as per cent."""
    return "-" if math.isnan(share) else f"{100 * share:.1f} %"


def share(value: float) -> str:
    """A share 0..1 with two digits."""
    return number(value, 2)
