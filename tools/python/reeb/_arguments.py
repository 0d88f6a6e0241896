"""Arguments that are numbers or names, as the compiled part takes them."""

import math
import os

import numpy as np

from .errors import Error

MOST = (1 << 63) - 1


def is_path(thing):
    return isinstance(thing, (str, os.PathLike))


def is_number(thing):
    """What float() takes, but for texts."""
    try:
        return isinstance(thing, (int, float, np.number)) and float(thing) is not None
    except (TypeError, OverflowError):
        return False


def whole(name, value, least, most=MOST):
    """An int within these limits."""
    try:
        number = int(value)
        if number != value:
            raise ValueError
    except (TypeError, ValueError, OverflowError):
        raise Error(f"{name}={value!r} is no whole number", f"a number from {least} on", kind="usage") from None
    if not least <= number <= most:
        raise Error(f"{name}={value!r} is out of range", f"{least} to {most}", kind="usage")
    return number


def vector(name, given, counts, hint):
    """A list of finite floats, as many as one of `counts`; texts like "1,2.5" have them, too."""
    try:
        values = [float(x) for x in (given.split(",") if isinstance(given, str) else given)]
    except (TypeError, ValueError, OverflowError):
        raise Error(f"{name}={given!r} is no list of numbers", hint, kind="usage") from None
    if len(values) not in counts:
        raise Error(f"{name} has {len(values)} numbers, not {' or '.join(map(str, counts))}", hint, kind="usage")
    for value in values:
        if not math.isfinite(value):
            raise Error(f"{name}: {value} is no finite number", hint, kind="usage")
    return values
