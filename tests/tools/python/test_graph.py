"""What a graph has: levels, skeletons, other forms; streams, segmentation, defects."""

import copy
import os
import pickle
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from meshes import torus, write_ply
from reference import reeb_graph

import reeb

PROGRAM = os.environ["REEB_PROGRAM"]


def run(*words):
    return subprocess.run([PROGRAM, *map(str, words)], check=True, capture_output=True, text=True).stdout


@pytest.fixture(scope="module")
def noisy(tmp_path_factory):
    folder = tmp_path_factory.mktemp("noisy")
    vertices, faces = torus(40, 30)
    vertices += np.random.default_rng(4).normal(0, 0.05, vertices.shape)
    mesh = write_ply(folder / "n.ply", vertices, faces)
    graph = reeb.compute(mesh, f="x", output=folder / "n.reeb")
    return mesh, vertices, faces, graph


def rg(text):
    return [line.split() for line in text.splitlines() if not line.startswith("#")]


def test_levels_are_those_of_the_program(noisy):
    _, _, _, graph = noisy
    for option, key in (("--threshold", "threshold"), ("--nodes", "nodes"), ("--memory", "memory")):
        for value in {"threshold": ["1%", "10%", 0.05, 99], "nodes": [2, 10, 50], "memory": ["8K", 20000]}[key]:
            level = graph.level(**{key: value})
            rows = rg(run("extract", graph.path, option, value, "--format", "rg"))
            vertex = level.nodes["vertex"]
            assert [int(row[1]) for row in rows if row[0] == "n"] == vertex.tolist()
            arcs = [(str(vertex[lo]), str(vertex[hi])) for lo, hi in level.arcs]
            assert [tuple(row[1:]) for row in rows if row[0] == "a"] == arcs
            kinds = level.pairs["type"].tolist()
            assert (kinds.count("Ext0"), kinds.count("Ext1")) == (level.components, level.loop_count)
    assert graph.level("10%").threshold < 0.1 * (graph.range[1] - graph.range[0])
    assert graph.levels["nodes"].max() == len(graph.nodes)


class Mirror:
    """A listener that keeps the graph it is told of."""

    def __init__(self):
        self.nodes, self.arcs = {}, {}

    def node_added(self, node, vertex, value, position):
        self.nodes[node] = vertex

    def node_removed(self, node):
        assert not any(node in arc for arc in self.arcs.values())
        del self.nodes[node]

    def arc_added(self, arc, lo, hi):
        assert lo in self.nodes and hi in self.nodes
        self.arcs[arc] = (lo, hi)

    def arc_removed(self, arc):
        del self.arcs[arc]

    def check(self, view):
        assert sorted(self.nodes.values()) == sorted(view.nodes["vertex"].tolist())
        named = sorted((self.nodes[lo], self.nodes[hi]) for lo, hi in self.arcs.values())
        vertex = view.nodes["vertex"]
        assert named == sorted((vertex[lo], vertex[hi]) for lo, hi in view.arcs)


def test_refine_and_coarsen_tell_a_listener(noisy):
    _, _, _, graph = noisy
    mirror = Mirror()
    view = reeb.open(graph.path, nodes=10, listener=mirror)

    def check():
        mirror.check(view)

    check()
    assert len(view.nodes) <= 10
    coarse = len(view.nodes)
    view.refine(nodes=60)
    check()
    assert coarse < len(view.nodes) <= 60
    view.coarsen(nodes=100)  # is finer: changes nothing
    assert coarse < len(view.nodes) <= 60
    view.coarsen("99%")
    check()
    for _ in range(len(view.levels) + 1):
        view.refine()
    check()
    assert view == graph
    for _ in range(len(view.levels) + 1):
        view.coarsen()
    check()
    assert len(view.nodes) == graph.levels["nodes"].min()


def test_a_listener_that_raises_misses_nothing(noisy):
    _, _, _, graph = noisy

    class Raises(Mirror):
        left = 0

        def node_added(self, *node):
            super().node_added(*node)
            Raises.left -= 1
            if Raises.left == 0:
                raise ValueError("stop")

    mirror = Raises()
    view = reeb.open(graph.path, nodes=10, listener=mirror)
    before = len(view.nodes)
    Raises.left = 3
    with pytest.raises(ValueError, match="stop"):
        view.refine(nodes=60)
    assert len(view.nodes) == before < len(mirror.nodes)
    view.refine(nodes=60)  # tells the rest of what has failed
    mirror.check(view)
    view.coarsen("99%")
    Raises.left = 3
    with pytest.raises(ValueError, match="stop"):
        view.refine(nodes=60)
    view.coarsen("99%")  # tells the rest first, and then the way back
    mirror.check(view)


def test_skeletons(noisy):
    _, vertices, faces, graph = noisy
    level = graph.level("20%")
    points, edges, radius, arc = level.skeleton()
    assert len(points) == len(radius) and len(edges) == len(arc) and edges.max() < len(points)
    assert np.array_equal(points[: len(level.nodes), 0], level.nodes["x"])
    assert np.array_equal(np.unique(arc), np.arange(len(level.arcs)))
    for i, (lo, hi) in enumerate(level.arcs):
        line = edges[arc == i]
        assert (line[0, 0], line[-1, 1]) == (lo, hi)
        assert (line[1:, 0] == line[:-1, 1]).all()
    # Lines run inside the tube of the torus, or where it is cut across.
    assert not np.isnan(radius).any() and 0.3 < np.median(radius) < 2
    lines = run("extract", graph.path, "--threshold", "20%", "--format", "obj").splitlines()
    exported = np.array([line.split()[1:4] for line in lines if line.startswith("v ")], float)
    assert np.allclose(exported, points)


# A closed tube around the x axis; f is x.
def test_radii_are_those_of_a_cylinder(tmp_path):
    around, along, true_radius = 64, 400, 0.75
    i, j = np.meshgrid(np.arange(along + 1), np.arange(around), indexing="ij")
    angle = 2 * np.pi * j / around
    tube = np.stack([i * 10 / along, true_radius * np.cos(angle), true_radius * np.sin(angle)], axis=-1).reshape(-1, 3)
    vertices = np.concatenate([tube, [[-0.1, 0, 0], [10.1, 0, 0]]])
    a = (np.arange(along)[:, None] * around + np.arange(around)).ravel()
    b = (np.arange(along)[:, None] * around + (np.arange(around) + 1) % around).ravel()
    rim, next_rim = np.arange(around), (np.arange(around) + 1) % around
    top = along * around
    faces = np.concatenate(
        [
            np.stack([a, b, a + around], axis=1),
            np.stack([b, b + around, a + around], axis=1),
            np.stack([next_rim, rim, np.full(around, len(tube))], axis=1),
            np.stack([top + rim, top + next_rim, np.full(around, len(tube) + 1)], axis=1),
        ]
    )
    graph = reeb.compute(vertices, faces, f="x", output=tmp_path / "tube.reeb")
    for skeleton in (graph.skeleton(), reeb.open(tmp_path / "tube.reeb").skeleton()):
        inside = (skeleton.points[:, 0] > 1) & (skeleton.points[:, 0] < 9)
        # A file keeps 7 bits after the point of the squared radius.
        assert inside.sum() > 50 and np.allclose(skeleton.radius[inside], true_radius, rtol=2**-8)
        assert len(skeleton.radius) == len(skeleton.points) and not np.isnan(skeleton.radius).any()
    without = reeb.compute(vertices, faces, f="x", buckets=0).skeleton()
    assert len(without.points) == len(without.radius) and np.isnan(without.radius).all()


def test_networkx_and_diagrams(noisy):
    _, _, _, graph = noisy
    network = graph.to_networkx()
    assert network.number_of_nodes() == len(graph.nodes) and network.number_of_edges() == len(graph.arcs)
    assert [network.nodes[i]["vertex"] for i in network] == graph.nodes["vertex"].tolist()
    lists = graph.to_gudhi()
    import json

    assert [[[d, list(p)] for d, p in part] for part in lists] == json.loads(
        run("pairs", graph.path, "--format", "gudhi")
    )
    zero, one = graph.to_persim()
    assert len(zero) + len(one) == len(graph.pairs) and (zero[:, 0] <= zero[:, 1]).all()


def test_polydata(noisy):
    pytest.importorskip("vtkmodules")
    _, _, _, graph = noisy
    data = graph.to_polydata()
    points, edges, _, _ = graph.skeleton()
    assert data.GetNumberOfPoints() == len(points) and data.GetNumberOfCells() == len(edges)
    values = data.GetPointData().GetArray("Value")
    assert values.GetRange()[0] == graph.nodes["value"][0]


def test_pictures(noisy, tmp_path):
    mesh, _, _, graph = noisy
    for kind in ("graph", "diagram", "loops", "skeleton"):
        picture = graph.level("10%").plot(tmp_path / f"{kind}.svg", kind=kind)
        assert "level at threshold 10%" in picture.svg
        assert repr(picture) == '<reeb picture; .save("picture.svg") writes it>'
        assert picture.svg.startswith("<") and (tmp_path / f"{kind}.svg").read_text() == picture.svg
    assert graph.plot(kind="skeleton", mesh=mesh, view=(1, 1, 1)).svg != picture.svg
    with pytest.raises(FileExistsError):
        graph.plot(tmp_path / "graph.svg")
    with pytest.raises(reeb.Error, match="no picture of kind"):
        graph.plot(kind="pie")


def test_names_of_functions_are_whole(tmp_path):
    vertices, faces = torus()
    values = tmp_path / ("a" * 90 + ".npy")
    np.save(values, vertices[:, 0])
    mesh = write_ply(tmp_path / "t.ply", vertices, faces)
    reeb.compute(mesh, f=f"file:{values}", output=tmp_path / "t.reeb")
    assert reeb.defects(mesh, graphs=tmp_path / "t.reeb").loops["function"].tolist() == [f"file:{values}"]


def test_save(noisy, tmp_path):
    _, vertices, faces, graph = noisy
    again = reeb.compute(vertices, faces, f="x")
    again.save(tmp_path / "s.reeb")
    assert (tmp_path / "s.reeb").read_bytes()[:4] == open(graph.path, "rb").read(4)
    assert reeb.open(tmp_path / "s.reeb") == graph
    with pytest.raises(FileExistsError) as caught:
        again.save(tmp_path / "s.reeb")
    assert isinstance(caught.value, reeb.Error) and caught.value.path == str(tmp_path / "s.reeb")
    again.save(tmp_path / "s.reeb", force=True)
    assert [path.name for path in tmp_path.iterdir()] == ["s.reeb"]


def test_graph_only(noisy, tmp_path):
    _, vertices, faces, graph = noisy
    only = reeb.compute(vertices, faces, f="x", graph_only=True)
    assert only == graph
    for action in (lambda: only.pairs, lambda: only.level("1%"), lambda: only.loops()):
        with pytest.raises(reeb.Error):
            action()


def test_segments_are_those_of_the_program(noisy, tmp_path):
    mesh, vertices, faces, graph = noisy
    for threshold in (0, "5%"):
        run("segment", mesh, graph.path, "--threshold", threshold, "-o", tmp_path / "s.i64", "--force")
        expected = np.fromfile(tmp_path / "s.i64", "<i8")
        level = graph.level(threshold)
        by_path, by_arrays = reeb.segment(level, mesh), reeb.segment(level, vertices, faces)
        assert np.array_equal(by_path.labels, expected) and np.array_equal(by_arrays.labels, expected)
        assert np.array_equal(by_arrays.values, vertices[:, 0])
        nodes = np.flatnonzero(expected < 0)
        assert level.nodes["vertex"][-1 - expected[nodes]].tolist() == nodes.tolist()
    values = vertices[:, 1].copy()
    own = reeb.compute(vertices, faces, values)
    assert np.array_equal(reeb.segment(own, vertices, faces, values).values, values)
    named = {"a": vertices[:, 0], "b": values}
    own = reeb.compute(vertices, faces, named, f="property:b")
    for given in (named, {"b": values}):
        assert np.array_equal(reeb.segment(own, vertices, faces, given).values, values)
    image = np.random.default_rng(8).random((6, 7))
    assert len(reeb.segment(reeb.compute(image), image).labels) == 42
    with pytest.raises(reeb.Error):
        reeb.segment(graph, vertices, faces[:-1])


def test_defects_are_those_of_the_program(noisy, tmp_path):
    mesh, vertices, faces, _ = noisy
    run("defects", mesh, "-o", tmp_path / "d.csv")
    lines = (tmp_path / "d.csv").read_text().splitlines()
    for found in (reeb.defects(mesh), reeb.defects(vertices, faces)):
        assert len(found.loops) == len(lines) - 1
        for row, line in zip(found.loops, lines[1:]):
            cells = line.split(",")
            assert [str(row["rank"]), str(row["lo"]), str(row["hi"]), row["kind"]] == [*cells[:3], cells[14]]
            assert float(cells[15]) == row["length_contour"] and float(cells[5]) == row["center"][0]
        assert found.others["components"]["count"] == 1 and "length" in found.suggested_threshold


def test_defects_are_shown_in_a_line():
    found = {"length": 0.0258, "confidence": 1.0, "why": ""}
    assert repr(reeb.Defects(np.zeros(55), found, {})) == "<reeb.Defects: 55 loops, suggested 0.0258 (100 %)>"
    found["length"] = None
    assert repr(reeb.Defects(np.zeros(1), found, {})) == "<reeb.Defects: 1 loop>"
    assert repr(reeb.Defects(np.zeros(0), found, {})) == "<reeb.Defects: no loops>"


def test_online_is_exact_at_any_moment():
    networkx = pytest.importorskip("networkx")
    random_ = np.random.default_rng(6)
    for _ in range(30):
        n = int(random_.integers(1, 9))
        values = random_.integers(0, 5, n).astype(float)
        triangles = random_.integers(0, n, (10, 3))
        online = reeb.Online()
        assert online.add_vertices(values, np.zeros((n, 3))).tolist() == list(range(n))
        for k in range(0, 10, 5):
            online.add_simplices(triangles[k : k + 5])
            graph = online.snapshot()
            vertex = graph.nodes["vertex"]
            nodes = list(zip(vertex.tolist(), graph.nodes["down"].tolist(), graph.nodes["up"].tolist()))
            arcs = [(int(vertex[lo]), int(vertex[hi])) for lo, hi in graph.arcs]
            assert (nodes, arcs) == reeb_graph(values.tolist(), triangles[: k + 5].tolist())
            assert graph.components == networkx.number_connected_components(graph.to_networkx())
        online.finalize([0])
        with pytest.raises(reeb.Error) as caught:
            online.add_simplices([[0, 0]])
        assert caught.value.position == "simplices[0]"
        assert online.snapshot() == graph and online.memory_bytes > 0
        with pytest.raises(reeb.Error):
            graph.pairs
    assert online.add_vertices([1]).tolist() == [n]


def test_a_snapshot_while_another_thread_adds():
    count = 20_000
    online = reeb.Online()
    online.add_vertices(np.arange(count, dtype=float))
    corners = np.arange(count - 4)[:, None] + [0, 1, 3]
    done = threading.Event()

    def add():
        for _ in range(40):
            online.add_simplices(corners)
            time.sleep(0.002)
        done.set()

    thread = threading.Thread(target=add)
    thread.start()
    while not done.is_set():
        online.snapshot()
    thread.join()
    assert online.snapshot().components == 2  # the last vertex has no triangle


def test_a_picture_of_itself():
    vertices, faces = torus()
    graph = reeb.compute(vertices, faces, f="x")
    assert repr(graph) == "<reeb.Graph of x: 4 nodes, 4 arcs>" and "4 nodes" in graph._repr_html_()
    edge = reeb.compute([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [[0, 1]], f="x")
    assert repr(edge) == "<reeb.Graph of x: 2 nodes, 1 arc>"
    with pytest.raises(ValueError):
        graph.nodes["value"][0] = 1
    with pytest.raises(TypeError):
        reeb.Graph()


def test_the_reader_for_paraview(noisy):
    pytest.importorskip("vtkmodules")
    import importlib.util
    from pathlib import Path

    _, _, _, graph = noisy
    source = Path(__file__).parents[3] / "packaging/paraview/reeb_reader.py"
    spec = importlib.util.spec_from_file_location("reeb_reader", source)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    reader = module.ReebReader()
    reader.SetFileName(graph.path)
    for percent in (0, 10, 50):
        reader.SetThreshold(percent)
        reader.Update()
        points, edges, _, _ = graph.level(f"{percent}%").skeleton()
        output = reader.GetOutputDataObject(0)
        assert output.GetNumberOfPoints() == len(points) and output.GetNumberOfCells() == len(edges)


def test_the_tutorial_prints_what_it_says(tmp_path):
    from pathlib import Path

    docs = Path(__file__).parents[3] / "docs"
    command = [sys.executable, docs / "render_tutorial.py", tmp_path / "TUTORIAL.md"]
    subprocess.run(command, check=True)
    assert (tmp_path / "TUTORIAL.md").read_text() == (docs / "TUTORIAL.md").read_text()
    # Pictures depend on the version of Graphviz.
    assert {path.name for path in tmp_path.glob("*.svg")} == {path.name for path in docs.glob("tutorial-*.svg")}


def test_a_graph_stays_what_it_is_when_its_file_is_replaced(tmp_path):
    vertices, faces = np.array([[0, 0, 0], [1, 0, 1], [0, 1, 2], [1, 1, 3.0]]), [[0, 1, 2], [1, 2, 3]]
    path = tmp_path / "graph.reeb"
    graph = reeb.compute(vertices, faces, output=path)
    other = reeb.compute(vertices, faces, [3, 0, 2, -1], output=path, force=True)
    assert graph != other
    for same in (pickle.loads(pickle.dumps(graph)), copy.copy(graph), copy.deepcopy(graph)):
        assert same == graph
    graph.save(tmp_path / "saved.reeb")
    assert reeb.open(tmp_path / "saved.reeb") == graph
    path.unlink()
    assert pickle.loads(pickle.dumps(other)) == other


def test_a_picture_is_of_the_level_and_not_of_one_with_as_many_nodes():
    # Two loops between the same nodes: their levels differ by arcs only.
    points = np.zeros((5, 3))
    points[:, 2] = [0, 10, 4, 5, 6]
    graph = reeb.compute(points, [[0, 2], [2, 1], [0, 3], [3, 1], [0, 4], [4, 1]])
    level = graph.level(memory=int(graph.levels["memory"].min()))
    assert (len(graph.nodes), len(level.nodes)) == (2, 2)
    assert "full graph, 2 nodes, 3 arcs, 1 component, 2 loops" in graph.plot().svg
    assert "level without the 2 smallest pairs, 2 nodes, 1 arc, 1 component, 0 loops" in level.plot().svg


def test_values_are_refused_where_the_graph_is_of_something_else():
    vertices, faces = np.array([[0, 0, 0], [1, 0, 1], [0, 1, 2.0]]), [[0, 1, 2]]
    with pytest.raises(reeb.Error, match="the graph is of z, not of values"):
        reeb.segment(reeb.compute(vertices, faces), vertices, faces, [9, 9, 9])
    graph = reeb.compute(vertices, faces, [2, 0, 1])
    assert list(reeb.segment(graph, vertices, faces, [2, 0, 1]).labels) == [-2, -1, 0]


def test_names_that_are_not_utf8(tmp_path):
    mesh = tmp_path / "mesh.ply"
    head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    text = head + "property float h\udcf6he\n" + faces + "0 0 0 1\n1 0 0 2\n0 1 0 3\n3 0 1 2\n"
    mesh.write_bytes(os.fsencode(text))
    graph = reeb.compute(mesh, f="property:h\udcf6he", output=tmp_path / "graph.reeb")
    assert graph.function == reeb.open(tmp_path / "graph.reeb").function == "property:h\udcf6he"
    assert "property:h\\xf6he" in repr(graph)
    assert list(reeb.segment(graph, mesh).labels) == [-1, 0, -2]

    vertices, faces = np.array([[0, 0, 0], [1, 0, 1], [0, 1, 2.0]]), [[0, 1, 2]]
    values = {"\udcff": [1, 2, 3]}
    graph = reeb.compute(vertices, faces, values, "property:\udcff")
    assert list(reeb.segment(graph, vertices, faces, values).labels) == [-1, 0, -2]

    folder = tmp_path / "temporary\udcff"
    folder.mkdir()
    graph = reeb.compute(vertices, faces, temp_dir=folder)
    assert list(reeb.segment(graph, vertices, faces, temp_dir=folder).labels) == [-1, 0, -2]
    assert len(reeb.defects(vertices, faces, temp_dir=folder).loops) == 0
    assert not any(folder.iterdir())


def test_names_do_not_depend_on_the_locale():
    words = """
import reeb
vertices, faces = [[0, 0, 0], [1, 0, 1], [0, 1, 2]], [[0, 1, 2]]
graph = reeb.compute(vertices, faces, {"h\\xf6he": [1, 2, 3]}, "property:h\\xf6he")
assert graph.function == "property:h\\xf6he", ascii(graph.function)
"""
    locale = {**os.environ, "LC_ALL": "POSIX", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    subprocess.run([sys.executable, "-c", words], check=True, env=locale)
