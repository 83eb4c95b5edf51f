"""Executes the notebooks: python execute.py --python PYTHON --out FOLDER [NAME...]

Each .py file of this folder (percent format: open it in VS Code, or in Jupyter with jupytext) becomes a notebook with
its outputs, and the pictures become PNG files. A cell that fails ends the command with an error.
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


def execute(source: Path, python: str, out: Path) -> int:
    """Returns how many pictures the notebook drew."""
    target = out / f"{source.stem}.ipynb"
    environment = {
        **os.environ,
        "FLEXDRILL_ROOT": str(HERE.parents[2]),
        "MPLBACKEND": "module://matplotlib_inline.backend_inline",
    }
    subprocess.run(
        [sys.executable, "-m", "jupytext", "--quiet", "--to", "ipynb", "--output", target, source],
        check=True,
        timeout=120,
    )
    subprocess.run(
        [sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--inplace", "--log-level=ERROR",
         f"--ExecutePreprocessor.timeout={LONGEST_S}", target],
        check=True, timeout=LONGEST_S + 60, env={**environment, "PATH": f"{Path(python).parent}:{os.environ['PATH']}"},
    )  # fmt: skip
    cells = json.loads(target.read_text())["cells"]
    outputs = [output for cell in cells for output in cell.get("outputs", [])]
    pictures = [output["data"]["image/png"] for output in outputs if "image/png" in output.get("data", {})]
    for number, picture in enumerate(pictures):
        (out / f"{source.stem}_{number}.png").write_bytes(base64.b64decode(picture))
    text = "".join("".join(output.get("text", [])) for output in outputs if output.get("name") == "stdout")
    print(f"--- {source.stem}: {len(pictures)} pictures\n{text}", flush=True)
    return len(pictures)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--python", default=sys.executable, help="interpreter that has the package")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("names", nargs="*")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    sources = sorted(path for path in HERE.glob("*.py") if path != Path(__file__).resolve())
    chosen = [source for source in sources if not given.names or source.stem in given.names]
    for source in chosen:
        execute(source, given.python, given.out)


if __name__ == "__main__":
    main()
