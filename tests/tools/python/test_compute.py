"""reeb.compute, of paths, arrays, objects and images."""

import math
import os
import pickle
import random
import subprocess
import types
import warnings

import numpy as np
import pytest
from meshes import torus, write_ply
from reference import reeb_graph

import reeb

PROGRAM = os.environ["REEB_PROGRAM"]


def shape_of(graph):
    vertex = graph.nodes["vertex"]
    nodes = list(zip(vertex.tolist(), graph.nodes["down"].tolist(), graph.nodes["up"].tolist()))
    return nodes, [(int(vertex[lo]), int(vertex[hi])) for lo, hi in graph.arcs]


def rg_of(graph):
    lines = []
    for vertex, value, _, _, _, down, up in graph.nodes.tolist():
        lines.append(f"n {vertex} {down} {up} {value:.17g}")
    vertex = graph.nodes["vertex"]
    lines += [f"a {vertex[lo]} {vertex[hi]}" for lo, hi in graph.arcs]
    return lines


def kilobytes(what):
    """VmRSS, the memory that this process has now, or VmHWM, the most since its mark was reset."""
    with open("/proc/self/status") as file:
        return next(int(line.split()[1]) for line in file if line.startswith(what + ":"))


def reset_the_mark():
    """Else earlier tests have raised it, and hide what comes."""
    with open("/proc/self/clear_refs", "w") as file:
        file.write("5")


def test_the_reference_knows_a_circle_and_a_filled_triangle():
    circle = reeb_graph([0, 1, 2], [(0, 1), (1, 2), (0, 2)])
    assert circle == ([(0, 0, 2), (2, 2, 0)], [(0, 2), (0, 2)])
    assert reeb_graph([0, 1, 2], [(0, 1, 2)]) == ([(0, 0, 1), (2, 1, 0)], [(0, 2)])
    assert reeb_graph([5.0], []) == ([(0, 0, 0)], [])


@pytest.mark.parametrize("width", [1, 2, 3, 4, 5])
def test_random_complexes_are_those_of_the_definition(width):
    random_ = random.Random(width)
    for _ in range(40):
        n = random_.randint(1, 10)
        values = [float(random_.randint(0, 4)) for _ in range(n)]
        rows = [[random_.randrange(n) for _ in range(width)] for _ in range(random_.randint(0, 12))]
        graph = reeb.compute(np.zeros((n, 3)), np.array(rows, int).reshape(-1, width), values)
        expected = reeb_graph(values, rows)
        assert shape_of(graph) == expected
        networkx_graph = graph.to_networkx()
        import networkx

        assert networkx.number_connected_components(networkx_graph) == graph.components
        assert graph.loop_count == len(expected[1]) - len(expected[0]) + graph.components
        types_ = graph.pairs["type"].tolist()
        assert (types_.count("Ext0"), types_.count("Ext1")) == (graph.components, graph.loop_count)


@pytest.mark.parametrize("width", [2, 4, 5, 7, 9])
def test_many_simplices_are_those_of_a_file(width, tmp_path):
    # A row has up to 28 triangles, more than are asked for at the end of a chunk.
    random_ = np.random.default_rng(width)
    vertices = random_.normal(size=(300, 3))
    rows = random_.permuted(np.tile(np.arange(300), (1500, 1)), axis=1)[:, :width]
    lines = ["v " + " ".join(f"{x:.17g}" for x in vertex) for vertex in vertices]
    lines += ["s " + " ".join(map(str, row)) for row in rows]
    (tmp_path / "m.cx").write_text("\n".join(lines) + "\n")
    expected = rg_of(reeb.compute(tmp_path / "m.cx", f="z"))
    for options in ({}, {"threads": 1}, {"chunk": 1}, {"chunk": 7}, {"chunk": 100}, {"memory": "256M"}):
        assert rg_of(reeb.compute(vertices, rows, f="z", **options)) == expected, options


@pytest.mark.parametrize("type_", ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", ">i4", "f8"])
def test_faces_of_all_types_and_layouts(type_):
    vertices, faces = torus(10, 8)
    expected = reeb.compute(vertices, faces, f="x")
    typed = faces.astype(type_)
    wide = np.zeros((2 * len(faces), 7), typed.dtype)
    wide[::2, 1:7:2] = typed
    for array in (typed, np.asfortranarray(typed), typed[::-1], wide[::2, 1:7:2], typed.tolist()):
        assert reeb.compute(vertices, array, f="x") == expected


@pytest.mark.parametrize("type_", ["f4", "f8", "f2", ">f8", "g", "i2", "u1", "?"])
def test_vertices_and_values_of_all_types_and_layouts(type_):
    vertices, faces = torus(10, 8)
    vertices = np.round(16 * vertices + 64).astype(type_)
    plain = vertices.astype(float)
    expected = reeb.compute(plain, faces, f="y")
    wide = np.zeros((2 * len(vertices), 6), vertices.dtype)
    wide[::2, ::2] = vertices
    for array in (vertices, np.asfortranarray(vertices), wide[::2, ::2], vertices.tolist()):
        assert reeb.compute(array, faces, f="y") == expected
        columns = np.asarray(array)
        assert reeb.compute(plain, faces, columns[:, 1]) == expected
    backwards = np.ascontiguousarray(vertices[::-1])
    assert reeb.compute(backwards[::-1], faces, f="y") == expected


def test_nothing_is_copied():
    n, width = 200_000, 8  # a long strip
    vertices = np.zeros((n * width, 3))
    vertices[:, 2] = np.arange(n * width)
    a = (np.arange(n - 1)[:, None] * width + np.arange(width - 1)).ravel()
    faces = np.concatenate([np.stack([a, a + 1, a + width], 1), np.stack([a + 1, a + width, a + width + 1], 1)])
    faces = faces.reshape(2, -1, 3).swapaxes(0, 1).reshape(-1, 3)
    before = kilobytes("VmRSS")
    reset_the_mark()
    assert len(reeb.compute(vertices, faces, memory="32M").nodes) == 2
    assert kilobytes("VmHWM") - before < 40 << 10  # the arrays take 100 MiB


def test_a_path_gives_what_the_program_gives(tmp_path):
    vertices, faces = torus()
    vertices += np.random.default_rng(1).normal(0, 0.02, vertices.shape)
    mesh = write_ply(tmp_path / "t.ply", vertices, faces)
    output = tmp_path / "t.reeb"
    graph = reeb.compute(mesh, f="x", output=output, memory="64M", denoise="1%")
    assert graph.path == str(output)
    command = [PROGRAM, "compute", mesh, "-f", "x", "--denoise", "1%", "-o", tmp_path / "p.reeb", "--quiet"]
    subprocess.run(command, check=True)
    assert (tmp_path / "p.reeb").read_bytes() == output.read_bytes()
    text = subprocess.run([PROGRAM, "extract", output], check=True, capture_output=True, text=True).stdout
    assert rg_of(graph) == [line for line in text.splitlines() if not line.startswith("#")]
    assert reeb.compute(vertices, faces, f="x", denoise="1%") == graph
    csv = subprocess.run([PROGRAM, "pairs", output], check=True, capture_output=True, text=True).stdout.splitlines()
    assert csv[0].split(",") == list(graph.pairs.dtype.names)
    assert [tuple(line.split(",")[:3]) for line in csv[1:]] == [
        (type_, str(lo), str(hi)) for type_, lo, hi in graph.pairs[["type", "lo", "hi"]].tolist()
    ]
    assert [float(line.split(",")[5]) for line in csv[1:]] == graph.pairs["persistence"].tolist()


def test_a_graph_stays_that_of_its_run(tmp_path):
    vertices, faces = torus()
    output = tmp_path / "t.reeb"
    first = reeb.compute(vertices, faces, f="z", output=output)
    second = reeb.compute(vertices, faces, f="x", output=output, force=True)
    assert first == reeb.compute(vertices, faces, f="z")
    assert second == reeb.compute(vertices, faces, f="x")
    assert first != second


def test_several_functions_and_outputs(tmp_path):
    vertices, faces = torus()
    x, y = reeb.compute(vertices, faces, f=["x", "y"])
    assert (x.function, y.function) == ("x", "y")
    assert x == reeb.compute(vertices, faces, f="x")
    graphs = reeb.compute(vertices, faces, f=["x", "y"], output=[tmp_path / "x.reeb", tmp_path / "y.reeb"])
    assert graphs == [x, y] == [reeb.open(tmp_path / "x.reeb"), reeb.open(tmp_path / "y.reeb")]


@pytest.mark.parametrize("f", ["c1", "index", "random:7", "distance:3", "distance:1,2,3", "geodesic:0", "spectral"])
def test_every_function_of_arrays_is_that_of_a_file(tmp_path, f):
    vertices, faces = torus()
    assert reeb.compute(vertices, faces, f=f) == reeb.compute(write_ply(tmp_path / "t.ply", vertices, faces), f=f)


def test_values_by_name_and_by_file(tmp_path):
    vertices, faces = torus()
    values = vertices @ [1.0, 2.0, 0.5]
    expected = reeb.compute(vertices, faces, values)
    assert expected.nodes["value"].tolist() == values[expected.nodes["vertex"]].tolist()
    assert reeb.compute(vertices, faces, f=values) == expected
    named = {"a": values, "b": vertices[:, 0]}
    for mapping in (named, types.MappingProxyType(named)):
        assert reeb.compute(vertices, faces, values=mapping, f="property:a") == expected
    assert reeb.compute(vertices, types.MappingProxyType({"triangle": faces}), values) == expected
    mesh = write_ply(tmp_path / "t.ply", vertices, faces, values)
    assert reeb.compute(mesh, f="property:w") == expected
    np.save(tmp_path / "values.npy", values)
    assert reeb.compute(mesh, f=f"file:{tmp_path / 'values.npy'}") == expected
    assert reeb.compute(vertices, faces, f=f"file:{tmp_path / 'values.npy'}") == expected


def test_meshes_of_other_packages(tmp_path):
    vertices, faces = torus()
    expected = reeb.compute(vertices, faces, f="x")
    for mesh in (
        types.SimpleNamespace(vertices=vertices, faces=faces),
        types.SimpleNamespace(vertices=vertices, triangles=faces),
        types.SimpleNamespace(points=vertices, regular_faces=faces),
        types.SimpleNamespace(points=vertices, cells_dict={"triangle": faces}),
        types.SimpleNamespace(points=vertices, cells_dict={5: faces}),
    ):
        assert reeb.compute(mesh, f="x") == expected
    meshio = pytest.importorskip("meshio")
    mesh = meshio.Mesh(vertices, [("triangle", faces)], point_data={"w": vertices[:, 0].copy()})
    assert reeb.compute(mesh, f="x") == expected
    assert reeb.compute(mesh, f="property:w") == expected


def test_cells_are_divided_as_in_files(tmp_path):
    meshio = pytest.importorskip("meshio")
    random_ = np.random.default_rng(3)
    i, j, k = np.meshgrid(range(3), range(3), range(3), indexing="ij")
    points = np.stack([i, j, k], -1).reshape(-1, 3).astype(float)
    number = random_.permutation(27).reshape(3, 3, 3)
    points[number.ravel()] = np.stack([i, j, k], -1).reshape(-1, 3)
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = np.array(
        [[number[a + x, b + y, c + z] for x, y, z in corners] for a in (0, 1) for b in (0, 1) for c in (0, 1)]
    )
    values = random_.permutation(27).astype(float)
    for kind, rows in (
        ("hexahedron", cells),
        ("wedge", cells[:, [0, 1, 2, 4, 5, 6]]),
        ("pyramid", cells[:, [0, 1, 2, 3, 6]]),
        ("quad", cells[:, [1, 2, 6, 5]]),
    ):
        mesh = meshio.Mesh(points, [(kind, rows)], point_data={"w": values})
        mesh.write(tmp_path / f"{kind}.vtu")
        assert reeb.compute(mesh, values=values) == reeb.compute(tmp_path / f"{kind}.vtu", f="property:w"), kind


@pytest.mark.parametrize("shape", [(7, 9), (5, 6, 7), (1, 5), (4, 1, 6)])
def test_images(tmp_path, shape):
    image = np.random.default_rng(5).integers(0, 50, shape).astype("i2")
    np.save(tmp_path / "i.npy", image)
    expected = reeb.compute(tmp_path / "i.npy")
    for array in (image, np.asfortranarray(image), image.astype("f4"), np.flip(np.flip(image).copy()), image.tolist()):
        assert reeb.compute(array) == expected
    assert expected.nodes["value"].tolist() == image.ravel()[expected.nodes["vertex"]].tolist()
    spaced = reeb.compute(image, spacing=(2, 3, 4)[: len(shape)], origin=(1, 1, 1)[: len(shape)])
    assert reeb.compute(image, spacing="2,3,4"[: 2 * len(shape) - 1], origin=(1, 1, 1)[: len(shape)]) == spaced
    vertex = expected.nodes["vertex"]
    place = np.stack(np.unravel_index(vertex, shape)[::-1], 1)
    scaled = 1 + place * np.array((2, 3, 4))[: len(shape)]
    for axis in range(len(shape)):
        assert spaced.nodes["xyz"[axis]].tolist() == scaled[:, axis].tolist()


def test_images_without_data():
    image = np.random.default_rng(5).random((6, 7))
    image[2, 3] = np.nan
    with pytest.raises(reeb.Error) as caught:
        reeb.compute(image)
    assert caught.value.position == "image[2, 3]"
    graph = reeb.compute(image, nodata="skip")
    assert 2 * 7 + 3 not in graph.nodes["vertex"] and graph.components == 1
    labels, values = reeb.segment(graph, image, nodata="skip")
    assert np.flatnonzero(labels == reeb.Segmentation.DROPPED).tolist() == [2 * 7 + 3] and np.isnan(values[2 * 7 + 3])
    image[2, 3] = -9
    assert reeb.compute(image, nodata=-9) == graph


def test_nothing_is_left_on_disk(tmp_path):
    vertices, faces = torus()
    reeb.compute(vertices, faces, temp_dir=tmp_path)
    with pytest.raises(reeb.Error):
        reeb.compute(vertices, faces + 1, temp_dir=tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_written_to_the_current_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    vertices, faces = torus(300, 200)
    seen = []

    def look(*_):
        seen.append(sorted(path.name for path in tmp_path.iterdir()))

    graph = reeb.compute(vertices, faces, progress=look)
    reeb.segment(graph, vertices, faces, progress=look)
    reeb.defects(vertices, faces, progress=look)
    assert seen and not any(seen)


def test_empty_lists_are_a_mesh_of_nothing():
    assert len(reeb.compute([], []).nodes) == 0


def test_no_leak_and_no_open_files():
    vertices, faces = torus(6, 4)
    image = np.random.default_rng(2).random((4, 5))

    def calls(count):
        for _ in range(count):
            graph = reeb.compute(vertices, faces, f="x")
            graph.level(0.5).nodes, graph.pairs
            reeb.compute(image)
            with pytest.raises(reeb.Error):
                reeb.compute(vertices, faces + 1)

    calls(60)
    before, files = kilobytes("VmRSS"), len(os.listdir("/proc/self/fd"))
    calls(300)
    assert kilobytes("VmRSS") - before < 4 << 10
    assert len(os.listdir("/proc/self/fd")) == files


def test_pickles_and_equality():
    vertices, faces = torus()
    graph = reeb.compute(vertices, faces, f="x")
    again = pickle.loads(pickle.dumps(graph))
    assert again == graph and again.function == "x"
    assert again.level(nodes=2) == graph.level(nodes=2) != graph
    assert pickle.loads(pickle.dumps(graph.level(nodes=2))) == graph.level(nodes=2)
    assert graph != reeb.compute(vertices, faces, f="y") and graph != 3


def test_a_colour_image_gives_a_note():
    image = np.random.default_rng(4).random((9, 10, 3))
    assert any("colour image" in note for note in reeb.compute(image).result["notes"])
    assert reeb.compute(image[..., 0]).result["notes"] == []


# Of three values, two are one double.
def test_rounded_integers_give_a_note():
    values = np.array([2**53 + 1, 2**53, 2**53 + 1])
    note = ["2 values beyond 2^53 were rounded to the nearest double"]
    one = ["1 value beyond 2^53 was rounded to the nearest double"]
    for type_ in (np.int64, np.uint64):
        on_arcs = reeb.compute([[0, 0], [1, 0], [2, 0]], [[0, 1], [1, 2]], values.astype(type_))
        assert on_arcs.result["notes"] == note
        for nodata in (None, "skip"):
            assert reeb.compute(values.astype(type_).reshape(3, 1), f="value", nodata=nodata).result["notes"] == note
    vertices = np.array([[0, 0, 2**60 + 1], [1, 0, 0], [2, 0, 1]])
    assert reeb.compute(vertices, [[0, 1, 2]], f="x").result["notes"] == one
    assert reeb.compute(values.reshape(3, 1) // 2, f="value").result["notes"] == []


def test_a_threshold_above_the_range_is_noted():
    vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 2]]
    assert reeb.compute(vertices, [[0, 1, 2]], denoise=2).result["notes"] == []
    (note,) = reeb.compute(vertices, [[0, 1, 2]], denoise=5).result["notes"]
    assert note == "the threshold 5.0 is more than the range 2 of z; did you mean 5.0%?"
    graph = reeb.compute(vertices, [[0, 1, 2]])
    with pytest.warns(UserWarning, match="the threshold 200% is more than the range of z"):
        graph.level("200%")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for threshold in (2, "100%", math.inf):
            graph.level(threshold)
