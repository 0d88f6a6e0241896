"""Counts the instructions of fixed small runs with one thread (callgrind), the most that they allocate at a time
(massif) and their peak memory, and compares them with those recorded in costs.json.

    costs.py REEB [--compiler C++] [--record]

More than 5 % above the record, and for peak memory half a MiB in addition, is a failure, if the record was made with
the same compiler and libraries. With others the figures are only reported. --record writes the present figures; do that
in the commit that changes them, and say in its message why they grew."""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile

RECORD = os.path.join(os.path.dirname(os.path.abspath(__file__)), "costs.json")
ALLOWED = 0.05
# How many pages of the program and its libraries are mapped depends on the page cache: the same program in two folders
# took 11.15 and 11.76 MB. What is allocated does not depend on it.
EXTRA = {"instructions": 0, "heap_bytes": 0, "peak_bytes": 512 << 10}
LIBRARIES = ["libc6", "libstdc++6", "libtbb12", "libzstd1", "liblz4-1", "zlib1g", "valgrind"]
GRAPH = ["--graph-only", "--buckets", "0"]
RUNS = {
    "patches, z, graph only": ["patches.ply", *GRAPH],
    "patches, random function, with hierarchy": ["patches.ply", "-f", "random:1"],
    "rows, z, noise removal, with hierarchy": ["rows.ply", "--denoise", "0.1%"],
    "random order, z, sorted on disk": ["random.ply", *GRAPH, "--memory", "64M"],
    "OBJ, z, graph only": ["patches.obj", *GRAPH],
    "image, graph only": ["image.nrrd", *GRAPH],
}


def text_of(command):
    return subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False).stdout.strip()


def environment_of(compiler):
    """What the counts depend on besides the code. The C library chooses its functions by the processor."""
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        flags = set(next((line for line in file if line.startswith("flags")), "").split())
    versions = {name: text_of(["dpkg-query", "-W", "-f=${Version}", name]) for name in LIBRARIES}
    return {"compiler": text_of([compiler, "--version"]).split("\n")[0].partition(" ")[2], **versions,
            "processor": " ".join([os.uname().machine] + sorted(flags & {"avx2", "avx512f", "bmi2", "erms"}))}


def run(command, folder):
    # Temporary folders and checkpoints must not depend on the place and on the speed of the machine.
    # The shell, since a process inherits the peak memory of the one that forked it.
    command = ["sh", "-c", '"$@"; exit $?', "sh", *command]
    environment = {"PATH": os.environ["PATH"], "TMPDIR": folder, "REEB_CHECKPOINT_SECONDS": "100000"}
    done = subprocess.run(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          check=False)
    if done.returncode != 0:
        sys.exit(f"error: {' '.join(command)}: exit code {done.returncode}: {done.stderr.strip()}")
    return done


def make_meshes(reeb, folder):
    for order in ("patches", "rows", "random"):
        run([reeb, "generate", "scan", "--triangles", "40k", "--order", order, "-o", order + ".ply"], folder)
    run([reeb, "convert", "patches.ply", "patches.obj"], folder)
    run([reeb, "generate", "volume", "--grid", "32x32x32", "-o", "image.nrrd"], folder)


def measure(reeb):
    costs = {}
    with tempfile.TemporaryDirectory() as folder:
        make_meshes(reeb, folder)
        for name, words in RUNS.items():
            compute = [reeb, "compute", *words, "--threads", "1", "--quiet", "--force", "-o", "out.reeb"]
            counted = run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *compute], folder)
            instructions = int(re.search(r"Collected : (\d+)", counted.stderr).group(1))
            run(["valgrind", "--tool=massif", "--massif-out-file=heap.txt", *compute], folder)
            with open(os.path.join(folder, "heap.txt"), encoding="utf-8") as file:
                heap = max(map(int, re.findall(r"^mem_heap_B=(\d+)", file.read(), re.MULTILINE)))
            peaks = [json.loads(run([*compute, "--report", "-"], folder).stdout)["peak_rss_bytes"] for _ in range(3)]
            costs[name] = {"instructions": instructions, "heap_bytes": heap, "peak_bytes": min(peaks)}
    return costs


def compare(costs, recorded, same_environment):
    """Prints a line for each figure. Returns how many grew too much."""
    too_much = 0
    for name, figures in costs.items():
        before = recorded.get(name)
        for what, now in figures.items():
            if before is None:
                print(f"{name}: {what} {now:,}; not recorded")
                too_much += 1
                continue
            change = now / before[what] - 1
            grew = now > (1 + ALLOWED) * before[what] + EXTRA[what]
            too_much += grew
            print(f"{name}: {what} {now:,}, recorded {before[what]:,}: {100 * change:+.1f} %"
                  + (" TOO MUCH" if grew and same_environment else ""))
    return too_much


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("reeb")
    parser.add_argument("--compiler", default="c++")
    parser.add_argument("--record", action="store_true")
    arguments = parser.parse_args()
    environment = environment_of(arguments.compiler)
    costs = measure(os.path.abspath(arguments.reeb))
    if arguments.record:
        with open(RECORD, "w", encoding="utf-8") as file:
            json.dump({"environment": environment, "costs": costs}, file, indent=1)
            file.write("\n")
        print("recorded")
        return 0
    with open(RECORD, encoding="utf-8") as file:
        recorded = json.load(file)
    same = recorded["environment"] == environment
    too_much = compare(costs, recorded["costs"], same)
    if not same:
        differing = [name for name in environment if environment[name] != recorded["environment"].get(name)]
        print(f"skipped: not here: the costs were recorded with another environment ({', '.join(differing)})")
        return 0
    if too_much:
        print(f"Figures more than {ALLOWED:.0%} above what was recorded: {too_much}. If that is worth it, record them "
              "again and say why in the commit:\n"
              "  cmake --build --preset release --target reeb_program\n"
              "  python3 tests/house/costs.py build/release/tools/reeb --record")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
