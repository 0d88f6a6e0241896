"""Runs docs/tutorial.py cell by cell, and writes it with all that it prints and draws.

    python3 docs/render_tutorial.py OUT.md        pictures are written beside it
"""

import ast
import contextlib
import io
import re
import sys
from pathlib import Path


def run(code, names):
    """What the cell prints, and the value of its last line if that is an expression."""
    tree = ast.parse(code)
    last = ast.Expression(tree.body.pop().value) if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(tree, "tutorial.py", "exec"), names)
        value = eval(compile(last, "tutorial.py", "eval"), names) if last else None
    return printed.getvalue(), value


def render(source, output):
    names, parts, pictures = {}, [], 0
    for kind, body in re.findall(r"^# %%( \[markdown\])?\n(.*?)(?=^# %%|\Z)", source, re.M | re.S):
        if kind:
            parts.append("\n".join(line[2:] for line in body.rstrip().split("\n")))
            continue
        parts.append(f"```python\n{body.strip()}\n```")
        printed, value = run(body, names)
        if hasattr(value, "svg"):
            pictures += 1
            name = f"{output.stem.lower()}-{pictures}.svg"
            (output.parent / name).write_text(value.svg)
            parts.append(f"![Picture {pictures}]({name})")
        elif value is not None:
            printed += f"{value!r}\n"
        if printed:
            parts.append(f"```text\n{printed.rstrip()}\n```")
    output.write_text("\n\n".join(parts) + "\n")


if __name__ == "__main__":
    render(Path(__file__).with_name("tutorial.py").read_text(), Path(sys.argv[1]))
