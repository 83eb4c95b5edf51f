"""Checks what was built: python check_package.py DIST. Size and contents of the wheel, and that the sdist is
complete."""

from __future__ import annotations

import sys
import tarfile
import zipfile
from pathlib import Path

MOST_BYTES = 15_000_000


def check_wheel(wheel: Path) -> None:
    size = wheel.stat().st_size
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        default = archive.read("flexdrill/configs/default.yaml")
    needed = ["flexdrill/py.typed", "flexdrill/_native.abi3.so", "flexdrill/_native.pyi", "flexdrill/configs/rig.yaml"]
    missing = [name for name in needed if name not in names]
    boms = [name for name in names if "/sboms/" in name]
    if missing or not boms or b"links: 33" not in default:
        raise SystemExit(f"{wheel.name}: missing {missing}, bills of materials {boms}")
    if size > MOST_BYTES:
        raise SystemExit(f"{wheel.name} has {size} bytes: must be at most {MOST_BYTES}")
    print(f"{wheel.name}: {size / 1e6:.1f} MB, {len(names)} files, bill of materials {boms[0]}")


def check_sdist(sdist: Path) -> None:
    with tarfile.open(sdist) as archive:
        names = archive.getnames()
        default = [member for member in archive.getmembers() if member.name.endswith("configs/default.yaml")]
    root = sdist.name.removesuffix(".tar.gz")
    needed = ["pyproject.toml", "PKG-INFO", "crates/flexdrill-core/Cargo.toml", "crates/flexdrill-config/Cargo.toml"]
    missing = [name for name in needed if f"{root}/{name}" not in names]
    if missing or len(default) != 1 or not default[0].isfile() or default[0].size < 10_000:
        raise SystemExit(f"{sdist.name}: missing {missing}; configurations {default}")
    print(f"{sdist.name}: {sdist.stat().st_size / 1e6:.1f} MB, {len(names)} files")


def main() -> None:
    dist = Path(sys.argv[1])
    wheels, sdists = sorted(dist.glob("*.whl")), sorted(dist.glob("*.tar.gz"))
    if len(wheels) != 1:
        raise SystemExit(f"{dist}: {len(wheels)} wheels, must be one")
    check_wheel(wheels[0])
    for sdist in sdists:
        check_sdist(sdist)


if __name__ == "__main__":
    main()
