"""Arguments that are numbers or names, as the compiled part takes them."""

import math
import os
import warnings

import numpy as np

from . import _reeb
from .errors import Error

MOST = (1 << 63) - 1


def is_path(thing):
    return isinstance(thing, (str, os.PathLike))


def path_bytes(path):
    """The name of a file, as the compiled part takes it."""
    try:
        name = os.fsencode(path)
    except UnicodeEncodeError:
        name = b"\0"
    if b"\0" in name:
        raise Error(f"{path!r} cannot be the name of a file", "choose another name", kind="usage")
    return name


def text_bytes(name, text):
    """A text as the compiled part takes it: UTF-8, whatever the locale; also with other bytes, as os.fsdecode gives."""
    try:
        return text.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError:
        raise Error(f"{name}={text!r} cannot be encoded", "a text of characters", kind="usage") from None


def printable(text):
    """A text that can be printed, where bytes that are not UTF-8 are as \\xFF."""
    return text.encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")


def check_output(path):
    if not is_path(path) or os.fspath(path) == "-":
        raise Error(f"output={path!r} is not a path", "the name of a file to write", kind="usage")
    path_bytes(path)


def warn_of_suffix(path):
    """Of a graph that is written under the name of another format. To be called by what users call."""
    suffix = os.path.splitext(os.fsdecode(path))[1]
    if suffix and suffix.lower() != ".reeb":
        warnings.warn(f"{os.fsdecode(path)} is a .reeb file", stacklevel=3)


def described(thing):
    """As messages name it: "None", "a dict", "an int"."""
    name = type(thing).__name__
    return "None" if thing is None else f"a{'n' if name[0].lower() in 'aeiou' else ''} {name}"


def is_number(thing):
    """What float() takes, but for texts, complex numbers and times."""
    try:
        is_real = isinstance(thing, (int, float, np.number, np.bool_))
        return is_real and not isinstance(thing, (np.complexfloating, np.timedelta64)) and float(thing) is not None
    except (TypeError, OverflowError):
        return False


def is_amount(thing):
    """A number as an argument. True does not count as one: denoise=True does not mean 1."""
    return is_number(thing) and not isinstance(thing, (bool, np.bool_))


def whole(name, value, least, most=MOST):
    """An int within these limits."""
    try:
        number = int(value)
        if number != value or isinstance(value, (bool, np.bool_)):
            raise ValueError
    except (TypeError, ValueError, OverflowError):
        raise Error(f"{name}={value!r} is not a whole number", f"a number from {least} on", kind="usage") from None
    if not least <= number <= most:
        raise Error(f"{name}={value!r} is out of range", f"{least} to {most}", kind="usage")
    return number


def size(name, value):
    """Bytes, of a number or of a text like "64M"."""
    return _reeb.parse_size(text_bytes(name, value)) if isinstance(value, str) else whole(name, value, 0)


def vector(name, given, counts, hint):
    """A list of finite floats, as many as one of `counts`; texts like "1,2.5" have them, too."""
    try:
        values = [float(x) for x in (given.split(",") if isinstance(given, str) else given)]
    except (TypeError, ValueError, OverflowError):
        raise Error(f"{name}={given!r} is not a list of numbers", hint, kind="usage") from None
    if len(values) not in counts:
        raise Error(f"{name} has {len(values)} numbers, not {' or '.join(map(str, counts))}", hint, kind="usage")
    for value in values:
        if not math.isfinite(value):
            raise Error(f"{name}: {value} is not a finite number", hint, kind="usage")
    return values
