"""What reads a mesh: compute, segment, defects."""

import json
import os
import sys
from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np

from . import _arrays, _reeb
from ._arguments import (
    described,
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
from .errors import Error, SystemFailure, without_path
from .graph import Graph, _open_result

_VALUES = "values"
_WITHOUT_PLACES = ("property:", "file:", "index", "random:", _VALUES)


def compute(
    mesh,
    faces=None,
    values=None,
    f=None,
    *,
    output=None,
    memory=None,
    denoise=None,
    threads=None,
    graph_only=False,
    buckets=64,
    format=None,
    spacing=None,
    origin=None,
    nodata=None,
    grid=None,
    type=None,
    skip=None,
    reorder=True,
    manifold=False,
    sidecar=False,
    snapshot_every=None,
    chunk=None,
    temp_dir=None,
    resume=False,
    force=False,
    progress=None,
):
    """Computes the Reeb graph of a mesh.

    Args:
        mesh: one of
            - a path: the file is read as a stream, and Python never holds the mesh;
            - vertices, an array (n, 3) (or of 1 to 9 columns), together with `faces`;
            - an object of trimesh, PyVista, meshio, or anything with .vertices/.faces, .points/.regular_faces or
              .points/.cells_dict;
            - a networkx.Graph: its nodes in their order, with the attribute `pos`, or x, y and z, as positions, and
              other attributes for f="property:NAME";
            - an image or volume, an array (ny, nx) or (nz, ny, nx), without `faces`. Its vertices are numbered as
              numpy.ravel does. An image 2 or 3 wide needs f="value": else it is taken for vertices without faces.
        faces: simplices, an array (m, k), k from 1 to 9: triangles (m, 3), tetrahedra (m, 4), edges (m, 2). Any type
            of integer, any layout; nothing is copied. A mapping of such arrays by meshio's names of cells is possible.
        values: the function, an array (n,); or a mapping of arrays, of which f="property:NAME" chooses one.
        f: the function: "x", "y", "z", "cK", "index", "random:SEED", "property:NAME", "file:PATH" (.npy, .f64 or
            text), "distance:VERTEX", "distance:X,Y,Z", "geodesic:VERTEX", "laplacian:K", "spectral", "value" (of an
            image). Or an array (n,). Default: "z", or the last coordinate if there are fewer than three; of an image
            "value". A list gives a list of graphs, from one reading.
        output: the .reeb file to write; for several functions a list. Default: nothing is left on disk.
        memory: what the run may use: bytes, or "64M", "1.5GiB". Arrays of the caller and Python are not counted.
        denoise: minima and maxima of less persistence are removed: 0.01 in units of the function, or "0.1%" of its
            range.
        threads: how many; default: all, or 1 for a small mesh.
        graph_only: the graph alone, without pairs and levels.
        buckets: of the embedding of arcs, in function values; 0: none.
        format: of the file, where its content does not tell: "cx", "raw", ...
        spacing, origin: of an image, in the order x, y, z. Default: 1 and 0.
        nodata: "skip" leaves out vertices of an image whose value is NaN (of a file, also the value that its header
            declares); a number leaves out those of this value, too.
        grid, type, skip: of a raw file, as the program's options: "256x256x100", "u16le", bytes.
        reorder, chunk, temp_dir: as the program's options of these names.
        manifold: no edge has more than two triangles, so each is dropped after its second; a third is an error.
        sidecar, resume: as the program's options; of a path only, and resume needs an output.
        snapshot_every: triangles after which the graph so far is written beside the output.
        force: replaces an existing output.
        progress: True for a bar (of tqdm, if that is installed), or a callable (phase, done, total, triangles),
            called by the calling thread a few times a second.

    Returns:
        A Graph, or a list of them if `f` is a list.

    Raises:
        reeb.Error: a bad mesh, array or function, or an output that exists. It is also a FileNotFoundError, a
            FileExistsError, a MemoryError (of `memory`, too) or an OSError (a full disk) where these fit.
        KeyboardInterrupt: Ctrl-C; with an output and a path, `resume=True` can continue.
    """
    functions, several = _functions(f)
    options = {
        "graph_only": bool(graph_only),
        "buckets": whole("buckets", buckets, 0, 1 << 20),
        "reorder": bool(reorder),
        "manifold": bool(manifold),
        "sidecar": bool(sidecar),
        "resume": bool(resume),
        "replace": bool(force),
    }
    _add_common(options, memory, threads, format, temp_dir)
    _add_denoise(options, denoise)
    if chunk is not None:
        options["chunk"] = whole("chunk", chunk, 1)
    if snapshot_every is not None:
        options["snapshot_every"] = whole("snapshot_every", snapshot_every, 1)
    _check_uses(options, output, is_path(mesh))
    if is_path(mesh):
        arrays = [g for g in functions if not isinstance(g, (str, type_none))]
        _refuse_arrays('name a file of values: f="file:PATH.npy"', faces, values, *arrays)
        held = path_bytes(mesh)
        _add_image(options, spacing, origin, nodata, grid, type, skip)
    else:
        _refuse_of_files(format=format, grid=grid, type=type, skip=skip)
        held, functions = _held(mesh, faces, values, functions, spacing, origin, nodata)
    names = ["" if g is None else path_bytes(g) if g.startswith("file:") else text_bytes("f", g) for g in functions]
    outputs = _outputs(output, len(names), several)
    for path in outputs or ():
        warn_of_suffix(path)
    with _Bar(progress) as report:
        graphs = _run(held, names, outputs, options, report)
    return graphs if several else graphs[0]


type_none = type(None)


# What would have no effect is an error.
def _check_uses(options, output, is_file):
    for name, of_files_only in (("resume", True), ("sidecar", True), ("snapshot_every", False)):
        if not options.get(name):
            continue
        if of_files_only and not is_file:
            raise Error(f"{name} is for a mesh in a file", f"leave out {name}, or pass a path", kind="usage")
        if output is None and name != "sidecar":
            raise Error(f"{name} needs an output", 'output="NAME.reeb"', kind="usage")


def _refuse_arrays(hint, *arrays):
    if any(array is not None for array in arrays):
        raise Error("a mesh in a file takes no arrays", hint, kind="usage")


def _refuse_of_files(**options):
    for name, value in options.items():
        if value is not None:
            raise Error(f"{name} is of a file, not of arrays", f"leave out {name}, or pass a path", kind="usage")


def _run(held, names, outputs, options, report):
    if outputs is not None:
        results = _reeb.compute(held, names, [path_bytes(path) for path in outputs], options, report)
        paths = [os.path.abspath(path) for path in outputs]
        return [_open_result({**result, "output": path}, path, None) for result, path in zip(results, paths)]
    with temporary_folder(os.fsdecode(options["temp_dir"]) if "temp_dir" in options else None) as folder:
        outputs = [path_bytes(os.path.join(folder, f"{i}.reeb")) for i in range(len(names))]
        try:
            # Temporary files are beside the output.
            results = _reeb.compute(held, names, outputs, {**options, "temp_dir": path_bytes(folder)}, report)
        except Error as error:
            if error.path is None or not error.path.startswith(folder):
                raise
            error.message = error.message.removesuffix("; the graph itself was written")
            raise without_path(error) from None
        graphs = []
        for result, path in zip(results, outputs):
            with open(path, "rb") as file:
                graphs.append(_open_result({**result, "output": None}, None, file.read()))
            os.remove(path)
        return graphs


def _functions(f):
    names = f if isinstance(f, (list, tuple)) else [f]
    if any(isinstance(g, str) and not g for g in names) or callable(f):
        raise Error("f must be a name or an array", 'as f="x"; or an array (n,) of values', kind="usage")
    if isinstance(f, (list, tuple)) and f and all(g is None or isinstance(g, str) for g in f):
        return list(f), True
    if isinstance(f, (list, tuple)) and any(isinstance(g, str) for g in f):
        raise Error("f mixes names and numbers", 'a list of names, as ["x", "y"], or an array', kind="usage")
    return [f], False


def _held(mesh, faces, values, functions, spacing, origin, nodata):
    """The mesh for the compiled part, and the functions by name."""
    data = {}
    if _arrays.is_mesh_object(mesh) and faces is None:
        vertices, faces, data = _arrays.parts_of_object(mesh)
        mesh = vertices if vertices is not None else _without_positions(len(mesh), values, functions)
    f = functions[0]
    if f is not None and not isinstance(f, str):
        if values is not None:
            raise Error("both values and f are arrays", "pass one of them", kind="usage")
        values, functions = f, [None]
    if faces is None:
        _arrays.check_mesh(mesh)
        if values is not None:
            raise Error(
                "an image takes no other values", "pass the values as the image, or faces for a mesh", kind="usage"
            )
        if not any(g is not None and g.startswith("value") for g in functions):
            _refuse_vertices(mesh, (spacing, origin, nodata))
        return _arrays.image_of_array(mesh, spacing, origin, nodata), functions
    for name, value in (("spacing", spacing), ("origin", origin), ("nodata", nodata)):
        if value is not None:
            raise Error(f"{name} is of an image, not of a mesh", f"leave out {name}", kind="usage")
    if isinstance(values, Mapping):
        data = {**data, **{str(name): array for name, array in values.items()}}
        if len(values) == 1 and functions == [None]:
            functions = [f"property:{next(iter(data if len(data) == 1 else values))}"]
    elif values is not None:
        if any(g not in (None, _VALUES, f"property:{_VALUES}") for g in functions):
            raise Error("both values and f name a function", "pass one of them", kind="usage")
        data[_VALUES] = values
        functions = [f"property:{_VALUES}"] * len(functions)
    functions = [f"property:{_VALUES}" if g == _VALUES else g for g in functions]
    # Only what is used is checked.
    used = {g.split(":", 1)[1] for g in functions if g is not None and g.startswith("property:")}
    return _arrays.mesh_of_arrays(mesh, faces, {name: data[name] for name in data if name in used}), functions


# Vertices of a mesh are an array like an image that is 2 or 3 wide, of which hardly anyone has one.
def _refuse_vertices(array, of_image):
    shape = array.shape if hasattr(array, "shape") else np.shape(np.asarray(array, dtype=object))
    if len(shape) == 2 and shape[0] and shape[1] in (2, 3) and all(option is None for option in of_image):
        raise Error("faces are missing", f'for an image {shape[1]} wide, say f="value"', kind="usage")


# Of a network whose nodes have no positions.
def _without_positions(count, values, functions):
    of_places = [g for g in functions if g is None or isinstance(g, str) and not g.startswith(_WITHOUT_PLACES)]
    if of_places and values is None:
        raise Error(
            f"{of_places[0] or 'z'} is a function of positions, which the nodes of the network do not have",
            'f="property:NAME" of an attribute of the nodes; or give them an attribute pos, as (x, y, z)',
        )
    return np.zeros((count, 3))


def _outputs(output, count, several):
    if output is None:
        return None
    outputs = [output] if is_path(output) or not isinstance(output, (list, tuple)) else list(output)
    for path in outputs:
        if not is_path(path) or os.fspath(path) == "-":
            raise Error(f"output={path!r} is not a path", "the name of a .reeb file to write", kind="usage")
        path_bytes(path)
    if len(outputs) != count:
        raise Error(f"there are {count} functions and {len(outputs)} outputs", "one output for each", kind="usage")
    return [os.fspath(path) for path in outputs]


def _add_common(options, memory, threads, format, temp_dir):
    if memory is not None:
        options["memory"] = size("memory", memory)
    if threads is not None:
        options["threads"] = whole("threads", threads, 1, 1024)
    if format is not None:
        options["format"] = text_bytes("format", str(format))
    if temp_dir is not None:
        if not is_path(temp_dir):
            raise Error(f"temp_dir={temp_dir!r} is not a path", "the name of a folder", kind="usage")
        options["temp_dir"] = path_bytes(temp_dir)
        if not os.path.isdir(temp_dir):
            raise SystemFailure(
                "the folder for temporary files does not exist", "create it", path=os.fspath(temp_dir), kind="resource"
            )


def _add_image(options, spacing, origin, nodata, grid, type_, skip):
    if origin is not None:
        raise Error("origin is of an image in memory", "a file says its own", kind="usage")
    if spacing is not None:
        steps = vector("spacing", spacing, (2, 3), "one finite number for each axis, in the order x, y, z")
        options["spacing"] = ",".join(map(repr, steps))
    if grid is not None:
        options["grid"] = text_bytes("grid", grid) if isinstance(grid, str) else _grid(grid)
    if type_ is not None:
        options["type"] = text_bytes("type", str(type_))
    if skip is not None:
        options["skip"] = whole("skip", skip, 0)
    if nodata is not None:
        if not (isinstance(nodata, str) and nodata == "skip"):
            raise Error(f"nodata={nodata!r} is not possible with a file", 'nodata="skip"', kind="usage")
        options["skip_nodata"] = True


def _grid(sizes):
    if not isinstance(sizes, Iterable):
        raise Error(f"grid={sizes!r} is not a list of numbers", 'as (256, 256, 100), or "256x256x100"', kind="usage")
    return "x".join(str(whole(f"grid[{i}]", size, 1)) for i, size in enumerate(sizes))


def _add_denoise(options, denoise):
    if denoise is None:
        return
    if not isinstance(denoise, str) and not is_amount(denoise):
        raise Error(f"denoise={denoise!r} is not a threshold", 'as 0.01, or "0.1%"', kind="usage")
    text = denoise if isinstance(denoise, str) else repr(float(denoise))
    options["denoise"] = _reeb.parse_threshold("denoise", text_bytes("denoise", text), 0, 1)
    options["denoise_is_share"] = text.strip().endswith("%")
    options["denoise_text"] = text  # for notes


class _Bar:
    """The callback of a progress bar, if one is wanted."""

    def __init__(self, progress):
        if not (progress is None or isinstance(progress, (bool, np.bool_)) or callable(progress)):
            hint = "True, or a function (phase, done, total, triangles)"
            raise Error(f"progress={progress!r} is not a function", hint, kind="usage")
        self._bar = None
        self._callback = progress if callable(progress) else self._show if progress else None

    def __enter__(self):
        return self._callback

    def __exit__(self, *_):
        if self._bar is not None:
            self._bar.close()

    def _show(self, phase, done, total, triangles):
        if self._bar is None:
            self._bar = _make_bar()
        self._bar.show(phase, done, total)


def _make_bar():
    try:
        import tqdm
    except ImportError:
        return _PlainBar()
    return _TqdmBar(tqdm.tqdm)


class _TqdmBar:
    def __init__(self, make):
        self._bar = make(unit="B", unit_scale=True, leave=False)

    def show(self, phase, done, total):
        if self._bar.desc != f"{phase}: ":
            self._bar.reset(total=total or None)
            self._bar.set_description(phase, refresh=False)
        self._bar.total = total or None
        self._bar.update(done - self._bar.n)

    def close(self):
        self._bar.close()


class _PlainBar:
    """A line that is written again and again on a terminal; elsewhere a line for each phase."""

    def __init__(self):
        self._phase = None
        self._is_terminal = sys.stderr.isatty()

    def show(self, phase, done, total):
        if self._is_terminal:
            share = f"{100 * done // total} %" if total else ""
            sys.stderr.write(f"\r{phase} {share}\x1b[K")
        elif phase != self._phase:
            sys.stderr.write(f"{phase}\n")
        self._phase = phase
        sys.stderr.flush()

    def close(self):
        if self._is_terminal:
            sys.stderr.write("\r\x1b[K")
        sys.stderr.flush()


class Segmentation(NamedTuple):
    """Where each vertex of a mesh lies.

    Attributes:
        labels: (n,) int64. Of a vertex on an arc the position of the arc in `graph.arcs`; of a node -1 - its position
            in `graph.nodes`; DROPPED for a vertex of an arc that was dropped, and of an image for one that is left
            out. Parallel arcs have an order of their own.
        values: (n,) float64, the function. NaN for a vertex of an image that is left out.
    """

    labels: np.ndarray
    values: np.ndarray


Segmentation.DROPPED = -(1 << 63)


def segment(
    graph,
    mesh,
    faces=None,
    values=None,
    *,
    memory=None,
    threads=None,
    format=None,
    spacing=None,
    origin=None,
    nodata=None,
    grid=None,
    type=None,
    skip=None,
    temp_dir=None,
    progress=None,
):
    """The arc of `graph`, at its level, on which each vertex of its mesh lies.

    Args:
        graph: of this very mesh, from reeb.compute or reeb.open; a level of it is possible.
        mesh, faces, values: as in reeb.compute; `values` if the graph was computed from them.

    Returns:
        A Segmentation: labels (n,) int64, values (n,) float64.

    Raises:
        reeb.Error: the graph is that of another mesh, or as reeb.compute.
    """
    if not isinstance(graph, Graph):
        raise Error(f"{described(graph)} is not a graph", "reeb.segment(graph, mesh)", kind="usage")
    options = {}
    _add_common(options, memory, threads, format, temp_dir)
    if is_path(mesh):
        _refuse_arrays("leave them out; the graph says its function", faces, values)
        held = path_bytes(mesh)
        _add_image(options, spacing, origin, nodata, grid, type, skip)
    else:
        _refuse_of_files(format=format, grid=grid, type=type, skip=skip)
        is_of_values = values is not None and not isinstance(values, Mapping)
        if is_of_values and not graph.function.startswith(("value", "property:", "file:")):
            raise Error(f"the graph is of {printable(graph.function)}, not of values", "leave out values", kind="usage")
        functions = [None if is_of_values else graph.function]
        held, _ = _held(mesh, faces, values, functions, spacing, origin, nodata)
    file, version = graph._need_file()
    with _Bar(progress) as report, temporary_folder(temp_dir) as folder:
        options["temp_dir"] = path_bytes(folder)
        return Segmentation(*_reeb.segment(held, file, version, options, report))


_DEFECT_COLUMNS = [
    ("rank", "i8"),
    ("lo", "i8"),
    ("hi", "i8"),
    ("persistence", "f8"),
    ("persistence_percent", "f8"),
    ("center", "f8", (3,)),
    ("min", "f8", (3,)),
    ("max", "f8", (3,)),
    ("kind", "U7"),
    ("length_contour", "f8"),
    ("length_cycle", "f8"),
    ("triangles", "i8"),
]


class Defects(NamedTuple):
    """Small loops and other defects of a surface.

    Attributes:
        loops: structured array, the most likely defect first, with the columns of the program's CSV.
        suggested_threshold: dict with length (or None), confidence (0 to 1), why.
        others: dict of {"count", "places"} by "components", "boundaries", "nonmanifold_edges",
            "nonmanifold_vertices", "degenerate", "duplicates", "folded".
    """

    loops: np.ndarray
    suggested_threshold: dict
    others: dict

    def __repr__(self):
        count = len(self.loops)
        text = f"{count or 'no'} loop{'s' * (count != 1)}"
        length = self.suggested_threshold["length"]
        if length is not None:
            text += f", suggested {length:.3g} ({100 * self.suggested_threshold['confidence']:.0f} %)"
        return f"<reeb.Defects: {text}>"


def defects(
    mesh, faces=None, *, graphs=(), memory=None, threads=None, format=None, temp_dir=None, progress=None
):
    """Finds, measures and ranks the small handles and tunnels of a surface, and counts its other defects.

    Args:
        mesh, faces: as in reeb.compute. Arrays are written to a temporary file, since they are read several times.
        graphs: paths of .reeb files of the mesh; default: the graphs of x, y and z are computed.

    Returns:
        Defects.

    Raises:
        reeb.Error: as reeb.compute; a graph of another mesh.
    """
    options = {}
    _add_common(options, memory, threads, format, temp_dir)
    files = _files(graphs)
    with _Bar(progress) as report, temporary_folder(temp_dir) as folder:
        options["temp_dir"] = path_bytes(folder)
        if is_path(mesh):
            _refuse_arrays('name its graphs: graphs=["scan.reeb"]', faces)
            path = path_bytes(mesh)
        else:
            _refuse_of_files(format=format)
            if _arrays.is_mesh_object(mesh) and faces is None:
                mesh, faces, _ = _arrays.parts_of_object(mesh)
            if faces is None:
                _arrays.check_mesh(mesh)
                if np.ndim(mesh) == 3:
                    raise Error("an image is not a surface", "make an isosurface of it first", kind="usage")
                raise Error("faces are missing", "reeb.defects(vertices, faces)", kind="usage")
            path = path_bytes(os.path.join(folder, "mesh.ply"))
            _write_ply(path, mesh, faces)
        try:
            found = json.loads(_reeb.defects(path, files, options, report))
        except Error as error:
            if error.path is None or not error.path.startswith(folder):
                raise
            raise without_path(error) from None
    rows = found.pop("loops")
    threshold = found.pop("suggested_threshold")
    found.pop("schema")
    longest = max((len(row["function"]) for row in rows), default=1)
    columns = [*_DEFECT_COLUMNS, ("function", f"U{longest}")]
    loops = np.zeros(len(rows), columns)
    for i, row in enumerate(rows):
        loops[i] = tuple(_defect_cell(row, column[0]) for column in columns)
    return Defects(loops, threshold, found)


def _files(graphs):
    if graphs is None:
        return []
    paths = [graphs] if is_path(graphs) or not isinstance(graphs, Iterable) else list(graphs)
    for path in paths:
        if not is_path(path):
            hint = 'graphs=["scan.reeb"]; a graph is written with graph.save("scan.reeb")'
            raise Error(f"graphs: {path!r} is not a path", hint, kind="usage")
    return [path_bytes(path) for path in paths]


def _defect_cell(row, name):
    if name in row:
        return float("inf") if row[name] is None else row[name]
    return tuple(row[f"{name}_{axis}"] for axis in "xyz")


def _no_surface():
    return Error("only surfaces have such defects", "vertices of shape (n, 3) and triangles of shape (m, 3)")


# Their numbers are int32 in the file.
_MOST_PLY_VERTICES = 1 << 31


def _write_ply(path, vertices, faces):
    vertices = _arrays.vertex_array(vertices)
    if isinstance(faces, Mapping):
        parts = _arrays.simplices_of_cells(faces, len(vertices))
    else:
        parts = [("faces", _arrays.simplex_array("faces", faces))]
    if vertices.shape[1] != 3 or any(array.shape[1] != 3 for _, array in parts):
        raise _no_surface()
    if len(vertices) > _MOST_PLY_VERTICES:
        raise Error(
            f"{len(vertices)} vertices in arrays are too many", "write the mesh to a file, and give its name"
        )
    for name, array in parts:
        _arrays.check_indices(name, array, len(vertices))
    faces = np.concatenate([np.empty((0, 3), np.int64), *(array.astype(np.int64, copy=False) for _, array in parts)])
    if not np.isfinite(vertices).all():
        row, column = np.argwhere(~np.isfinite(vertices))[0]
        raise Error(
            "a coordinate is not finite", "give every vertex finite numbers", position=f"vertices[{row}, {column}]"
        )
    rows = np.empty(len(faces), [("count", "u1"), ("corners", "<i4", (3,))])
    rows["count"] = 3
    rows["corners"] = faces
    with open(path, "wb") as file:
        file.write(
            f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\nproperty double x\n"
            f"property double y\nproperty double z\nelement face {len(faces)}\n"
            "property list uchar int vertex_indices\nend_header\n".encode()
        )
        np.ascontiguousarray(vertices, "<f8").tofile(file)
        rows.tofile(file)
