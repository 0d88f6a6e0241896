"""The exact graph of a stream, at any moment."""

import numpy as np

from . import _arrays, _reeb
from .errors import Error
from .graph import _snapshot


class Online:
    """Takes vertices and simplices in batches, in any order in which a simplex comes after its vertices.

        online = reeb.Online()
        online.add_vertices([0.0, 1.0, 2.0])
        online.add_simplices([[0, 1, 2]])
        online.finalize([0])                 # no later simplex names it, so its memory can go
        graph = online.snapshot()

    THREADS: one at a time for each object.
    """

    def __init__(self):
        self._graph = _reeb.Online()

    def add_vertices(self, values, positions=None):
        """Adds the next vertices.

        Args:
            values: (n,) numbers, the function.
            positions: (n, 3) numbers, or none. They are checked, but a snapshot does not have them: its nodes are
                named by their vertices.

        Returns:
            (n,) int64: their indices, which count from 0.

        Raises:
            reeb.Error: a value or a position is not finite; the vertices before it were added.
        """
        values = np.ascontiguousarray(_arrays.numbers("values", values, (1,), _arrays.OF_VALUES), float)
        if positions is None:
            positions = np.empty(0)
        else:
            positions = np.ascontiguousarray(_arrays.numbers("positions", positions, (2,), _arrays.OF_VERTICES), float)
            if positions.shape != (len(values), 3):
                raise Error(f"positions have the shape {positions.shape}", f"({len(values)}, 3)")
        first = self._graph.add_vertices(values, positions)
        return np.arange(first, first + len(values))

    def add_simplices(self, simplices):
        """Adds simplices.

        Args:
            simplices: (m, k) integers, k from 1 to 9; a row has the indices of vertices.

        Raises:
            reeb.Error: a vertex was not added, or is finalized; the simplices before it were added.
        """
        array = _arrays.simplex_array("simplices", simplices)
        self._graph.add_simplices(np.ascontiguousarray(array, np.int64), array.dtype.kind == "u")

    def finalize(self, ids):
        """Says that no later simplex names these vertices.

        Args:
            ids: (n,) integers, or one.
        """
        array = np.atleast_1d(_arrays.numbers("ids", ids, (0, 1), "the indices of vertices", of_indices=True))
        if array.size == 0:
            return
        if array.dtype.kind == "f":
            raise Error("ids has numbers that are not integers", "the indices of vertices")
        self._graph.finalize(np.ascontiguousarray(array, np.int64), array.dtype.kind == "u")

    def snapshot(self):
        """The exact Reeb graph of everything added so far: a Graph of nodes and arcs, without pairs and levels."""
        return _snapshot(self._graph.snapshot())

    @property
    def memory_bytes(self):
        """What it holds, with what a snapshot would take now."""
        return self._graph.memory_bytes()
