"""Reeb graphs, at any level of detail."""

import collections
import contextlib
import io
import math
import os
import warnings
from typing import NamedTuple

import numpy as np

from . import _reeb
from ._arguments import (
    check_output,
    is_amount,
    is_path,
    path_bytes,
    printable,
    size,
    text_bytes,
    vector,
    warn_of_suffix,
    whole,
)
from ._folders import temporary_folder
from .errors import Error, MissingPackage, without_path

_TYPES = np.array(["Ext0", "Ext1", "Ord0", "Rel1"])
_PAIR_COLUMNS = [
    ("type", "U4"),
    ("lo", "i8"),
    ("hi", "i8"),
    ("lo_value", "f8"),
    ("hi_value", "f8"),
    ("persistence", "f8"),
    ("lo_x", "f8"),
    ("lo_y", "f8"),
    ("lo_z", "f8"),
    ("hi_x", "f8"),
    ("hi_y", "f8"),
    ("hi_z", "f8"),
    ("kept", "i1"),
]


_PICTURES = ("graph", "skeleton", "diagram", "loops")


class Skeleton(NamedTuple):
    """A graph as lines in space.

    Attributes:
        points: (n, 3) float64; first the nodes, in their order, then the points of arcs, from below.
        edges: (m, 2) int64, positions in `points`.
        radius: (n,) float64, that of the contour around a point; of a node the mean of those next to it. NaN where the
            file knows none: without buckets, and in files of version 1.
        arc: (m,) int64, of each edge the position of its arc in `graph.arcs`.
    """

    points: np.ndarray
    edges: np.ndarray
    radius: np.ndarray
    arc: np.ndarray


class _Store:
    """The .reeb file of a graph: at a path, or as bytes."""

    def __init__(self, path, content):
        self.path, self.content = path, content
        self._file = None

    def file(self):
        if self.content is not None:
            return _reeb.File.from_bytes(self.content)
        if self._file is None:
            self._file = _reeb.File(path_bytes(self.path))
        return self._file

    @contextlib.contextmanager
    def named(self):
        """The file under a name that a title can show."""
        if self.path is not None:
            yield self.file()
            return
        with temporary_folder() as folder:
            path = os.path.join(folder, "graph.reeb")
            with io.open(path, "wb") as file:
                file.write(self.content)
            try:
                yield _reeb.File(path_bytes(path))
            except Error as error:
                if error.path != path:
                    raise
                raise without_path(error) from None

    def bytes(self):
        """As the file was when it was opened: the name may be that of another file by now."""
        return self.content if self.content is not None else self.file().bytes()


class Graph:
    """A Reeb graph at one level of detail. What it has is loaded when it is asked for.

    Two graphs are equal if their nodes and arcs are. A graph can be pickled. Its arrays cannot be written to.

    Attributes:
        function: the name of the function, as "z".
        result: dict of what the run said: counts of the mesh and of the full graph, seconds, notes; empty if the
            graph comes from a file.
    """

    def __init__(self):
        raise TypeError("graphs come from reeb.compute, reeb.open and reeb.Online")

    @classmethod
    def _make(cls, store, version=0, *, arrays=None, function="", result=None, listener=None, asked=""):
        graph = cls.__new__(cls)
        graph._store, graph._version, graph._arrays, graph._asked = store, version, arrays, asked
        graph._pairs = graph._header = graph._levels = None
        graph._listener, graph._progressive, graph._untold = listener, None, collections.deque()
        graph.result = result or {}
        graph.function = function or (graph.header["function"] if store is not None else "")
        return graph

    # -- what it has

    @property
    def nodes(self):
        """Structured array (n,), in the order of the function: vertex (int64, its index in the mesh), value, x, y, z
        (float64; NaN if not known), down, up (int32, the numbers of arcs)."""
        return self._load()["nodes"]

    @property
    def arcs(self):
        """(m, 2) int64: the lower and the upper node of each arc, as positions in `nodes`. Parallel arcs repeat."""
        return self._load()["arcs"]

    @property
    def pairs(self):
        """The persistence pairs of this level, by falling persistence: a structured array with the columns of
        `reeb pairs`; `type` is "Ord0", "Rel1", "Ext0" or "Ext1".

        Raises:
            reeb.Error: the graph was computed with graph_only.
        """
        if self._pairs is None:
            self._pairs = self._load_pairs()
        return self._pairs

    def loops(self):
        """The rows of `pairs` that are loops (of type "Ext1"), the largest first."""
        return self.pairs[self.pairs["type"] == "Ext1"]

    @property
    def components(self):
        """The number of connected components (b0)."""
        if self._store is not None:
            return self.header["components"]  # no level cancels one
        parent = _union(len(self.nodes), self.arcs)
        return int(np.count_nonzero(parent == np.arange(len(parent))))

    @property
    def loop_count(self):
        """The number of independent loops (b1)."""
        return len(self.arcs) - len(self.nodes) + self.components

    @property
    def header(self):
        """dict: what the .reeb file says of the mesh, the function and the full graph."""
        if self._header is None:
            self._header = self._need_file()[0].header()
        return self._header

    @property
    def range(self):
        """(least, greatest) value of the function on the mesh."""
        return self.header["min"], self.header["max"]

    @property
    def path(self):
        """The .reeb file, or None if there is none on disk."""
        return self._store.path if self._store is not None else None

    @property
    def threshold(self):
        """The least threshold that yields this level, in units of the function; 0 for the full graph."""
        return self._load().get("threshold", 0.0)

    def save(self, path, *, force=False):
        """Writes the .reeb file, with all levels.

        Raises:
            reeb.Error: it exists, and `force` is not given (also a FileExistsError), or it cannot be written (also an
                OSError).
        """
        if self._store is None:
            self._need_file()
        check_output(path)
        warn_of_suffix(path)
        _reeb.write_file(path_bytes(path), self._store.bytes(), force)

    # -- levels

    @property
    def levels(self):
        """Structured array of levels, from coarse to fine, whose size is known: threshold, nodes, arcs, memory
        (bytes)."""
        rows = self._level_lines()
        table = np.zeros(len(rows), [("threshold", "f8"), ("nodes", "i8"), ("arcs", "i8"), ("memory", "i8")])
        for i, row in enumerate(rows):
            table[i] = row[1:]
        return table

    def level(self, threshold=None, *, nodes=None, memory=None):
        """The graph after all features of less persistence were cancelled.

        Args: (one of them)
            threshold: in units of the function, or as "0.1%" of its range.
            nodes: the finest level with at most this many nodes.
            memory: the finest level that takes at most this: bytes, or "64M".

        Returns:
            Another Graph, which shares the file.

        Raises:
            reeb.Error: even the coarsest level is larger, or the graph has no levels.
        """
        version = self._choose(threshold, nodes, memory)
        asked = _threshold_text(threshold)
        return Graph._make(self._store, version, function=self.function, result=self.result, asked=asked)

    def refine(self, threshold=None, *, nodes=None, memory=None):
        """Moves this graph to a finer level: that of level(); or, without arguments, to the next of `levels`. A level
        that is coarser changes nothing. Returns the graph.

        With a listener (reeb.open), its methods are called for each change: node_added(node, vertex, value,
        position), node_removed(node), arc_added(arc, lo, hi), arc_removed(arc). Nodes and arcs are named by numbers
        that they keep. If a method raises, the graph stays at its level, and the next move begins with the changes
        that were not told.
        """
        lines = [line[0] for line in self._level_lines()]
        if (threshold, nodes, memory) == (None, None, None):
            version = next((v for v in lines if v < self._version), self._version)
        else:
            version = min(self._version, self._choose(threshold, nodes, memory))
        return self._go_to(version)

    def coarsen(self, threshold=None, *, nodes=None, memory=None):
        """Moves this graph to a coarser level, as refine() does to a finer one."""
        lines = [line[0] for line in self._level_lines()]
        if (threshold, nodes, memory) == (None, None, None):
            version = next((v for v in reversed(lines) if v > self._version), self._version)
        else:
            version = max(self._version, self._choose(threshold, nodes, memory))
        return self._go_to(version)

    # -- other forms

    def skeleton(self):
        """The graph as lines through the shape of the mesh.

        Returns:
            A Skeleton: points (n, 3), edges (m, 2), radius (n,), arc (m,).
        """
        arrays = self._load()
        nodes, arcs = arrays["nodes"], arrays["arcs"]
        offsets, inner = arrays.get("offsets"), arrays.get("points")
        if offsets is None:
            offsets, inner = np.zeros(len(arcs) + 1, np.int64), np.empty((0, 3))
        offsets = offsets.astype(np.int64)
        points = np.concatenate([_positions(nodes), inner])
        # The lines of all arcs, one after the other: lower node, points, upper node.
        lengths = np.diff(offsets)
        starts = np.concatenate([[0], np.cumsum(lengths + 2)]).astype(np.int64)
        line = np.empty(starts[-1], np.int64)
        line[starts[:-1]] = arcs[:, 0]
        line[starts[1:] - 1] = arcs[:, 1]
        is_inner = np.ones(len(line), bool)
        is_inner[starts[:-1]] = is_inner[starts[1:] - 1] = False
        line[is_inner] = len(nodes) + np.arange(len(inner))
        is_edge = np.ones(len(line), bool)
        is_edge[starts[1:] - 1] = False
        begin = np.flatnonzero(is_edge)
        edges = np.stack([line[begin], line[begin + 1]], axis=1)
        arc = np.repeat(np.arange(len(arcs)), lengths + 1)
        radius = arrays.get("radii")
        if radius is None:
            radius = np.full(len(points), np.nan)
        return Skeleton(points, edges, radius.copy(), arc)

    def to_networkx(self):
        """A networkx.MultiGraph, since parallel arcs are real. Nodes are positions in `nodes`, with the columns of a
        node as attributes; an edge has the attribute `arc`, its position in `arcs`."""
        try:
            import networkx
        except ImportError as error:
            raise _missing("to_networkx()", "networkx", "python3-networkx") from error
        graph = networkx.MultiGraph(function=self.function)
        names = self.nodes.dtype.names
        graph.add_nodes_from((i, dict(zip(names, row))) for i, row in enumerate(self.nodes.tolist()))
        graph.add_edges_from((lo, hi, {"arc": i}) for i, (lo, hi) in enumerate(self.arcs.tolist()))
        return graph

    def to_polydata(self):
        """The skeleton as pyvista.PolyData, or as vtkPolyData if there is only VTK. Point data: Value, VertexId (-1
        between nodes). Cell data: SegmentationId (the position of the arc)."""
        points, edges, _, arc = self.skeleton()
        between = len(points) - len(self.nodes)
        vertex = np.concatenate([self.nodes["vertex"], np.full(between, -1)])
        value = np.concatenate([self.nodes["value"], np.full(between, np.nan)])
        # Between nodes the function rises along the line.
        value = _fill_values(value, edges, arc)
        points = np.nan_to_num(points)
        try:
            import pyvista
        except ImportError:
            return _vtk_lines(points, edges, {"Value": value, "VertexId": vertex}, {"SegmentationId": arc})
        data = pyvista.PolyData(points, lines=np.insert(edges, 0, 2, axis=1).ravel())
        data.point_data["Value"], data.point_data["VertexId"] = value, vertex
        data.cell_data["SegmentationId"] = arc
        return data

    def to_gudhi(self):
        """The four lists that extended_persistence() of GUDHI returns: Ordinary, Relative, Extended+, Extended-. An
        item is (dimension, (birth, death)); of Relative and Extended- the birth is above the death."""
        lists = []
        for type_, dimension, falls in (("Ord0", 0, False), ("Rel1", 1, True), ("Ext0", 0, False), ("Ext1", 1, True)):
            rows = self.pairs[self.pairs["type"] == type_]
            birth, death = ("hi_value", "lo_value") if falls else ("lo_value", "hi_value")
            lists.append([(dimension, (b, d)) for b, d in zip(rows[birth].tolist(), rows[death].tolist())])
        return lists

    def to_persim(self):
        """Persistence diagrams by dimension, as persim and ripser have them: two arrays (k, 2) of birth and death,
        lower value first. Dimension 0 has Ord0 and Ext0, dimension 1 Rel1 and Ext1."""

        def diagram(*types):
            rows = self.pairs[np.isin(self.pairs["type"], types)]
            return np.stack([rows["lo_value"], rows["hi_value"]], axis=1)

        return [diagram("Ord0", "Ext0"), diagram("Rel1", "Ext1")]

    def plot(self, output=None, *, kind="graph", mesh=None, view=None, force=False):
        """A picture of this level.

        Args:
            output: a file to write: .svg, .png or .pdf. Default: none.
            kind: "graph" (laid out by value), "skeleton" (in space), "diagram" (of pairs), "loops" (their number
                above a persistence). The first needs Graphviz, the last two gnuplot.
            mesh: for a skeleton, the path of the mesh that it is drawn into.
            view: for a skeleton, (x, y, z) towards the eye.

        Returns:
            A Picture, which notebooks show; `.svg` is its text.
        """
        from .pictures import Picture

        self._need_file()
        if not isinstance(kind, str) or kind not in _PICTURES:
            raise Error(f"there is no picture of kind {kind!r}", f"one of: {' '.join(_PICTURES)}", kind="usage")
        for name, value in (("mesh", mesh), ("view", view)):
            if value is not None and kind != "skeleton":
                raise Error(f"{name} is for a skeleton", f'kind="skeleton", or leave out {name}', kind="usage")
        if mesh is not None and not is_path(mesh):
            raise Error("a skeleton is drawn into a mesh in a file only", "mesh=PATH", kind="usage")
        if view is not None:
            hint = "(x, y, z), towards the eye"
            view = vector("view", view, (3,), hint)
            if not any(view):
                raise Error("view=(0, 0, 0) is not a direction", hint, kind="usage")
        with self._store.named() as file:
            path = "" if mesh is None else path_bytes(mesh)
            text = _reeb.plot(file, self._version, self._asked, kind, path, view)
        picture = Picture(text)
        if output is not None:
            picture.save(output, force=force)
        return picture

    # -- Python

    def __eq__(self, other):
        if not isinstance(other, Graph):
            return NotImplemented
        # NaN is a position that is not known.
        return np.array_equal(self.arcs, other.arcs) and _same_rows(self.nodes, other.nodes)

    __hash__ = None

    def __repr__(self):
        arrays = self._arrays
        if arrays is None and self._store is not None and self._version == 0:
            nodes, arcs = self.header["nodes"], self.header["arcs"]
        else:
            nodes, arcs = len(self.nodes), len(self.arcs)
        level = f", level of threshold {self.threshold:g}" if self._version else ""
        counts = f"{nodes} node{'s' * (nodes != 1)}, {arcs} arc{'s' * (arcs != 1)}"
        return f"<reeb.Graph of {printable(self.function) or 'a stream'}: {counts}{level}>"

    def _repr_html_(self):
        from html import escape

        return f"<pre>{escape(repr(self))}</pre>"

    def __getstate__(self):
        content = self._store.bytes() if self._store is not None else None
        arrays = None if self._store is not None else self._arrays
        return (content, self._version, arrays, self.function, self.result, self._asked)

    def __setstate__(self, state):
        content, version, arrays, function, result, asked = state
        store = _Store(None, content) if content is not None else None
        self.__dict__.update(
            Graph._make(store, version, arrays=arrays, function=function, result=result, asked=asked).__dict__
        )

    # -- within

    def _need_file(self):
        if self._store is None:
            raise Error(
                "a snapshot has the nodes and arcs only",
                "compute the graph with reeb.compute for pairs and levels",
                kind="usage",
            )
        return self._store.file(), self._version

    def _load(self):
        if self._arrays is None:
            file, version = self._need_file()
            self._arrays = file.load(version)
            for array in self._arrays.values():
                if isinstance(array, np.ndarray):
                    array.flags.writeable = False
        return self._arrays

    def _load_pairs(self):
        file, version = self._need_file()
        columns = file.pairs()
        # The first pairs were cancelled; those that cannot be are in every level.
        cancellable = (columns["kept"] == 0) & (columns["type"] != 0)
        stays = ~cancellable | (np.cumsum(cancellable) > version)
        rows = np.zeros(int(np.count_nonzero(stays)), _PAIR_COLUMNS)
        for name, _ in _PAIR_COLUMNS:
            if name == "type":
                rows["type"] = _TYPES[columns["type"][stays]]
            elif name != "persistence":
                rows[name] = columns[name][stays]
        rows["persistence"] = rows["hi_value"] - rows["lo_value"]
        order = np.lexsort((rows["hi"], rows["lo"], columns["type"][stays], -rows["persistence"]))
        rows = rows[order]
        rows.flags.writeable = False
        return rows

    def _level_lines(self):
        if self._levels is None:
            self._levels = self._need_file()[0].levels()
        return self._levels

    def _choose(self, threshold, nodes, memory):
        choices = {"threshold": threshold, "nodes": nodes, "memory": memory}
        given = [name for name, choice in choices.items() if choice is not None]
        if len(given) != 1:
            what = f"{' and '.join(given)} given" if given else "level() needs one of threshold, nodes, memory"
            raise Error(what, 'one of these, as level("1%") or level(nodes=100)', kind="usage")
        file = self._need_file()[0]
        if nodes is not None:
            return file.finest_with_nodes(whole("nodes", nodes, 0))
        if memory is not None:
            return file.finest_with_memory(size("memory", memory))
        if not isinstance(threshold, str) and (not is_amount(threshold) or not threshold >= 0):
            raise Error(f"threshold={threshold!r} is not a threshold", 'as 0.01, or "0.1%"', kind="usage")
        least, greatest = self.range
        value = threshold
        if isinstance(threshold, str):
            value = _reeb.parse_threshold("threshold", text_bytes("threshold", threshold), least, greatest)
        value = float(value)
        text = _threshold_text(threshold)
        function = text_bytes("function", self.function)
        if math.isfinite(value) and (note := _reeb.large_threshold(text, least, greatest, function)):
            warnings.warn(note, stacklevel=3)
        return file.version_at(value)

    def _go_to(self, version):
        if self._listener is not None:
            self._listen(version)
        if version != self._version:
            self._version, self._arrays, self._pairs, self._asked = version, None, None, ""
        return self

    def _listen(self, version):
        if self._progressive is None:
            self._progressive = _reeb.Progressive(self._need_file()[0])
        self._untold.extend(self._progressive.go_to_version(version))
        while self._untold:
            name, *change = self._untold.popleft()
            method = getattr(self._listener, name, None)
            if method is not None:
                method(*change)


def open(path, *, threshold=None, nodes=None, memory=None, listener=None):
    """Opens a .reeb file. Nothing but its header is read before it is needed, and a level needs a part of the file
    only.

    Args:
        path: the file.
        threshold, nodes, memory: the level to begin with, as Graph.level(); default: the full graph.
        listener: an object with any of the methods node_added, node_removed, arc_added, arc_removed (see
            Graph.refine). It is told of the first level, too.

    Returns:
        A Graph.

    Raises:
        reeb.Error: the file is damaged, or none (also a FileNotFoundError if there is no file).
    """
    if not is_path(path):
        raise Error(f"{path!r} is not a path", "the name of a .reeb file", kind="usage")
    path_bytes(path)
    path = os.path.abspath(os.fspath(path))
    graph = Graph._make(_Store(path, None), listener=listener)
    version = 0
    if (threshold, nodes, memory) != (None, None, None):
        version = graph._choose(threshold, nodes, memory)
    graph._version, graph._asked = version, _threshold_text(threshold)
    if listener is not None:
        graph._listen(version)
    return graph


def _open_result(result, path, content):
    store = _Store(path, content)
    store.file()  # another run may replace the file before it is needed
    return Graph._make(store, function=result["function"], result=result)


def _snapshot(arrays):
    for array in arrays.values():
        array.flags.writeable = False
    return Graph._make(None, arrays=arrays)


def _missing(method, packages, of_debian):
    return MissingPackage(
        f"{method} needs the Python package {packages}, which is not installed",
        f"install it, on Debian as {of_debian}",
        kind="resource",
    )


def _threshold_text(threshold):
    """As titles say it, and as the compiled part reads it."""
    return "" if threshold is None else threshold if isinstance(threshold, str) else repr(float(threshold))


def _positions(nodes):
    return np.stack([nodes["x"], nodes["y"], nodes["z"]], axis=1)


def _same_rows(a, b):
    if a.shape != b.shape:
        return False
    return all(np.array_equal(a[name], b[name], equal_nan=name in "xyz") for name in a.dtype.names)


def _union(count, arcs):
    parent = np.arange(count)

    def root(i):
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    for lo, hi in arcs.tolist():
        parent[root(lo)] = root(hi)
    return np.array([root(i) for i in range(count)], int) if count else parent


# Linear along each arc by the number of points, where there is no value.
def _fill_values(value, edges, arc):
    value = value.copy()
    if len(edges) == 0:
        return value
    starts = np.flatnonzero(np.concatenate([[True], arc[1:] != arc[:-1]]))
    for begin, end in zip(starts, np.concatenate([starts[1:], [len(arc)]])):
        lo, hi = value[edges[begin, 0]], value[edges[end - 1, 1]]
        inner = edges[begin : end - 1, 1]
        value[inner] = lo + (hi - lo) * np.arange(1, len(inner) + 1) / (len(inner) + 1)
    return value


def _vtk_lines(points, edges, point_data, cell_data):
    try:
        from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
        from vtkmodules.vtkCommonCore import vtkPoints
        from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    except ImportError as error:
        raise _missing("to_polydata()", "pyvista or vtk", "python3-vtk9") from error
    data = vtkPolyData()
    places = vtkPoints()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    data.SetPoints(places)
    lines = vtkCellArray()
    lines.SetData(
        numpy_to_vtkIdTypeArray(2 * np.arange(len(edges) + 1), deep=True),
        numpy_to_vtkIdTypeArray(np.ascontiguousarray(edges.ravel()), deep=True),
    )
    data.SetLines(lines)
    for target, arrays in ((data.GetPointData(), point_data), (data.GetCellData(), cell_data)):
        for name, values in arrays.items():
            array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
            array.SetName(name)
            target.AddArray(array)
    data.GetPointData().SetActiveScalars("Value")
    return data
