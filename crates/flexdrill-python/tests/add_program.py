"""Puts the program into a wheel: python add_program.py WHEEL PROGRAM.

PROGRAM is the wheel that maturin makes of the program alone. Its script and its bill of materials are added to WHEEL,
the wheel of the Python module, in place.
"""

from __future__ import annotations

import base64
import csv
import hashlib
import io
import sys
import zipfile
from pathlib import Path

PROGRAM = "flexdrill"
BOM = "program.cyclonedx.json"


def add_program(wheel: Path, program: Path) -> None:
    """Adds the program with its bill of materials to the wheel."""
    with zipfile.ZipFile(program) as archive:
        release = _release(archive, program)
        scripts = [name for name in archive.namelist() if "/scripts/" in name]
        if scripts != [f"{release}.data/scripts/{PROGRAM}"]:
            raise SystemExit(f"{program}: its scripts are {scripts}: must be {PROGRAM} alone")
        boms = [name for name in archive.namelist() if name.startswith(f"{release}.dist-info/sboms/")]
        if len(boms) != 1:
            raise SystemExit(f"{program}: its bills of materials are {boms}: must be one")
        content, bom = archive.read(scripts[0]), archive.read(boms[0])
    new = wheel.with_suffix(".part")
    with zipfile.ZipFile(wheel) as archive:
        if _release(archive, wheel) != release:
            raise SystemExit(f"{wheel} is {_release(archive, wheel)}, and {program} is {release}: must be the same")
        info = f"{release}.dist-info"
        if scripts[0] in archive.namelist():
            raise SystemExit(f"{wheel} has {scripts[0]} already")
        # The record comes last, as installers expect it.
        entries = {entry: archive.read(entry) for entry in archive.infolist() if entry.filename != f"{info}/RECORD"}
        date = archive.getinfo(f"{info}/METADATA").date_time
    entries[_entry(scripts[0], date, 0o755)] = content
    entries[_entry(f"{info}/sboms/{BOM}", date)] = bom
    entries[_entry(f"{info}/RECORD", date)] = _record(f"{info}/RECORD", entries)
    with zipfile.ZipFile(new, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for entry, data in entries.items():
            archive.writestr(entry, data, zipfile.ZIP_DEFLATED, 9)
    new.replace(wheel)


def _release(archive: zipfile.ZipFile, wheel: Path) -> str:
    """Name and version, which the folders of a wheel begin with."""
    for name in archive.namelist():
        folder = name.split("/")[0]
        if folder.endswith(".dist-info"):
            return folder.removesuffix(".dist-info")
    raise SystemExit(f"{wheel} is no wheel: it has no folder .dist-info")


def _entry(name: str, date: tuple[int, int, int, int, int, int], mode: int = 0o644) -> zipfile.ZipInfo:
    entry = zipfile.ZipInfo(name, date)
    entry.external_attr = (0o100000 | mode) << 16
    return entry


def _record(name: str, entries: dict[zipfile.ZipInfo, bytes]) -> bytes:
    """The list of all files with SHA-256 and size, as the wheel's format asks for it."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    for entry, data in entries.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        rows.writerow([entry.filename, f"sha256={digest}", len(data)])
    rows.writerow([name, "", ""])
    return text.getvalue().encode()


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit("two arguments are needed: WHEEL PROGRAM")
    add_program(*map(Path, sys.argv[1:]))
