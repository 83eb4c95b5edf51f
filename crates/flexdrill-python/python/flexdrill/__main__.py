"""`python -m flexdrill`: the program `flexdrill` of this package, with the same arguments."""

from __future__ import annotations

import importlib.metadata
import os
import sys
from pathlib import Path
from typing import Optional

NO_PROGRAM = """\
error: {package} has no program flexdrill.
Released wheels have it for x86-64 and 64-bit ARM with Linux; a package that was compiled from source has the Python
module alone. To get the program, install a released wheel (pip install --force-reinstall --only-binary flexdrill
flexdrill), the Debian package, or compile it in a clone of the repository (cargo install --path . --features full)."""


def program() -> Optional[Path]:
    """The program that was installed with this package; none where the package was built without it.

    A program of the same name elsewhere in PATH may be of another version, and is not taken.
    """
    package = Path(__file__).resolve().parent
    try:
        recorded = importlib.metadata.files("flexdrill") or []
    except importlib.metadata.PackageNotFoundError:
        recorded = []
    candidates = [Path(str(file.locate())) for file in recorded if file.parts[-2:] == ("bin", "flexdrill")]
    # `pip install --target` moves packages and programs into one folder, and leaves the old path in its record.
    candidates.append(package.parent / "bin" / "flexdrill")
    return next((path.resolve() for path in candidates if path.is_file()), None)


def main() -> None:
    """Becomes the program, so that signals and the exit code are the program's own."""
    found = program()
    if found is None:
        sys.exit(NO_PROGRAM.format(package=Path(__file__).resolve().parent))
    try:
        os.execv(found, [str(found), *sys.argv[1:]])
    except OSError as error:
        sys.exit(f"error: {found} cannot be started: {error.strerror}")


if __name__ == "__main__":
    main()
