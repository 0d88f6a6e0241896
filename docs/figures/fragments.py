#!/usr/bin/env python3
"""Draws ../fragments.svg: a surface in two chunks, their fragments, and what gluing does.

    python3 docs/figures/fragments.py > docs/fragments.svg
"""
A, B, SHARED, INK, FAINT = "#3d6fb4", "#c0603a", "#6b3fa0", "#222", "#999"

print('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1080 390" width="1080" height="390" '
      f'font-family="sans-serif" fill="{INK}">')
print('<rect width="1080" height="390" fill="white"/>')


def text(x, y, words, size=13, anchor="middle", fill=INK, weight="normal"):
    print(f'<text x="{x}" y="{y}" font-size="{size}" text-anchor="{anchor}" fill="{fill}" '
          f'font-weight="{weight}">{words}</text>')


def line(p, q, colour=INK, width=1.5, dash=""):
    extra = f' stroke-dasharray="{dash}"' if dash else ""
    print(f'<line x1="{p[0]}" y1="{p[1]}" x2="{q[0]}" y2="{q[1]}" stroke="{colour}" '
          f'stroke-width="{width}"{extra}/>')


def polygon(points, fill, stroke="white"):
    path = " ".join(f"{x},{y}" for x, y in points)
    print(f'<polygon points="{path}" fill="{fill}" stroke="{stroke}" stroke-width="1.2"/>')


def node(p, colour, is_open=False, label="", dx=12, dy=4):
    fill = "white" if is_open else colour
    print(f'<circle cx="{p[0]}" cy="{p[1]}" r="6" fill="{fill}" stroke="{colour}" stroke-width="2.4"/>')
    if label:
        text(p[0] + dx, p[1] + dy, label, 12, "start" if dx > 0 else "end")


def shift(p, dx):
    return p[0] + dx, p[1]


# 1. The mesh. Height on the page is the function value. t > u > s are on the border.
s, u, t = (130, 300), (130, 210), (130, 110)
a0, a1, a2 = (40, 340), (30, 190), (75, 60)          # chunk A, on the left
b0, b1, b2 = (215, 330), (235, 235), (205, 75)       # chunk B, on the right
text(130, 28, "1  a mesh in two chunks", 14, weight="bold")
for triangle in [(a0, s, u), (a0, u, a1), (a1, u, t), (a1, t, a2)]:
    polygon(triangle, "#c9d8ee")
for triangle in [(b0, s, u), (b0, u, b1), (b1, u, t), (b1, t, b2)]:
    polygon(triangle, "#f2d4c6")
for p, q in [(s, u), (u, t)]:
    line(p, q, SHARED, 4)
for p, name in [(s, "s"), (u, "u"), (t, "t")]:
    node(p, SHARED, True, name)
text(60, 372, "chunk A", 12, fill=A)
text(205, 372, "chunk B", 12, fill=B)

# 2. The fragments.
MIDDLE = 405
LEFT, RIGHT = MIDDLE - 55, MIDDLE + 55
text(MIDDLE, 28, "2  each alone: two fragments", 14, weight="bold")
for x, colour, low, high, side in [(LEFT, A, 340, 60, -1), (RIGHT, B, 330, 75, 1)]:
    for y0, y1 in [(low, 300), (300, 210), (210, 110), (110, high)]:
        line((x, y0), (x, y1), colour, 3)
    for y0, y1 in [(300, 210), (210, 110)]:
        line((x + 8 * side, y0 - 9), (x + 8 * side, y1 + 9), SHARED, 2, "5 4")
    for y in (300, 210, 110):
        node((x, y), colour, True)
    for y in (low, high):
        node((x, y), colour)
for y, name in [(300, "s"), (210, "u"), (110, "t")]:
    text(MIDDLE, y + 4, name, 12)
    line((LEFT + 12, y), (MIDDLE - 10, y), FAINT, 1, "2 3")
    line((MIDDLE + 10, y), (RIGHT - 12, y), FAINT, 1, "2 3")
text(MIDDLE, 372, "dashed: path kept for an edge both have", 12, fill=SHARED)

# 3. Equal vertices become one node: the shared edges now have two paths each.
X = 685
text(X, 28, "3  equal vertices: one node", 14, weight="bold")
for y0, y1, colour, side in [(300, 210, A, -1), (300, 210, B, 1), (210, 110, A, -1), (210, 110, B, 1)]:
    print(f'<path d="M{X} {y0} C{X + side * 34} {y0 - 25} {X + side * 34} {y1 + 25} {X} {y1}" '
          f'fill="none" stroke="{colour}" stroke-width="3"/>')
line((X, 300), (X - 25, 340), A, 3)
line((X, 300), (X + 25, 330), B, 3)
line((X, 110), (X - 25, 60), A, 3)
line((X, 110), (X + 25, 75), B, 3)
for p in [(X - 25, 340), (X - 25, 60)]:
    node(p, A)
for p in [(X + 25, 330), (X + 25, 75)]:
    node(p, B)
for y, name in [(300, "s"), (210, "u"), (110, "t")]:
    node((X, y), SHARED, True, name, 14)
text(X, 372, "two cycles that the surface does not have", 12)

# 4. Zipped.
X = 950
text(X, 28, "4  paths zipped, u contracted", 14, weight="bold")
line((X, 300), (X, 110), INK, 3)
line((X, 300), (X - 25, 340), INK, 3)
line((X, 300), (X + 25, 330), INK, 3)
line((X, 110), (X - 25, 60), INK, 3)
line((X, 110), (X + 25, 75), INK, 3)
for p in [(X - 25, 340), (X - 25, 60), (X + 25, 330), (X + 25, 75)]:
    node(p, INK)
node((X, 300), INK, False, "s", 14)
node((X, 110), INK, False, "t", 14)
text(X, 372, "the Reeb graph of the whole", 12)

for x in (270, 540, 815):
    print(f'<path d="M{x} 205 h18 m-6 -5 l6 5 l-6 5" fill="none" stroke="{INK}" stroke-width="1.6"/>')
print("</svg>")
