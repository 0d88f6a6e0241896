"""Small meshes."""

import numpy as np


def torus(n=24, m=16):
    """A torus with its axis along z, of radii 2 and 0.7: (vertices, faces)."""
    u, w = np.meshgrid(np.arange(n) * 2 * np.pi / n, np.arange(m) * 2 * np.pi / m, indexing="ij")
    ring = 2 + 0.7 * np.cos(w)
    vertices = np.stack([ring * np.cos(u), ring * np.sin(u), 0.7 * np.sin(w)], -1).reshape(-1, 3)
    a = np.arange(n * m).reshape(n, m)
    b, d = np.roll(a, -1, 0), np.roll(a, -1, 1)
    c = np.roll(b, -1, 1)
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return vertices, faces


def write_ply(path, vertices, faces, values=None):
    rows = np.zeros(len(vertices), [("p", "<f8", 3)] + ([] if values is None else [("w", "<f8")]))
    rows["p"] = vertices
    if values is not None:
        rows["w"] = values
    cells = np.zeros(len(faces), [("n", "u1"), ("c", "<i4", (3,))])
    cells["n"], cells["c"] = 3, faces
    with open(path, "wb") as file:
        lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
        lines += [f"property double {name}" for name in ("xyz" if values is None else "xyzw")]
        lines += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header\n"]
        file.write("\n".join(lines).encode())
        rows.tofile(file)
        cells.tofile(file)
    return path
