#!/usr/bin/env python3
"""Draws docs/loading.svg: time and memory to load a level, by its size.

    build/release/bench/loading_bench --benchmark_out=loading.json --benchmark_out_format=json
    docs/figures/loading.py loading.json > docs/loading.svg
"""
import json
import math
import sys

WIDTH, HEIGHT, LEFT, TOP, SIZE = 760, 360, 62, 34, 270
INK, GREY, COLOURS = "#222", "#ccc", {0: "#1f6f8b", 1: "#c8553d"}
NAMES = {0: "without embedding", 1: "with embedding"}


def panel(out, x0, title, unit, y_range, series, promise=None):
    x_lo, x_hi = 1.9, 6.1
    y_lo, y_hi = y_range

    def at(x, y):
        px = x0 + (math.log10(x) - x_lo) / (x_hi - x_lo) * SIZE
        py = TOP + SIZE - (math.log10(y) - y_lo) / (y_hi - y_lo) * SIZE
        return f"{px:.1f},{py:.1f}"

    out.append(f'<text x="{x0 + SIZE / 2}" y="{TOP - 12}" text-anchor="middle" font-weight="bold">{title}</text>')
    for decade in range(math.ceil(x_lo), math.floor(x_hi) + 1):
        x, y = at(10**decade, 10**y_lo).split(",")
        out.append(f'<line x1="{x}" y1="{y}" x2="{x}" y2="{TOP}" stroke="{GREY}"/>')
        out.append(f'<text x="{x}" y="{float(y) + 16}" text-anchor="middle">10<tspan dy="-5" font-size="9">{decade}</tspan></text>')
    for decade in range(math.ceil(y_lo), math.floor(y_hi) + 1):
        y = at(100, 10**decade).split(",")[1]
        out.append(f'<line x1="{x0}" y1="{y}" x2="{x0 + SIZE}" y2="{y}" stroke="{GREY}"/>')
        label = f"{10**decade:g}" if decade < 0 else f"{10**decade:,}"
        out.append(f'<text x="{x0 - 6}" y="{float(y) + 4}" text-anchor="end">{label}</text>')
    out.append(f'<text x="{x0 + SIZE / 2}" y="{TOP + SIZE + 34}" text-anchor="middle">nodes of the level</text>')
    out.append(f'<text x="{x0 - 46}" y="{TOP + SIZE / 2}" text-anchor="middle" transform="rotate(-90 {x0 - 46} {TOP + SIZE / 2})">{unit}</text>')
    if promise:
        (x1, y1), (x2, y2) = promise
        out.append(f'<polyline points="{at(x1, y1)} {at(x2, y2)}" fill="none" stroke="{INK}" stroke-dasharray="4 4"/>')
    for embedding, points in series.items():
        line = " ".join(at(x, y) for x, y in points)
        out.append(f'<polyline points="{line}" fill="none" stroke="{COLOURS[embedding]}" stroke-width="2"/>')
        for x, y in points:
            px, py = at(x, y).split(",")
            out.append(f'<circle cx="{px}" cy="{py}" r="3" fill="{COLOURS[embedding]}"/>')


def main():
    with open(sys.argv[1]) as file:
        runs = [run for run in json.load(file)["benchmarks"] if run["name"].startswith("BM_Load")]
    times, held = {0: [], 1: []}, {0: [], 1: []}
    for run in runs:
        embedding = int("embedding:1" in run["name"])
        times[embedding].append((run["nodes"], run["cpu_time"]))
        held[embedding].append((run["nodes"], run["held_bytes"] / run["promised_bytes"]))
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12" fill="{INK}">',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    panel(out, LEFT, "time to open the file and load a level", "milliseconds", (-1.2, 4), times,
          ((1000, 10), (1000, 10**-1.2)))
    panel(out, LEFT + SIZE + 110, "memory held, of what the table promises", "share", (-1, 1), held, ((80, 1), (1.2e6, 1)))
    for i, (embedding, name) in enumerate(NAMES.items()):
        x = LEFT + 14
        y = TOP + 18 + 18 * i
        out.append(f'<circle cx="{x}" cy="{y - 4}" r="4" fill="{COLOURS[embedding]}"/><text x="{x + 10}" y="{y}">{name}</text>')
    out.append("</svg>")
    print("\n".join(out))


if __name__ == "__main__":
    main()
