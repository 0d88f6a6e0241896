#!/usr/bin/env python3
"""Draws docs/memory.svg: resident memory of a run over time.

    (reeb compute large.ply --denoise 0.1% --force & p=$!
     while kill -0 $p; do
       echo "$(date +%s.%N) $(awk '/VmRSS|RssAnon/{printf "%s ",$2}' /proc/$p/status)"; sleep 0.25
     done) > memory.txt
    docs/figures/memory.py memory.txt > docs/memory.svg

A line is the time in seconds, resident kilobytes, and those of them that are no mapped file.
"""
import sys

WIDTH, HEIGHT, LEFT, TOP, PANEL_WIDTH, PANEL_HEIGHT = 760, 300, 62, 34, 660, 210
INK, GREY, TOTAL, OWN = "#222", "#ccc", "#1f6f8b", "#c8553d"


def main():
    with open(sys.argv[1]) as file:
        rows = [[float(word) for word in line.split()[:3]] for line in file if len(line.split()) >= 3]
    start = rows[0][0]
    seconds = [row[0] - start for row in rows]
    x_most = 5 * (int(seconds[-1] / 5) + 1)
    y_most = 10 * (int(max(row[1] for row in rows) / 1024 / 10) + 1)

    def at(second, megabytes):
        return f"{LEFT + second / x_most * PANEL_WIDTH:.1f},{TOP + PANEL_HEIGHT * (1 - megabytes / y_most):.1f}"

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12" fill="{INK}">',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    for second in range(0, x_most + 1, 5):
        x = at(second, 0).split(",")[0]
        out.append(f'<line x1="{x}" y1="{TOP}" x2="{x}" y2="{TOP + PANEL_HEIGHT}" stroke="{GREY}"/>')
        out.append(f'<text x="{x}" y="{TOP + PANEL_HEIGHT + 16}" text-anchor="middle">{second}</text>')
    for megabytes in range(0, y_most + 1, 10):
        y = float(at(0, megabytes).split(",")[1])
        out.append(f'<line x1="{LEFT}" y1="{y}" x2="{LEFT + PANEL_WIDTH}" y2="{y}" stroke="{GREY}"/>')
        out.append(f'<text x="{LEFT - 6}" y="{y + 4}" text-anchor="end">{megabytes}</text>')
    out.append(f'<text x="{LEFT + PANEL_WIDTH / 2}" y="{TOP + PANEL_HEIGHT + 36}" text-anchor="middle">seconds</text>')
    middle = TOP + PANEL_HEIGHT / 2
    out.append(f'<text x="18" y="{middle}" text-anchor="middle" transform="rotate(-90 18 {middle})">resident, MiB</text>')
    for column, colour, name in ((1, TOTAL, "all"), (2, OWN, "without mapped files")):
        line = " ".join(at(second, row[column] / 1024) for second, row in zip(seconds, rows))
        out.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        x = LEFT + 12 + 60 * (column - 1)
        out.append(f'<circle cx="{x}" cy="{TOP - 16}" r="4" fill="{colour}"/><text x="{x + 9}" y="{TOP - 12}">{name}</text>')
    out.append("</svg>")
    print("\n".join(out))


if __name__ == "__main__":
    main()
