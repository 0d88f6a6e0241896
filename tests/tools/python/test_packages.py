"""Other packages: present, absent, and what they hold."""

import ast
import sys
import types
from pathlib import Path

import numpy as np
import pytest
from meshes import torus
from reference import reeb_graph

import reeb


@pytest.fixture(scope="module")
def graph():
    vertices, faces = torus()
    return reeb.compute(vertices, faces, f="x")


@pytest.mark.parametrize(
    "method, hidden, of_debian",
    [("to_networkx", ["networkx"], "python3-networkx"), ("to_polydata", ["pyvista", "vtkmodules"], "python3-vtk9")],
)
def test_a_missing_package_is_named(graph, monkeypatch, method, hidden, of_debian):
    for name in list(sys.modules):
        if name.split(".")[0] in hidden:
            monkeypatch.delitem(sys.modules, name)
    for name in hidden:
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(ImportError, match="is not installed") as caught:
        getattr(graph, method)()
    assert isinstance(caught.value, reeb.Error) and of_debian in caught.value.hint


def test_missing_programs_are_named(graph, monkeypatch, tmp_path):
    picture = graph.plot()
    monkeypatch.setenv("PATH", str(tmp_path))
    for kind, program in (("graph", "graphviz"), ("diagram", "gnuplot"), ("loops", "gnuplot")):
        with pytest.raises(reeb.Error) as caught:
            graph.plot(kind=kind)
        assert program in str(caught.value).lower()
    with pytest.raises(reeb.Error, match="rsvg"):
        picture.save(tmp_path / "g.png")
    assert list(tmp_path.iterdir()) == []


def test_stubs_have_the_fields_of_tuples():
    stub = ast.parse((Path(reeb.__file__).parent / "__init__.pyi").read_text())
    classes = [node for node in stub.body if isinstance(node, ast.ClassDef)]
    tuples = [node for node in classes if any(getattr(base, "id", "") == "NamedTuple" for base in node.bases)]
    assert len(tuples) == 3
    for node in tuples:
        fields = tuple(item.target.id for item in node.body if isinstance(item, ast.AnnAssign))
        assert fields == getattr(reeb, node.name.lstrip("_"))._fields


def test_nothing_else_is_needed(graph):
    assert [len(part) for part in graph.to_gudhi()] == [0, 0, 1, 1]
    assert [part.shape for part in graph.to_persim()] == [(1, 2), (1, 2)]


def test_polydata_of_pyvista(graph, monkeypatch):
    class PolyData:
        def __init__(self, points, lines):
            self.points, self.lines, self.point_data, self.cell_data = points, lines, {}, {}

    monkeypatch.setitem(sys.modules, "pyvista", types.SimpleNamespace(PolyData=PolyData))
    data = graph.to_polydata()
    points, edges, _, arc = graph.skeleton()
    assert np.array_equal(data.points, points) and np.array_equal(data.lines.reshape(-1, 3)[:, 1:], edges)
    assert set(data.lines[::3]) == {2} and np.array_equal(data.cell_data["SegmentationId"], arc)
    assert len(data.point_data["Value"]) == len(data.point_data["VertexId"]) == len(points)


def test_networks():
    networkx = pytest.importorskip("networkx")
    for seed in range(20):
        network = networkx.gnp_random_graph(9, 0.3, seed=seed)
        values = np.random.default_rng(seed).integers(0, 5, 9).astype(float)
        networkx.set_node_attributes(network, dict(enumerate(values.tolist())), "height")
        named = networkx.relabel_nodes(network, "node {}".format)
        expected = reeb_graph(values.tolist(), list(network.edges()))
        for graph in (
            reeb.compute(network, f="property:height"),
            reeb.compute(network, values=values),
            reeb.compute(named, f="property:height"),
        ):
            vertex = graph.nodes["vertex"]
            nodes = list(zip(vertex.tolist(), graph.nodes["down"].tolist(), graph.nodes["up"].tolist()))
            assert (nodes, [(int(vertex[lo]), int(vertex[hi])) for lo, hi in graph.arcs]) == expected
        assert graph.loop_count == len(networkx.cycle_basis(network))
    networkx.set_node_attributes(network, {3: np.nan}, "height")
    with pytest.raises(reeb.Error, match="not finite") as caught:
        reeb.compute(network, f="property:height")
    assert (caught.value.path, caught.value.position) == (None, "height[3]")


def test_places_of_networks(graph):
    networkx = pytest.importorskip("networkx")
    network = networkx.path_graph(3)
    with pytest.raises(reeb.Error, match="functions? of positions") as caught:
        reeb.compute(network, f="x")
    assert "pos" in caught.value.hint
    networkx.set_node_attributes(network, {0: (1, 5), 1: (2, 6), 2: (3, 7)}, "pos")
    assert reeb.compute(network, f="x").nodes["y"].tolist() == [5, 7]
    level = graph.level(nodes=2)
    again = reeb.compute(level.to_networkx(), f="property:value")
    assert [again.nodes[name].tolist() for name in "xyz"] == [level.nodes[name].tolist() for name in "xyz"]
    with pytest.raises(reeb.Error, match="parallel"):
        reeb.compute(graph.to_networkx(), f="property:value")  # a loop of two arcs


def test_attributes_of_networks_are_exact_or_not_there():
    networkx = pytest.importorskip("networkx")
    network = networkx.cycle_graph(6)
    networkx.set_node_attributes(network, {i: 2**53 + i for i in network}, "large")
    networkx.set_node_attributes(network, {i: 10**400 for i in network}, "huge")
    networkx.set_node_attributes(network, {i: np.complex128(1j) for i in network}, "complex")
    notes = reeb.compute(network, f="property:large").result["notes"]
    assert notes == ["3 values beyond 2^53 were rounded to the nearest double"]
    assert len(reeb.compute(network, f="index").nodes) == 2
    for name in ("huge", "complex"):
        with pytest.raises(reeb.Error, match=f'there are no values of the name "{name}"'):
            reeb.compute(network, f="property:" + name)
