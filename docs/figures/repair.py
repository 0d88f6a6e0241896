#!/usr/bin/env python3
"""Draws a part of a mesh before and after its repair, side by side, as a PNG; new triangles are orange.

    reeb repair MESH -o AFTER.ply --log LOG.json
    reeb convert MESH BEFORE.ply
    docs/figures/repair.py BEFORE.ply AFTER.ply LOG.json OUT.png --center X,Y,Z --radius R --view 30,20

The view is the angle to turn about z and the angle to look down, in degrees. Triangles with all corners within the
radius of the center are drawn; both files are binary PLY as reeb writes it. Needs numpy.
"""
import argparse
import json
import struct
import zlib

import numpy

SIDE, SAMPLES = 420, 3
GREY, ORANGE, EDGE, BACK = (206, 212, 218), (240, 140, 40), 0.72, 255


def read_ply(path):
    data = open(path, "rb").read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    fields, count, element = [], {}, None
    for line in data[:end].decode("ascii").splitlines():
        words = line.split()
        if words[:1] == ["element"]:
            element = words[1]
            count[element] = int(words[2])
        elif words[:1] == ["property"] and element == "vertex":
            kind = {"float": "<f4", "double": "<f8", "uchar": "u1", "int": "<i4"}[words[1]]
            fields.append((words[2], kind))
    vertices = numpy.frombuffer(data, numpy.dtype(fields), count["vertex"], end)
    points = numpy.stack([vertices[axis].astype(float) for axis in "xyz"], 1)
    face = numpy.dtype([("n", "u1"), ("v", "<u4", 3)])
    faces = numpy.frombuffer(data, face, count["face"], end + vertices.nbytes)
    return points, faces["v"].astype(int)


def draw(points, triangles, fresh, arguments):
    turn, down = numpy.radians([float(angle) for angle in arguments.view.split(",")])
    center = numpy.array([float(x) for x in arguments.center.split(",")])
    places = points - center
    near = (places**2).sum(1) <= arguments.radius**2
    keep = near[triangles].all(1)
    triangles, fresh = triangles[keep], fresh[keep]
    right = numpy.array([numpy.cos(turn), numpy.sin(turn), 0])
    ahead = numpy.array([-numpy.sin(turn) * numpy.cos(down), numpy.cos(turn) * numpy.cos(down), -numpy.sin(down)])
    up = numpy.cross(right, ahead)
    size = SIDE * SAMPLES
    scale = 0.48 * size / arguments.radius
    screen = numpy.stack([size / 2 + scale * places @ right, size / 2 - scale * places @ up, places @ ahead], 1)
    depth = numpy.full((size, size), numpy.inf)
    picture = numpy.full((size, size, 3), float(BACK))
    light = -ahead + 0.5 * up - 0.4 * right
    light /= numpy.linalg.norm(light)
    for corners, new in zip(triangles, fresh):
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = a, b, c = screen[corners]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if abs(area) < 1e-9:
            continue
        low = numpy.maximum(numpy.floor(numpy.minimum(numpy.minimum(a, b), c)[:2]).astype(int), 0)
        high = numpy.minimum(numpy.ceil(numpy.maximum(numpy.maximum(a, b), c)[:2]).astype(int) + 1, size)
        if (low >= high).any():
            continue
        x, y = numpy.meshgrid(numpy.arange(low[0], high[0]) + 0.5, numpy.arange(low[1], high[1]) + 0.5)
        u = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area
        v = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area
        w = 1 - u - v
        z = u * az + v * bz + w * cz
        window = (slice(low[1], high[1]), slice(low[0], high[0]))
        seen = (u >= 0) & (v >= 0) & (w >= 0) & (z < depth[window])
        p, q, r = places[corners]
        normal = numpy.cross(q - p, r - p)
        shade = 0.45 + 0.55 * abs(normal @ light) / max(numpy.linalg.norm(normal), 1e-300)
        color = numpy.array(ORANGE if new else GREY) * shade
        height = abs(area) / max(numpy.hypot(bx - ax, by - ay), numpy.hypot(cx - bx, cy - by),
                                 numpy.hypot(ax - cx, ay - cy))
        edge = numpy.minimum(numpy.minimum(u, v), w) * height < 0.6 * SAMPLES
        shown = numpy.where(edge[..., None], color * EDGE, color)
        depth[window] = numpy.where(seen, z, depth[window])
        picture[window] = numpy.where(seen[..., None], shown, picture[window])
    return picture.reshape(SIDE, SAMPLES, SIDE, SAMPLES, 3).mean((1, 3))


def write_png(path, picture):
    height, width, _ = picture.shape
    rows = b"".join(b"\0" + row.tobytes() for row in picture.round().astype(numpy.uint8))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("before", "after", "log", "output"):
        parser.add_argument(name)
    parser.add_argument("--center", required=True)
    parser.add_argument("--radius", type=float, required=True)
    parser.add_argument("--view", default="30,20")
    arguments = parser.parse_args()
    with open(arguments.log) as file:
        added = sum(row["triangles_added"] for row in json.load(file)["loops"])
    panels = []
    for path, new in ((arguments.before, 0), (arguments.after, added)):
        points, triangles = read_ply(path)
        fresh = numpy.arange(len(triangles)) >= len(triangles) - new
        panels.append(draw(points, triangles, fresh, arguments))
        panels.append(numpy.full((SIDE, 12, 3), float(BACK)))
    write_png(arguments.output, numpy.concatenate(panels[:-1], 1))


if __name__ == "__main__":
    main()
