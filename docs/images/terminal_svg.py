"""Draws what a full-screen program shows as an SVG: the picture of the README.

    python3 -m venv /tmp/venv && /tmp/venv/bin/pip install pyte==0.8.2
    # beside a running twin and rig:
    /tmp/venv/bin/python docs/images/terminal_svg.py docs/images/run.svg --seconds 35 -- target/release/flexdrill watch
"""

import argparse
import fcntl
import html
import os
import pty
import select
import signal
import struct
import termios
import time

import pyte

CELL_WIDTH, CELL_HEIGHT, FONT_SIZE = 8.4, 17, 14
BACKGROUND, FOREGROUND = "#1b1f23", "#d6dae0"
COLORS = {
    "black": "#1b1f23", "red": "#e5534b", "green": "#57ab5a", "brown": "#d0a215", "yellow": "#d0a215",
    "blue": "#539bf5", "magenta": "#c678dd", "cyan": "#56b6c2", "white": "#f0f3f6",
}


def capture(command, seconds, columns, rows):
    """The screen after `seconds`; the program is then told to end."""
    screen = pyte.Screen(columns, rows)
    stream = pyte.ByteStream(screen)
    pid, terminal = pty.fork()
    if pid == 0:
        os.environ["TERM"] = "xterm-256color"
        os.execvp(command[0], command)
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if select.select([terminal], [], [], 0.1)[0]:
            stream.feed(os.read(terminal, 65536))
    os.kill(pid, signal.SIGTERM)
    os.waitpid(pid, 0)
    return screen


def color(name, default):
    if name == "default":
        return default
    return COLORS.get(name.replace("bright", ""), f"#{name}" if len(name) == 6 else default)


def draw(screen):
    width, height = screen.columns * CELL_WIDTH + 16, screen.lines * CELL_HEIGHT + 16
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height}" width="{width:.0f}" height="{height}">',
        f'<rect width="100%" height="100%" rx="6" fill="{BACKGROUND}"/>',
        f'<g font-family="DejaVu Sans Mono, Menlo, Consolas, monospace" font-size="{FONT_SIZE}" xml:space="preserve">',
    ]
    for row in range(screen.lines):
        y = 8 + row * CELL_HEIGHT
        for column in range(screen.columns):
            cell = screen.buffer[row][column]
            front, back = color(cell.fg, FOREGROUND), color(cell.bg, BACKGROUND)
            if cell.reverse:
                front, back = back, front
            x = 8 + column * CELL_WIDTH
            if back != BACKGROUND:
                out.append(f'<rect x="{x:.1f}" y="{y}" width="{CELL_WIDTH + 0.3:.1f}" height="{CELL_HEIGHT}" fill="{back}"/>')
            if cell.data.strip():
                weight = ' font-weight="bold"' if cell.bold else ""
                text = html.escape(cell.data)
                out.append(f'<text x="{x:.1f}" y="{y + CELL_HEIGHT - 4}" fill="{front}"{weight}>{text}</text>')
    return "\n".join([*out, "</g>", "</svg>", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--columns", type=int, default=100)
    parser.add_argument("--rows", type=int, default=30)
    parser.add_argument("command", nargs="+")
    given = parser.parse_args()
    with open(given.out, "w", encoding="utf-8") as file:
        file.write(draw(capture(given.command, given.seconds, given.columns, given.rows)))


if __name__ == "__main__":
    main()
