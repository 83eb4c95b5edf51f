#!/usr/bin/env bash
# The Python package as its users get it: launch_scripts/python_test.sh [--quick]
# Builds wheel (manylinux_2_17) and sdist into target/python/dist, installs the wheel into a clean environment, and runs
# tests, types and notebooks against it; the notebooks' pictures go to target/python/notebooks. Does its own set-up (as
# root or with sudo): Python's venv, and the tools that crates/flexdrill-python/tests/requirements.txt names.
#   --quick   without the environment and the notebooks
# FLEXDRILL_BINARY names the program whose bits are compared with the package's; default: the one in target/release.
# launch_scripts/wheels.sh installs the sdist, and tries the wheel in other Pythons.
set -euo pipefail
. "$(dirname "$0")/common.sh"
quick=""
case ${1:-} in
"") ;;
--quick) quick=yes ;;
*) sed -n '2,9s/^# \{0,1\}//p' "$0" >&2 && exit 2 ;;
esac
need_packages build-essential python3-venv
need_rust
cd "$root"
crate=$root/crates/flexdrill-python
out=$python_out
dist=$out/dist
[ -z "${FLEXDRILL_BINARY:-}" ] || FLEXDRILL_BINARY=$(realpath "$FLEXDRILL_BINARY")
binary=${FLEXDRILL_BINARY:-${CARGO_TARGET_DIR:-$root/target}/release/flexdrill}

say "step 1 of 5: tools, versions pinned"
python_tools

say "step 2 of 5: wheel and sdist"
rm -rf "$dist"
python_wheel x86_64-unknown-linux-gnu "$dist"
maturin sdist --manifest-path "$crate/Cargo.toml" --out "$dist"
"$tools/bin/python" "$crate/tests/check_package.py" "$dist"

say "step 3 of 5: tests in a clean environment"
clean=$out/clean
rm -rf "$clean"
python3 -m venv "$clean"
"$clean/bin/python" -m pip install --quiet --disable-pip-version-check "$wheel[bags,xarray]" \
    $(grep -E '^(pytest|rosbags|xarray|gymnasium|matplotlib|scipy|scipy-stubs|jupytext|nbconvert|ipykernel)==' "$crate/tests/requirements.txt")
[ ! -x "$binary" ] || export FLEXDRILL_BINARY=$binary
[ -x "$binary" ] || echo "SKIPPED: the program's bits against the package's: $binary is not there"
(cd "$out" && timeout 900 "$clean/bin/python" -m pytest -q -p no:cacheprovider "$crate/tests")

say "step 4 of 5: types of the package and of all examples, by mypy and pyright in strict mode"
# Against the installed package, as its users see it.
(
    cd "$crate"
    "$tools/bin/mypy" --python-executable "$clean/bin/python" python/flexdrill
    "$tools/bin/mypy" --python-executable "$clean/bin/python" tests examples notebooks
    "$tools/bin/pyright" --pythonpath "$clean/bin/python"
)

if [ -n "$quick" ]; then
    say "step 5 of 5: left out"
    exit 0
fi
say "step 5 of 5: the environment, and the notebooks"
"$clean/bin/python" -W ignore "$crate/examples/drilling_env.py"
"$clean/bin/python" "$crate/notebooks/execute.py" --out "$out/notebooks"
