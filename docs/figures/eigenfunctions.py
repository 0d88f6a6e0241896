#!/usr/bin/env python3
"""Draws docs/eigenfunctions.png, and prints how well the vectors solve L v = lambda M v.

    for k in 1 2 3 4 5 6 7 8; do reeb function MESH -f laplacian:$k -o $k.ply; done
    docs/figures/eigenfunctions.py docs/eigenfunctions.png 1.ply 2.ply 3.ply 4.ply 5.ply 6.ply 7.ply 8.ply

L has cotangent weights; M is a third of the area of the triangles at a vertex. Needs numpy.
"""
import struct
import sys
import zlib

import numpy as np

WIDTH, HEIGHT, COLUMNS = 250, 185, 4
LARGEST_COTANGENT = 1e6  # as in io/fields/laplacian.cpp


def read(path):
    """Positions, values, triangles of a PLY as reeb writes it."""
    with open(path, "rb") as file:
        columns, vertices, faces = [], 0, 0
        for line in iter(file.readline, b"end_header\n"):
            words = line.decode().split()
            if words[:2] == ["element", "vertex"]:
                vertices = int(words[2])
            elif words[:2] == ["element", "face"]:
                faces = int(words[2])
            elif words[0] == "property" and words[1] != "list":
                columns.append((words[2], "<f8" if words[1] == "double" else "<f4"))
        table = np.frombuffer(file.read(vertices * np.dtype(columns).itemsize), columns)
        record = np.dtype([("n", "u1"), ("corners", "<i4", 3)])
        triangles = np.frombuffer(file.read(faces * record.itemsize), record)["corners"]
    points = np.stack([table[name].astype(float) for name in "xyz"], axis=1)
    return points, table[columns[-1][0]].astype(float), triangles.astype(np.int64)


def laplacian(points, triangles, values):
    """L v and the diagonal of M."""
    result, masses = np.zeros(len(points)), np.zeros(len(points))
    for i in range(3):
        a, b, c = (triangles[:, (i + k) % 3] for k in range(3))
        ab, ac = points[b] - points[a], points[c] - points[a]
        double_area = np.linalg.norm(np.cross(ab, ac), axis=1)
        weight = np.einsum("ij,ij->i", ab, ac) / np.maximum(double_area, 1e-300)
        weight = np.clip(weight, -LARGEST_COTANGENT, LARGEST_COTANGENT) / 2
        step = weight * (values[b] - values[c])
        result += np.bincount(b, step, len(points)) - np.bincount(c, step, len(points))
        masses += np.bincount(a, double_area / 6, len(points))
    return result, masses


def colours(values):
    """Blue below zero, red above it, white between: told apart by all kinds of eyes."""
    t = np.clip(values / np.abs(values).max(), -1, 1)[:, None]
    low, high, middle = np.array([33, 102, 172]), np.array([178, 24, 43]), np.array([247, 247, 247])
    strength = np.abs(t) ** 0.7
    return middle * (1 - strength) + np.where(t < 0, low, high) * strength


def render(points, values, triangles):
    """From the front, shaded, nearest triangle first; a triangle is drawn as samples of it."""
    low, high = points.min(axis=0), points.max(axis=0)
    scale = 0.94 * min(WIDTH / (high - low)[0], HEIGHT / (high - low)[1])
    shown = (points - (low + high) / 2) * scale
    corners = shown[triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    light = 0.45 + 0.55 * np.clip(normal @ np.array([-0.35, 0.45, 0.82]), 0, 1)
    shade = colours(values)[triangles].mean(axis=1) * light[:, None]
    image, depth = np.full((HEIGHT, WIDTH, 3), 255.0), np.full(HEIGHT * WIDTH, -np.inf)
    flat = image.reshape(-1, 3)
    samples = [(u, v, 1 - u - v) for u in (0.05, 0.35, 0.65, 0.9) for v in (0.05, 0.35, 0.65, 0.9) if u + v <= 1]
    for weights in samples:
        at = np.einsum("tij,i->tj", corners, np.array(weights))
        x = np.clip((at[:, 0] + WIDTH / 2).astype(int), 0, WIDTH - 1)
        y = np.clip((HEIGHT / 2 - at[:, 1]).astype(int), 0, HEIGHT - 1)
        order = np.argsort(at[:, 2])
        pixel, z = (y * WIDTH + x)[order], at[order, 2]
        nearer = z >= depth[pixel]
        flat[pixel[nearer]] = shade[order][nearer]
        np.maximum.at(depth, pixel, z)
    return image


def write_png(path, image):
    rows = b"".join(b"\0" + row.tobytes() for row in (np.clip(np.round(image / 6) * 6, 0, 255)).astype(np.uint8))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", image.shape[1], image.shape[0], 8, 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def main():
    panels = []
    for path in sys.argv[2:]:
        points, values, triangles = read(path)
        image, masses = laplacian(points, triangles, values)
        used = masses > 0
        eigenvalue = values @ image / (values @ (masses * values))
        rest = (image - eigenvalue * masses * values)[used]
        scale = 1 / np.sqrt(masses[used])
        residual = np.linalg.norm(rest * scale) / np.linalg.norm(eigenvalue * (masses * values)[used] * scale)
        print(f"{path}: eigenvalue {eigenvalue:.6g}, residual {residual:.1e}")
        panels.append(render(points, values, triangles))
    while len(panels) % COLUMNS:
        panels.append(np.full((HEIGHT, WIDTH, 3), 255.0))
    rows = [np.hstack(panels[i : i + COLUMNS]) for i in range(0, len(panels), COLUMNS)]
    write_png(sys.argv[1], np.vstack(rows))


if __name__ == "__main__":
    main()
