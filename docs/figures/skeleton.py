#!/usr/bin/env python3
"""Draws a mesh in grey and a skeleton in it, as a PNG: one panel a view, side by side.

    reeb convert MESH shape.ply
    reeb extract GRAPH.reeb --threshold 1% -o skeleton.obj
    docs/figures/skeleton.py shape.ply skeleton.obj skeleton.png --up y --views 20,10 110,10

A view is the angle to turn the shape about its upright axis and the angle to look down, in degrees.
The skeleton is drawn as the file has it, over the shape: minima blue, maxima red, forks white; arcs
in colours that tell neighbours apart. Python's standard library is all it needs.
"""
import argparse
import array
import math
import struct
import sys
import zlib

ARCS = [(31, 111, 139), (200, 85, 61), (96, 130, 38), (140, 82, 160), (214, 150, 30), (40, 150, 130), (170, 60, 110)]
LOW, HIGH, FORK, INK = (40, 80, 190), (205, 40, 40), (255, 255, 255), (30, 30, 30)
SAMPLES = 2  # a side of a pixel
LEAST_GREY, MOST_GREY = 165, 242


def read_shape(path):
    """Vertices and triangles of a binary PLY as `reeb convert` writes it."""
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    count, stride, offset, faces = {}, 0, {}, 0
    sizes = {"float": 4, "double": 8}
    for line in data[:end].decode("ascii").splitlines():
        words = line.split()
        if words[:1] == ["element"]:
            element = words[1]
            count[element] = int(words[2])
        elif words[:1] == ["property"] and element == "vertex":
            offset[words[2]] = ("<f" if words[1] == "float" else "<d", stride)
            stride += sizes[words[1]]
        elif words[:1] == ["format"] and words[1] != "binary_little_endian":
            sys.exit(f"{path}: not a binary little-endian PLY")
    body = memoryview(data)[end : end + stride * count["vertex"]]
    columns = []
    for axis in "xyz":
        code, start = offset[axis]
        step = struct.calcsize(code)
        column = array.array(code[1])
        column.frombytes(b"".join(body[i + start : i + start + step] for i in range(0, len(body), stride)))
        columns.append(column)
    triangles, at = [], end + stride * count["vertex"]
    for _ in range(count["face"]):
        corners = data[at]
        ids = struct.unpack_from(f"<{corners}i", data, at + 1)
        triangles += [(ids[0], ids[k], ids[k + 1]) for k in range(1, corners - 1)]
        at += 1 + 4 * corners
    return list(zip(*columns)), triangles


def read_lines(path):
    points, lines = [], []
    with open(path) as file:
        for line in file:
            words = line.split()
            if words[0] == "v":
                points.append(tuple(float(word) for word in words[1:4]))
            elif words[0] == "l":
                lines.append([int(word) - 1 for word in words[1:]])
    return points, lines


def without_specks(points, lines, least):
    """The lines of the components that span at least this share of the largest one's extent."""
    root = list(range(len(points)))

    def find(i):
        while root[i] != i:
            root[i] = i = root[root[i]]
        return i

    for line in lines:
        for i in line[1:]:
            root[find(i)] = find(line[0])
    corners = {}
    for line in lines:
        low, high = corners.setdefault(find(line[0]), ([math.inf] * 3, [-math.inf] * 3))
        for i in line:
            low[:], high[:] = map(min, low, points[i]), map(max, high, points[i])
    extent = {component: math.dist(*box) for component, box in corners.items()}
    enough = least * max(extent.values())
    return [line for line in lines if extent[find(line[0])] >= enough]


def projection(turn, tilt, up):
    """From a point to (right, up, towards the eye)."""
    a, b = math.radians(turn), math.radians(tilt)
    order = {"x": (1, 2, 0), "y": (2, 0, 1), "z": (0, 1, 2)}[up[-1]]
    sign = -1 if up[0] == "-" else 1

    def project(point):
        x, y, z = point[order[0]], sign * point[order[1]], sign * point[order[2]]
        right, far = x * math.cos(a) - y * math.sin(a), x * math.sin(a) + y * math.cos(a)
        return right, z * math.cos(b) + far * math.sin(b), z * math.sin(b) - far * math.cos(b)

    return project


class Canvas:
    def __init__(self, width, height):
        self.width, self.height = width, height
        self.depth = [-math.inf] * (width * height)
        self.pixels = [(255, 255, 255)] * (width * height)

    def triangle(self, a, b, c):
        """Shaded by how it lies to the eye, either side alike; the nearest one is seen."""
        ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        length = math.sqrt(nx * nx + ny * ny + nz * nz)
        if nz == 0 or length == 0:
            return
        side = 1 if nz > 0 else -1
        light = max(0.0, side * (0.35 * nx - 0.45 * ny + 0.82 * nz) / length)
        grey = int(LEAST_GREY + (MOST_GREY - LEAST_GREY) * light) & ~3
        shade = (grey, grey, grey)
        width, depth, pixels = self.width, self.depth, self.pixels
        x0, x1 = math.ceil(min(a[0], b[0], c[0])), math.floor(max(a[0], b[0], c[0]))
        y0, y1 = math.ceil(min(a[1], b[1], c[1])), math.floor(max(a[1], b[1], c[1]))
        for y in range(max(0, y0), min(self.height - 1, y1) + 1):
            for x in range(max(0, x0), min(width - 1, x1) + 1):
                p, q = x - a[0], y - a[1]
                s, t = (p * vy - q * vx) / nz, (ux * q - uy * p) / nz
                if s < -1e-9 or t < -1e-9 or s + t > 1 + 1e-9:
                    continue
                z, i = a[2] + s * uz + t * vz, y * width + x
                if z > depth[i]:
                    depth[i], pixels[i] = z, shade

    def disc(self, x, y, radius, colour):
        for row in range(max(0, math.ceil(y - radius)), min(self.height - 1, math.floor(y + radius)) + 1):
            half = math.sqrt(max(0.0, radius * radius - (row - y) ** 2))
            first, last = max(0, math.ceil(x - half)), min(self.width - 1, math.floor(x + half))
            if first <= last:
                self.pixels[row * self.width + first : row * self.width + last + 1] = [colour] * (last - first + 1)

    def line(self, a, b, radius, colour):
        steps = max(1, math.ceil(2 * math.dist(a[:2], b[:2]) / radius))
        for i in range(steps + 1):
            t = i / steps
            self.disc(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), radius, colour)

    def rows(self):
        """Of whole pixels, each the mean of its samples, in 32 shades a channel."""
        for y in range(0, self.height, SAMPLES):
            row = bytearray()
            for x in range(0, self.width, SAMPLES):
                sums = [0, 0, 0]
                for dy in range(SAMPLES):
                    for dx in range(SAMPLES):
                        for k, value in enumerate(self.pixels[(y + dy) * self.width + x + dx]):
                            sums[k] += value
                row += bytes(min(255, (s // SAMPLES**2 + 4) // 8 * 8) for s in sums)
            yield row


def draw_panel(shape, skeleton, view, up, size, mark):
    vertices, triangles = shape
    points, lines = skeleton
    project = projection(*view, up)
    seen, drawn = [project(p) for p in vertices], [project(p) for p in points]
    x0, x1 = min(p[0] for p in seen), max(p[0] for p in seen)
    y0, y1 = min(p[1] for p in seen), max(p[1] for p in seen)
    width, height, margin = size[0] * SAMPLES, size[1] * SAMPLES, 8 * SAMPLES
    scale = min((width - 2 * margin) / (x1 - x0), (height - 2 * margin) / (y1 - y0))

    def place(p):
        return width / 2 + (p[0] - (x0 + x1) / 2) * scale, height / 2 - (p[1] - (y0 + y1) / 2) * scale, p[2] * scale

    seen, drawn = [place(p) for p in seen], [place(p) for p in drawn]
    canvas = Canvas(width, height)
    for i, j, k in triangles:
        canvas.triangle(seen[i], seen[j], seen[k])
    thick = 1.3 * SAMPLES * mark
    down, rise = {}, {}
    by_depth = sorted(range(len(lines)), key=lambda n: sum(drawn[i][2] for i in lines[n]) / len(lines[n]))
    for n in by_depth:
        rise[lines[n][0]] = rise.get(lines[n][0], 0) + 1
        down[lines[n][-1]] = down.get(lines[n][-1], 0) + 1
        for radius, colour in ((thick + 0.7 * SAMPLES, FORK), (thick, ARCS[n % len(ARCS)])):
            for i, j in zip(lines[n], lines[n][1:]):
                canvas.line(drawn[i], drawn[j], radius, colour)
    for node in sorted(set(down) | set(rise), key=lambda i: drawn[i][2]):
        colour = LOW if node not in down else HIGH if node not in rise else FORK
        canvas.disc(*drawn[node][:2], 2.9 * SAMPLES * mark, INK)
        canvas.disc(*drawn[node][:2], 2.1 * SAMPLES * mark, colour)
    return list(canvas.rows())


def write_png(path, panels):
    rows = [b"".join(bytes(panel[y]) for panel in panels) for y in range(len(panels[0]))]

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        file.write(chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]) // 3, len(rows), 8, 2, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows), 9)))
        file.write(chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shape", help="binary PLY")
    parser.add_argument("skeleton", help="OBJ with lines")
    parser.add_argument("picture", help="PNG to write")
    parser.add_argument("--up", choices=["x", "y", "z", "-x", "-y", "-z"], default="z", help="the upright axis")
    parser.add_argument("--views", nargs="+", default=["25,12", "115,12"], metavar="TURN,TILT")
    parser.add_argument("--size", default="400x400", metavar="WxH", help="pixels a panel")
    parser.add_argument("--mark", type=float, default=1, help="thickness of lines and dots")
    parser.add_argument("--least", type=float, default=0, metavar="SHARE",
                        help="leave out components of the skeleton that are smaller than this share of the largest")
    options = parser.parse_args()
    points, lines = read_lines(options.skeleton)
    shape, skeleton = read_shape(options.shape), (points, without_specks(points, lines, options.least))
    size = tuple(int(n) for n in options.size.split("x"))
    views = [tuple(float(angle) for angle in view.split(",")) for view in options.views]
    write_png(options.picture, [draw_panel(shape, skeleton, view, options.up, size, options.mark) for view in views])


if __name__ == "__main__":
    main()
