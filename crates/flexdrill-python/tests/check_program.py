"""Tries the program of the installed package: python check_program.py.

It is run by the Python of a clean environment. The demonstration is shown once in a terminal, ended by its key, and once
without a terminal, ended by a signal. Neither may leave a process behind.
"""

from __future__ import annotations

import fcntl
import importlib.metadata
import os
import pty
import select
import signal
import struct
import subprocess
import sys
import sysconfig
import termios
import time
from pathlib import Path

PROGRAM = Path(sysconfig.get_path("scripts")) / "flexdrill"
DEADLINE_S = 120.0
"""For a view that shows the twin. It takes three seconds on an idle machine."""
ENDING_S = 60.0
"""For the end of all processes: each of the three has ten seconds before it is killed."""
LEAST_PROCESSES = 4
"""The demonstration itself, twin, rig and view; each of these has a DDS process of the same program."""
ROWS, COLUMNS = 40, 120
"""Size of the terminal, which has none by itself."""


def output(*command: str) -> str:
    """What a command prints; it must succeed."""
    done = subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE_S, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)}: exit code {done.returncode}: {done.stderr}")
    return done.stdout


def running() -> list[int]:
    """Processes of this very program. Those that have ended, and wait for their parent, have no path."""
    found: list[int] = []
    for process in Path("/proc").iterdir():
        try:
            if process.name.isdigit() and (process / "exe").resolve(strict=True) == PROGRAM.resolve():
                found.append(int(process.name))
        except OSError:
            continue
    return found


def read(source: int, wanted: bytes) -> None:
    """Reads until the view shows what is wanted."""
    text = b""
    deadline = time.monotonic() + DEADLINE_S
    while wanted not in text:
        ready, _, _ = select.select([source], [], [], 1.0)
        try:
            more = os.read(source, 65536) if ready else b""
        except OSError:
            # The terminal has no other side.
            raise SystemExit(f"the demonstration ended before it showed {wanted!r}: {text!r}") from None
        if ready and not more:
            raise SystemExit(f"the demonstration ended before it showed {wanted!r}: {text!r}")
        text += more
        if time.monotonic() > deadline:
            raise SystemExit(f"the demonstration did not show {wanted!r} within {DEADLINE_S:.0f} s: {text!r}")


def demonstrate(arguments: list[str], wanted: bytes, end: str) -> None:
    """Shows the demonstration until it shows what is wanted, and ends it."""
    if end == "q":
        ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
    else:
        ours, theirs = os.pipe()
    command = [str(PROGRAM), "demo", *arguments]
    process = subprocess.Popen(
        command,
        stdin=theirs if end == "q" else subprocess.DEVNULL,
        stdout=theirs,
        stderr=theirs,
        start_new_session=True,
    )
    os.close(theirs)
    try:
        read(ours, wanted)
        found = running()
        if len(found) < LEAST_PROCESSES:
            raise SystemExit(f"{len(found)} processes run: must be {LEAST_PROCESSES} or more")
        if end == "q":
            os.write(ours, b"q")
        else:
            process.send_signal(signal.SIGINT)
        code = ended(process, ours)
        if code != 0:
            raise SystemExit(f"the demonstration ended with exit code {code}: must be 0")
        deadline = time.monotonic() + ENDING_S
        while remaining := running():
            if time.monotonic() > deadline:
                raise SystemExit(f"processes {remaining} outlive the demonstration")
            time.sleep(0.05)
    finally:
        process.kill()
        process.wait()
        os.close(ours)
    print(f"flexdrill demo {' '.join(arguments)}: {len(found)} processes, none remains after {end}")


def ended(process: subprocess.Popen[bytes], source: int) -> int:
    """The exit code. What is printed meanwhile is read, so that no process waits for a reader."""
    deadline = time.monotonic() + ENDING_S
    while process.poll() is None:
        if time.monotonic() > deadline:
            raise SystemExit(f"the demonstration does not end within {ENDING_S:.0f} s")
        try:
            if select.select([source], [], [], 0.05)[0]:
                os.read(source, 65536)
        except OSError:
            time.sleep(0.05)
    return process.returncode


def main() -> None:
    version = output(str(PROGRAM), "--version").strip()
    wanted = f"flexdrill {importlib.metadata.version('flexdrill')}"
    if not version.startswith(wanted):
        raise SystemExit(f"the program is {version!r}: must be {wanted}")
    if output(sys.executable, "-m", "flexdrill", "--version").strip() != version:
        raise SystemExit("python -m flexdrill is another program than flexdrill")
    if not output(str(PROGRAM), "check", "rig").strip():
        raise SystemExit("flexdrill check rig says nothing")
    demonstrate([], b"RUNNING", "q")
    demonstrate(["--plain"], b"RUNNING", "SIGINT")
    print(f"{version}: {PROGRAM.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
