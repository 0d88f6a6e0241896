"""Pictures of graphs."""

import os

from . import _reeb


class Picture:
    """A picture as SVG; notebooks show it.

    Attributes:
        svg: its text.
    """

    def __init__(self, svg):
        self.svg = svg

    def _repr_svg_(self):
        return self.svg

    def save(self, output, *, force=False):
        """Writes a file: .svg, .png or .pdf (these two need rsvg-convert).

        Raises:
            reeb.Error: the file exists, and `force` is not given.
        """
        from .graph import _exists

        output = os.fspath(output)
        if not force and os.path.lexists(output):
            raise _exists(output)
        content = _reeb.picture(self.svg, os.fsencode(output))
        with open(output, "wb") as file:
            file.write(content)
