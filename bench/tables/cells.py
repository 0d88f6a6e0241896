"""What is measured: meshes, commands, and what must be true of their answers before they are timed."""
import json
import os
import re
import shutil
import sys
import tempfile

import instructions
from measure import Failed, figures, run_once

SIZES = {"0.87M": 871414, "7.2M": 7200000, "28M": 28000000, "56M": 56000000, "372M": 372000000}
SIZES_OF = {"quick": ["0.87M", "7.2M"], "full": ["0.87M", "7.2M", "28M", "56M"], "huge": list(SIZES)}
FUNCTIONS = ["x", "y", "z", "random:1"]
ORDERS = ["patches", "rows", "hilbert", "spectral", "random"]
TILED = ["patches", "rows", "random", "tiles:32", "random-tiles:32", "seams-last:32"]
GRAPH = ["--graph-only", "--buckets", "0"]
MEMORY_FOLDER = "/dev/shm"
TABLES = ["sizes", "orders", "extras", "manifold", "peers", "targets", "profile"]


def kinds_of(path):
    """'memory' or 'disk', by the file system of the folder."""
    best, kind = "", "disk"
    with open("/proc/mounts", encoding="utf-8") as mounts:
        for line in mounts:
            _, point, system = line.split()[:3]
            inside = (os.path.realpath(path) + "/").startswith(point.rstrip("/") + "/")
            if inside and len(point) >= len(best):
                best, kind = point, "memory" if system in ("tmpfs", "ramfs") else "disk"
    return kind


class Bench:
    def __init__(self, program, folder, mode, runs, store):
        self.program, self.folder, self.mode, self.runs, self.store = program, folder, mode, runs, store
        self.failures, self.done, self.planned = [], 0, []
        self.scratch = tempfile.mkdtemp(prefix="bench-", dir=folder)
        self.output, self.report = os.path.join(self.scratch, "out.reeb"), os.path.join(self.scratch, "report.json")
        self.in_core = None
        if os.path.isdir(MEMORY_FOLDER) and kinds_of(MEMORY_FOLDER) == "memory":
            self.in_core = tempfile.mkdtemp(prefix="bench-", dir=MEMORY_FOLDER)

    def close(self):
        for folder in (self.scratch, self.in_core):
            if folder:
                shutil.rmtree(folder, ignore_errors=True)

    @property
    def sizes(self):
        return SIZES_OF[self.mode]

    def say(self, text):
        print(text, file=sys.stderr, flush=True)

    # ---- meshes

    def path(self, name):
        return os.path.join(self.folder, name)

    def mesh(self, name, *options, need=0):
        """The generated mesh of this name, which is made unless it is there with its topology."""
        path = self.path(name)
        if not (os.path.exists(path) and os.path.exists(path + ".topology")):
            if shutil.disk_usage(self.folder).free < need + (1 << 30):
                raise Failed(f"no room on disk for {name}")
            self.say(f"  making {name}")
            partial = self.path("new-" + name)
            _, text = run_once([self.program, "generate", *options, "-o", partial, "--force"])
            with open(path + ".topology", "w", encoding="utf-8") as file:
                file.write(" ".join(text.split()))
            os.replace(partial, path)
        return path

    def scan(self, size, order="patches", *options):
        triangles = SIZES.get(size) or int(size)
        name = f"scan-{size}-{order.replace(':', '-')}{''.join(options).replace('--', '-')}.ply"
        return self.mesh(name, "scan", "--triangles", str(triangles), "--order", order, *options, need=20 * triangles)

    def genus(self, mesh):
        with open(mesh + ".topology", encoding="utf-8") as file:
            return int(re.search(r"genus (\d+)", file.read()).group(1))

    # ---- figures

    def cell(self, name, measure, runs=None):
        """The stored figures of this name, or those of `measure()`, which returns the fields of one run and the
        facts that all runs share. A failure is stored for this time only."""
        self.done += 1
        cell = self.store.find(name)
        if cell is None:
            runs = runs or self.runs
            try:
                results = []
                facts = {}
                for _ in range(runs):
                    fields, facts = measure()
                    results.append(fields)
                cell = {**facts, **figures(results)}
                self.store.put(name, cell)
            except Failed as failure:
                self.failures.append((name, str(failure)))
                self.say(f"  {name}: FAILED: {failure}")
                return {"failed": str(failure)}
            self.say(f"  {self.line_of(name, cell)}")
        return cell

    @staticmethod
    def line_of(name, cell):
        text = name
        if "wall" in cell:
            wall = cell["wall"]
            text += f": {wall['median']:.2f} s ({wall['min']:.2f} to {wall['max']:.2f})"
        if "peak_bytes" in cell:
            text += f", {cell['peak_bytes']['median'] / 2**20:.0f} MiB"
        return text

    def compute(self, mesh, *options, limit=3600):
        """One run of compute to a new file: its fields, and facts of its report. A run that took too long left a state,
        which --force ignores."""
        for old in (self.output, self.report):  # removing them would be part of the run
            if os.path.exists(old):
                os.remove(old)
        command = [self.program, "compute", mesh, "-o", self.output, "--force", "--quiet", "--report", self.report]
        if "--temp-dir" not in options:
            options = (*options, "--temp-dir", self.scratch)
        fields, _ = run_once([*command, *options], limit)
        with open(self.report, encoding="utf-8") as file:
            report = json.load(file)
        fields["spilled_bytes"] = report["spilled_bytes"]
        for phase, seconds in report["seconds"].items():
            if phase != "wall":
                fields[phase] = seconds
        if "bytes" in report["live_max"]:
            fields["live_bytes"] = report["live_max"]["bytes"]
        facts = {"triangles": report["input"]["triangles"], "live_vertices": report["live_max"]["vertices"],
                 "nodes": report["graph"]["nodes"], "arcs": report["graph"]["arcs"],
                 "loops": report["graph"]["loops"], "components": report["graph"]["components"],
                 "file_bytes": os.path.getsize(self.output), "input_bytes": os.path.getsize(mesh),
                 "threads": report["threads"]}
        return fields, facts

    def checked(self, name, mesh, *options, genus=None, runs=None, limit=3600, may_fail=False):
        """Figures of compute; before that, its answer is checked, which also brings the mesh into the page cache.
        The graph of a closed orientable surface has at most as many loops as the surface has handles; that of the
        height of a generated scan has exactly as many. What may fail is stored as unsuited if it does."""
        checked = []
        is_height = "-f" not in options or options[options.index("-f") + 1] == "z"

        def measure():
            if not checked:
                _, facts = self.compute(mesh, *options, limit=limit)
                if genus is not None:
                    loops = facts["loops"]
                    right = loops == genus if is_height else loops <= genus
                    if facts["components"] != 1 or not right:
                        raise Failed(f"wrong answer: {facts['components']} components and {loops} loops instead of 1 "
                                     f"and {genus}")
                checked.append(True)
            return self.compute(mesh, *options, limit=limit)

        before = len(self.failures)
        cell = self.cell(name, measure, runs)
        if may_fail and "failed" in cell:  # which is then its figure
            self.store.put(name, {"unsuited": cell["failed"]})
            del self.failures[before:]
        return cell

    def paired(self, name, mesh, first, second, same_bytes=False, least=5, first_mesh=None):
        """Runs with two lists of options in turns, `least` times or more unless all is quick; the fields of the second,
        and its quotients with the first, which may be of another mesh."""
        def measure():
            before, _ = self.compute(first_mesh or mesh, *first)
            with open(self.output, "rb") as file:
                bytes_before = file.read() if same_bytes else b""
            after, facts = self.compute(mesh, *second)
            if same_bytes:
                with open(self.output, "rb") as file:
                    if file.read() != bytes_before:
                        raise Failed("wrong answer: the files differ")
            after["first_wall"], after["first_processor"] = before["wall"], before["processor"]
            for field in ("wall", "processor", "peak_bytes"):  # a tiny run may take no time that can be measured
                after[field + "_ratio"] = after[field] / max(before[field], 1e-6)
            if "live_bytes" in after:
                after["first_live_bytes"] = before["live_bytes"]
            return after, facts

        return self.cell(name, measure, self.runs if self.mode == "quick" else max(self.runs, least))

    def runs_of(self, size):
        return self.runs if size in ("0.87M", "7.2M") else max(1, self.runs - 1)


# ---- the tables

def sizes(bench):
    for size in bench.sizes:
        mesh = bench.scan(size)
        genus, runs = bench.genus(mesh), bench.runs_of(size)
        for function in FUNCTIONS:
            bench.checked(f"sizes/{size}/{function}", mesh, "-f", function, *GRAPH, genus=genus, runs=runs)
        for function in ("z", "random:1") if bench.in_core else ():
            bench.checked(f"sizes/{size}/{function}/in-core", mesh, "-f", function, *GRAPH, "--temp-dir", bench.in_core,
                          genus=genus, runs=runs)
        bench.checked(f"sizes/{size}/hierarchy", mesh, "--denoise", "0.1%", genus=genus, runs=runs)
        bench.cell(f"sizes/{size}/load", lambda mesh=mesh: loaded(bench, mesh), runs)


def loaded(bench, mesh):
    """A run that reads all triangles for their last uses first, since it is to keep what it finds."""
    sidecar = mesh + ".final"
    if os.path.exists(sidecar):
        os.remove(sidecar)
    try:
        return bench.compute(mesh, *GRAPH, "--sidecar")
    finally:
        if os.path.exists(sidecar):
            os.remove(sidecar)


def converted(bench, mesh, size, order):
    """The mesh as a stream in this order, and what it cost."""
    stream = bench.path(f"scan-{size}-{order}.smb")

    def convert():
        fields, _ = run_once([bench.program, "convert", mesh, stream, "--finalize", "--order", order, "--force",
                              "--quiet"], 3600, {"TMPDIR": bench.scratch})
        return fields, {"bytes": os.path.getsize(stream)}

    if not os.path.exists(stream):
        bench.store.find(f"orders/{size}/{order}/conversion")
        bench.store.fresh.discard(f"orders/{size}/{order}/conversion")
    cell = bench.cell(f"orders/{size}/{order}/conversion", convert, 1 if size != "0.87M" else None)
    if "failed" in cell:
        raise Failed(f"no mesh in the order {order}: {cell['failed']}")
    if not os.path.exists(stream):
        convert()
    return stream


def orders(bench):
    for size in [size for size in bench.sizes if size in ("0.87M", "7.2M", "28M")]:
        if size == "7.2M" and bench.mode == "quick":
            continue
        original = bench.scan(size)
        genus = bench.genus(original)
        converted_from = bench.scan(size, "rows")
        for order in ORDERS:
            try:
                if order in ("hilbert", "spectral"):
                    mesh = converted(bench, converted_from, size, order)
                else:
                    mesh = bench.scan(size, order)
            except Failed as failure:
                bench.failures.append((f"orders/{size}/{order}", str(failure)))
                continue
            for function in FUNCTIONS:
                bench.checked(f"orders/{size}/{order}/{function}", mesh, "-f", function, *GRAPH, genus=genus,
                              runs=bench.runs_of(size))


def extras(bench):
    torus = bench.mesh("torus-1k.ply", "torus", "--triangles", "1k")
    bench.checked("extras/start-up", torus, genus=1, runs=21)
    size = "0.87M" if bench.mode == "quick" else "7.2M"
    scan = bench.scan(size)
    text = bench.path(f"scan-{size}.obj")
    if not os.path.exists(text):
        bench.say(f"  making scan-{size}.obj")
        run_once([bench.program, "convert", scan, text, "--quiet"])
    bench.checked(f"extras/obj/{size}", text, *GRAPH, genus=bench.genus(scan))
    side = 128 if bench.mode == "quick" else 256
    image = bench.mesh(f"volume-{side}.nrrd", "volume", "--grid", f"{side}x{side}x{side}")
    bench.checked(f"extras/image/{side}", image, *GRAPH)
    bench.cell("extras/level/1000", lambda: level(bench, 1000))
    program = os.path.join(os.path.dirname(bench.program), "..", "bench", "reader_bench")
    if os.path.exists(program):  # of the same build
        bench.cell("extras/readers", lambda: readers(program))


def readers(program):
    """Bytes of text read in a second of processor time, by the reader alone."""
    _, text = run_once([program, "--benchmark_filter=Stream", "--benchmark_format=json"])
    rates = {row["name"]: row["bytes_per_second"] for row in json.loads(text[text.index("{"):])["benchmarks"]}
    rate = lambda kind: rates[f"BM_Stream/ascii_obj_binary:{kind}/process_time"]
    return {"ascii_ply": rate(0), "obj": rate(1)}, {}


def level(bench, nodes):
    """Loading the finest level with that many nodes of a file with a hierarchy of a noisy scan."""
    file = bench.path("scan-0.87M.reeb")
    if not os.path.exists(file):
        bench.compute(bench.scan("0.87M"))
        shutil.move(bench.output, file)
    fields, _ = run_once([bench.program, "extract", file, "--nodes", str(nodes), "-o",
                          os.path.join(bench.scratch, "level.rg"), "--force"])
    return fields, {}


def manifold(bench):
    for size in bench.sizes if bench.mode != "huge" else SIZES_OF["full"]:
        for order in ("patches", "rows"):
            for function in ("z", "random:1"):
                options = ["-f", function, *GRAPH]
                bench.paired(f"manifold/{size}/{order}/{function}", bench.scan(size, order), options,
                             [*options, "--manifold"], same_bytes=True)


def vtk_python():
    """The Python that has VTK, with its version; or None."""
    driver = os.path.join(os.path.dirname(os.path.abspath(__file__)), "vtk_reeb_graph.py")
    for python in ("/usr/bin/python3", sys.executable):
        try:
            _, text = run_once([python, driver, "--version"], 60)
            return [python, driver], text.strip().splitlines()[-1]
        except (Failed, OSError):
            continue
    return None


def arcs_of(bench, file):
    text = os.path.join(bench.scratch, "graph.rg")
    run_once([bench.program, "extract", file, "--format", "rg", "-o", text, "--force"])
    with open(text, encoding="ascii") as lines:
        return sorted(tuple(map(int, line.split()[1:])) for line in lines if line.startswith("a "))


def peers(bench):
    vtk = vtk_python()
    if vtk is None:
        bench.say("  VTK is not there: apt-get install python3-vtk9")
        return
    driver, version = vtk
    # It takes quadratic time, so the meshes are small.
    for size in ["5000", "10000", "20000"] + ([] if bench.mode == "quick" else ["50000", "100000"]):
        mesh = bench.scan(size)
        ours = bench.checked(f"peers/reeb/{size}", mesh, *GRAPH, genus=bench.genus(mesh))
        if "failed" in ours:
            continue
        bench.compute(mesh, *GRAPH)
        expected = arcs_of(bench, bench.output)

        def measure():
            out = os.path.join(bench.scratch, "vtk.txt")
            fields, text = run_once([*driver, mesh, "z", out], 300)
            fields.update({name: float(value) for name, value in re.findall(r"^(load|compute) ([0-9.]+)$", text, re.M)})
            with open(out, encoding="ascii") as lines:
                found = [tuple(map(int, line.split())) for line in lines]
            return fields, {"equal": found == expected, "version": version}

        bench.cell(f"peers/vtk/{size}", measure, bench.runs if int(size) <= 20000 else 1)


def beyond_memory(bench, name, mesh, memory):
    """The hierarchy of a graph with all its noise: without a limit, and within less memory than the graph takes."""
    for kind, limit in (("free", []), (memory, ["--memory", memory])):
        bench.checked(f"targets/{name}/all-noise/{kind}", mesh, "--buckets", "0", *limit, genus=bench.genus(mesh),
                      runs=1)


def targets(bench):
    # 12 million triangles, as the targets say; a tenth of them where that would take too long.
    mesh = bench.scan("12000000")
    genus = bench.genus(mesh)
    for threads in ("1", "2"):
        bench.checked(f"targets/12M/z/threads-{threads}", mesh, *GRAPH, "--threads", threads, genus=genus)
    bench.checked("targets/12M/random", mesh, *GRAPH, "-f", "random:1", genus=genus)
    for function, least in (("z", 25), ("random:1", 5)):  # a few per cent of a short run need many
        bench.paired(f"targets/12M/{function}/embedding-and-noise", mesh, ["-f", function, *GRAPH],
                     ["-f", function, "--graph-only", "--denoise", "0.1%"], least=least)
    if bench.mode == "quick":
        return
    bench.checked("targets/12M/coherent-64M", mesh, "--memory", "64M", genus=genus)
    shuffled = bench.scan("12000000", "random")
    bench.checked("targets/12M/random-order-64M", shuffled, "--memory", "64M", genus=genus)
    limited = ["--memory", "64M"]
    bench.paired("targets/12M/random-order-against-coherent", shuffled, limited, limited, first_mesh=mesh)
    for buckets in ("0", "64"):
        bench.checked(f"targets/12M/hierarchy-buckets-{buckets}", mesh, "-f", "random:1", "--buckets", buckets,
                      genus=genus)
    for order in TILED:
        tiled = bench.scan("12000000", order)
        for memory in ("free", "64M"):
            options = [*GRAPH] + ([] if memory == "free" else ["--memory", memory])
            bench.checked(f"targets/tiles/{order}/{memory}", tiled, *options, genus=bench.genus(tiled), runs=1)
            # It may well fail, or take too long: then it is not the best.
            bench.checked(f"targets/tiles/{order}/{memory}/no-reorder", tiled, *options, "--no-reorder",
                          genus=bench.genus(tiled), runs=1, limit=60, may_fail=True)
    beyond_memory(bench, "48M", bench.scan("48000000"), "40M")
    if bench.in_core:
        size = bench.sizes[-1]
        bench.paired(f"targets/{size}/temporary-files", bench.scan(size), [*GRAPH, "--temp-dir", bench.in_core], GRAPH)
    if bench.mode != "huge":
        return
    beyond_memory(bench, "372M", bench.scan("372M"), "128M")
    wide = bench.scan("372M", "rows", "--width", "9990")
    bench.checked("targets/372M/rows", wide, "--denoise", "0.1%", "--memory", "96M", genus=bench.genus(wide))
    tiled = bench.scan("372M", "random-tiles:32")
    bench.checked("targets/372M/random-tiles", tiled, *GRAPH, "--memory", "64M", genus=bench.genus(tiled), runs=1,
                  may_fail=True)
    bench.checked("targets/372M/random-tiles-128M", tiled, *GRAPH, "--memory", "128M", genus=bench.genus(tiled), runs=1)


def profile(bench):
    """What the functions execute, without and with an embedding and noise removal."""
    if bench.mode == "quick":
        return
    if shutil.which("callgrind_annotate") is None:
        bench.say("  valgrind is not there: apt-get install valgrind")
        return
    mesh = bench.scan("0.87M")

    def measure(function):
        counts = []
        for options in (["--buckets", "0"], ["--denoise", "0.1%"]):
            command = [bench.program, "compute", mesh, "-f", function, "--graph-only", *options, "--threads", "1",
                       "--temp-dir", bench.scratch, "--quiet", "--force", "-o", bench.output]
            counts.append(instructions.counted(command, bench.scratch))
        return {}, {"functions": instructions.compared(*counts, SIZES["0.87M"])}

    for function in ("z", "random:1"):
        bench.cell(f"profile/{function}", lambda function=function: measure(function), 1)
