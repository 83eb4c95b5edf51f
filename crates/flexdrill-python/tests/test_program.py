"""The program in a package: put into a wheel, found where installers put it, and missed with a reason."""

from __future__ import annotations

import base64
import csv
import hashlib
import io
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from add_program import add_program

import flexdrill

ECHO = '#!/bin/sh\nprintf "%s\\n" "$@"\nexit 3\n'
"""In place of the program: it prints its arguments and ends with a code that Python does not use."""
INFO = "flexdrill-1.2.3.dist-info"
METADATA = "Metadata-Version: 2.4\nName: flexdrill\nVersion: 1.2.3\nLicense-File: LICENSE-MIT\n\nText: none\n"


def zip_file(path: Path, entries: dict[str, str]) -> Path:
    with zipfile.ZipFile(path, "w") as archive:
        for name, text in entries.items():
            archive.writestr(name, text)
    return path


@pytest.fixture
def module(tmp_path: Path) -> Path:
    """A wheel with this package's way to the program, and without the mechanics."""
    main = Path(flexdrill.__file__).with_name("__main__.py").read_text()
    tags = "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: false\nTag: py3-none-any\n"
    return zip_file(
        tmp_path / "flexdrill-1.2.3-py3-none-any.whl",
        {
            "flexdrill/__init__.py": "",
            "flexdrill/__main__.py": main,
            f"{INFO}/METADATA": METADATA,
            f"{INFO}/WHEEL": tags,
            f"{INFO}/RECORD": f"flexdrill/__init__.py,,\nflexdrill/__main__.py,,\n{INFO}/RECORD,,\n",
        },
    )


@pytest.fixture
def wheel(module: Path, tmp_path: Path) -> Path:
    """The same with a program."""
    program = zip_file(
        tmp_path / "program.whl",
        {"flexdrill-1.2.3.data/scripts/flexdrill": ECHO, f"{INFO}/sboms/any.json": "{}", f"{INFO}/METADATA": METADATA},
    )
    add_program(module, program)
    return module


def install(wheel: Path, *where: str) -> None:
    """Nothing is asked of a network."""
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", "--no-compile"]
    pip += ["--disable-pip-version-check", "--ignore-installed"]
    subprocess.run([*pip, *where, str(wheel)], check=True, timeout=120)


def start(packages: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "flexdrill", *arguments]
    environment = {**os.environ, "PYTHONPATH": str(packages)}
    return subprocess.run(command, env=environment, cwd=packages, capture_output=True, text=True, timeout=60)


def test_the_record_of_a_wheel_with_a_program_is_complete(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        rows = list(csv.reader(io.StringIO(archive.read(f"{INFO}/RECORD").decode())))
        assert [row[0] for row in rows] == names and names[-1] == f"{INFO}/RECORD"
        for name, digest, size in rows[:-1]:
            data = archive.read(name)
            expected = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).decode().rstrip("=")
            assert (digest, int(size)) == (f"sha256={expected}", len(data)), name
        assert archive.read("flexdrill-1.2.3.data/scripts/flexdrill").decode() == ECHO
        mode = archive.getinfo("flexdrill-1.2.3.data/scripts/flexdrill").external_attr >> 16
        assert mode & 0o777 == 0o755
        assert archive.read(f"{INFO}/METADATA").decode() == METADATA
        assert archive.read(f"{INFO}/sboms/program.cyclonedx.json") == b"{}"


def test_a_program_of_another_version_is_refused(module: Path, tmp_path: Path) -> None:
    other = zip_file(
        tmp_path / "other.whl",
        {"flexdrill-1.2.4.data/scripts/flexdrill": ECHO, "flexdrill-1.2.4.dist-info/sboms/any.json": "{}"},
    )
    before = module.read_bytes()
    with pytest.raises(SystemExit, match="must be the same"):
        add_program(module, other)
    assert module.read_bytes() == before


def test_the_program_is_found_in_an_environment(wheel: Path, tmp_path: Path) -> None:
    install(wheel, "--prefix", str(tmp_path / "prefix"))
    (packages,) = (tmp_path / "prefix").glob("l*/python*/*-packages")
    done = start(packages, "demo", "--seconds", "a b")
    assert (done.stdout, done.returncode) == ("demo\n--seconds\na b\n", 3), done.stderr


def test_the_program_is_found_next_to_packages_in_a_folder(wheel: Path, tmp_path: Path) -> None:
    install(wheel, "--target", str(tmp_path / "folder"))
    done = start(tmp_path / "folder", "demo")
    assert (done.stdout, done.returncode) == ("demo\n", 3), done.stderr


def test_a_package_without_a_program_says_how_to_get_one(module: Path, tmp_path: Path) -> None:
    install(module, "--target", str(tmp_path / "folder"))
    done = start(tmp_path / "folder", "demo")
    assert done.returncode == 1 and done.stdout == ""
    assert f"error: {tmp_path / 'folder' / 'flexdrill'} has no program flexdrill." in done.stderr
    assert "cargo install --path . --features full" in done.stderr


def test_a_program_that_cannot_be_started_is_named(wheel: Path, tmp_path: Path) -> None:
    install(wheel, "--target", str(tmp_path / "folder"))
    program = tmp_path / "folder" / "bin" / "flexdrill"
    # An ELF file of no machine.
    program.write_bytes(b"\x7fELF")
    done = start(tmp_path / "folder", "demo")
    assert done.returncode == 1 and f"error: {program} cannot be started: " in done.stderr
