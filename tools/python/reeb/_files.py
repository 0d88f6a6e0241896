"""Files that appear only whole."""

import io
import os
import tempfile

from ._arguments import is_path
from .errors import Error, OutputExists, SystemFailure


def check_output(path):
    if not is_path(path):
        raise Error(f"output={path!r} is no path", "the name of a file to write", kind="usage")


def write_whole(path, content, force):
    """Writes the bytes to a file, under another name until all of them are there."""
    check_output(path)
    path = os.fspath(path)
    if not force and os.path.lexists(path):
        raise OutputExists("the output exists already", "choose another name, or force=True", path=path)
    try:
        descriptor, name = tempfile.mkstemp(prefix=".reeb-", dir=os.path.dirname(path) or ".")
        try:
            with io.open(descriptor, "wb") as file:
                file.write(content)
            mask = os.umask(0)
            os.umask(mask)
            os.chmod(name, 0o666 & ~mask)
            os.replace(name, path)
        except BaseException:
            os.unlink(name)
            raise
    except OSError as error:
        raise SystemFailure(
            f"the output cannot be written: {error.strerror}",
            "choose a folder that exists and is writable, and the name of a file in it",
            path=path,
            kind="resource",
        ) from error
