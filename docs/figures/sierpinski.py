#!/usr/bin/env python3
"""Draws ../sierpinski.svg: Reeb graphs of Sierpinski simplices of dimension 2 to 5.

    for d in 2 3 4 5; do for k in 1 2 3; do
      reeb generate sierpinski --dimension $d --triangles $(((d + 1) ** k * (d + 1) * d * (d - 1) / 6)) -o s.cx --force
      reeb compute s.cx -f x -o s.reeb --force
      reeb extract s.reeb -o $d-$k.json --force
    done; done
    docs/figures/sierpinski.py ?-?.json > docs/sierpinski.svg

A file D-K.json has the graph of dimension D, divided K times. `dot` of Graphviz places the nodes from left to right.
Their height is the value: one band for each. Nodes of one value lie in its band in the order that settles their tie.
"""
import collections
import json
import math
import os
import subprocess
import sys

WIDTH, MARGIN, GAP, LABEL, VALUES = 980, 14, 30, 40, 18
HEIGHTS = {1: 130, 2: 250, 3: 420}  # of the pictures of a level
SPREAD = 0.72  # the share of a band over which the nodes of its value are spread
LINES = {1: 2, 2: 1.5, 3: 0.8}
RADII = {1: 4.2, 2: 3.2, 3: 1.9}
CLUSTERS = ["#2a6f97", "#c8553d", "#608226", "#8c52a0", "#d6961e", "#28967f"]
WIDEST = {1: 140, 2: 150, 3: 150}  # pixels a unit of `dot`


def expected_loops(dimension, level):
    return math.comb(dimension, 2) * ((dimension + 1) ** level - 1) // dimension


def cluster(vertex, dimension, level):
    """The child of the whole simplex that has the vertex; None for the middles of its edges, which join two."""
    corners, edges = dimension + 1, math.comb(dimension + 1, 2)
    if vertex < corners:
        return vertex
    number = (vertex - corners) // edges
    return (number - 1) // ((corners ** (level - 1) - 1) // dimension) if number else None


def heights(nodes, arcs):
    """Of each node: its value, and above it as far as the arcs within the value rise."""
    step = [0] * len(nodes)
    for lo, hi in sorted(arcs, key=lambda arc: arc[1]):
        if nodes[lo]["value"] == nodes[hi]["value"]:
            step[hi] = max(step[hi], step[lo] + 1)
    steps = collections.Counter()
    for node, s in zip(nodes, step):
        steps[node["value"]] = max(steps[node["value"]], s)
    return [node["value"] + SPREAD * s / max(1, steps[node["value"]]) for node, s in zip(nodes, step)]


def layout(nodes, arcs, height):
    """Places of nodes and curves of arcs, both in units of `dot`, with the height as rank."""
    ranks = sorted(set(height))
    lines = ["graph { ranksep=0.4; nodesep=0.16; node [shape=point, width=0.12]; edge [weight=2];"]
    lines.append(" -- ".join(f"r{k}" for k in range(len(ranks))) + " [style=invis, weight=0];")
    for k, rank in enumerate(ranks):
        lines.append(f"{{ rank=same; r{k}; " + "; ".join(f"n{i}" for i, h in enumerate(height) if h == rank) + " }")
    lines += [f"n{lo} -- n{hi};" for lo, hi in arcs] + ["}"]
    plain = subprocess.run(["dot", "-Tplain"], input="\n".join(lines), capture_output=True, text=True, check=True)
    places, curves, rank_y = {}, [], {}
    for line in plain.stdout.splitlines():
        words = line.split()
        if words[0] == "node":
            name, at = words[1], (float(words[2]), float(words[3]))
            if name[0] == "n":
                places[int(name[1:])] = at
            else:
                rank_y[int(name[1:])] = at[1]
        elif words[0] == "edge" and words[1][0] == "n":
            numbers = [float(w) for w in words[4 : 4 + 2 * int(words[3])]]
            curves.append((int(words[1][1:]), int(words[2][1:]), list(zip(numbers[::2], numbers[1::2]))))
    # `dot` puts the lowest rank at the top, and all ranks at equal distances. Here they go to their heights.
    knots = sorted((rank_y[k], rank) for k, rank in enumerate(ranks))

    def value_at(y):
        for (y0, h0), (y1, h1) in zip(knots, knots[1:]):
            if y <= y1:
                break
        return h0 + (h1 - h0) * (min(max(y, knots[0][0]), knots[-1][0]) - y0) / (y1 - y0)

    places = [(places[i][0], height[i]) for i in range(len(nodes))]
    curves = [(min(a, b), max(a, b), [(x, value_at(y)) for x, y in curve]) for a, b, curve in curves]
    return places, curves


def number(x):
    return f"{x:.1f}".removesuffix(".0")


class Picture:
    def __init__(self, path):
        self.dimension, self.level = map(int, os.path.basename(path).removesuffix(".json").split("-"))
        with open(path) as file:
            graph = json.load(file)
        self.nodes = graph["nodes"]
        place = {node["vertex"]: i for i, node in enumerate(self.nodes)}
        self.arcs = [(place[arc["lo"]], place[arc["hi"]]) for arc in graph["arcs"]]
        self.loops = len(self.arcs) - len(self.nodes) + 1
        if self.loops != expected_loops(self.dimension, self.level):
            sys.exit(f"{path}: {self.loops} loops, not {expected_loops(self.dimension, self.level)}")
        self.places, self.curves = layout(self.nodes, self.arcs, heights(self.nodes, self.arcs))
        xs = [p[0] for p in self.places] + [x for _, _, curve in self.curves for x, _ in curve]
        self.left, self.width = min(xs), max(xs) - min(xs)

    def draw(self, left, top, width, height):
        loops = "1 loop" if self.loops == 1 else f"{self.loops} loops"
        text(left + width / 2, top + height + 24, f"dimension {self.dimension}: {loops}")
        unit, radius = height / 2**self.level, RADII[self.level]
        scale = min(WIDEST[self.level], (width - 2 * radius) / self.width)
        left += (width - scale * self.width) / 2

        def place(point):
            return left + (point[0] - self.left) * scale, top + height - point[1] * unit

        paths = collections.defaultdict(str)
        for lo, hi, curve in self.curves:
            ends = {cluster(self.nodes[i]["vertex"], self.dimension, self.level) for i in (lo, hi)} - {None}
            points = [place(p) for p in curve]
            first, second = place(self.places[lo]), place(self.places[hi])
            if math.dist(points[0], first) > math.dist(points[0], second):
                first, second = second, first
            points[0], points[-1] = first, second
            path = "M" + " ".join(map(number, points[0])) + "C" + " ".join(number(c) for p in points[1:] for c in p)
            paths[CLUSTERS[ends.pop()] if len(ends) == 1 else "#777"] += path
        for stroke, path in paths.items():
            print(f'<path d="{path}" fill="none" stroke="{stroke}" stroke-width="{LINES[self.level]}"/>')
        dots = collections.defaultdict(list)
        for node, at in zip(self.nodes, self.places):
            c = cluster(node["vertex"], self.dimension, self.level)
            dots["#fff" if c is None else CLUSTERS[c]].append(place(at))
        for fill, where in sorted(dots.items()):
            stroke = ' stroke="#222"' if fill == "#fff" else ""
            print(f'<g fill="{fill}"{stroke}>')
            for x, y in where:
                print(f'<circle cx="{number(x)}" cy="{number(y)}" r="{radius}"/>')
            print("</g>")


def text(x, y, words, anchor="middle", size=13, fill="#222"):
    print(f'<text x="{x:.0f}" y="{y:.0f}" font-size="{size}" text-anchor="{anchor}" fill="{fill}">{words}</text>')


def main():
    rows = collections.defaultdict(list)
    for path in sys.argv[1:]:
        picture = Picture(path)
        rows[picture.level].append(picture)
    total = sum(HEIGHTS[level] + LABEL + MARGIN + 10 for level in rows) + MARGIN
    print(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {total}" width="{WIDTH}" height="{total}" '
          'font-family="sans-serif">')
    print(f'<rect width="{WIDTH}" height="{total}" fill="white"/>')
    top = MARGIN
    for level, pictures in sorted(rows.items()):
        pictures.sort(key=lambda p: p.dimension)
        height, least = HEIGHTS[level], 90
        unit = height / 2**level
        for value in range(2**level + 1):
            y = top + height - value * unit
            if value % 2 == 0 and value < 2**level:
                print(f'<rect x="{MARGIN + VALUES}" y="{y - unit:.1f}" width="{WIDTH - 2 * MARGIN - VALUES}" '
                      f'height="{unit:.1f}" fill="#f3f1ea"/>')
            text(MARGIN + 8, y + 4, value, size=11, fill="#777")
        room = WIDTH - 2 * MARGIN - VALUES - GAP * len(pictures)
        weights = [math.sqrt(p.width) for p in pictures]
        left = MARGIN + VALUES + GAP / 2
        for picture, weight in zip(pictures, weights):
            width = least + (room - least * len(pictures)) * weight / sum(weights)
            picture.draw(left, top, width, height)
            left += width + GAP
        top += height + LABEL + MARGIN + 10
    print("</svg>")


if __name__ == "__main__":
    main()
