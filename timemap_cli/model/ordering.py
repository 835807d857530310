"""What order figures are put in."""


def to_order(figure: float) -> float:
    """A length [m], share or ratio to put in order by: to six digits, as by a last bit no tie may be decided.

    Six digits are finer than any scanner, and coarser than what rounding leaves of a sum in a building's map.
    """
    return round(figure, 6)
