#!/usr/bin/env bash
# Builds the manual into target/manual and checks that every link in it leads somewhere: launch_scripts/manual.sh
set -euo pipefail
. "$(dirname "$0")/common.sh"
cd "$root"
tools=${FLEXDRILL_TOOLS:-$root/target/tools}
PATH="$tools/bin:$PATH"
command -v mdbook >/dev/null ||
    cargo install --quiet --locked mdbook --version '^0.5' --root "$tools" ||
    fail "mdbook is not there and could not be installed; cargo install --locked mdbook"
rm -rf target/manual
mdbook build
python3 launch_scripts/manual_links.py target/manual
say "open $root/target/manual/index.html"
