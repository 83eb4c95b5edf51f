#!/usr/bin/env python3
"""Works on a sweep with Dask, for Python teams that have a Dask cluster.

    python3 sweep_dask.py tcp://SCHEDULER:8786 DIR [CHUNKS]

DIR must be the same folder on every worker's machine. Every task computes a part of the points; a task whose worker is
lost runs again on another one, and computes only what has no result yet. Needs the package `distributed` here and on the
workers (pip install distributed), and the program `flexdrill` (or FLEXDRILL_BINARY) there.
"""

import os
import subprocess
import sys

try:
    from distributed import Client, as_completed
except ImportError as missing:
    raise SystemExit(f"{missing.name} is missing: pip install distributed") from None


def work(program: str, folder: str, part: int, parts: int) -> str:
    """Computes a part of the points. It may run twice: the results are the same bytes."""
    done = subprocess.run(
        [program, "sweep", "work", folder, "--chunk", f"{part}/{parts}"],
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        raise RuntimeError(done.stderr.strip())
    return done.stdout.strip()


def main() -> int:
    if len(sys.argv) not in (3, 4):
        print(__doc__, file=sys.stderr)
        return 2
    folder = os.path.realpath(sys.argv[2])
    parts = int(sys.argv[3]) if len(sys.argv) == 4 else 32
    program = os.environ.get("FLEXDRILL_BINARY", "flexdrill")
    with Client(sys.argv[1]) as client:
        # pure=False: equal calls are not one task. retries: a lost worker's task begins again elsewhere.
        tasks = [client.submit(work, program, folder, part, parts, retries=3, pure=False) for part in range(parts)]
        for task in as_completed(tasks, with_results=False):
            print(task.result(), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
