#!/usr/bin/env bash
# All tests of the workspace. Does its own set-up on a fresh Debian or Ubuntu that has Rust and Python 3 (as root or with
# sudo): packages, a Python environment in .venv with pinned versions, then `cargo test --release`, whose summary ends the
# run. Options go to cargo test: launch_scripts/test.sh --test interop node::
# Tests that need what a machine may lack are skipped with a word; with CI set, as .ci/run does, they fail instead.
set -euo pipefail
. "$(dirname "$0")/common.sh"
# Longest time of all this (s).
limit=${FLEXDRILL_TEST_LIMIT:-5400}

say "step 1 of 4: packages (a C compiler for SQLite, Zstandard and TLS, ip, nft and unshare for private networks, ps, venv for Python, an MQTT broker and openssl for its certificates)"
need_packages build-essential iproute2 nftables procps util-linux python3-venv mosquitto openssl
# Fast DDS as a peer, where the system has it: other releases do without.
if apt-cache show libfastrtps-dev >/dev/null 2>&1; then need_packages libfastrtps-dev; fi
need_rust

say "step 2 of 4: Python packages of other vendors in .venv, versions pinned in tests/python/requirements.txt"
venv=$root/.venv
requirements=$root/tests/python/requirements.txt
[ -x "$venv/bin/python" ] && "$venv/bin/python" -c '' 2>/dev/null || {
    rm -rf "$venv"
    python3 -m venv "$venv" || fail "python3 -m venv failed; the package python3-venv of this very Python is needed"
}
if ! cmp -s "$requirements" "$venv/installed.txt"; then
    timeout 900 "$venv/bin/python" -m pip install --quiet --disable-pip-version-check -r "$requirements" ||
        fail "pip could not install what tests/python/requirements.txt names; is there a network?"
    cp "$requirements" "$venv/installed.txt"
fi
export FLEXDRILL_PYTHON=$venv/bin/python
say "$("$FLEXDRILL_PYTHON" --version): $("$FLEXDRILL_PYTHON" -m pip list --format=freeze --disable-pip-version-check | grep -E '^(cyclonedds|rosbags|mcap)' | tr '\n' ' ')"

say "step 3 of 4: building"
cd "$root"
# What criterion asks for would have many packages compiled again, for benches that no test runs.
packages=(--workspace --exclude flexdrill-benches --features flexdrill/full)
timeout "$limit" cargo test "${packages[@]}" --release --locked --no-run || fail "the build failed or took more than $((limit / 60)) minutes"

left=$((limit - SECONDS))
[ "$left" -ge 60 ] || left=60
say "step 4 of 4: cargo test ${packages[*]} --release (at most $((left / 60)) minutes)"
# To the end, so that one run shows everything that fails.
exec timeout -k 30 "$left" cargo test "${packages[@]}" --release --locked --no-fail-fast "$@"
