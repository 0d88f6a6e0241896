"""Arrays and meshes of other packages, as the compiled part takes them."""

import numpy as np

from . import _reeb
from ._networks import is_network, parts_of_network, values_of_network
from .errors import Error

_MOST_COLUMNS = 9

# Of meshio and of VTK: what is a simplex, and what is divided. VTK counts a few cells in another order.
_SIMPLICES = {"vertex": 1, "line": 2, "triangle": 3, "tetra": 4}
_DIVIDED = {"quad": 4, "hexahedron": 8, "wedge": 6, "pyramid": 5}
_VTK_NAMES = {
    1: "vertex",
    3: "line",
    5: "triangle",
    8: "pixel",
    9: "quad",
    10: "tetra",
    11: "voxel",
    12: "hexahedron",
    13: "wedge",
    14: "pyramid",
}
_BINARY = {"pixel": ("quad", [0, 1, 3, 2]), "voxel": ("hexahedron", [0, 1, 3, 2, 4, 5, 7, 6])}


def numbers(name, array, axes):
    """An array of numbers, copied only if the compiled part has no such type."""
    if np.ma.is_masked(array):
        hint = "array.filled(numpy.nan) of floats, with nodata=\"skip\"" if name == "image" else "leave them out"
        raise Error(f"{name} has masked items", hint)
    try:
        array = np.asarray(array)
    except ValueError as error:  # rows of different lengths
        raise Error(f"{name} is no array: {error}", "give all rows the same length") from error
    if array.ndim not in axes:
        shapes = " or ".join(f"{n}" for n in axes)
        raise Error(f"{name} has {array.ndim} axes, not {shapes}", _shape_hint(name))
    if array.dtype.kind == "b":
        array = array.view(np.uint8)
    if array.dtype.kind not in "iuf":
        raise Error(f"{name} has items of type {array.dtype}, not numbers", f"convert it: array.astype({'int' if _is_of_simplices(name) else 'float'})")
    if array.dtype.kind == "f" and array.dtype.itemsize not in (4, 8):
        array = array.astype(np.float32 if array.dtype.itemsize == 2 else np.float64)
    if not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder("="))
    return array


def _is_of_simplices(name):
    return name.startswith(("faces", "simplices"))


def _shape_hint(name):
    if name == "vertices":
        return "one row for each vertex: an array of shape (n, 3)"
    if _is_of_simplices(name):
        return "one row of corners for each simplex: an array of shape (m, 3)"
    if name == "image":
        return "a 2-D or 3-D array of values, or pass faces as well"
    return "one value for each vertex: an array of shape (n,)"


def vertex_array(vertices):
    array = np.empty((0, 3)) if _is_empty_list(vertices) else numbers("vertices", vertices, (2,))
    if not 1 <= array.shape[1] <= _MOST_COLUMNS:
        raise Error(f"vertices have {array.shape[1]} coordinates", "1 to 9 are possible; an array of shape (n, 3)")
    return array


def simplex_array(name, simplices):
    array = np.asarray(simplices) if _is_empty(simplices) else numbers(name, simplices, (2,))
    if array.size == 0:
        width = array.shape[1] if array.ndim == 2 and 1 <= array.shape[1] <= _MOST_COLUMNS else 3
        return np.empty((0, width), np.int64)
    if not 1 <= array.shape[1] <= _MOST_COLUMNS:
        raise Error(
            f"{name} have {array.shape[1]} columns", "a simplex has 1 to 9 corners; triangles have shape (m, 3)"
        )
    if array.dtype.kind == "f":
        bad = (array != np.floor(array)) | ~(np.abs(array) < 2.0**63)
        if bad.any():
            row, column = np.argwhere(bad)[0]
            raise Error(
                f"{array[row, column]} is no index of a vertex",
                "a row has the indices of vertices, whole numbers from 0",
                position=f"{name}[{row}, {column}]",
            )
        array = array.astype(np.int64)
    return array


def _is_empty_list(array):
    return isinstance(array, (list, tuple)) and len(array) == 0


def _is_empty(array):
    try:
        return np.size(array) == 0
    except ValueError:
        return False


def value_array(name, values, vertices):
    array = numbers(name, values, (1, 2))
    if array.ndim == 2 and array.shape[1] != 1:
        raise Error(f"{name} has {array.shape[1]} columns", _shape_hint(name))
    array = array.reshape(len(array)) if array.ndim == 2 else array
    if len(array) != vertices:
        raise Error(f"{name} has {len(array)} values, but there are {vertices} vertices", _shape_hint(name))
    return array


def mesh_of_arrays(vertices, faces, values):
    """`faces`: an array, or a list of (name, array); `values`: a dict of arrays, by name."""
    vertices = vertex_array(vertices)
    if isinstance(faces, dict):
        faces = _simplices_of_cells(faces)
    elif not (isinstance(faces, list) and faces and isinstance(faces[0], tuple) and isinstance(faces[0][0], str)):
        faces = [("faces", faces)]
    simplices = [(name, simplex_array(name, array)) for name, array in faces]
    columns = [(name, value_array(name, array, len(vertices))) for name, array in values.items()]
    return _reeb.HeldMesh.of_arrays(vertices, columns, simplices)


def _simplices_of_cells(cells):
    simplices = []
    for kind, array in cells.items():
        name = _VTK_NAMES.get(int(kind), f"VTK type {int(kind)}") if not isinstance(kind, str) else kind
        array = np.asarray(array)
        if array.size == 0:
            continue
        if name in _BINARY:
            name, order = _BINARY[name]
            array = array[:, order]
        if name in _SIMPLICES:
            simplices.append((f"faces of type {name}", array))
        elif name in _DIVIDED:
            simplices.append((f"faces of type {name}", _divided(name, array)))
        else:
            raise Error(
                f"cells of type {name} are not taken from memory",
                "write the mesh to a file, as .vtu, and compute from that; or divide the cells into simplices",
            )
    return simplices


def _divided(name, cells):
    width = {"quad": 3}.get(name, 4)
    return _reeb.divide(name, np.ascontiguousarray(cells, np.int64)).reshape(-1, width)


def image_of_array(image, spacing, origin, nodata):
    image = numbers("image", image, (2, 3))
    if image.size == 0:
        raise Error("image has no values", _shape_hint("image"))

    def vector(name, given, default):
        values = [default] * image.ndim if given is None else [float(x) for x in np.ravel(given)]
        if len(values) != image.ndim or not np.all(np.isfinite(values)):
            axes = "x, y" if image.ndim == 2 else "x, y, z"
            raise Error(f"{name} has {len(values)} numbers", f"one finite number for each of {axes}", kind="usage")
        return values

    skip = nodata is not None
    value = None if not skip or nodata == "skip" else float(nodata)
    return _reeb.HeldMesh.of_image(image, vector("origin", origin, 0.0), vector("spacing", spacing, 1.0), skip, value)


def is_mesh_object(thing):
    return is_network(thing) or _parts_of(thing) is not None


def _parts_of(thing):
    if hasattr(thing, "points") and hasattr(thing, "cells_dict"):
        return thing.points, dict(thing.cells_dict)
    if hasattr(thing, "points") and hasattr(thing, "regular_faces"):
        return thing.points, _regular_faces(thing)
    if hasattr(thing, "vertices") and hasattr(thing, "faces"):
        return thing.vertices, thing.faces
    if hasattr(thing, "vertices") and hasattr(thing, "triangles"):
        return np.asarray(thing.vertices), np.asarray(thing.triangles)
    return None


# Polygons with the same number of corners each.
def _regular_faces(thing):
    try:
        faces = np.asarray(thing.regular_faces)
    except ValueError as error:
        raise Error("the mesh has polygons of several kinds", "divide them first: mesh.triangulate()") from error
    if faces.ndim == 2 and faces.shape[1] == 4:
        return {"quad": faces}
    if faces.ndim == 2 and faces.shape[1] > 4:
        fan = [faces[:, [0, k, k + 1]] for k in range(1, faces.shape[1] - 1)]
        return {"triangle": np.concatenate(fan)}
    return {"triangle": faces}


def _point_data(thing):
    for name in ("point_data", "vertex_attributes"):
        data = getattr(thing, name, None)
        if data is not None and hasattr(data, "items"):
            return {key: array for key, array in data.items() if _is_column(array)}
    return {}


def _is_column(array):
    array = np.asarray(array)
    return array.ndim == 1 and array.dtype.kind in "iufb"


def parts_of_object(thing):
    """(vertices, faces, values) of a mesh of trimesh, PyVista, meshio, Open3D, or anything with such parts; of a graph
    of networkx, where `vertices` is None if its nodes have no positions."""
    if is_network(thing):
        return *parts_of_network(thing), values_of_network(thing)
    vertices, faces = _parts_of(thing)
    return vertices, faces, _point_data(thing)
