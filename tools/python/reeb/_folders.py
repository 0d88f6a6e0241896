"""Temporary folders that stay until what uses them has ended, also at the end of Python."""

import atexit
import contextlib
import os
import tempfile
import threading

_changed = threading.Condition()
_folders = set()
_is_registered = _ends = False


@contextlib.contextmanager
def temporary_folder(dir=None):
    """The name of a new folder. Unlike that of mkdtemp, it is removed at the end of Python, too."""
    with _changed:
        # At the end, other threads wait here until Python stops them. What is registered with atexit may go on.
        _changed.wait_for(lambda: not _ends or threading.current_thread() is threading.main_thread())
        folder = tempfile.TemporaryDirectory(prefix="reeb-", dir=dir)
        _folders.add(folder)
        _register()
    try:
        yield folder.name
    finally:
        with _changed:
            if folder in _folders:  # else this is a process that was forked
                try:
                    folder.cleanup()
                finally:
                    _folders.remove(folder)
                    _changed.notify_all()


# What is registered last is called first. So folders are removed after this wait only if it is registered after the
# first of them was made.
def _register():
    global _is_registered
    if not _is_registered:
        atexit.register(_wait_for_users)
        _is_registered = True


def _wait_for_users():
    global _ends
    with _changed:
        _ends = True
        _changed.wait_for(lambda: not _folders)


# The folders are those of the process that made them, and so are the threads that use them.
def _start_over():
    global _changed
    _changed = threading.Condition()
    for folder in _folders:
        folder._finalizer.detach()
    _folders.clear()


os.register_at_fork(after_in_child=_start_over)
