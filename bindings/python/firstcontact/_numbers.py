"""Numbers of arguments, refused by the argument's name."""

import operator
from typing import SupportsIndex


def whole_number(value: SupportsIndex, name: str, end: int) -> int:
    """The value as an int in [0, end)."""
    try:
        number = operator.index(value)
    except TypeError:
        number = -1
    if not 0 <= number < end:
        raise ValueError(f"{name}: expected a whole number from 0 to {end - 1}, got {value!r}")
    return number
