"""The command line of bench/run.sh, which has its help."""
import argparse
import datetime
import hashlib
import json
import os
import platform
import subprocess
import sys
import time

import cells
import document
from measure import Failed, Store


def text_of(command):
    try:
        return subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              check=False).stdout.strip()
    except OSError:
        return ""


def package_version(name):
    return text_of(["dpkg-query", "-W", "-f=${Version}", name]) or "not known"


def machine(folder):
    model = "not known"
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        for line in file:
            if line.startswith("model name"):
                model = line.split(":", 1)[1].strip()
                break
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    compiler = text_of(["c++", "--version"]).splitlines()
    return {"processor": model, "cores": len(os.sched_getaffinity(0)), "memory_bytes": memory,
            "system": f"{platform.system()} {platform.release()}", "temporary_files": cells.kinds_of(folder),
            "compiler": compiler[0] if compiler else "not known",
            "libraries": {name: package_version(package) for name, package in
                          (("C library", "libc6"), ("TBB", "libtbb12"), ("zstd", "libzstd1"))}}


def digest_of(path):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        for piece in iter(lambda: file.read(1 << 20), b""):
            digest.update(piece)
    return digest.hexdigest()[:16]


def parse():
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    modes = parser.add_mutually_exclusive_group()
    for mode in cells.SIZES_OF:
        modes.add_argument("--" + mode, dest="mode", action="store_const", const=mode, default="quick")
    parser.add_argument("--only")
    parser.add_argument("--folder", default="build/bench")
    parser.add_argument("--program", default="build/release/tools/reeb")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--render", action="store_true")
    parser.add_argument("--output", default="docs")
    arguments = parser.parse_args()
    arguments.tables = arguments.only.split(",") if arguments.only else cells.TABLES
    unknown = [name for name in arguments.tables if name not in cells.TABLES]
    if unknown:
        parser.error(f"no table {unknown[0]}; there are {', '.join(cells.TABLES)}")
    if arguments.runs < 1:
        parser.error("--runs takes a number from 1")
    return arguments


def measure(arguments):
    """Runs the tables; returns what is stored afterwards, and the failures."""
    os.makedirs(arguments.folder, exist_ok=True)
    program = os.path.abspath(arguments.program)
    store = Store(os.path.join(arguments.folder, "cells"), digest_of(program), arguments.again)
    bench = cells.Bench(program, os.path.abspath(arguments.folder), arguments.mode, arguments.runs, store)
    begin, loads = time.monotonic(), [os.getloadavg()[0]]
    try:
        for number, table in enumerate(arguments.tables, 1):
            bench.say(f"[{number}/{len(arguments.tables)}] {table} ({time.monotonic() - begin:.0f} s)")
            try:
                getattr(cells, table)(bench)
            except Failed as failure:
                bench.failures.append((table, str(failure)))
                bench.say(f"  {table}: FAILED: {failure}")
            loads.append(os.getloadavg()[0])
    finally:
        bench.close()
    bench.say(f"done ({time.monotonic() - begin:.0f} s)")
    result = {"schema": "reeb.bench.v1", "date": datetime.date.today().isoformat(), "mode": arguments.mode,
              "version": text_of([program, "--version"]), "machine": machine(arguments.folder),
              "load": {"least": min(loads), "most": max(loads)},
              "failures": [{"what": name, "why": why.replace(bench.folder + "/", "")} for name, why in bench.failures],
              "cells": store.all()}
    return result


def main():
    arguments = parse()
    stored = os.path.join(arguments.output, "benchmarks.json")
    if arguments.render:
        with open(stored, encoding="utf-8") as file:
            result = json.load(file)
    else:
        result = measure(arguments)
        os.makedirs(arguments.output, exist_ok=True)
        with open(stored + ".new", "w", encoding="utf-8") as file:
            json.dump(result, file, indent=1)
            file.write("\n")
        os.replace(stored + ".new", stored)
    document.write(result, arguments.output)
    print(f"wrote {os.path.join(arguments.output, 'BENCHMARKS.md')}", file=sys.stderr)
    for failure in result["failures"]:
        print(f"failed: {failure['what']}: {failure['why']}", file=sys.stderr)
    return 1 if result["failures"] else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("interrupted; the same command continues", file=sys.stderr)
        sys.exit(130)
