"""The exports of `reeb extract`, opened by the programs that they are for: VTK, networkx, Graphviz, assimp. Each must
have the graph of the .rg file. SWC and CSV are read by the few lines below.

    foreign_exports.py REEB FOLDER PROGRAM...
"""

import collections
import csv
import json
import math
import subprocess
import sys

reeb, folder, programs = sys.argv[1], sys.argv[2], sys.argv[3:]


def run(*words):
    return subprocess.run(words, cwd=folder, check=True, capture_output=True, text=True).stdout


def extract(name, *options):
    run(reeb, "extract", "g.reeb", "-o", name, "--force", *options)
    return folder + "/" + name


def expect(what, found, expected):
    if found != expected:
        sys.exit(f"{what}: found {found}, expected {expected}")


def critical_type(down, up):
    if down == 0:
        return 0
    if up == 0:
        return 3
    if down > 1 and up > 1:
        return 4
    return 1 if down > 1 else 2


class Graph:
    """The graph of an .rg file, with what follows from its definition."""

    def __init__(self, path):
        self.nodes, self.arcs = [], []
        for line in open(path):
            words = line.split()
            if words[0] == "n":
                self.nodes.append((int(words[1]), int(words[2]), int(words[3]), float(words[4])))
            elif words[0] == "a":
                self.arcs.append((int(words[1]), int(words[2])))
        self.types = [critical_type(down, up) for _, down, up, _ in self.nodes]
        self.degrees = sorted(down + up for _, down, up, _ in self.nodes)
        component = {node[0]: node[0] for node in self.nodes}

        def find(v):
            while component[v] != v:
                v = component[v]
            return v

        for lo, hi in self.arcs:
            component[find(lo)] = find(hi)
        numbers = {}
        self.components = [numbers.setdefault(find(node[0]), len(numbers)) for node in self.nodes]
        self.isolated = [v for v, down, up, _ in self.nodes if down + up == 0]


def check_text(graph):
    extract("t.csv")
    nodes = list(csv.DictReader(open(folder + "/t.nodes.csv")))
    arcs = list(csv.DictReader(open(folder + "/t.arcs.csv")))
    expect("csv nodes", [(int(r["vertex"]), int(r["down"]), int(r["up"]), float(r["value"])) for r in nodes],
           graph.nodes)
    expect("csv types", [int(r["type"]) for r in nodes], graph.types)
    expect("csv components", [int(r["component"]) for r in nodes], graph.components)
    expect("csv arcs", [(int(r["lo"]), int(r["hi"])) for r in arcs], graph.arcs)
    both = run(reeb, "extract", "g.reeb", "--format", "csv").split("\n\n")
    expect("csv to standard output", [both[0] + "\n", both[1]],
           [open(f"{folder}/t.{part}.csv").read() for part in ("nodes", "arcs")])

    data = json.load(open(extract("t.json")))
    expect("json schema", data["schema"], "reeb.graph.v1")
    expect("json nodes", [(n["vertex"], n["down"], n["up"], n["value"]) for n in data["nodes"]], graph.nodes)
    expect("json types", [n["type"] for n in data["nodes"]], graph.types)
    expect("json arcs", [(a["arc"], a["lo"], a["hi"]) for a in data["arcs"]],
           [(i, *arc) for i, arc in enumerate(graph.arcs)])
    pairs = list(csv.DictReader(open(pairs_file("p.csv"))))
    largest = collections.defaultdict(float)
    for pair in pairs:
        for end in ("lo", "hi"):
            largest[int(pair[end])] = max(largest[int(pair[end])], float(pair["persistence"]))
    expect("persistences of nodes", [n["persistence"] for n in data["nodes"]], [largest[n[0]] for n in graph.nodes])
    loops = {float(pair["persistence"]) for pair in pairs if pair["type"] == "Ext1"}
    of_arcs = {a["loop"] for a in data["arcs"]} - {None}
    expect("loops of arcs", (of_arcs <= loops, bool(of_arcs)), (True, bool(loops)))
    return data


def pairs_file(name, *options):
    run(reeb, "pairs", "g.reeb", "-o", name, "--force", *options)
    return folder + "/" + name


def check_pairs():
    rows = list(csv.DictReader(open(pairs_file("p.csv"))))
    data = json.load(open(pairs_file("p.json")))
    keys = ("type", "lo", "hi", "lo_value", "hi_value", "persistence")
    expect("pairs as json", [tuple(str(p[k]) for k in keys[:3]) + tuple(p[k] for k in keys[3:]) for p in data["pairs"]],
           [tuple(r[k] for k in keys[:3]) + tuple(float(r[k]) for k in keys[3:]) for r in rows])
    lists = json.load(open(pairs_file("p.gudhi", "--format", "gudhi")))
    expect("lists of gudhi", len(lists), 4)
    for diagram, (kind, dimension, falls) in zip(lists, (("Ord0", 0, False), ("Rel1", 1, True), ("Ext0", 0, False),
                                                         ("Ext1", 1, True))):
        of_kind = [(float(r["lo_value"]), float(r["hi_value"])) for r in rows if r["type"] == kind]
        expect("gudhi " + kind, sorted((d, tuple(interval)) for d, interval in diagram),
               sorted((dimension, (hi, lo) if falls else (lo, hi)) for lo, hi in of_kind))


def check_swc(graph, data):
    """Every node is there, every arc is a way between its nodes, and cut loops are repeated samples."""
    samples, places = {}, {}
    for node in data["nodes"]:
        places.setdefault(tuple(node["position"]), node["vertex"])
    for line in open(extract("t.swc")):
        if line.startswith("#"):
            continue
        number, _, x, y, z, radius, parent = line.split()
        parent = int(parent)
        if parent != -1 and parent not in samples:
            sys.exit(f"swc: sample {number} comes before its parent")
        samples[int(number)] = (parent, (float(x), float(y), float(z)), float(radius))
    expect("swc ids", sorted(samples), list(range(1, len(samples) + 1)))
    expect("swc roots", sum(s[0] == -1 for s in samples.values()), len(set(graph.components)))
    ways, repeated = [], 0
    seen = set()
    for parent, place, _ in samples.values():
        vertex = places.get(place)
        if vertex is None:
            continue
        repeated += vertex in seen
        seen.add(vertex)
        if parent == -1:
            continue
        while samples[parent][1] not in places:
            parent = samples[parent][0]
        ways.append(tuple(sorted((vertex, places[samples[parent][1]]))))
    expect("swc nodes", seen, {n[0] for n in graph.nodes})
    expect("swc arcs", sorted(ways), sorted(tuple(sorted(arc)) for arc in graph.arcs))
    expect("swc cuts", repeated, len(graph.arcs) - len(graph.nodes) + len(set(graph.components)))


def check_vtk(graph, data):
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

    for name, reader in (("t.vtp", vtkXMLPolyDataReader()), ("t.vtu", vtkXMLUnstructuredGridReader())):
        reader.SetFileName(extract(name))
        reader.Update()
        mesh = reader.GetOutput()

        def array(of, wanted, name=name):
            found = of.GetArray(wanted)
            if found is None:
                sys.exit(f"{name}: no array {wanted}")
            return [found.GetValue(i) for i in range(found.GetNumberOfTuples())]

        points, cells = mesh.GetPointData(), mesh.GetCellData()
        inner = sum(len(arc["path"]) for arc in data["arcs"])
        count = len(graph.nodes)
        expect(name + " points", mesh.GetNumberOfPoints(), count + inner)
        expect(name + " cells", mesh.GetNumberOfCells(), len(graph.isolated) + len(graph.arcs))
        expect(name + " Value", array(points, "Value")[:count], [n[3] for n in graph.nodes])
        expect(name + " VertexId", array(points, "VertexId"), [n[0] for n in graph.nodes] + [-1] * inner)
        expect(name + " CriticalType", array(points, "CriticalType"), graph.types + [5] * inner)
        expect(name + " NodeId", array(points, "NodeId"), list(range(count)) + [-1] * inner)
        expect(name + " DownDegree", array(points, "DownDegree"), [n[1] for n in graph.nodes] + [1] * inner)
        expect(name + " UpDegree", array(points, "UpDegree"), [n[2] for n in graph.nodes] + [1] * inner)
        expect(name + " Component", array(points, "Component")[:count], graph.components)
        expect(name + " Persistence", array(points, "Persistence")[:count], [n["persistence"] for n in data["nodes"]])
        number = {n[0]: i for i, n in enumerate(graph.nodes)}
        alone = [number[v] for v in graph.isolated]
        expect(name + " SegmentationId", array(cells, "SegmentationId"),
               [-1] * len(alone) + list(range(len(graph.arcs))))
        expect(name + " upNodeId", array(cells, "upNodeId"), alone + [number[hi] for _, hi in graph.arcs])
        expect(name + " downNodeId", array(cells, "downNodeId"), alone + [number[lo] for lo, _ in graph.arcs])
        expect(name + " VertexCount", array(cells, "VertexCount"),
               [0] * len(alone) + [arc["vertices"] for arc in data["arcs"]])
        expect(name + " LoopPersistence", array(cells, "LoopPersistence"),
               [-1] * len(alone) + [-1 if arc["loop"] is None else arc["loop"] for arc in data["arcs"]])
        for i in range(mesh.GetNumberOfCells()):
            cell, arc = mesh.GetCell(i), i - len(alone)
            ends = (cell.GetPointId(0), cell.GetPointId(cell.GetNumberOfPoints() - 1))
            if arc < 0:
                expect(name + " vertex cell", (cell.GetCellType(), ends), (1, (alone[i], alone[i])))
            else:
                lo, hi = graph.arcs[arc]
                expect(name + " line", ends, (number[lo], number[hi]))
                expect(name + " line's type", cell.GetCellType() in (3, 4), True)  # line, polyline
                expect(name + " line's length", cell.GetNumberOfPoints(), 2 + len(data["arcs"][arc]["path"]))


def check_networkx(graph, data):
    import networkx

    found = networkx.read_graphml(extract("t.graphml"), force_multigraph=True)
    made = networkx.MultiGraph()
    made.add_nodes_from(n["vertex"] for n in data["nodes"])
    made.add_edges_from((a["lo"], a["hi"]) for a in data["arcs"])
    for name, each in (("graphml", found), ("json", made)):
        expect(name + " degrees", sorted(degree for _, degree in each.degree()), graph.degrees)
    # An arc is on no loop if it is a bridge; parallel arcs are none.
    bridges = set(map(frozenset, networkx.bridges(networkx.Graph(made))))
    times = collections.Counter(map(frozenset, graph.arcs))
    expect("arcs on no loop", [a["loop"] is None for a in data["arcs"]],
           [times[frozenset(arc)] == 1 and frozenset(arc) in bridges for arc in graph.arcs])
    expect("graphml types", [found.nodes[str(n[0])]["type"] for n in graph.nodes], graph.types)
    expect("graphml values", [found.nodes[str(n[0])]["value"] for n in graph.nodes], [n[3] for n in graph.nodes])
    expect("graphml arcs", sorted((e["arc"], int(lo), int(hi)) for lo, hi, e in found.edges(data=True)),
           [(i, *arc) for i, arc in enumerate(graph.arcs)])


def check_graphviz(graph, data):
    extract("t.dot", "--nodes", "40")
    coarse = Graph(extract("coarse.rg", "--nodes", "40"))
    height, lines = {}, 0
    for line in run("dot", "-Tplain", "t.dot").splitlines():
        words = line.split()
        if words[0] == "node":
            height[int(words[1])] = float(words[3])
        lines += words[0] == "edge"
    expect("dot nodes", sorted(height), sorted(n[0] for n in coarse.nodes))
    expect("dot lines", lines, len(coarse.arcs) + max(0, len(set(coarse.components)) - 1))
    heights = [height[n[0]] for n in coarse.nodes]
    expect("dot ranks", heights, sorted(heights))
    for lo, hi in coarse.arcs:
        expect("dot arc goes up", height[lo] < height[hi], True)


def check_assimp(graph, data):
    if not graph.nodes:
        expect("gltf of nothing", json.load(open(extract("t.gltf")))["scenes"], [{}])
        return
    expected = [node["position"] for node in data["nodes"]]
    gltf = extract("t.gltf")
    run("assimp", "info", gltf)
    run("assimp", "export", gltf, folder + "/t.obj", "-f", "obj")
    points = [tuple(map(float, line.split()[1:4])) for line in open(folder + "/t.obj") if line.startswith("v ")]
    size = max(abs(c) for point in expected for c in point)
    cell = size * 1e-4
    places = collections.defaultdict(list)
    for point in points:
        places[tuple(round(c / cell) for c in point)].append(point)
    for x, y, z in expected:
        near = [p for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)
                for p in places.get((round(x / cell) + i, round(y / cell) + j, round(z / cell) + k), [])]
        if not any(math.dist(p, (x, y, z)) < 2 * cell for p in near):
            sys.exit(f"gltf: no point at the node {x} {y} {z}")
    lines = sum(len(line.split()) - 2 for line in open(folder + "/t.obj") if line.startswith("l "))
    expect("gltf lines", lines, sum(len(arc["path"]) + 1 for arc in data["arcs"]))


def check(mesh, *options):
    run(reeb, mesh, "-o", "g.reeb", "--force", "--quiet", *options)
    graph = Graph(extract("t.rg"))
    data = check_text(graph)
    check_pairs()
    check_swc(graph, data)
    for program in programs:
        globals()["check_" + program](graph, data)


run(reeb, "generate", "scan", "--triangles", "4000", "--seed", "5", "-o", "scan.ply")
check("scan.ply")
check("scan.ply", "--buckets", "0")
with open(folder + "/parts.obj", "w") as out:  # a triangle, an edge, two points, far from the origin
    out.write("v 1000000 0 0\nv 1000001 0 1\nv 1000000 1 2\nv 1000005 5 0.1\nv 1000006 6 0.30000000000000004\n"
              "v 1000007 7 7\nv 1000008 8 -8\nf 1 2 3\nl 4 5\n")
check("parts.obj")
with open(folder + "/empty.obj", "w") as out:
    out.write("# nothing\n")
check("empty.obj")
print("ok")
