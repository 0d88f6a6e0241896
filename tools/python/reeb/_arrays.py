"""Arrays and meshes of other packages, as the compiled part takes them."""

from collections.abc import Mapping

import numpy as np

from . import _reeb
from ._arguments import described, is_amount, text_bytes, vector
from ._networks import is_network, parts_of_network, values_of_network
from .errors import Error

_MOST_COLUMNS = 9

# Of meshio and of VTK: what is a simplex, and what is divided. VTK counts a few cells in another order.
_SIMPLICES = {"vertex": 1, "line": 2, "triangle": 3, "tetra": 4}
_DIVIDED = {"quad": 4, "hexahedron": 8, "wedge": 6, "pyramid": 5, "pixel": 4, "voxel": 8}
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


def numbers(name, array, axes, shape, *, of_indices=False):
    """An array of numbers, copied only if the compiled part has no such type. `shape` is a hint."""
    if np.ma.is_masked(array):
        hint = 'array.filled(numpy.nan) of floats, with nodata="skip"' if shape == _OF_IMAGE else "leave them out"
        raise Error(f"{name} has masked items", hint)
    try:
        array = np.asarray(array)
    except ValueError as error:  # rows of different lengths
        raise Error(f"{name} is not an array", "give all rows the same length") from error
    if array.ndim == 0 and array.dtype.kind not in "iufb":
        raise Error(f"{name} is {described(array.item())}, not an array", shape)
    if array.ndim not in axes:
        unit = "axis" if array.ndim == 1 else "axes"
        raise Error(f"{name} has {array.ndim} {unit}, not {' or '.join(map(str, axes))}", shape)
    if array.dtype.kind == "b":
        if of_indices:
            raise Error(f"{name} has true and false, not indices of vertices", _INDICES)
        array = array.view(np.uint8)
    if array.dtype.kind not in "iuf":
        type_ = "int" if of_indices else "float"
        raise Error(f"{name} has items of type {array.dtype}, not numbers", f"convert it: array.astype({type_})")
    if array.dtype.kind == "f" and array.dtype.itemsize not in (4, 8):
        array = array.astype(np.float32 if array.dtype.itemsize == 2 else np.float64)
    if not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder("="))
    return array


OF_VERTICES = "one row for each vertex: an array of shape (n, 3)"
OF_VALUES = "one value for each vertex: an array of shape (n,)"
_OF_SIMPLICES = "one row of corners for each simplex: an array of shape (m, 3)"
_OF_IMAGE = "a 2-D or 3-D array of values, or pass faces as well"
_INDICES = "a row has the indices of vertices, whole numbers from 0"


def vertex_array(vertices):
    array = np.empty((0, 3)) if _is_empty_list(vertices) else numbers("vertices", vertices, (2,), OF_VERTICES)
    if not 1 <= array.shape[1] <= _MOST_COLUMNS:
        raise Error(f"vertices have {array.shape[1]} coordinates", "1 to 9 are possible; an array of shape (n, 3)")
    return array


def simplex_array(name, simplices, shape=_OF_SIMPLICES):
    array = np.asarray(simplices) if _is_empty(simplices) else numbers(name, simplices, (2,), shape, of_indices=True)
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
                f"{array[row, column]} is not the index of a vertex",
                _INDICES,
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
    array = numbers(name, values, (1, 2), OF_VALUES)
    if array.ndim == 2 and array.shape[1] != 1:
        raise Error(f"{name} has {array.shape[1]} columns", OF_VALUES)
    array = array.reshape(len(array)) if array.ndim == 2 else array
    if len(array) != vertices:
        raise Error(f"{name} has {len(array)} values, but there are {vertices} vertices", OF_VALUES)
    return array


def mesh_of_arrays(vertices, faces, values):
    """`faces`: an array, or arrays by the names of cells; `values`: a dict of arrays, by name."""
    vertices = vertex_array(vertices)
    if isinstance(faces, Mapping):
        simplices = simplices_of_cells(faces, len(vertices))
    else:
        simplices = [("faces", simplex_array("faces", faces))]
    columns = [
        (text_bytes("values", str(name)), value_array(name, array, len(vertices))) for name, array in values.items()
    ]
    return _reeb.HeldMesh.of_arrays(vertices, columns, simplices)


def simplices_of_cells(cells, vertices):
    """A list of (name, array): what is in the dict, or what it is divided into."""
    simplices = []
    for kind, array in cells.items():
        if _is_empty(array):
            continue
        name = _name_of_cells(kind)
        width = _SIMPLICES.get(name) or _DIVIDED.get(name)
        if width is None:
            raise Error(
                f"cells of type {name} are not taken from memory",
                "write the mesh to a file, as .vtu, and compute from that; or divide the cells into simplices",
            )
        shape = f"one row of corners for each cell: an array of shape (m, {width})"
        array = simplex_array(name, array, shape)
        if array.shape[1] != width:
            raise Error(f"{name} has {array.shape[1]} columns, not {width}", shape)
        simplices.append((name, array if name in _SIMPLICES else _divided(name, array, vertices)))
    return simplices


def _name_of_cells(kind):
    if isinstance(kind, (int, np.integer)):
        return _VTK_NAMES.get(int(kind), f"VTK type {kind}")
    return str(kind)


def _divided(name, cells, vertices):
    check_indices(name, cells, vertices)  # later they are those of simplices
    if name in _BINARY:
        name, order = _BINARY[name]
        cells = cells[:, order]
    return _reeb.divide(name, np.ascontiguousarray(cells, np.int64)).reshape(-1, 3 if name == "quad" else 4)


def check_indices(name, array, vertices):
    bad = (array < 0) | (array >= vertices)
    if bad.any():
        row, column = np.argwhere(bad)[0]
        raise Error(
            f"names vertex {array[row, column]}, but there are {vertices} vertices",
            "vertices are numbered from 0",
            position=f"{name}[{row}, {column}]",
        )


def image_of_array(image, spacing, origin, nodata):
    image = numbers("image", image, (2, 3), _OF_IMAGE)
    if image.size == 0:
        raise Error("image has no values", _OF_IMAGE)

    hint = f"one finite number for each of {'x, y' if image.ndim == 2 else 'x, y, z'}"
    origin = vector("origin", [0] * image.ndim if origin is None else origin, (image.ndim,), hint)
    spacing = vector("spacing", [1] * image.ndim if spacing is None else spacing, (image.ndim,), hint)
    if 0 in spacing:
        raise Error("spacing has a zero, which gives all vertices of an axis the same place", hint, kind="usage")
    value = None
    if nodata is not None and not (isinstance(nodata, str) and nodata == "skip"):
        if not is_amount(nodata):
            raise Error(f"nodata={nodata!r} is not a number", 'a number, or "skip"', kind="usage")
        value = float(nodata)
    return _reeb.HeldMesh.of_image(image, origin, spacing, nodata is not None, value)


def check_mesh(thing):
    """Refuses what is neither the vertices of a mesh nor an image."""
    if thing is None:
        raise Error("mesh is None", _MESHES, kind="usage")
    if not hasattr(thing, "__array__") and not hasattr(thing, "__len__") or isinstance(thing, Mapping):
        raise Error(f"{described(thing)} is not a mesh", _MESHES, kind="usage")
    if isinstance(thing, (list, tuple)) and _are_parts(thing):
        hint = "pass its parts, as reeb.compute(vertices, faces) and reeb.segment(graph, vertices, faces)"
        raise Error(f"mesh is {described(thing)} of two arrays", hint, kind="usage")


_MESHES = "a path, an array, or an object with vertices and faces"


# Vertices and faces, not two slices of a volume.
def _are_parts(things):
    if len(things) != 2 or not any(getattr(part, "ndim", 0) == 2 for part in things):
        return False
    shapes = {getattr(part, "shape", None) for part in things}
    return isinstance(things, tuple) or len(shapes) == 2


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
    is_flat = array.ndim == 1 or (array.ndim == 2 and array.shape[1] == 1)
    return is_flat and array.dtype.kind in "iufb"


def parts_of_object(thing):
    """(vertices, faces, values) of a mesh of trimesh, PyVista, meshio, Open3D, or anything with such parts; of a graph
    of networkx, where `vertices` is None if its nodes have no positions."""
    if is_network(thing):
        return *parts_of_network(thing), values_of_network(thing)
    vertices, faces = _parts_of(thing)
    return vertices, faces, _point_data(thing)
