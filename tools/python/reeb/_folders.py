"""Temporary folders that stay until what uses them has ended, also at the end of Python."""

import atexit
import contextlib
import os
import tempfile
import threading

_changed = threading.Condition()
_used = 0
_is_registered = _ends = False


@contextlib.contextmanager
def temporary_folder(dir=None):
    """The name of a new folder. Unlike that of mkdtemp, it is removed at the end of Python, too."""
    global _used
    with _changed:
        _changed.wait_for(lambda: not _ends)  # a daemon thread then ends with Python
        _used += 1
    try:
        with tempfile.TemporaryDirectory(prefix="reeb-", dir=dir) as folder:
            _register()
            yield folder
    finally:
        with _changed:
            _used -= 1
            _changed.notify_all()


# What is registered last is called first. So folders are removed after this wait only if it is registered after the
# first of them was made.
def _register():
    global _is_registered
    with _changed:
        if not _is_registered:
            atexit.register(_wait_for_users)
            _is_registered = True


def _wait_for_users():
    global _ends
    with _changed:
        _ends = True
        _changed.wait_for(lambda: _used == 0)


# The threads that use folders are not in the new process.
def _start_over():
    global _changed, _used
    _changed, _used = threading.Condition(), 0


os.register_at_fork(after_in_child=_start_over)
