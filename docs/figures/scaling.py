#!/usr/bin/env python3
"""Draws docs/scaling.svg: the model of docs/DISTRIBUTED.md for meshes of 10^9 to 10^12 triangles.

    docs/figures/scaling.py > docs/scaling.svg
"""
import math

RUN = 110e-9  # seconds of a core for each triangle of a share
READ, FILES = 45, 100e9  # bytes of the file for each triangle, in three readings; bytes per second for all ranks
EDGE, NETWORK = 770, 1e9  # bytes for each root of the number of vertices; bytes per second, glued as well
WIDTH, HEIGHT, LEFT, TOP, PANEL_WIDTH, PANEL_HEIGHT = 760, 380, 70, 20, 560, 300
INK, GREY = "#222", "#ccc"
COLOURS = ("#1f6f8b", "#c8553d", "#7a9e3b", "#8a5fa8")


def seconds(triangles, ranks):
    edge = EDGE * math.sqrt(triangles / 2)
    return RUN * triangles / ranks + READ * triangles / FILES + 2 * math.log2(ranks) * edge / NETWORK


def main():
    most, least = 6, -1  # powers of ten of seconds

    def at(ranks, time):
        x = LEFT + math.log2(ranks) / 12 * PANEL_WIDTH
        return f"{x:.1f},{TOP + PANEL_HEIGHT * (most - math.log10(time)) / (most - least):.1f}"

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12" fill="{INK}">',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    for power in range(0, 13, 2):
        x = at(2**power, 1).split(",")[0]
        out.append(f'<line x1="{x}" y1="{TOP}" x2="{x}" y2="{TOP + PANEL_HEIGHT}" stroke="{GREY}"/>')
        out.append(f'<text x="{x}" y="{TOP + PANEL_HEIGHT + 16}" text-anchor="middle">{2**power}</text>')
    for power in range(least, most + 1):
        y = float(at(1, 10**power).split(",")[1])
        out.append(f'<line x1="{LEFT}" y1="{y}" x2="{LEFT + PANEL_WIDTH}" y2="{y}" stroke="{GREY}"/>')
        out.append(f'<text x="{LEFT - 6}" y="{y + 4}" text-anchor="end">{10**power:,}</text>')
    out.append(f'<text x="{LEFT + PANEL_WIDTH / 2}" y="{TOP + PANEL_HEIGHT + 38}" text-anchor="middle">ranks</text>')
    middle = TOP + PANEL_HEIGHT / 2
    out.append(f'<text x="14" y="{middle}" text-anchor="middle" transform="rotate(-90 14 {middle})">seconds</text>')
    for power, colour in zip((9, 10, 11, 12), COLOURS):
        line = " ".join(at(2**k, seconds(10**power, 2**k)) for k in range(13))
        out.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        x, y = line.split()[-1].split(",")
        out.append(f'<text x="{float(x) + 8}" y="{float(y) + 4}" fill="{colour}">10<tspan font-size="9" dy="-4">{power}</tspan>'
                   '<tspan dx="4" dy="4">triangles</tspan></text>')
    out.append("</svg>")
    print("\n".join(out))


if __name__ == "__main__":
    main()
