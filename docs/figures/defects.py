#!/usr/bin/env python3
"""Draws the first five rows of `reeb defects` and the longest one whose curve was found, each from two sides.

    reeb defects MESH -o rows.json --limit 5000 --patches patches
    docs/figures/defects.py rows.json patches docs/defects-NAME.png

Blue-grey is the outer side of a triangle, sand the inner side. The shorter curve is red, the other one green; what is
hidden is dotted; a key below says so. The bar is as many median edges long as it says. Needs numpy.
"""
import json
import math
import struct
import sys
import zlib

import numpy as np

CELL, CAPTION, GAP, FIRST_ROWS, VIEWS = 250, 24, 6, 5, 40
TEXT = 2  # pixels for each dot of a letter
SHADES = 48  # of each side
WHITE, BLACK, RED, GREEN = 0, 1, 2, 3
FIRST_OUTER, FIRST_INNER = 4, 4 + SHADES
LIGHT = np.array([-0.35, 0.45, 0.82])

GLYPHS = {
    "0": "0e11131519110e", "1": "040c040404040e", "2": "0e11010204081f", "3": "1f02040201110e", "4": "02060a121f0202",
    "5": "1f101e0101110e", "6": "0608101e11110e", "7": "1f010204080808", "8": "0e11110e11110e", "9": "0e11110f01020c",
    ".": "00000000000c0c", ",": "000000000c0408", "=": "00001f001f0000", "-": "0000001f000000", " ": "00000000000000",
    "a": "00000e010f110f", "b": "10101619111 11e".replace(" ", ""), "c": "00000e1010110e", "d": "01010d1311110f",
    "e": "00000e111f100e", "f": "0609081c080808", "g": "000f11110f010e", "h": "10101619111111", "i": "04000c0404040e",
    "k": "08080a0c0c0a09", "l": "0c04040404040e", "n": "00001619111111", "o": "00000e1111110e", "r": "00001619101010",
    "s": "00000e100e011e", "t": "08081c0808090 6".replace(" ", ""), "u": "0000111111130d", "w": "0000111115150a",
    "m": "00001a15151111", "p": "00001e111e1010", "v": "00001111110a04", "x": "0000110a040a11", "y": "000011110f010e",
    "z": "00001f0204081f", "+": "0004041f040400",
}


def read_ply(path):
    """Positions, and faces (with three corners) or edges with whether they are red."""
    with open(path, encoding="ascii") as file:
        vertices = count = columns = 0
        for line in iter(file.readline, "end_header\n"):
            words = line.split()
            if words[:2] == ["element", "vertex"]:
                vertices = int(words[2])
            elif words[0] == "element":
                kind, count = words[1], int(words[2])
        points = np.array([[float(w) for w in file.readline().split()[:3]] for _ in range(vertices)])
        rows = [[int(w) for w in file.readline().split()] for _ in range(count)]
    if kind == "face":
        return points, np.array([row[1:4] for row in rows])
    return points, [(row[0], row[1], row[2] > row[3]) for row in rows]


def directions(count):
    """Spread evenly over the sphere."""
    k = np.arange(count) + 0.5
    z, angle = 1 - 2 * k / count, math.pi * (1 + math.sqrt(5)) * k
    return np.stack([np.sqrt(1 - z * z) * np.cos(angle), np.sqrt(1 - z * z) * np.sin(angle), z], axis=1)


def camera(direction):
    """Rows: right, up, towards the eye."""
    up = np.array([0.0, 1, 0]) if abs(direction[1]) < 0.9 else np.array([1.0, 0, 0])
    right = np.cross(up, direction)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(direction, right), direction])


class Picture:
    """Triangles and lines seen along a direction, those near `center` only."""

    def __init__(self, size, direction, center, radius):
        self.size, self.rows, self.center = size, camera(direction), center
        self.scale = size / (2 * radius)
        self.pixels = np.full((size, size), WHITE, np.uint8)
        self.depth = np.full((size, size), -np.inf)

    def project(self, points):
        p = (points - self.center) @ self.rows.T
        return np.stack([self.size / 2 + p[:, 0] * self.scale, self.size / 2 - p[:, 1] * self.scale, p[:, 2] * self.scale],
                        axis=1)

    def draw(self, points, faces, shaded=True):
        p = self.project(points)
        for face in faces:
            a, b, c = p[face]
            x0, y0 = np.maximum(np.floor(np.minimum(np.minimum(a, b), c)[:2]).astype(int), 0)
            x1, y1 = np.minimum(np.ceil(np.maximum(np.maximum(a, b), c)[:2]).astype(int) + 1, self.size)
            if x0 >= x1 or y0 >= y1:
                continue
            twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
            if abs(twice) < 1e-9:
                continue
            x, y = np.arange(x0, x1)[None, :] + 0.5, np.arange(y0, y1)[:, None] + 0.5
            v = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / twice
            w = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / twice
            u = 1 - v - w
            z = u * a[2] + v * b[2] + w * c[2]
            here = self.depth[y0:y1, x0:x1]
            inside = (u >= 0) & (v >= 0) & (w >= 0) & (z > here)
            if not inside.any():
                continue
            here[inside] = z[inside]
            if not shaded:
                continue
            normal = np.cross(b - a, c - a)
            length = np.linalg.norm(normal)
            normal = normal * [1, -1, 1] / length
            outer = twice < 0  # the picture's y goes down
            if normal[2] < 0:
                normal = -normal
            shade = 0.25 + 0.75 * max(0.0, float(normal @ LIGHT))
            level = min(SHADES - 1, int(shade * (SHADES - 1)))
            colour = (FIRST_OUTER if outer else FIRST_INNER) + level
            dark = (FIRST_OUTER if outer else FIRST_INNER) + max(0, level - 9)
            # Sides of the triangle are darker, where there is room.
            block = self.pixels[y0:y1, x0:x1]
            block[inside] = colour
            longest = max(np.linalg.norm((b - a)[:2]), np.linalg.norm((c - b)[:2]), np.linalg.norm((a - c)[:2]))
            if abs(twice) / max(longest, 1e-9) > 5:
                margin = np.minimum(np.minimum(u * abs(twice) / max(np.linalg.norm((c - b)[:2]), 1e-9),
                                               v * abs(twice) / max(np.linalg.norm((a - c)[:2]), 1e-9)),
                                    w * abs(twice) / max(np.linalg.norm((b - a)[:2]), 1e-9))
                block[inside & (margin < 0.5)] = dark

    def samples(self, points, edges, step):
        """Points along the edges on the picture, with whether they are visible and red."""
        p = self.project(points)
        for a, b, red in edges:
            count = max(2, int(np.linalg.norm(p[b][:2] - p[a][:2]) / step) + 1)
            for share in np.linspace(0, 1, count):
                x, y, z = p[a] + share * (p[b] - p[a])
                i, j = int(y), int(x)
                if 0 <= i < self.size and 0 <= j < self.size:
                    yield i, j, z >= self.depth[i, j] - 2.5, red

    def draw_curves(self, points, edges):
        number = 0
        for wanted in (False, True):
            for i, j, visible, red in self.samples(points, edges, 0.7):
                if red != wanted:
                    continue
                number += 1
                if visible:
                    self.pixels[max(0, i - 1):i + 2, max(0, j - 1):j + 2] = RED if red else GREEN
                elif number % 6 < 2:
                    self.pixels[i, j] = RED if red else GREEN


def near(points, faces, center, radius):
    """Faces with a corner within the picture."""
    close = np.max(np.abs(points - center), axis=1) < 2.2 * radius
    return faces[close[faces].any(axis=1)]


def best_views(points, faces, curve_points, edges, center, radius):
    """Two directions, far apart, from which most of the curves is seen, the red one open."""
    size, scored = 64, []
    red = np.array([curve_points[a] for a, _, is_red in edges if is_red])
    for direction in directions(min(VIEWS, max(8, 25_000 // max(1, len(faces))))):
        picture = Picture(size, direction, center, radius)
        picture.draw(points, faces, shaded=False)
        seen = [visible for *_, visible, is_red in picture.samples(curve_points, edges, 1.0) if is_red]
        other = [visible for *_, visible, is_red in picture.samples(curve_points, edges, 1.0) if not is_red]
        flat = picture.project(red)[:, :2]
        spread = np.linalg.svd(flat - flat.mean(axis=0), compute_uv=False) if len(flat) > 2 else [0, 0]
        open_share = spread[1] / max(spread[0], 1e-9)
        score = (sum(seen) / max(1, len(seen))) * (0.5 + open_share) + 0.25 * sum(other) / max(1, len(other))
        scored.append((score, direction))
    scored.sort(key=lambda s: -s[0])
    first = scored[0][1]
    second = next((d for _, d in scored if abs(float(d @ first)) < 0.5), scored[1][1])
    return first, second


def write_text(pixels, x, y, text):
    for character in text:
        rows = bytes.fromhex(GLYPHS[character])
        for dy, row in enumerate(rows):
            for dx in range(5):
                if row >> (4 - dx) & 1:
                    top, left = y + dy * TEXT, x + dx * TEXT
                    pixels[top:top + TEXT, left:left + TEXT] = BLACK
        x += 6 * TEXT
    return x


def write_key(pixels, x, y):
    """What the lines are."""
    for name, colour, dotted in (("shorter curve", RED, False), ("other curve", GREEN, False), ("hidden", RED, True)):
        for i in range(36):
            if not dotted:
                pixels[y + 6:y + 9, x + i] = colour
            elif i % 6 < 2:
                pixels[y + 7, x + i] = colour
        x = write_text(pixels, x + 44, y, name) + 28


def save(path, pixels):
    palette = [(255, 255, 255), (30, 30, 30), (210, 40, 40), (20, 150, 60)]
    for r, g, b in ((178, 200, 226), (232, 208, 160)):
        palette += [tuple(int(c * (0.3 + 0.7 * s / (SHADES - 1))) for c in (r, g, b)) for s in range(SHADES)]

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width = pixels.shape
    raw = b"".join(b"\0" + row.tobytes() for row in pixels)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)) +
                   chunk(b"PLTE", bytes(c for colour in palette for c in colour)) +
                   chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def shorter(row):
    return min(float(row["length_contour"]), float(row["length_cycle"]))


def draw_row(row, folder):
    points, faces = read_ply(f"{folder}/defect-{row['rank']}.ply")
    curve_points, edges = read_ply(f"{folder}/defect-{row['rank']}-curves.ply")
    red = np.array([curve_points[v] for a, b, is_red in edges if is_red for v in (a, b)])
    center = (red.min(axis=0) + red.max(axis=0)) / 2
    corners = points[faces]
    edge = float(np.median(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)))
    radius = max(1.6 * float(np.linalg.norm(red - center, axis=1).max()), 3.5 * edge)
    faces = near(points, faces, center, 0.8 * radius)
    cells = []
    for direction in best_views(points, faces, curve_points, edges, center, radius):
        picture = Picture(CELL, direction, center, radius)
        picture.draw(points, faces)
        picture.draw_curves(curve_points, edges)
        cells.append(picture.pixels)
    count = max(1, round(radius / 2 / edge))
    label = f"{count} edge" + ("s" if count != 1 else "")
    end = 8 + int(count * edge * cells[0].shape[0] / (2 * radius))
    cells[0][CELL - 32:, :max(end, 8 + 6 * TEXT * len(label)) + 6] = WHITE
    cells[0][CELL - 10:CELL - 7, 8:end] = BLACK
    write_text(cells[0], 8, CELL - 28, label)
    caption = f"rank {row['rank']} {row['kind']} {shorter(row):.4g} = {shorter(row) / edge:.2g} edges"
    if shorter(row) / edge < 0.1:
        caption = f"rank {row['rank']} {row['kind']} {shorter(row):.4g} = {shorter(row) / edge:.4f} edges"
    return caption, cells


def main():
    table, folder, output = sys.argv[1:4]
    with open(table, encoding="utf-8") as file:
        rows = [row for row in json.load(file)["loops"] if math.isfinite(shorter(row))]
    first = rows[:FIRST_ROWS]
    chosen = first + [max(rows[FIRST_ROWS:], key=shorter)] if len(rows) > FIRST_ROWS else first
    height = CELL + CAPTION + GAP
    rows_height = (len(chosen) + 1) // 2 * height
    sheet = np.full((rows_height + CAPTION, 2 * (2 * CELL + 3 * GAP)), WHITE, np.uint8)
    write_key(sheet, GAP + 2, rows_height + 3)
    for k, row in enumerate(chosen):
        caption, cells = draw_row(row, folder)
        x, y = k % 2 * (2 * CELL + 3 * GAP) + GAP, k // 2 * height
        write_text(sheet, x + 2, y + 5, caption)
        for i, cell in enumerate(cells):
            sheet[y + CAPTION:y + CAPTION + CELL, x + i * (CELL + GAP):x + i * (CELL + GAP) + CELL] = cell
        print(caption)
    save(output, sheet)


if __name__ == "__main__":
    main()
