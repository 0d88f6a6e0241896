"""What this package raises."""

import re

_KINDS = {1: "input", 2: "usage", 3: "resource", 130: "interrupted"}
# Of libreeb/base/error.h.
_MEMORY, _EXISTS, _MISSING = 1, 2, 3


class Error(Exception):
    """Something is wrong with a file, an array or an argument, or a resource ran out.

    Attributes:
        path: the file, or None.
        position: where in it: a byte offset or "line:column"; for arrays "faces[3, 1]", or "height[2]" of named
            values; or None.
        hint: what to do about it, or an empty text.
        kind: "input" (a file or an array is bad), "usage" (an argument is wrong), "resource" (memory or disk ran
            out), "interrupted".
        message: what is wrong, without the place.
    """

    def __init__(self, message, hint="", *, path=None, position=None, kind="input"):
        self.message = message
        self.hint = hint
        self.path = path
        self.position = position
        self.kind = kind
        place = ":".join(part for part in (path, position) if part)
        text = f"{place}: {message}" if place else message
        super().__init__(f"{text}\nhint: {hint}" if hint else text)

    def __reduce__(self):
        state = {"path": self.path, "position": self.position, "kind": self.kind}
        return _again, (type(self), self.message, self.hint, state)

    # Of an OSError, str() would show the number of the error only.
    def __str__(self):
        return self.args[0]


class OutOfMemory(Error, MemoryError):
    """The memory, or what `memory` allows, does not suffice."""


class SystemFailure(Error, OSError):
    """A file or a folder cannot be written, or the disk is full."""


class MissingFile(Error, FileNotFoundError):
    """An input does not exist."""


class OutputExists(Error, FileExistsError):
    """An output exists, and `force` is not given."""


class MissingPackage(Error, ImportError):
    """Another package is needed, and is not installed."""


def _again(type_, message, hint, state):
    return type_(message, hint, **state)


def _make(kind, cause, path, position, message, hint):
    """The exception for an error of the compiled part."""
    name = _KINDS[kind]
    type_ = {_MEMORY: OutOfMemory, _EXISTS: OutputExists, _MISSING: MissingFile}.get(cause, Error)
    if name == "resource" and type_ is not OutOfMemory:
        type_ = SystemFailure
    if path == "-" or path.startswith("/proc/self/fd/"):  # arrays, or a graph without a file on disk
        path = ""
    message = re.sub(r"/proc/self/fd/\d+", "the graph", message)
    for word, here in _NAMES:
        hint = word.sub(here, hint)
        if name == "usage":
            message = word.sub(here, message)
    return type_(message, hint, path=path or None, position=position or None, kind=name)


def without_path(error):
    """The same of a file that the caller does not know."""
    return type(error)(error.message, error.hint, position=error.position, kind=error.kind)


# What the program's messages call otherwise.
_NAMES = (
    (re.compile(r"--grid (\d[\dx]*) --type (\w+)"), r'grid="\1", type="\2"'),
    (re.compile(r"--grid (\d[\dx]*)"), r'grid="\1"'),
    (re.compile(r"--spacing (\d[\d.]*),(\d[\d.]*),(\d[\d.]*)"), r"spacing=(\1, \2, \3)"),
    (re.compile(r'--(grid|type|spacing) (?=")'), r"\1="),
    (re.compile(r"--memory (\d\w*)"), r'memory="\1"'),
    (re.compile(r"--memory SIZE"), 'memory="64M"'),
    (re.compile(r"with --sidecar|--sidecar"), "with sidecar=True"),
    (re.compile(r"--force"), "force=True"),
    (re.compile(r"--resume"), "resume=True"),
    (re.compile(r"--graph-only"), "graph_only=True"),
    (re.compile(r"--no-reorder"), "reorder=False"),
    (re.compile(r"--manifold"), "manifold=True"),
    (re.compile(r"--nodata skip"), 'nodata="skip"'),
    (re.compile(r"--temp-dir DIR"), 'temp_dir="DIR"'),
    (re.compile(r"--temp-dir"), "temp_dir"),
    (re.compile(r"-o FILE"), "output"),
    (re.compile(r"--(?=[a-z])"), ""),
)
