"""Pictures of graphs."""

import os

from . import _reeb
from ._files import check_output, write_whole


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
            reeb.Error: the file exists, and `force` is not given; it cannot be written; a program is not installed.
        """
        check_output(output)
        write_whole(output, _reeb.picture(self.svg, os.fsencode(output)), force)
