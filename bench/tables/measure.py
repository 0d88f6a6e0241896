"""Runs of a program, measured as whole processes, and figures of several runs."""
import functools
import json
import os
import signal
import subprocess
import tempfile
import threading
import time


class Failed(Exception):
    """A command that failed or took too long; the text says which and why."""


def median(values):
    """The middle value; the mean of the two middle values of an even number."""
    ordered = sorted(values)
    half = len(ordered) // 2
    if len(ordered) % 2 == 1:
        return ordered[half]
    return (ordered[half - 1] + ordered[half]) / 2


def summary(values):
    return {"min": min(values), "median": median(values), "max": max(values)}


def _io_of(pid):
    """Bytes that the process read and wrote: by calls, and from and to devices."""
    try:
        with open(f"/proc/{pid}/io", encoding="ascii") as file:
            fields = dict(line.split(": ") for line in file.read().splitlines())
        return {name: int(fields[name]) for name in ("rchar", "wchar", "read_bytes", "write_bytes")}
    except (OSError, KeyError, ValueError):
        return {}  # the system does not tell


def run_once(command, seconds_limit=3600, environment=None):
    """Runs it once. Returns its wall and processor seconds, peak memory, and bytes moved; and what it printed."""
    fields, text = _run_timed(command, seconds_limit, environment)
    fields["wall"] = max(0, fields["wall"] - _seconds_of_measuring())
    return fields, text


@functools.cache
def _seconds_of_measuring():
    """What measuring adds to the wall seconds of a run, mostly the start of GNU time: the difference of the medians of
    runs of `true` in turns, measured and by itself."""
    measured, alone = [], []
    for _ in range(15):
        measured.append(_run_timed(["true"])[0]["wall"])
        begin = time.perf_counter()
        subprocess.call(["true"], stdin=subprocess.DEVNULL)
        alone.append(time.perf_counter() - begin)
    return max(0, median(measured) - median(alone))


def _run_timed(command, seconds_limit=3600, environment=None):
    """GNU time starts it, since a process inherits the peak memory of the one that forked it."""
    with tempfile.NamedTemporaryFile() as times:
        timed = ["/usr/bin/time", "-q", "-f", "%M", "-o", times.name, *command]
        begin = time.perf_counter()
        try:
            process = subprocess.Popen(timed, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                       stderr=subprocess.STDOUT, start_new_session=True,
                                       env={**os.environ, **(environment or {})})
        except FileNotFoundError as error:
            raise Failed("GNU time is not installed: apt-get install time") from error
        too_long = threading.Event()

        def stop():
            too_long.set()
            os.killpg(process.pid, signal.SIGKILL)

        watch = threading.Timer(seconds_limit, stop)
        watch.start()
        try:
            with process.stdout:
                text = process.stdout.read().decode(errors="replace")
            os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
        except BaseException:  # also Ctrl-C, which the session does not get
            watch.cancel()
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            raise
        wall = time.perf_counter() - begin
        watch.cancel()
        transferred = _io_of(process.pid)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = code = os.waitstatus_to_exitcode(status)
        if too_long.is_set():
            raise Failed(f"not done in {seconds_limit} s")
        if code != 0:
            lines = text.strip().splitlines()
            error = next((line for line in lines if "error" in line.lower()), lines[-1] if lines else "")
            raise Failed(f"exit code {code}: {error}")
        peak = int(times.read()) * 1024
    return {"wall": wall, "processor": usage.ru_utime + usage.ru_stime, "peak_bytes": peak, **transferred}, text


def figures(runs):
    """Of several runs with the same fields: each field's least, median and largest value."""
    fields = [name for name in runs[0] if all(name in run for run in runs)]
    return {"runs": len(runs), **{name: summary([run[name] for run in runs]) for name in fields}}


class Store:
    """Figures by name, in a folder, each in a file of its own that appears when it is whole."""

    def __init__(self, folder, program, again=False):
        self.folder, self.program = folder, program
        self.again, self.fresh = again, set()
        os.makedirs(folder, exist_ok=True)

    def _path(self, name):
        return os.path.join(self.folder, name.replace("/", ",") + ".json")

    def find(self, name):
        """What is stored under the name for this program, or None."""
        if self.again and name not in self.fresh:
            return None
        try:
            with open(self._path(name), encoding="utf-8") as file:
                cell = json.load(file)
        except (OSError, ValueError):
            return None
        return cell if cell.get("program") == self.program else None

    def put(self, name, cell):
        path = self._path(name)
        with open(path + ".new", "w", encoding="utf-8") as file:
            json.dump({"name": name, "program": self.program, **cell}, file, indent=1)
        os.replace(path + ".new", path)
        self.fresh.add(name)

    def all(self):
        """Every figure of this program, by name."""
        cells = {}
        for entry in sorted(os.listdir(self.folder)):
            if not entry.endswith(".json"):
                continue
            with open(os.path.join(self.folder, entry), encoding="utf-8") as file:
                cell = json.load(file)
            if cell.pop("program") == self.program:
                cells[cell.pop("name")] = cell
        return cells
