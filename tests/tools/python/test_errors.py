"""Bad input, interruptions, progress."""

import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import warnings

import numpy as np
import pytest
from meshes import torus, write_ply

import reeb


def error_of(*arguments, **options):
    with pytest.raises(reeb.Error) as caught:
        reeb.compute(*arguments, **options)
    error = caught.value
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), vars(again)) == (type(error), str(error), vars(error))
    return error


VERTICES, FACES = torus(8, 6)
IMAGE = np.random.default_rng(1).random((4, 5))
NAN = VERTICES.copy()
NAN[5, 1] = np.nan


@pytest.mark.parametrize(
    "arguments, options, words, position, kind",
    [
        ((VERTICES, FACES + 1), {}, "names vertex 48, but there are 48 vertices", "faces[40, 2]", "input"),
        ((VERTICES, FACES - 1), {}, "names vertex -1", "faces[0, 0]", "input"),
        ((VERTICES, FACES + 0.5), {}, "0.5 is not the index", "faces[0, 0]", "input"),
        ((VERTICES, [[0, 1, np.inf]]), {}, "inf is not the index", "faces[0, 2]", "input"),
        ((VERTICES, [[0, 1, 1e300]]), {}, "1e+300 is not the index", "faces[0, 2]", "input"),
        ((VERTICES, np.array([[2**64 - 1]], "u8")), {}, f"names vertex {2**64 - 1}", "faces[0, 0]", "input"),
        ((VERTICES, FACES.astype(object)), {}, "astype(int)", None, "input"),
        ((np.ma.masked_less(VERTICES, 0), FACES), {}, "masked", None, "input"),
        ((np.ma.masked_less(VERTICES, 0),), {"f": "value"}, 'nodata="skip"', None, "input"),
        ((VERTICES,), {}, "faces are missing", None, "usage"),
        ((VERTICES[:, :2].tolist(),), {"f": "y"}, "faces are missing", None, "usage"),
        ((VERTICES, FACES.ravel()), {}, "1 axis", None, "input"),
        ((VERTICES, np.zeros((1, 10), int)), {}, "10 columns", None, "input"),
        ((VERTICES, [[0, 1, 2], [0, 1]]), {}, "faces is not an array", None, "input"),
        ((VERTICES, "abc"), {}, "faces is a str, not an array", None, "input"),
        ((VERTICES.ravel(), FACES), {}, "1 axis", None, "input"),
        ((np.zeros((48, 10)), FACES), {}, "10 coordinates", None, "input"),
        ((VERTICES.astype(str), FACES), {}, "not numbers", None, "input"),
        ((VERTICES.astype(complex), FACES), {}, "not numbers", None, "input"),
        ((NAN, FACES), {"f": "y"}, "not finite", "vertices[5, 1]", "input"),
        ((VERTICES, FACES, NAN[:, 1]), {}, "not finite", "values[5]", "input"),
        ((VERTICES, FACES, [1, 2]), {}, "2 values, but there are 48", None, "input"),
        ((VERTICES, FACES, VERTICES), {}, "3 columns", None, "input"),
        ((VERTICES, FACES), {"f": "height"}, "is not a function", None, "usage"),
        ((VERTICES, FACES), {"f": "property:a"}, 'no values of the name "a"', None, "input"),
        ((VERTICES, FACES), {"f": "c3"}, "no coordinate c3", None, "input"),
        ((VERTICES, FACES), {"f": "distance:48"}, "48", None, "input"),
        ((VERTICES, FACES), {"f": "value"}, "no values of the name", None, "input"),
        ((VERTICES, FACES, VERTICES[:, 0]), {"f": "x"}, "both values and f", None, "usage"),
        ((VERTICES, FACES, VERTICES[:, 0]), {"f": "z"}, "both values and f", None, "usage"),
        ((VERTICES, {"tetra10": np.zeros((1, 10), int)}), {}, "tetra10", None, "input"),
        ((VERTICES, FACES), {"memory": "much"}, "much", None, "usage"),
        ((VERTICES, FACES), {"denoise": "-1"}, "-1", None, "usage"),
        ((VERTICES, FACES), {"threads": 0}, "out of range", None, "usage"),
        ((VERTICES, FACES), {"buckets": 1.5}, "not a whole number", None, "usage"),
        ((VERTICES, FACES), {"f": ["x", "y"], "output": ["a.reeb"]}, "2 functions and 1 outputs", None, "usage"),
        ((np.zeros((0, 3)),), {}, "no values", None, "input"),
        ((np.zeros((2, 2, 2, 2)),), {}, "4 axes", None, "input"),
        ((np.zeros((2, 2)),), {"spacing": [1, 2, 3]}, "3 numbers", None, "usage"),
        ((np.zeros((2, 4)),), {"f": "property:a"}, "the image has no", None, "input"),
        ((3,), {}, "an int is not a mesh", None, "usage"),
        ((None,), {}, "mesh is None", None, "usage"),
        (({"a": VERTICES},), {}, "a dict is not a mesh", None, "usage"),
        (((VERTICES, FACES),), {}, "mesh is a tuple of two arrays", None, "usage"),
        (([VERTICES, FACES],), {}, "mesh is a list of two arrays", None, "usage"),
        (([[1, 2], [3]],), {}, "image is not an array", None, "input"),
        ((None, FACES), {}, "vertices is None", None, "input"),
        (("x.ply", FACES), {}, "takes no arrays", None, "usage"),
        (("x.ply",), {"resume": True}, "resume needs an output", None, "usage"),
        (("x.ply",), {"snapshot_every": 9}, "snapshot_every needs an output", None, "usage"),
        ((VERTICES, FACES), {"resume": True, "output": "a.reeb"}, "for a mesh in a file", None, "usage"),
        ((VERTICES, FACES), {"sidecar": True}, "for a mesh in a file", None, "usage"),
        ((VERTICES, FACES), {"format": "ply"}, "format is of a file", None, "usage"),
        ((VERTICES, FACES), {"spacing": (1, 1, 1)}, "spacing is of an image", None, "usage"),
        ((VERTICES,), {"type": "u8"}, "type is of a file", None, "usage"),
        ((VERTICES, FACES), {"f": ""}, "f must be a name or an array", None, "usage"),
        ((VERTICES, FACES), {"f": len}, "f must be a name or an array", None, "usage"),
        ((VERTICES, FACES), {"output": "-"}, "is not a path", None, "usage"),
        ((VERTICES, FACES), {"output": 3}, "is not a path", None, "usage"),
        ((VERTICES, FACES), {"temp_dir": 3}, "is not a path", None, "usage"),
        ((VERTICES, FACES), {"denoise": [1]}, "is not a threshold", None, "usage"),
        ((VERTICES, FACES), {"denoise": True}, "denoise=True is not a threshold", None, "usage"),
        ((VERTICES, FACES), {"denoise": np.timedelta64(1)}, "is not a threshold", None, "usage"),
        ((VERTICES, FACES), {"buckets": True}, "buckets=True is not a whole number", None, "usage"),
        ((IMAGE,), {"nodata": True}, "nodata=True is not a number", None, "usage"),
        ((VERTICES, FACES), {"memory": 10**30}, "out of range", None, "usage"),
        ((VERTICES, FACES), {"chunk": 10**30}, "out of range", None, "usage"),
        ((VERTICES, FACES), {"denoise": 10**400}, "is not a threshold", None, "usage"),
        ((VERTICES, FACES % 2 == 0), {}, "true and false", None, "input"),
        ((VERTICES, FACES, {"height": NAN[:, 1]}), {"f": "property:height"}, "not finite", "height[5]", "input"),
        ((VERTICES, FACES, {"a/b": NAN[:, 1]}), {"f": "property:a/b"}, "not finite", "a/b[5]", "input"),
        ((IMAGE,), {"spacing": (1, np.nan)}, "nan is not a finite number", None, "usage"),
        ((IMAGE,), {"spacing": [0] * IMAGE.ndim}, "spacing has a zero", None, "usage"),
        ((IMAGE,), {"spacing": "1;2"}, "not a list of numbers", None, "usage"),
        ((IMAGE,), {"origin": 3}, "not a list of numbers", None, "usage"),
        ((IMAGE,), {"nodata": "foo"}, "nodata='foo' is not a number", None, "usage"),
        ((IMAGE,), {"progress": 5}, "progress=5 is not a function", None, "usage"),
        ((IMAGE,), {"progress": "a"}, "progress='a' is not a function", None, "usage"),
        (("x.raw",), {"grid": ("a", 2), "type": "u8"}, "grid[0]='a'", None, "usage"),
        (("x.raw",), {"grid": 3, "type": "u8"}, "grid=3 is not a list", None, "usage"),
        (("x.raw",), {"grid": (2, 2, 2), "spacing": ("a", 2, 3)}, "not a list of numbers", None, "usage"),
        (("x.raw",), {"grid": (2, 2, 2), "spacing": (1, 2, np.nan)}, "nan is not a finite number", None, "usage"),
        (("x.raw",), {"nodata": np.zeros(2)}, "not possible with a file", None, "usage"),
    ],
)
def test_bad_arguments_say_what_and_where(arguments, options, words, position, kind):
    error = error_of(*arguments, **options)
    assert words in str(error)
    assert (error.position, error.kind) == (position, kind)
    assert error.hint and error.path is None
    assert "--" not in str(error)


WIDTHS = {"triangle": 3, "tetra": 4, "quad": 4, "pixel": 4, "pyramid": 5, "wedge": 6, "hexahedron": 8, "voxel": 8}


def cells_of(width):
    return np.arange(2 * width).reshape(2, width)


@pytest.mark.parametrize("kind, width", [*WIDTHS.items(), ("line", 2), (9, 4)])
def test_cells_are_as_wide_as_their_names_say(kind, width):
    name = "quad" if kind == 9 else kind
    for compute in (reeb.compute, reeb.defects):
        for columns in (width - 1, width + 1):
            with pytest.raises(reeb.Error, match=f"{name} has {columns} columns, not {width}") as caught:
                compute(VERTICES, {kind: cells_of(columns)})
            assert caught.value.kind == "input" and f"(m, {width})" in caught.value.hint
        with pytest.raises(reeb.Error, match=f"{name} has 1 axis"):
            compute(VERTICES, {kind: cells_of(width).ravel()})


@pytest.mark.filterwarnings("error")
def test_cells_are_refused_by_their_own_place():
    for bad, words in (
        (48, "names vertex 48"),
        (-1, "names vertex -1"),
        (2.5, "2.5 is not the index"),
        (np.nan, "nan is"),
    ):
        for kind, width in WIDTHS.items():
            cells = cells_of(width).astype(type(bad))
            cells[1, 2] = bad
            with pytest.raises(reeb.Error, match=words) as caught:
                reeb.compute(VERTICES, {kind: cells})
            assert (caught.value.path, caught.value.position) == (None, f"{kind}[1, 2]") and caught.value.hint
    for rows, words in (
        ([list("abcd")], "not numbers"),
        ([[0, 1, 2, 3], [0]], "not an array"),
        ([[True] * 4], "true and false"),
    ):
        with pytest.raises(reeb.Error, match=f"quad .*{words}") as caught:
            reeb.compute(VERTICES, {"quad": rows})
        assert caught.value.hint
    with pytest.raises(reeb.Error, match="4 corners"):
        reeb._reeb.divide("quad", np.zeros((1, 3), int))


def test_messages_are_in_the_words_of_python(tmp_path):
    (tmp_path / "v.raw").write_bytes(bytes(8))
    for options, words in (
        ({}, 'grid="256x256x100", type="u16le"'),
        ({"type": "u8"}, 'grid="256x256x100", type="u16le"'),
        ({"grid": "a", "type": "u8"}, 'grid="512x512" or grid="256x256x100"'),
        ({"grid": "2x2x2", "type": "u8", "spacing": (1, 2)}, "spacing=(0.5, 0.5, 2)"),
    ):
        hint = error_of(tmp_path / "v.raw", **options).hint
        assert words in hint and "--" not in hint
    graph = reeb.compute(VERTICES, FACES)
    with pytest.raises(reeb.Error) as caught:
        reeb.segment(graph, np.concatenate([VERTICES, VERTICES]), FACES)
    assert "the graph" in str(caught.value) and "/proc" not in str(caught.value)
    with pytest.raises(reeb.Error, match="mesh is a tuple of two arrays"):
        reeb.segment(graph, (VERTICES, FACES))


def test_two_slices_are_a_volume():
    slices = [IMAGE, IMAGE + 1]
    assert reeb.compute(slices) == reeb.compute(np.array(slices))


def test_defects_need_faces():
    for mesh, words in ((VERTICES, "faces are missing"), (None, "mesh is None"), ({}, "a dict is not a mesh")):
        with pytest.raises(reeb.Error, match=words):
            reeb.defects(mesh)


def test_a_graph_under_another_suffix_gives_a_warning(tmp_path):
    with pytest.warns(UserWarning, match="t.json is a .reeb file"):
        graph = reeb.compute(VERTICES, FACES, output=tmp_path / "t.json")
    with pytest.warns(UserWarning, match="t.ply is a .reeb file"):
        graph.save(tmp_path / "t.ply")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        graph.save(tmp_path / "t.reeb")
        graph.save(tmp_path / "t")


def test_defects_of_lines_and_triangles_are_refused():
    with pytest.raises(reeb.Error, match="only surfaces"):
        reeb.defects(VERTICES, {"triangle": FACES, "line": FACES[:, :2]})


def test_images_two_or_three_wide_are_named_as_such():
    image = np.arange(12.0).reshape(4, 3)
    assert reeb.compute(image, f="value").function == "value"
    assert reeb.compute(image, spacing=(1, 1)) == reeb.compute(image, f="value")


def test_a_mesh_in_a_file_takes_no_arrays(tmp_path):
    path = write_ply(tmp_path / "t.ply", VERTICES, FACES)
    graph = reeb.compute(path, output=tmp_path / "t.reeb")
    for action in (
        lambda: reeb.defects(path, graph),
        lambda: reeb.segment(graph, path, FACES),
        lambda: reeb.segment(graph, path, values=VERTICES[:, 2]),
    ):
        with pytest.raises(reeb.Error, match="takes no arrays") as caught:
            action()
        assert caught.value.kind == "usage" and caught.value.hint


def test_defects_of_cells_are_refused(tmp_path):
    program = os.environ["REEB_PROGRAM"]
    ball = tmp_path / "ball.svb"
    subprocess.run([program, "generate", "ball", "--tetrahedra", "300", "-o", ball], check=True, capture_output=True)
    with pytest.raises(reeb.Error, match="has cells"):
        reeb.defects(ball)


def test_defects_of_a_bad_vertex_name_the_array():
    with pytest.raises(reeb.Error) as caught:
        reeb.defects(NAN, FACES)
    assert (caught.value.path, caught.value.position) == (None, "vertices[5, 1]")
    for faces, place in ((FACES + 1, "faces[40, 2]"), ({"triangle": FACES - 1}, "triangle[0, 0]")):
        with pytest.raises(reeb.Error, match="names vertex") as caught:
            reeb.defects(VERTICES, faces)
        assert (caught.value.path, caught.value.position) == (None, place)


def test_graphs_of_defects_are_paths():
    graph = reeb.compute(VERTICES, FACES)
    for graphs in ([graph], graph, 3):
        with pytest.raises(reeb.Error, match="is not a path") as caught:
            reeb.defects(VERTICES, FACES, graphs=graphs)
        assert caught.value.kind == "usage" and "graph.save" in caught.value.hint
    assert len(reeb.defects(VERTICES, FACES, graphs=None).loops) == len(reeb.defects(VERTICES, FACES).loops)


def test_arguments_of_a_graph_are_checked(tmp_path):
    graph = reeb.compute(VERTICES, FACES, f="x")
    for action, words in (
        (lambda: graph.level([1]), "is not a threshold"),
        (lambda: graph.level(), r"level\(\) needs one of"),
        (lambda: graph.level(1, nodes=2), "threshold and nodes given"),
        (lambda: graph.plot(kind="skeleton", view=(1, 2)), "2 numbers"),
        (lambda: graph.plot(kind="skeleton", mesh=VERTICES), "in a file only"),
        (lambda: graph.plot(kind="skeleton", view=(0, 0, 0)), "not a direction"),
        (lambda: graph.plot(kind="skeleton", view=(1, np.nan, 0)), "nan is not a finite number"),
        (lambda: graph.plot(kind="skeleton", view=(-np.inf, 1, 0)), "-inf is not a finite number"),
        (lambda: graph.plot(kind="skeleton", view=5), "not a list of numbers"),
        (lambda: graph.plot(view=(1, 1, 1)), "view is for a skeleton"),
        (lambda: graph.plot(kind="loops", mesh="x.ply"), "mesh is for a skeleton"),
        (lambda: graph.plot(kind=3), "no picture of kind 3"),
        (lambda: graph.plot(3, kind="skeleton"), "output=3 is not a path"),
        (lambda: graph.save(3), "output=3 is not a path"),
        (lambda: graph.save("-"), "output='-' is not a path"),
        (lambda: graph.level(nodes=2**70), "out of range"),
        (lambda: graph.level(memory=2**70), "out of range"),
        (lambda: graph.level(10**400), "is not a threshold"),
        (lambda: reeb.open(3), "is not a path"),
        (lambda: reeb.segment(3, VERTICES, FACES), "is not a graph"),
    ):
        with pytest.raises(reeb.Error, match=words) as caught:
            action()
        assert caught.value.kind == "usage" and caught.value.hint
    for path in (tmp_path / "no" / "g.reeb", tmp_path):
        with pytest.raises(OSError) as caught:
            graph.save(path, force=True)
        assert isinstance(caught.value, reeb.Error) and caught.value.path == str(path) and caught.value.hint
    assert list(tmp_path.iterdir()) == []


def test_no_file_is_named_that_is_gone_or_never_was(tmp_path):
    graph = reeb.compute(VERTICES, FACES, graph_only=True)
    with pytest.raises(reeb.Error, match="the graph only") as caught:
        graph.plot(kind="diagram")
    assert caught.value.path is None and "graph.reeb" not in str(caught.value)
    missing = error_of(VERTICES, FACES, temp_dir=tmp_path / "no")
    assert isinstance(missing, OSError) and (missing.kind, missing.path) == ("resource", str(tmp_path / "no"))


def test_an_output_is_written_as_the_program_does(tmp_path):
    graph = reeb.compute(VERTICES, FACES)
    (tmp_path / "real.reeb").write_text("old")
    (tmp_path / "link.reeb").symlink_to("real.reeb")
    (tmp_path / f"free.reeb.partial-{1 << 22}-0").write_text("of a process that was killed")
    with pytest.raises(FileExistsError) as caught:
        graph.save(tmp_path / "link.reeb")
    assert "force=True" in caught.value.hint
    with pytest.raises(FileExistsError):
        graph.save(tmp_path)
    graph.save(tmp_path / "link.reeb", force=True)
    assert (tmp_path / "link.reeb").is_symlink() and reeb.open(tmp_path / "real.reeb") == graph
    graph.save(tmp_path / "free.reeb")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["free.reeb", "link.reeb", "real.reeb"]


# The numbers are those of libreeb/base/error.h.
@pytest.mark.parametrize("number, cause, type_", [(3, 1, MemoryError), (3, 0, OSError), (1, 3, FileNotFoundError)])
def test_no_wording_decides_the_class(number, cause, type_):
    for message in ("there is no such file", "the output exists", "of memory"):
        made = reeb.errors._make(number, cause, "a.ply", "", message, "")
        assert isinstance(made, type_) and not isinstance(made, FileExistsError)


def test_more_vertices_than_int32_can_number():
    many = np.broadcast_to(np.zeros(3), ((1 << 31) + 1, 3))  # takes no memory
    with pytest.raises(reeb.Error, match="too many"):
        reeb.defects(many, FACES)


def test_positions_of_a_stream_are_finite():
    online = reeb.Online()
    for bad in (np.nan, np.inf):
        first = online.add_vertices([0.0]).item()
        with pytest.raises(reeb.Error, match="not finite") as caught:
            online.add_vertices([1, 2, 3], [[0, 0, 0], [0, bad, 0], [0, 0, 0]])
        assert caught.value.position == "positions[1]"
        assert online.add_vertices([4.0]).tolist() == [first + 2]  # those before it were added
    with pytest.raises(reeb.Error, match="true and false"):
        online.finalize([True])


def test_a_stream_names_the_largest_indices_as_they_are():
    online = reeb.Online()
    online.add_vertices([0.0, 1.0])
    for index in (2**63, 2**64 - 1):
        with pytest.raises(reeb.Error, match=f"vertex {index}\\b"):
            online.finalize([index])
        with pytest.raises(reeb.Error, match=f"vertex {index}\\b"):
            online.add_simplices(np.array([[0, index]], "u8"))
    with pytest.raises(reeb.Error, match="vertex -1"):
        online.finalize([-1])


@pytest.mark.parametrize("bad", ["\0xyz", "\ud800"])
def test_no_file_has_such_a_name(tmp_path, monkeypatch, bad):
    monkeypatch.chdir(tmp_path)
    write_ply("t.ply", VERTICES, FACES)
    graph = reeb.compute("t.ply", output="t.reeb")
    for use in (
        lambda: reeb.compute("t.ply" + bad),
        lambda: reeb.compute("t.ply", f="file:t.ply" + bad),
        lambda: reeb.compute("t.ply", output=f"q{bad}.reeb"),
        lambda: reeb.compute("t.ply", temp_dir="." + bad),
        lambda: reeb.defects("t.ply" + bad),
        lambda: reeb.defects("t.ply", graphs=["t.reeb" + bad]),
        lambda: reeb.segment(graph, "t.ply" + bad),
        lambda: reeb.open("t.reeb" + bad),
        lambda: graph.save(f"q{bad}.reeb"),
        lambda: graph.plot(f"q{bad}.svg"),
    ):
        with pytest.raises(reeb.Error, match="cannot be the name of a file") as caught:
            use()
        assert caught.value.kind == "usage"
    assert sorted(os.listdir()) == ["t.ply", "t.reeb"]


def test_files_say_what_and_where(tmp_path):
    assert isinstance(error_of(tmp_path / "none.ply"), FileNotFoundError)
    assert isinstance(error_of(""), FileNotFoundError)
    (tmp_path / "cut.ply").write_bytes(write_ply(tmp_path / "t.ply", VERTICES, FACES).read_bytes()[:-5])
    cut = error_of(tmp_path / "cut.ply")
    assert cut.path == str(tmp_path / "cut.ply") and int(cut.position) > 0 and cut.hint
    (tmp_path / "old.reeb").write_text("mine")
    exists = error_of(tmp_path / "t.ply", output=tmp_path / "old.reeb")
    assert isinstance(exists, FileExistsError) and "force=True" in exists.hint
    assert (tmp_path / "old.reeb").read_text() == "mine"
    reeb.compute(tmp_path / "t.ply", output=tmp_path / "old.reeb", force=True)
    assert isinstance(error_of(VERTICES, FACES, output=tmp_path / "no" / "a.reeb"), OSError)
    with pytest.raises(FileNotFoundError) as caught:
        reeb.open(tmp_path / "none.ply")
    assert str(caught.value) == str(error_of(tmp_path / "none.ply"))
    with pytest.raises(reeb.Error, match=r"this is a mesh \(PLY\), not a Reeb graph") as caught:
        reeb.open(tmp_path / "t.ply")
    assert "reeb.compute" in caught.value.hint
    assert "damaged" not in caught.value.hint
    with pytest.raises(reeb.Error):
        reeb.open(tmp_path / "old.reeb").level(nodes=1)


def test_too_little_memory_is_a_memory_error():
    assert isinstance(error_of(VERTICES, FACES, memory=1000), MemoryError)
    assert error_of(VERTICES, FACES, memory=1000).kind == "resource"


def long_work():
    return np.random.default_rng(1).random((220, 220, 220), dtype=np.float32)


def assert_ended_soon(sent):
    """A fifth of a second of two threads. By the clock it is as long if the machine is not busy with other things."""
    wall, cpu = (now - then for now, then in zip((time.monotonic(), time.process_time()), sent))
    assert cpu < 0.4 and wall < 2


def test_ctrl_c_ends_a_run_within_a_fifth_of_a_second(tmp_path):
    mesh = tmp_path / "scan.ply"
    generate = [os.environ["REEB_PROGRAM"], "generate", "scan", "--triangles", "4M", "-o", mesh]
    subprocess.run(generate, check=True, capture_output=True)
    sent = []

    def interrupt():
        sent.append((time.monotonic(), time.process_time()))
        os.kill(os.getpid(), signal.SIGINT)

    for delay in (0.1, 0.3):
        timer = threading.Timer(delay, interrupt)
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            reeb.compute(mesh, f="random:1", temp_dir=tmp_path)
            timer.join()  # if it was faster, this is interrupted
        assert_ended_soon(sent[-1])
        timer.join()
    assert list(tmp_path.iterdir()) == [mesh]


def test_ctrl_c_ends_a_run_on_a_volume_as_fast():
    volume = long_work()
    sent = []

    def interrupt():
        sent.append((time.monotonic(), time.process_time()))
        os.kill(os.getpid(), signal.SIGINT)

    for delay in (0.3, 0.5, 0.7):
        timer = threading.Timer(delay, interrupt)
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            reeb.compute(volume)
            timer.join()
        assert_ended_soon(sent[-1])
        timer.join()


def test_other_threads_run_and_progress_is_told():
    image = long_work()[:40]
    ticks, told = [], []
    stop = threading.Event()

    def tick():
        while not stop.wait(0.005):
            ticks.append(time.monotonic())

    thread = threading.Thread(target=tick)
    thread.start()
    reeb.compute(image, progress=lambda *step: told.append((threading.get_ident(), step)))
    stop.set()
    thread.join()
    assert len(ticks) > 10
    assert {ident for ident, _ in told} == {threading.get_ident()}
    assert {step[0] for _, step in told} <= {"copy", "finalization", "reorder", "reeb", "hierarchy"}
    assert all(0 <= done <= total or total == 0 for _, (_, done, total, _) in told)


def test_what_a_callback_raises_ends_the_run():
    def fail(*_):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        reeb.compute(long_work()[:40], progress=fail)


def test_bars(capsys):
    reeb.compute(long_work()[:40], progress=True)
    assert "reeb" in capsys.readouterr().err


def test_a_bar_in_a_file_has_no_codes_of_terminals(capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm", None)
    reeb.compute(long_work()[:40], progress=True)
    shown = capsys.readouterr().err
    assert "reeb\n" in shown and "\x1b" not in shown and "\r" not in shown


DAEMONS = """
import sys, threading, time
import numpy as np
import reeb

image = np.random.default_rng(1).random((60, 60, 60))
file = sys.argv[1]
reeb.compute(image[:20], output=file)


def repeat(work):
    while True:
        work()


for work in (
    lambda: reeb.compute(image),
    lambda: reeb.compute(image, progress=lambda *_: time.sleep(0.01)),
    lambda: reeb.open(file).nodes,
):
    threading.Thread(target=repeat, args=(work,), daemon=True).start()
time.sleep(0.3)
print("the main thread ends")
"""


def test_the_end_of_python_waits_for_threads_that_compute(tmp_path):
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    for run in range(3):
        command = [sys.executable, "-c", DAEMONS, str(tmp_path / f"{run}.reeb")]
        ended = subprocess.run(
            command, capture_output=True, text=True, timeout=60, env={**os.environ, "TMPDIR": str(temporary)}
        )
        assert (ended.returncode, ended.stdout, ended.stderr) == (0, "the main thread ends\n", "")
        assert list(temporary.iterdir()) == []


def test_several_threads_compute_at_once():
    expected = reeb.compute(VERTICES, FACES, f="x")
    results = []
    threads = [
        threading.Thread(target=lambda: results.append(reeb.compute(VERTICES, FACES, f="x"))) for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == [expected] * 4


@pytest.mark.parametrize("bad", ["\udcff", "\ud800"])
def test_texts_that_are_not_utf8_are_errors_like_others(bad):
    vertices, faces = np.array([[0, 0, 0], [1, 0, 1], [0, 1, 2.0]]), [[0, 1, 2]]
    for options in ({"memory": bad}, {"denoise": bad}, {"f": "property:" + bad}):
        with pytest.raises(reeb.Error):
            reeb.compute(vertices, faces, **options)
    with pytest.raises(reeb.Error):
        reeb.compute(vertices, faces).level(bad)
    with pytest.raises(reeb.Error):
        reeb.compute(vertices, faces, {bad: [1, 2, 3]}, "property:other")


@pytest.mark.parametrize("bad", [[[1], [1, 2]], "x", None, [[1]], 1.5])
def test_what_is_finalized_is_an_array_of_indices(bad):
    with pytest.raises(reeb.Error, match="ids"):
        reeb.Online().finalize(bad)


def test_a_promise_of_manifold_edges_that_is_broken_is_an_error():
    faces = [[0, 1, 2], [0, 1, 3], [0, 1, 4]]
    vertices = np.array([[0, 0, 0], [1, 0, 1], [0, 1, 2], [0, 1, 3], [1, 1, 4.0]])
    assert reeb.compute(vertices, faces[:2], manifold=True) == reeb.compute(vertices, faces[:2])
    with pytest.raises(reeb.Error, match="has a third triangle") as caught:
        reeb.compute(vertices, faces, manifold=True)
    assert "manifold=True" in caught.value.hint


FORKS = """
import os, sys, threading
import numpy, reeb
image = numpy.random.default_rng(1).random((400, 400))
graphs = []
begun = threading.Event()
thread = threading.Thread(target=lambda: graphs.append(reeb.compute(image, progress=lambda *_: begun.set())))
thread.start()
begun.wait()
child = os.fork()
if child == 0:
    sys.exit(0)  # which removes no folder of its parent
assert os.waitpid(child, 0)[1] == 0
thread.join()
print(graphs[0] == reeb.compute(image))
"""
AT_EXIT = """
import atexit, reeb
vertices, faces = [[0, 0, 0], [1, 0, 1], [0, 1, 2]], [[0, 1, 2]]
atexit.register(lambda: print(len(reeb.compute(vertices, faces).nodes) == 2))
reeb.compute(vertices, faces)
"""


@pytest.mark.parametrize("words", [FORKS, AT_EXIT])
def test_folders_at_the_end_of_a_process(words):
    ended = subprocess.run([sys.executable, "-c", words], capture_output=True, text=True, timeout=60)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "True\n", "")
