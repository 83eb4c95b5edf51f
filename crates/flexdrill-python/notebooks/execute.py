"""Executes the notebooks: python execute.py --out FOLDER [NAME...]

Each .py file of this folder (percent format: open it in VS Code, or in Jupyter with jupytext) becomes a notebook with
its outputs, and the pictures become PNG files. A cell that fails ends the command with an error. It needs the package,
jupytext, nbconvert and ipykernel in the interpreter that runs it.
"""

from __future__ import annotations

import argparse
import base64
import json
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
LONGEST_S = 900
NEED_THE_PROGRAM = ("rig_bag",)


def call(*arguments: object) -> None:
    """Runs a module of this interpreter."""
    environment = {
        "FLEXDRILL_ROOT": str(HERE.parents[2]),
        **os.environ,
        "MPLBACKEND": "module://matplotlib_inline.backend_inline",
    }
    command = [sys.executable, "-m", *map(str, arguments)]
    subprocess.run(command, check=True, timeout=LONGEST_S + 60, env=environment)


def execute(source: Path, out: Path) -> None:
    """Writes the notebook and its pictures, and prints what it printed."""
    target = out / f"{source.stem}.ipynb"
    call("jupytext", "--quiet", "--to", "ipynb", "--output", target, source)
    longest = f"--ExecutePreprocessor.timeout={LONGEST_S}"
    call("nbconvert", "--to", "notebook", "--execute", "--inplace", "--log-level=ERROR", longest, target)
    cells = json.loads(target.read_text())["cells"]
    outputs = [output for cell in cells for output in cell.get("outputs", [])]
    pictures = [output["data"]["image/png"] for output in outputs if "image/png" in output.get("data", {})]
    if not pictures:
        raise SystemExit(f"{source.name}: it drew no picture")
    for number, picture in enumerate(pictures):
        (out / f"{source.stem}_{number}.png").write_bytes(base64.b64decode(picture))
    text = "".join("".join(output.get("text", [])) for output in outputs if output.get("name") == "stdout")
    print(f"--- {source.stem}: {len(pictures)} pictures\n{text}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("names", nargs="*")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    for source in sorted(path for path in HERE.glob("*.py") if path != Path(__file__).resolve()):
        if given.names and source.stem not in given.names:
            continue
        if source.stem in NEED_THE_PROGRAM and "FLEXDRILL_BINARY" not in os.environ:
            print(f"SKIPPED: {source.stem}: FLEXDRILL_BINARY does not name the program")
            continue
        execute(source, given.out)


if __name__ == "__main__":
    main()
