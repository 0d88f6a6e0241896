#!/usr/bin/env python3
"""Draws ../torus.svg: a standing torus coloured by its height z, and its Reeb graph beside it.

    python3 docs/figures/torus.py > docs/torus.svg
"""
import math

RING, TUBE = 1.0, 0.5
RINGS, SIDES = 56, 22
TURN, TILT = math.radians(38), math.radians(12)
SCALE, CENTER_X, CENTER_Y, GRAPH_X = 92, 170, 168, 452
LIGHT = (-0.35, -0.75, 0.56)


def point(a, b):
    r = RING + TUBE * math.cos(b)
    return r * math.cos(a), TUBE * math.sin(b), r * math.sin(a)


def normal(a, b):
    return math.cos(b) * math.cos(a), math.sin(b), math.cos(b) * math.sin(a)


def view(p):
    """Screen x, screen y, depth (larger is nearer)."""
    x, y, z = p
    x, y = x * math.cos(TURN) - y * math.sin(TURN), x * math.sin(TURN) + y * math.cos(TURN)
    y, z = y * math.cos(TILT) + z * math.sin(TILT), z * math.cos(TILT) - y * math.sin(TILT)
    return x, z, -y


def screen(p):
    x, z, _ = view(p)
    return CENTER_X + SCALE * x, CENTER_Y - SCALE * z


def colour(z, shade=1.0):
    low, middle, high = (49, 92, 160), (226, 226, 214), (190, 76, 48)
    t = (z / (RING + TUBE) + 1) / 2
    a, b, s = (low, middle, 2 * t) if t < 0.5 else (middle, high, 2 * t - 1)
    return "#%02x%02x%02x" % tuple(round(min(255, shade * (u + s * (v - u)))) for u, v in zip(a, b))


def quads():
    for i in range(RINGS):
        for j in range(SIDES):
            a, b = 2 * math.pi * i / RINGS, 2 * math.pi * j / SIDES
            c, d = 2 * math.pi * (i + 1) / RINGS, 2 * math.pi * (j + 1) / SIDES
            middle = (a + c) / 2, (b + d) / 2
            n = normal(*middle)
            if view(n)[2] <= 0:
                continue
            shade = 0.62 + 0.42 * max(0.0, sum(u * v for u, v in zip(n, LIGHT)))
            corners = [screen(point(*q)) for q in ((a, b), (c, b), (c, d), (a, d))]
            yield view(point(*middle))[2], corners, colour(point(*middle)[2], shade)


def text(x, y, words, anchor="start", size=13):
    print(f'<text x="{x:.0f}" y="{y:.0f}" font-size="{size}" text-anchor="{anchor}">{words}</text>')


print('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 680 350" width="680" height="350" '
      'font-family="sans-serif" fill="#222">')
print('<rect width="680" height="350" fill="white"/>')
for _, corners, fill in sorted(quads()):
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in corners)
    print(f'<polygon points="{path}" fill="{fill}" stroke="{fill}" stroke-width="0.6"/>')

levels = [-RING - TUBE, -RING + TUBE, RING - TUBE, RING + TUBE]
names = ["minimum", "up-fork: the contour splits in two", "down-fork: the two meet again", "maximum"]
heights = [screen((0, 0, z))[1] for z in levels]
for z, y in zip(levels, heights):
    print(f'<line x1="{CENTER_X}" y1="{y:.1f}" x2="{GRAPH_X}" y2="{y:.1f}" stroke="#888" '
          'stroke-dasharray="3 4"/>')
arcs = [(0, 1, 0), (1, 2, -34), (1, 2, 34), (2, 3, 0)]
for lo, hi, bend in arcs:
    y0, y1 = heights[lo], heights[hi]
    print(f'<path d="M{GRAPH_X} {y0:.1f} C{GRAPH_X + bend * 1.35:.0f} {y0 - (y0 - y1) * .3:.1f} '
          f'{GRAPH_X + bend * 1.35:.0f} {y1 + (y0 - y1) * .3:.1f} {GRAPH_X} {y1:.1f}" '
          f'fill="none" stroke="#444" stroke-width="3"/>')
for z, y, name in zip(levels, heights, names):
    print(f'<circle cx="{GRAPH_X}" cy="{y:.1f}" r="7" fill="{colour(z)}" stroke="#222"/>')
    if "fork" in name:
        kind, what = name.split(": ")
        text(GRAPH_X + 50, y - 3, kind)
        text(GRAPH_X + 50, y + 12, what, size=11)
    else:
        text(GRAPH_X + 16, y + 4, name)
text(GRAPH_X + 50, (heights[1] + heights[2]) / 2 + 4, "one loop", size=13)
text(CENTER_X, 340, "mesh, coloured by f = z", "middle")
text(GRAPH_X, 340, "its Reeb graph", "middle")
print("</svg>")
