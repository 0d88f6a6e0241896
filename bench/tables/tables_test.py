"""Tests of the benchmark tables: statistics by hand, a whole small run, resuming, and the page.

    tables_test.py PROGRAM
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import cells  # noqa: E402
import document  # noqa: E402
import goals  # noqa: E402
import instructions  # noqa: E402
from measure import Failed, Store, figures, median, run_once, summary  # noqa: E402

PROGRAM = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else "build/release/tools/reeb"


class Statistics(unittest.TestCase):
    def test_medians_by_hand(self):
        self.assertEqual(median([3.0]), 3.0)
        self.assertEqual(median([5, 1, 3]), 3)
        self.assertEqual(median([4, 1, 3, 2]), 2.5)
        self.assertEqual(median([10, 9, 100, 1, 2]), 9)  # not sorted as text
        self.assertEqual(median([7, 7, 1, 7]), 7)

    def test_summary_by_hand(self):
        self.assertEqual(summary([0.5, 0.25, 4.0]), {"min": 0.25, "median": 0.5, "max": 4.0})

    def test_each_field_has_its_own_median(self):
        found = figures([{"wall": 1, "peak": 30}, {"wall": 3, "peak": 10}, {"wall": 2, "peak": 20}])
        self.assertEqual(found["runs"], 3)
        self.assertEqual(found["wall"], {"min": 1, "median": 2, "max": 3})
        self.assertEqual(found["peak"], {"min": 10, "median": 20, "max": 30})

    def test_a_field_that_a_run_lacks_is_left_out(self):
        self.assertEqual(set(figures([{"wall": 1, "rchar": 2}, {"wall": 1}])), {"runs", "wall"})


class Running(unittest.TestCase):
    def test_time_memory_and_bytes_are_those_of_the_process(self):
        script = "import time; time.sleep(0.3); x = bytearray(b'1') * (60 << 20); print('y' * 300000)"
        fields, text = run_once([sys.executable, "-c", script])
        self.assertEqual(len(text.strip()), 300000)
        self.assertGreater(fields["wall"], 0.3)
        self.assertGreater(fields["peak_bytes"], 60 << 20)
        self.assertLess(fields["peak_bytes"], 160 << 20)
        self.assertGreaterEqual(fields["wchar"], 300000)

    def test_failures_and_limits_are_said(self):
        with self.assertRaisesRegex(Failed, "exit code 3: reeb: error: no room"):
            run_once([sys.executable, "-c", "import sys; print('note'); print('reeb: error: no room'); sys.exit(3)"])
        with self.assertRaisesRegex(Failed, "not done in 0.2 s"):
            run_once(["sleep", "20"], 0.2)


class SmallRun(unittest.TestCase):
    """The tables with tiny meshes under their names."""

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.addCleanup(setattr, cells, "SIZES", cells.SIZES)
        cells.SIZES = {name: 2000 + index for index, name in enumerate(cells.SIZES)}

    def bench(self, mode="quick", again=False, program="p"):
        bench = cells.Bench(PROGRAM, self.folder, mode, 1, Store(os.path.join(self.folder, "cells"), program, again))
        bench.say = lambda text: None
        self.addCleanup(bench.close)
        return bench

    def test_a_run_is_stored_resumed_and_written(self):
        bench = self.bench()
        cells.sizes(bench)
        cells.orders(bench)
        cells.manifold(bench)
        self.assertEqual(bench.failures, [])
        stored = bench.store.all()
        cell = stored["sizes/0.87M/z"]
        self.assertEqual((cell["components"], cell["loops"]), (1, bench.genus(bench.scan("0.87M"))))
        self.assertIn("live_bytes", cell)
        self.assertIn("orders/0.87M/spectral/x", stored)
        self.assertIn("manifold/7.2M/rows/random:1", stored)

        # What is stored is not measured again, neither with a program that would fail.
        resumed = self.bench()
        resumed.program = "/bin/false"
        cells.sizes(resumed)
        cells.orders(resumed)
        self.assertEqual(resumed.failures, [])
        # But that of another program is.
        other = self.bench(program="q")
        other.program = "/bin/false"
        cells.sizes(other)
        self.assertEqual(len(other.failures), len([name for name in stored if name.startswith("sizes/")]))
        self.assertEqual(other.store.all(), {})

        page = self.page(stored, [{"what": "peers", "why": "no reason"}])
        for text in ("| 871,414 |", "| 7.2 million | rows | random:1 |", "paper: St. Matthew", "| `peers` | no reason |",
                     "`orders/0.87M/hilbert/random:1`", "| not measured |"):
            self.assertIn(text, page)
        self.assertNotIn(self.folder, page)
        self.assertLess(max(len(line) for line in page.splitlines() if not line.startswith(("|", "!"))), 121)

    def page(self, stored, failures):
        result = {"schema": "reeb.bench.v1", "date": "2026-01-01", "mode": "quick", "version": "reeb 0",
                  "machine": {"processor": "P", "cores": 2, "memory_bytes": 1 << 30, "system": "S", "compiler": "C",
                              "temporary_files": "disk", "libraries": {"L": "1"}},
                  "load": {"least": 0.1, "most": 9.0}, "failures": failures, "cells": stored}
        output = os.path.join(self.folder, "docs")
        os.makedirs(output, exist_ok=True)
        with open(os.path.join(output, "benchmarks.json"), "w", encoding="utf-8") as file:
            json.dump(result, file)
        # In a process of its own, without a program to run.
        script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "run.py")
        done = subprocess.run([sys.executable, script, "--render", "--output", output], capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 1 if failures else 0, done.stderr)
        with open(os.path.join(output, "BENCHMARKS.md"), encoding="utf-8") as file:
            return file.read()

    def test_a_wrong_answer_fails(self):
        bench = self.bench()
        mesh = bench.scan("0.87M")
        cell = bench.checked("wrong", mesh, *cells.GRAPH, genus=bench.genus(mesh) + 1)
        self.assertIn("wrong answer", cell["failed"])
        self.assertEqual(bench.store.all(), {})

    def test_nothing_is_left_but_meshes_and_figures(self):
        bench = self.bench()
        cells.extras(bench)
        bench.close()
        self.assertEqual([name for name in os.listdir(self.folder) if name.startswith(("bench-", "new-"))], [])


class Profile(unittest.TestCase):
    ANNOTATED = """--------
Ir
--------
1,000 (100.0%)  PROGRAM TOTALS

--------
Ir              file:function
--------
  600 (60.00%)  ???:reeb::Sums::add(std::span<unsigned int const, 5ul>) const [/bin/reeb]
   90 ( 9.00%)  ./x.c:memcpy [/lib/libc.so.6]
   60 ( 6.00%)  ???:0x00000000000012a0 [/lib/libzstd.so.1.5.4]
   50 ( 5.00%)  ???:0x00000000000013a0 [/lib/libzstd.so.1.5.4]
   40 ( 4.00%)  ???:void std::vector<reeb::Id<A, int>, B>::insert<int*>(int*) [/bin/reeb]
   10 ( 1.00%)  ???:reeb::io::(anonymous namespace)::Reader::fill(char) [/bin/reeb]
"""

    def test_functions_by_hand(self):
        self.assertEqual(instructions.parsed(self.ANNOTATED),
                         {"reeb::Sums::add": 600, "memcpy": 90, "libzstd (without names)": 110,
                          "std::vector::insert": 40, "reeb::io::Reader::fill": 10})
        with self.assertRaisesRegex(Failed, "no function"):
            instructions.parsed("Ir\n")

    def test_what_is_added_by_hand(self):
        self.addCleanup(setattr, instructions, "SHOWN", instructions.SHOWN)
        instructions.SHOWN = 2
        rows = instructions.compared({"a": 100, "b": 40, "gone": 20}, {"a": 130, "b": 40, "new": 60, "c": 2}, 10)
        self.assertEqual(rows, [["new", 0, 6], ["a", 10, 13], ["other functions", 6, 4.2], ["all", 16, 23.2]])
        page = document.profile_tables({"profile/z": {"functions": rows}})
        for text in ("z: 7 instructions a triangle more, +45.0 %.", "| a | 10.0 | 13.0 | 41.7 % |",
                     "| other functions | 6.0 | 4.2 | -25.0 % |"):
            self.assertIn(text, page)


class Goals(unittest.TestCase):
    @staticmethod
    def cell(wall, **facts):
        return {"wall": summary([wall]), **{name: summary([value]) if isinstance(value, float) else value
                                            for name, value in facts.items()}}

    def rows(self, stored):
        return {row[0]: row for row in goals.goal_rows(document.Figures(stored))}

    def test_by_hand(self):
        stored = {"targets/12M/z/threads-1": self.cell(1.0, triangles=12000000, peak_bytes=20e6),
                  "targets/12M/z/threads-2": self.cell(0.5, triangles=12000000, peak_bytes=33e6),
                  "targets/12M/random-order-against-coherent": self.cell(7.0, wall_ratio=3.5),
                  "sizes/7.2M/hierarchy": self.cell(1.0, triangles=10000000),
                  "sizes/56M/hierarchy": self.cell(12.0, triangles=100000000),
                  "targets/56M/temporary-files": self.cell(1.0, wall_ratio=1.06)}
        rows = self.rows(stored)
        self.assertEqual(rows["12M triangles, z, graph only, `--buckets 0`, two threads"][2:4],
                         ["24.0 M/s, 33 MB", "no"])  # the memory
        self.assertEqual(rows["the same with one thread"][2:4], ["12.0 M/s", "no"])
        self.assertEqual(rows["two threads against one"][2:], ["2.00 times", "yes", ""])
        self.assertEqual(
            rows["12M triangles in random order, `--memory 64M`, with hierarchy, against patches"][2:4],
            ["3.5 times", "yes"])
        self.assertEqual(rows["growth from 7.2M triangles to the largest mesh: ns a triangle"][2:4], ["+20 %", "no"])
        self.assertEqual(rows["temporary files on disk against in memory, z, largest mesh"][2:4], ["+6.0 %", "no"])
        self.assertEqual(rows["the same with a random function"][2:4], ["–", "not measured"])

    def test_memory_and_time_of_a_hierarchy_beyond_memory(self):
        stored = {"targets/48M/all-noise/free": self.cell(2.0), "targets/372M/all-noise/free": self.cell(2.0),
                  "targets/48M/all-noise/40M": self.cell(4.0, peak_bytes=40.0 * 2**20),
                  "targets/372M/all-noise/128M": self.cell(3.0, peak_bytes=129.0 * 2**20)}
        rows = [row for what, row in self.rows(stored).items() if "all their noise" in what]
        self.assertEqual([row[2:4] for row in rows], [["2.00 times, 40.0 MiB", "yes"], ["1.50 times, 129.0 MiB", "no"]])

    def test_the_better_option_decides(self):
        stored = {"targets/tiles/rows/free": self.cell(3.0), "targets/tiles/rows/free/no-reorder": self.cell(2.0),
                  "targets/tiles/rows/64M": self.cell(3.0), "targets/tiles/rows/64M/no-reorder": {"unsuited": "late"}}
        row = self.rows(stored)["12 orders and budgets of 12M triangles: the default against the better of it and "
                                "`--no-reorder`"]
        self.assertEqual(row[2:4], ["1.50 times (rows/free)", "no"])


if __name__ == "__main__":
    unittest.main(verbosity=1)
