"""Pictures of graphs."""

from . import _reeb
from ._arguments import check_output, path_bytes


class Picture:
    """A picture as SVG; notebooks show it.

    Attributes:
        svg: its text.
    """

    def __init__(self, svg):
        self.svg = svg

    def __repr__(self):
        return '<reeb picture; .save("picture.svg") writes it>'

    def _repr_svg_(self):
        return self.svg

    def save(self, output, *, force=False):
        """Writes a file: .svg, .png or .pdf (these two need rsvg-convert).

        Raises:
            reeb.Error: the file exists, and `force` is not given; it cannot be written; a program is not installed.
        """
        check_output(output)
        path = path_bytes(output)
        _reeb.write_file(path, _reeb.picture(self.svg, path), force)
