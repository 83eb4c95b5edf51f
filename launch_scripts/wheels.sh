#!/usr/bin/env bash
# The Python package as it is released: launch_scripts/wheels.sh [--without-program]
# Builds into target/python/release: wheels for x86-64 and aarch64 (manylinux_2_17, linked by zig), each with the program
# flexdrill, and the sdist. It checks names, contents, licences, shared libraries and symbols; installs the sdist in a
# clean environment away from the repository, which compiles it; runs the wheel in each Python from 3.9 to 3.14 that is
# here (pyenv's, or in PATH), which must all give the same bits; and shows the demonstration with the program of an
# installed wheel. Checks whose tools are missing are reported as NOT CHECKED and skipped.
#   --without-program   the Python module alone, which takes a fraction of the time; not for a release
set -euo pipefail
. "$(dirname "$0")/common.sh"
programs=yes
case ${1:-} in
"") ;;
--without-program) programs="" ;;
*) sed -n '2,8s/^# \{0,1\}//p' "$0" >&2 && exit 2 ;;
esac
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

# add_program TARGET: compiles the program with the default features, which the demonstration needs, and puts it into
# $wheel. It is linked as the module is. With all features, or with the names of its functions, the wheel would be larger
# than check_package.py permits.
with_program=()
add_program() {
    local target=$1 made=$out/program/$1
    [ -n "$programs" ] || return 0
    rm -rf "$made"
    maturin build --release --locked --strip --zig --compatibility manylinux_2_17 --target "$target" --bindings bin \
        --manifest-path "$root/Cargo.toml" --out "$made" || return 1
    "$tools/bin/python" "$crate/tests/add_program.py" "$wheel" "$(find "$made" -name '*.whl')" ||
        fail "the program could not be put into $wheel"
    python_audit "$wheel"
    with_program+=("${target%%-*}")
}

say "step 1 of 5: tools, versions pinned"
python_tools

say "step 2 of 5: wheels and sdist"
rm -rf "$dist"
native=x86_64-unknown-linux-gnu other=aarch64-unknown-linux-gnu
python_wheel "$native" "$dist"
add_program "$native" || fail "the program could not be compiled for $native; see above"
x86_64=$wheel
if rustup target list --installed 2>/dev/null | grep -qx "$other" || timeout 60 rustup target add "$other"; then
    python_wheel "$other" "$dist"
    add_program "$other" || not_checked "the wheel for aarch64 has no program: it could not be compiled; see above"
    # Cross-compiled: name, ELF machine, libraries and symbols are checked, and nothing runs.
    not_checked "the wheel for aarch64 runs: this machine is $(uname -m)"
else
    not_checked "the wheel for aarch64: its target cannot be had (rustup target add $other)"
fi
maturin sdist --manifest-path "$crate/Cargo.toml" --out "$dist"
sdist=$(find "$dist" -name '*.tar.gz')
"$tools/bin/python" "$crate/tests/check_package.py" "$dist" ${with_program[@]+"${with_program[@]}"}

say "step 3 of 5: the wheel in every Python"
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

say "step 4 of 5: the program of the wheel"
if [ -n "$programs" ]; then
    cp "$crate/tests/check_program.py" "$scratch/"
    install python3 "$scratch/program" "$x86_64"
    (
        cd "$scratch"
        # With nothing in PATH but the system's own programs, as on a machine without Rust.
        ROS_DOMAIN_ID=${FLEXDRILL_TEST_DOMAIN:-88} PATH=/usr/bin:/bin timeout 600 program/bin/python check_program.py
    ) || fail "the program of $x86_64 does not do what it must"
else
    not_checked "the program: it is left out (--without-program)"
fi

say "step 5 of 5: the sdist, compiled in a clean environment"
# pip unpacks it into TMPDIR and compiles it there. Files of an sdist have a fixed date, so that cargo would take a crate
# of an earlier run for this one: there must be no earlier one.
mkdir "$scratch/tmp"
export TMPDIR=$scratch/tmp CARGO_TARGET_DIR=$scratch/build
(cd "$scratch" && install python3 "$scratch/sdist" "$sdist")
run "$scratch/sdist" "the sdist"
# A package without the program says so.
said=$("$scratch/sdist/bin/python" -m flexdrill --version 2>&1) && fail "the sdist has a program: $said"
[[ $said == *"has no program flexdrill"* ]] || fail "python -m flexdrill of the sdist says: $said"
say "done: $(cd "$dist" && echo *)"
