#!/usr/bin/env bash
# What the layout costs and saves: builds, sizes and lines of a commit BEFORE against the one that is checked out, as rows
# for docs/measurements.md (section "The house"):
#   benches/house.sh BEFORE [FOLDER]
# Both are built from nothing in FOLDER (default: a temporary one, some GB), so this takes half an hour on two processors.
# Nothing else should run meanwhile. Progress goes to the error output, the rows to the standard output.
set -euo pipefail
cd "$(dirname "$0")/.."
before=${1:?give the commit to compare with}
folder=${2:-$(mktemp -d)}
export CARGO_TERM_COLOR=never CARGO_INCREMENTAL=0
say() { printf '[house] %s\n' "$*" >&2; }

# Files of Rust that people write.
sources() { git -C "$1" ls-files '*.rs' | grep -v 'messages/generated\.rs$'; }

# seconds COMMAND...: its wall time, rounded; what it prints goes to the log.
seconds() {
    local began=$EPOCHREALTIME
    "$@" >>"$folder/log" 2>&1 || {
        say "failed: $*; see $folder/log"
        exit 1
    }
    awk -v b="$began" -v e="$EPOCHREALTIME" 'BEGIN { printf "%.0f s", e - b }'
}

# checkout NAME COMMIT: a work tree of its own.
checkout() {
    git worktree add --quiet --force --detach "$folder/$1" "$2"
    (cd "$folder/$1" && cargo fetch --locked >>"$folder/log" 2>&1)
}

# touched NAME PATTERN: rebuild of the product after one file changed.
touched() {
    local file
    file=$(cd "$folder/$1" && sources . | grep -m 1 "$2") || { echo "no such file"; return; }
    touch "$folder/$1/$file"
    printf '%s (%s)' "$(cd "$folder/$1" && seconds cargo build --release --locked)" "$(basename "$file")"
}

files() {
    (cd "$folder/$1" && sources . | xargs wc -l | awk '$2 != "total" { print $1, $2 }' | sort -n) |
        awk '{ n[NR] = $1; name[NR] = $2; sum += $1 }
             END { printf "%d files, %d lines; %d; %d (%s)", NR, sum, n[int((NR + 1) / 2)], n[NR], name[NR] }'
}

packages() { (cd "$folder/$1" && cargo tree --locked --edges normal --prefix none "${@:2}" | sed 's/ (.*//' | sort -u | wc -l); }

finish() {
    for name in before after; do
        git worktree remove --force "$folder/$name" 2>/dev/null || true
    done
}
trap finish EXIT

checkout before "$before"
checkout after HEAD
declare -A row
for name in before after; do
    say "$name: the product from nothing"
    row[$name,product]=$(cd "$folder/$name" && seconds cargo build --release --locked)
    row[$name,size]=$(stat --format %s "$folder/$name/target/release/flexdrill" | awk '{ printf "%.1f MB", $1 / 1e6 }')
    say "$name: a file of the mechanics, a file of the command line"
    row[$name,core_file]=$(touched "$name" '/newton\.rs$')
    row[$name,cli_file]=$(touched "$name" '^src/cli/check\.rs$')
    row[$name,files]=$(files "$name")
done
say "the core from nothing"
core() { (cd "$folder/after" && rm -rf target && seconds cargo "$@"); }
build=$(core build --release --locked --package flexdrill-core)
tests=$(core test --release --locked --package flexdrill-core)

lines=$(git diff --find-renames --shortstat "$before" HEAD -- '*.rs' | sed 's/^ *//')
moved=$(git diff --find-renames --diff-filter=R --name-only "$before" HEAD -- '*.rs' | xargs --no-run-if-empty cat | wc -l)
renamed=$(git diff --find-renames --diff-filter=R --name-only "$before" HEAD -- '*.rs' | wc -l)

cat <<EOT
$(git rev-parse --short "$before") against $(git rev-parse --short HEAD), $(nproc) processors, $(rustc --version), $(date -u +%F).

| figure | before | after |
|---|---|---|
| product, from nothing: \`cargo build --release\` | ${row[before,product]} | ${row[after,product]} |
| core, from nothing: \`cargo build --release -p flexdrill-core\` | | $build |
| core with its tests, from nothing: \`cargo test --release -p flexdrill-core\` | | $tests |
| product, after touching a file of the mechanics | ${row[before,core_file]} | ${row[after,core_file]} |
| product, after touching a file of the command line | ${row[before,cli_file]} | ${row[after,cli_file]} |
| packages that the mechanics is built with: \`cargo tree -e normal\` | $(packages before) | $(packages after --package flexdrill-core) |
| packages that the product is built with | $(packages before) | $(packages after --package flexdrill) |
| binary | ${row[before,size]} | ${row[after,size]} |
| Rust, generated code left out: files, lines; median file; largest file | ${row[before,files]} | ${row[after,files]} |
| lines of Rust: \`git diff --find-renames --shortstat\` | | $lines |
| files moved and the lines in them | | $renamed; $moved |
EOT
