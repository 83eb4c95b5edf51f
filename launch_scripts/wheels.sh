#!/usr/bin/env bash
# The Python package as it is released: launch_scripts/wheels.sh
# Builds into target/python/release: wheels for x86-64 and aarch64 (manylinux_2_17, linked by zig) and the sdist. It
# checks names, contents, licences, shared libraries and symbols; installs the sdist in a clean environment away from
# the repository, which compiles it; and runs the wheel in each Python from 3.9 to 3.14 that is here (pyenv's, or in
# PATH). All must give the same bits. Checks whose tools are missing are reported as NOT CHECKED and skipped.
set -euo pipefail
. "$(dirname "$0")/common.sh"
[ $# -eq 0 ] || { sed -n '2,6s/^# \{0,1\}//p' "$0" >&2 && exit 2; }
need_packages build-essential python3-venv
need_rust
cd "$root"
crate=$root/crates/flexdrill-python
out=$python_out
dist=$out/release
not_checked() { say "NOT CHECKED: $*"; }

# find_python VERSION: prints the newest interpreter of this version that starts, with venv and Python's global lock,
# which the stable interface requires.
find_python() {
    local candidate
    for candidate in $(find "${PYENV_ROOT:-$HOME/.pyenv}/versions" -maxdepth 3 -path "*/$1.*/bin/python$1" 2>/dev/null | sort -rV) \
        "/usr/bin/python$1" "/usr/local/bin/python$1" "$(command -v "python$1" || true)"; do
        if [ -n "$candidate" ] && "$candidate" - "$1" 2>/dev/null <<'CHECK'; then
import ensurepip, sys, sysconfig, venv
fits = "%d.%d" % sys.version_info[:2] == sys.argv[1] and not sysconfig.get_config_var("Py_GIL_DISABLED")
sys.exit(0 if fits else 1)
CHECK
            printf '%s\n' "$candidate"
            return 0
        fi
    done
    return 1
}

# install PYTHON ENVIRONMENT WHAT: a new environment with the package in it.
install() {
    rm -rf "$2"
    "$1" -m venv "$2"
    timeout 2400 "$2/bin/python" -m pip install --quiet --disable-pip-version-check --no-cache-dir "$3" ||
        fail "pip could not install $3 with $1"
}

say "step 1 of 4: tools, versions pinned"
python_tools

say "step 2 of 4: wheels and sdist"
rm -rf "$dist"
native=x86_64-unknown-linux-gnu other=aarch64-unknown-linux-gnu
python_wheel "$native" "$dist"
x86_64=$wheel
if rustup target list --installed 2>/dev/null | grep -qx "$other" || timeout 60 rustup target add "$other"; then
    python_wheel "$other" "$dist"
    # Cross-compiled: name, ELF machine, libraries and symbols are checked, and nothing runs.
    not_checked "the wheel for aarch64 runs: this machine is $(uname -m)"
else
    not_checked "the wheel for aarch64: its target cannot be had (rustup target add $other)"
fi
maturin sdist --manifest-path "$crate/Cargo.toml" --out "$dist"
sdist=$(find "$dist" -name '*.tar.gz')
"$tools/bin/python" "$crate/tests/check_package.py" "$dist"

say "step 3 of 4: the wheel in every Python"
# Away from the repository, so that nothing of it is imported or built by accident.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp "$crate/tests/digest.py" "$scratch/"
bits="" missing=()
run() {
    local got
    got=$(cd "$scratch" && timeout 600 "$1/bin/python" digest.py) || fail "the package of $1 does not run"
    say "${got:0:16} of $2"
    [ "${bits:=$got}" = "$got" ] || fail "$2 gives $got, and what was tried before it ${bits}: the bits differ"
}
for version in 3.9 3.10 3.11 3.12 3.13 3.14; do
    if python=$(find_python "$version"); then
        install "$python" "$scratch/$version" "$x86_64"
        run "$scratch/$version" "the wheel in Python $version"
        rm -rf "$scratch/$version"
    else
        missing+=("$version")
    fi
done
[ -n "$bits" ] || fail "no Python from 3.9 to 3.14 with venv is here; the package python3-venv is needed"
[ ${#missing[@]} -eq 0 ] || not_checked "the wheel in Python ${missing[*]}: not here (pyenv install VERSION)"

say "step 4 of 4: the sdist, compiled in a clean environment"
# pip unpacks it into TMPDIR and compiles it there. Files of an sdist have a fixed date, so that cargo would take a crate
# of an earlier run for this one: there must be no earlier one.
mkdir "$scratch/tmp"
export TMPDIR=$scratch/tmp CARGO_TARGET_DIR=$scratch/build
(cd "$scratch" && install python3 "$scratch/sdist" "$sdist")
run "$scratch/sdist" "the sdist"
say "done: $(cd "$dist" && echo *)"
