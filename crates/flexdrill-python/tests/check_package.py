"""Checks what was built: python check_package.py DIST [ARCHITECTURE...]. Names, size and contents of the wheels, their
bills of materials and licences, and that the sdist is complete. The wheels for the architectures that are named must
have the program, and others must not."""

from __future__ import annotations

import json
import re
import sys
import tarfile
import zipfile
from email import message_from_bytes
from pathlib import Path

MOST_BYTES = 15_000_000
ROOT = Path(__file__).resolve().parents[3]
LICENCES = ["LICENSE-APACHE", "LICENSE-MIT"]
PROGRAM_BOM = "program.cyclonedx.json"
OF_MODULE = ["flexdrill-config", "flexdrill-core", "numpy", "pyo3"]
OF_PROGRAM = ["flexdrill-core", "flexdrill-dashboard", "flexdrill-field-log", "flexdrill-ros2", "ratatui", "rustdds"]
"""Components that the bills of materials must name."""
CONFIGS = ["coarse.yaml", "default.yaml", "paper.yaml", "rig.yaml"]
WHEEL_NAME = re.compile(r"flexdrill-[\d.]+-cp39-abi3-manylinux2014_(x86_64|aarch64)\.manylinux_2_17_\1\.whl")
MACHINES = {"x86_64": 62, "aarch64": 183}
"""`e_machine` of an ELF file: EM_X86_64, EM_AARCH64."""
PERMITTED = {"MIT", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause"}
"""A component may be used under one of these; `deny.toml` has the same, and the exceptions below."""
NOT_COMPILED = {"ar_archive_writer", "terminfo", "wezterm-bidi", "zlib-rs"}
"""maturin lists optional dependencies of dependencies too, also those that no build here turns on."""
EXCEPTIONS = {
    "foldhash": "Zlib",
    "unicode-ident": "Unicode-3.0",
    "target-lexicon": "Apache-2.0 WITH LLVM-exception",
}


def check_wheel(wheel: Path, with_program: list[str]) -> None:
    name = WHEEL_NAME.fullmatch(wheel.name)
    if name is None:
        raise SystemExit(f"{wheel.name}: its name must match {WHEEL_NAME.pattern}")
    size = wheel.stat().st_size
    if size > MOST_BYTES:
        raise SystemExit(f"{wheel.name} has {size} bytes: must be at most {MOST_BYTES}")
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        info = next(entry.split("/")[0] for entry in names if ".dist-info/" in entry)
        needed = ["flexdrill/py.typed", "flexdrill/_native.abi3.so", "flexdrill/_native.pyi", f"{info}/METADATA"]
        same = {f"flexdrill/configs/{config}": ROOT / "config" / config for config in CONFIGS}
        same.update({f"{info}/licenses/{licence}": ROOT / licence for licence in LICENCES})
        program = f"{info.removesuffix('.dist-info')}.data/scripts/flexdrill"
        has_program = name[1] in with_program
        if has_program:
            needed += [program, f"{info}/sboms/{PROGRAM_BOM}"]
        missing = [entry for entry in [*needed, *same] if entry not in names]
        boms = [entry for entry in names if entry.startswith(f"{info}/sboms/")]
        if missing or len(boms) != 1 + has_program:
            raise SystemExit(f"{wheel.name}: missing {missing}, bills of materials {boms}, must be {1 + has_program}")
        if not has_program and program in names:
            raise SystemExit(f"{wheel.name} has a program: must have none")
        for entry, source in same.items():
            if archive.read(entry) != source.read_bytes():
                raise SystemExit(f"{wheel.name}: {entry} is not {source}")
        for file in ["flexdrill/_native.abi3.so", *([program] if has_program else [])]:
            machine = int.from_bytes(archive.read(file)[18:20], "little")
            if machine != MACHINES[name[1]]:
                raise SystemExit(f"{wheel.name}: machine {machine} of {file} must be {MACHINES[name[1]]}")
        metadata = message_from_bytes(archive.read(f"{info}/METADATA"))
        components: list[int] = []
        for bom in boms:
            wanted = OF_PROGRAM if bom.endswith(f"/{PROGRAM_BOM}") else OF_MODULE
            components.append(check_bom(archive.read(bom), wanted))
    licences = (metadata["License-Expression"], sorted(metadata.get_all("License-File", [])))
    if licences != ("MIT OR Apache-2.0", LICENCES):
        raise SystemExit(f"{wheel.name}: METADATA names the licences {licences}")
    with_or_without = "with the program" if has_program else "without the program"
    print(
        f"{wheel.name}: {size / 1e6:.1f} MB, {with_or_without}, {len(names)} files, "
        f"bills of materials of {' and '.join(map(str, components))} components"
    )


def check_bom(text: bytes, needed: list[str]) -> int:
    """The number of components of a CycloneDX bill of materials, all with a version and a permitted licence."""
    bom = json.loads(text)
    names = {component["name"] for component in bom["components"]}
    missing = [name for name in needed if name not in names]
    if bom["bomFormat"] != "CycloneDX" or missing:
        raise SystemExit(f"bill of materials: format {bom['bomFormat']}, missing {missing}")
    for component in bom["components"]:
        name = component["name"]
        licence = " AND ".join(entry["expression"] for entry in component.get("licenses", []))
        # One choice must be permitted. With AND, as in unicode-ident's, every part of it must be.
        choices = [{part.strip(" ()") for part in choice.split(" AND ")} for choice in re.split(r" OR |/", licence)]
        permitted = any(choice <= PERMITTED | {EXCEPTIONS.get(name)} for choice in choices)
        if not component.get("version") or not (permitted or name in NOT_COMPILED):
            raise SystemExit(f"bill of materials: {name} {component.get('version')}, licence {licence!r}: not permitted")
    return len(bom["components"])


def check_sdist(sdist: Path) -> None:
    root = sdist.name.removesuffix(".tar.gz")
    needed = ["pyproject.toml", "PKG-INFO", "Cargo.lock", *LICENCES]
    needed += [f"crates/{name}/Cargo.toml" for name in ("flexdrill-config", "flexdrill-core", "flexdrill-python")]
    with tarfile.open(sdist) as archive:
        files = {member.name: member for member in archive.getmembers()}
        missing = [name for name in needed if f"{root}/{name}" not in files]
        links = [name for name, member in files.items() if not member.isfile()]
        configs = [name for name in files if name.rpartition("/configs/")[2] in CONFIGS]
        if missing or links or len(configs) != len(CONFIGS):
            raise SystemExit(f"{sdist.name}: missing {missing}, no plain files {links}, configurations {configs}")
        for name in configs:
            text = archive.extractfile(name)
            if text is None or text.read() != (ROOT / "config" / name.rpartition("/")[2]).read_bytes():
                raise SystemExit(f"{sdist.name}: {name} is not the one in config/")
    print(f"{sdist.name}: {sdist.stat().st_size / 1e6:.1f} MB, {len(files)} files")


def main() -> None:
    dist = Path(sys.argv[1])
    wheels, sdists = sorted(dist.glob("*.whl")), sorted(dist.glob("*.tar.gz"))
    if not wheels or len(sdists) != 1:
        raise SystemExit(f"{dist}: {len(wheels)} wheels and {len(sdists)} sdists, must be one or more and one")
    for wheel in wheels:
        check_wheel(wheel, sys.argv[2:])
    check_sdist(sdists[0])


if __name__ == "__main__":
    main()
