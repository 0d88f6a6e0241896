"""What each function executes, counted by callgrind, without and with a list of options."""
import os
import re

from measure import Failed, run_once

SHOWN = 14  # functions


def without_brackets(text, open_mark, close_mark):
    """The text without what is in such brackets, also nested ones."""
    kept, depth = [], 0
    for mark in text:
        depth += mark == open_mark
        if depth == 0:
            kept.append(mark)
        depth -= mark == close_mark and depth > 0
    return "".join(kept)


def short_name(function, object_file):
    """reeb::Class::name for a function, without arguments and result; the library for one that has no name."""
    if function.startswith("0x"):
        return os.path.basename(object_file).split(".so")[0] + " (without names)"
    function = function.replace("(anonymous namespace)::", "").replace("operator()", "operator call")
    plain = without_brackets(without_brackets(function, "<", ">"), "(", ")").removesuffix(" const").strip()
    return plain if "operator" in plain else plain.split(" ")[-1]


def parsed(text):
    """Instructions by function, from what callgrind_annotate prints."""
    counts = {}
    for line in text.splitlines():
        found = re.match(r" *([\d,]+) \([^)]*\) +[^:]*:(.*)$", line)
        if found is None:
            continue
        name, _, object_file = found[2].partition(" [")
        name = short_name(name, object_file.rstrip("]"))
        counts[name] = counts.get(name, 0) + int(found[1].replace(",", ""))
    if not counts:
        raise Failed("callgrind_annotate printed no function")
    return counts


def counted(command, folder):
    out = os.path.join(folder, "callgrind.txt")
    run_once(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", *command])
    _, text = run_once(["callgrind_annotate", "--threshold=100", out])
    os.remove(out)
    return parsed(text)


def compared(before, after, triangles):
    """Instructions a triangle, before and after: of the functions that grow most, of all others together, and of all."""
    grown = sorted(after, key=lambda name: (before.get(name, 0) - after[name], name))[:SHOWN]
    rows = [(name, before.get(name, 0), after[name]) for name in grown]
    rows.append(("other functions", *(sum(count for name, count in counts.items() if name not in grown)
                                      for counts in (before, after))))
    rows.append(("all", sum(before.values()), sum(after.values())))
    return [[name, first / triangles, second / triangles] for name, first, second in rows]
