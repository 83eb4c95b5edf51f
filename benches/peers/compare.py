#!/usr/bin/env python3
"""The same tool in EXUDYN and in flexdrill, one after the other, one thread each; prints a Markdown table. See README.md."""

import argparse
import json
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def exudyn(args):
    command = [sys.executable, str(HERE / "exudyn_tool.py")]
    command += ["--start-up", str(args.start_up), "--duration", str(args.duration), "--step", str(args.step)]
    out = subprocess.run(command, check=True, capture_output=True, text=True, timeout=args.timeout).stdout
    return json.loads(out.splitlines()[-1])


def flexdrill(args):
    """Rows of `flexdrill bench` by their name."""
    command = [str(args.binary), "bench", "--config", str(ROOT / "config/default.yaml")]
    command += ["--duration", str(args.flexdrill_duration)]
    out = subprocess.run(command, check=True, capture_output=True, text=True, timeout=args.timeout).stdout
    return dict(re.findall(r"^\| (.+?) \| (.+?) \|$", out, re.M))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--binary", type=pathlib.Path, default=ROOT / "target/release/flexdrill")
    parser.add_argument("--start-up", type=float, default=0.2, help="EXUDYN's model time before it is measured (s)")
    parser.add_argument("--duration", type=float, default=0.1, help="EXUDYN's measured model time (s)")
    parser.add_argument("--step", type=float, default=2.5e-4, help="EXUDYN's step (s)")
    parser.add_argument("--flexdrill-duration", type=float, default=20.0, help="model time (s)")
    parser.add_argument("--timeout", type=float, default=1800.0, help="of each program (s)")
    args = parser.parse_args()
    print("EXUDYN runs; this takes minutes", file=sys.stderr)
    theirs = exudyn(args)
    print("flexdrill runs", file=sys.stderr)
    ours = flexdrill(args)
    measured, start = theirs["measured"], theirs["start_up"]
    per_second = measured["cpu"] / measured["model_time"]
    factor = float(ours["real-time factor, of processor time"].split(",")[1])
    unknowns, step = ours["unknowns, step"].split(", ")
    iterations = ours["Newton iterations per step: mean, most"].split(",")[0]
    rows = [
        ("", f"EXUDYN {theirs['exudyn']}", "flexdrill"),
        ("---", "---", "---"),
        ("unknowns: displacements, multipliers", f"{theirs['unknowns'][0]}, {theirs['unknowns'][1]}", unknowns),
        ("contacts with friction", str(theirs["contacts"]), "332"),
        ("step asked for", f"{1e3 * theirs['step']:g} ms", step),
        ("mean step taken", f"{1e3 * measured['model_time'] / measured['steps']:.3g} ms", step),
        ("Newton iterations per step", f"{measured['newton'] / measured['steps']:.1f}", iterations),
        ("Jacobians per step", f"{measured['jacobians'] / measured['steps']:.1f}", iterations),
        (
            "model time measured",
            f"{measured['model_time']:g} s after {start['model_time']:g} s",
            f"{args.flexdrill_duration:g} s from rest",
        ),
        ("processor time per simulated second", f"{per_second:.1f} s", f"{1 / factor:.3f} s"),
        ("of the start-up", f"{start['cpu'] / start['model_time']:.1f} s", ""),
        ("real-time factor (of processor time)", f"{1 / per_second:.4f}", f"{factor:.2f}"),
        ("ratio", "1", f"{factor * per_second:.0f}"),
    ]
    for row in rows:
        print(f"| {' | '.join(row)} |")


if __name__ == "__main__":
    main()
