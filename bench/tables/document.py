"""docs/BENCHMARKS.md and its picture, from the figures of a run."""
import os
import shutil
import subprocess
import tempfile
import textwrap

from goals import goal_rows
from paper import MACHINE, ORIGINAL_ORDER, SIZES as PAPER_SIZES

MISSING = "–"
NAMES = {"0.87M": "871,414", "7.2M": "7.2 million", "28M": "28 million", "56M": "56 million", "372M": "372 million"}


def paragraph(text):
    return textwrap.fill(" ".join(text.split()), 118, break_long_words=False, break_on_hyphens=False) + "\n"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def seconds(value):
    if value < 0.1:
        return f"{value:.3f} s"
    return f"{value:.2f} s" if value < 10 else f"{value:.1f} s" if value < 100 else f"{value:.0f} s"


def size(value):
    if value < 1000:
        return f"{value:.0f} B"
    if value < 1e6:
        return f"{value / 1e3:.0f} KB"
    return f"{value / 1e6:.1f} MB" if value < 1e7 else f"{value / 1e6:.0f} MB"


class Figures:
    """Medians by name; a figure that was not measured is a dash."""

    def __init__(self, cells):
        self.cells = cells

    def get(self, name, field="wall"):
        cell = self.cells.get(name, {})
        value = cell.get(field)
        return value["median"] if isinstance(value, dict) else value

    def text(self, name, field, form):
        value = self.get(name, field)
        return MISSING if value is None else form(value)

    def mean(self, names, field="wall"):
        values = [self.get(name, field) for name in names]
        return None if None in values else sum(values) / len(values)

    def largest(self, names, field):
        values = [self.get(name, field) for name in names]
        return None if None in values else max(values)


def shown(value, form):
    return MISSING if value is None else form(value)


def size_table(figures):
    rows, memory = [], []
    for name, triangles in NAMES.items():
        at = f"sizes/{name}/"
        coordinates = [at + function for function in "xyz"]
        if figures.get(at + "z") is None:
            continue
        model, paper_average, paper_most, paper_load, paper_memory, _ = PAPER_SIZES[name]
        rows.append([triangles, figures.text(at + "load", "finalization", seconds),
                     shown(figures.mean(coordinates), seconds), figures.text(at + "random:1", "wall", seconds),
                     figures.text(at + "z/in-core", "wall", seconds),
                     figures.text(at + "random:1/in-core", "wall", seconds), model, paper_load, paper_average,
                     paper_most])
        memory.append([triangles, shown(figures.largest(coordinates, "peak_bytes"), size),
                       figures.text(at + "random:1", "peak_bytes", size),
                       figures.text(at + "z/in-core", "peak_bytes", size),
                       shown(figures.largest(coordinates, "live_bytes"), size),
                       figures.text(at + "random:1", "live_bytes", size),
                       figures.text(at + "z", "spilled_bytes", size),
                       figures.text(at + "random:1", "spilled_bytes", size), paper_memory])
    return (table(["triangles", "load", "x, y, z on average", "random", "z, in core", "random, in core", "paper", "load",
                   "average", "random"], rows) + "\n" +
            table(["triangles", "peak memory, x, y, z", "random", "z, in core", "live graph, x, y, z", "random",
                   "spilled, z", "random", "paper"], memory))


def noise_table(figures):
    rows = []
    for name, triangles in NAMES.items():
        before, after = f"sizes/{name}/z", f"sizes/{name}/hierarchy"
        if figures.get(after) is None or figures.get(before) is None:
            continue
        rows.append([triangles, f"{figures.get(before, 'arcs'):,}", f"{figures.get(after, 'arcs'):,}",
                     seconds(figures.get(after)), size(figures.get(after, "peak_bytes")),
                     size(figures.get(after, "file_bytes"))])
    return table(["triangles", "arcs before", "arcs after", "whole run", "peak memory", "file"], rows)


def order_table(figures):
    rows = []
    for name, triangles in NAMES.items():
        for order in ("patches", "rows", "hilbert", "spectral", "random"):
            at = f"orders/{name}/{order}/"
            cells = [figures.text(at + function, "wall", seconds) + " / " + figures.text(at + function, "peak_bytes", size)
                     for function in ("x", "y", "z", "random:1")]
            if figures.get(at + "z") is None:
                continue
            conversion = at + "conversion"
            rows.append([triangles, order, figures.text(conversion, "wall", seconds), *cells])
    for model, triangles, conversion, *cells in ORIGINAL_ORDER:
        rows.append([triangles, f"paper: {model}, original", conversion, *cells])
    return table(["triangles", "order", "conversion", "x", "y", "z", "random"], rows)


def manifold_table(figures):
    rows = []
    for name in NAMES:
        for order in ("patches", "rows"):
            for function in ("z", "random:1"):
                at = f"manifold/{name}/{order}/{function}"
                if figures.get(at) is None:
                    continue
                change = lambda field: f"{100 * (figures.get(at, field) - 1):+.1f} %"
                rows.append([NAMES[name], order, function, seconds(figures.get(at, "first_wall")),
                             seconds(figures.get(at)), change("processor_ratio"), change("peak_bytes_ratio"),
                             figures.text(at, "first_live_bytes", size), figures.text(at, "live_bytes", size)])
    return table(["triangles", "order", "function", "without", "with", "processor time", "peak memory",
                  "live graph without", "with"], rows)


def peer_table(figures, cells):
    rows = []
    for name in ("5000", "10000", "20000", "50000", "100000"):
        ours, vtk = f"peers/reeb/{name}", f"peers/vtk/{name}"
        if figures.get(ours) is None:
            continue
        there = cells.get(vtk, {})
        rows.append([f"{figures.get(ours, 'triangles'):,}", figures.text(ours, "wall", seconds),
                     figures.text(ours, "peak_bytes", size), figures.text(vtk, "compute", seconds),
                     figures.text(vtk, "wall", seconds), figures.text(vtk, "peak_bytes", size),
                     MISSING if "equal" not in there else "yes" if there["equal"] else "no"])
    version = next((cell["version"] for cell in cells.values() if "version" in cell), "")
    if not rows:
        return version, "Not measured: VTK was not installed.\n"
    return version, table(["triangles", "reeb", "memory", "VTK, the graph alone", "VTK, whole process", "memory",
                           "the same arcs"], rows)


def profile_tables(cells):
    parts = []
    for function, what in (("z", "z"), ("random:1", "A random function")):
        rows = cells.get(f"profile/{function}", {}).get("functions")
        if rows is None:
            continue
        *_, (_, before_all, after_all) = rows
        added = after_all - before_all
        parts.append(f"{what}: {added:.0f} instructions a triangle more, {100 * added / before_all:+.1f} %.\n")
        parts.append(table(["function", "without", "with", "share of what is added"],
                           [[f"`{name}`" if "::" in name else name, f"{before:.1f}", f"{after:.1f}",
                             f"{100 * (after - before) / added:.1f} %"] for name, before, after in rows]))
    return "\n".join(parts)


def all_figures(cells):
    rows = []
    for name in sorted(cells):
        cell = cells[name]
        if "wall" not in cell:
            continue
        wall = cell["wall"]
        form = lambda field: size(cell[field]["median"]) if field in cell else MISSING
        rows.append([f"`{name}`", str(cell["runs"]), *(seconds(wall[key]) for key in ("min", "median", "max")),
                     seconds(cell["processor"]["median"]), form("peak_bytes"), form("rchar"), form("read_bytes"),
                     form("wchar")])
    return table(["what", "runs", "least", "median", "most", "processor", "peak memory", "read by calls",
                  "read from a device", "written"], rows)


# ---- the picture

def points(figures, names, field="wall"):
    found = []
    for name in NAMES:
        value = figures.mean([f"sizes/{name}/{part}" for part in names], field)
        triangles = figures.get(f"sizes/{name}/z", "triangles")
        if value is not None and triangles:
            found.append((triangles, value))
    return found


def picture(figures, path):
    """Time against size, as the paper's figure 10; False if there is no gnuplot or nothing to draw."""
    if shutil.which("gnuplot") is None or not points(figures, ["z"]):
        return False
    triangles = {name: figures.get(f"sizes/{name}/z", "triangles") for name in NAMES}
    number = lambda text: float(text.split()[0].replace(",", ""))
    paper = [(float(PAPER_SIZES[name][5]), number(PAPER_SIZES[name][1]), number(PAPER_SIZES[name][2]))
             for name in triangles]
    curves = [("reeb, x, y, z on average", points(figures, "xyz"), "lw 2 pt 7 ps 0.7 lc rgb '#1f5fa8'"),
              ("reeb, random function", points(figures, ["random:1"]), "lw 2 pt 5 ps 0.7 lc rgb '#c0392b'"),
              ("reeb, load", points(figures, ["load"], "finalization"), "lw 2 pt 9 ps 0.7 lc rgb '#666666'"),
              ("paper, on average", [(x, y) for x, y, _ in paper], "dt 2 lw 2 pt 6 ps 0.7 lc rgb '#1f5fa8'"),
              ("paper, random function", [(x, y) for x, _, y in paper], "dt 2 lw 2 pt 4 ps 0.7 lc rgb '#c0392b'")]
    with tempfile.TemporaryDirectory() as folder:
        plots = []
        for index, (title, places, style) in enumerate(curves):
            if not places:
                continue
            data = os.path.join(folder, str(index))
            with open(data, "w", encoding="ascii") as file:
                file.writelines(f"{x} {y}\n" for x, y in places)
            plots.append(f"'{data}' with linespoints {style} title '{title}'")
        first_x, first_y = points(figures, "xyz")[0] if points(figures, "xyz") else points(figures, ["z"])[0]
        plots.append(f"{first_y / first_x!r}*x with lines dt 3 lc rgb '#999999' title 'linear'")
        script = f"""set terminal svg size 760,480 font 'sans-serif,13' background '#ffffff'
set output '{path}'
set logscale xy
set xrange [6e5:6e8]
set xlabel 'triangles'
set ylabel 'seconds'
set format x '10^{{%T}}'
set format y '%g'
set grid lc rgb '#dddddd'
set key left top
plot {', '.join(plots)}
"""
        done = subprocess.run(["gnuplot"], input=script, text=True, capture_output=True, check=False)
        return done.returncode == 0


# ---- the page

def write(result, folder):
    cells = result["cells"]
    figures = Figures(cells)
    drawn = picture(figures, os.path.join(folder, "benchmarks.svg"))
    with open(os.path.join(folder, "BENCHMARKS.md"), "w", encoding="utf-8") as file:
        file.write(page(result, cells, figures, drawn or os.path.exists(os.path.join(folder, "benchmarks.svg"))))


def machine_text(result):
    machine = result["machine"]
    libraries = ", ".join(f"{name} {version}" for name, version in machine["libraries"].items())
    return (f"{machine['processor']}, {machine['cores']} cores, {machine['memory_bytes'] / 2**30:.0f} GiB of memory, "
            f"{machine['system']}; {machine['compiler']}; {libraries}; {result['version']}; {result['date']}. "
            f"Temporary files were on {'a disk' if machine['temporary_files'] == 'disk' else 'a file system in memory'}.")


def page(result, cells, figures, has_picture):
    load = result["load"]
    cores = result["machine"]["cores"]
    busy = ""
    if load["most"] > cores + 1.5:
        busy = (f"**The machine was busy**: its load was up to {load['most']:.1f} on {cores} cores. Times are longer "
                "than on a quiet one; memory and graphs are not affected.")
    version, peers = peer_table(figures, cells)
    profile = profile_tables(cells)
    profile = [] if not profile else [
        "## Profile of embedding and noise removal\n",
        paragraph("Instructions a triangle, counted by callgrind: 871,414 triangles in patches, `--graph-only --threads 1`, "
                  "with `--buckets 0` and with `--denoise 0.1%`. Functions are without those that they call, but with "
                  "those that the compiler put inside them."),
        profile]
    parts = ["# Benchmarks\n",
             paragraph("`bench/run.sh` makes the meshes, checks every answer, measures, and writes this page, its picture "
                       "and `docs/benchmarks.json`. `--quick` takes minutes and has meshes of up to 12 million triangles, "
                       "`--full` up to 56 million, `--huge` up to 372 million. An interrupted command continues where it "
                       "was; `--only sizes` measures one table; `--render` writes the page again from the JSON."),
             paragraph(f"*This page*: `--{result['mode']}`; {machine_text(result)}"),
             paragraph(busy) if busy else "",
             paragraph("Times are wall times of whole processes, medians, with the file in the page cache and as many "
                       "threads as cores. GNU time starts the programs, to measure their memory; its own start does not "
                       "count. Memory is the peak resident memory of the process; MB are millions of bytes. "
                       "The meshes are surfaces of `reeb generate scan`, with noise and handles. Before a time is taken, "
                       "the graph must have one component, and no more loops than the surface has handles; for z exactly "
                       "as many. A dash is what was not measured."),
             paragraph(f"The paper is Pascucci, Scorzelli, Bremer and Mascarenhas, SIGGRAPH 2007. Its figures are of "
                       f"{MACHINE}, of scans of about the same sizes, and its memory is that of the algorithm's own "
                       f"structures; the live graph below is the nearest to that."),
             "## Sizes and functions\n",
             paragraph("`--graph-only --buckets 0`, triangles in patches (table 2 of the paper). *Load* is the first pass "
                       "of a run with `--sidecar`, which reads every triangle. *In core* has its temporary files in "
                       "memory (`--temp-dir` on tmpfs); everything else has them where the temporary folder is. *Live graph* is `live_max.bytes` of the "
                       "report, *spilled* its `spilled_bytes`."),
             size_table(figures)]
    if has_picture:
        parts += ["![Seconds against triangles, both logarithmic: straight lines, those of reeb below those of the paper]"
                  "(benchmarks.svg)\n",
                  paragraph("Figure 10 of the paper again. The dotted line is linear.")]
    parts += ["## Noise removal and hierarchy\n",
              paragraph("The number of arcs for z, without and with `--denoise 0.1%`; and the whole run with noise "
                        "removal, embedding and hierarchy, to the stored file."),
              noise_table(figures),
              "## Orders\n",
              paragraph("The same surface in several orders of its triangles (table 3 of the paper): time / peak memory, "
                        "and the time of `reeb convert --finalize --order` from rows. *Random* is the worst order for a "
                        "program that reads a stream: every triangle is far from the one before. Here it is sorted on "
                        "disk first. The worst case of the paper is St. Matthew for y: 3.8 hours and 376 MB."),
              order_table(figures),
              "## Manifold\n",
              paragraph("`--manifold` promises that no edge has more than two triangles, so the path of an edge is dropped "
                        "after the second one. Runs with and without it, in turns; the graphs must be the same, byte for "
                        "byte. Edges stay known until one end is complete, so that a third triangle is always noticed. "
                        "Little is saved here, since only edges at the borders of chunks have paths, and these are "
                        "dropped when one end is complete, which is soon. That every edge is checked takes more than that."),
              manifold_table(figures),
              "## Peers\n",
              paragraph("VTK's `vtkReebGraph` implements the paper's algorithm; its time is quadratic on these meshes, so "
                        "they are small. " + (f"It is version {version} of Debian, from Python. " if version else "") +
                        "The graph alone is the time of `Build()`. The arcs are compared by their vertices."),
              peers,
              "## Targets\n",
              paragraph("What the project aims at, and what this run found."),
              table(["what", "target", "here", "reached", "why not"], goal_rows(figures, bool(busy))),
              *profile,
              "## Small parts\n",
              paragraph("The programs `bench/*_bench.cpp` time single parts in a process of their own: readers, the sweep, "
                        "gluing, the second stage, codecs, loading of levels. `bench/growth.sh`, `bench/overhead.sh` and "
                        "`bench/conversion_table.sh` measure one question each in more detail."),
              "## All figures\n",
              paragraph("Seconds are wall times but for the processor time, which is a median of all threads together, as "
                        "are the columns after it. Files that are mapped into memory are not read by calls."),
              all_figures(cells)]
    if result["failures"]:
        parts += ["## Failures\n",
                  table(["what", "why"], [[f"`{failure['what']}`", failure["why"]] for failure in result["failures"]])]
    return "\n".join(part for part in parts if part)
