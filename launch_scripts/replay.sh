#!/usr/bin/env bash
# A bag or a field log through the model, as fast as it goes: launch_scripts/replay.sh IN [OUT] [options of
# `flexdrill replay`]. Without OUT the result is a folder with IN's name and _replayed.
set -euo pipefail
. "$(dirname "$0")/common.sh"
input=${1:-}
[ -n "$input" ] || fail "give a bag (.mcap, .db3 or its folder) or a rig log (.csv)"
shift
[ -e "$input" ] || fail "$input is not there"
case ${1:-} in
"" | -*)
    output=$(basename "${input%/}")
    output="${output%.*}_replayed"
    ;;
*) output=$1 && shift ;;
esac
# Bags in SQLite need the feature that compiles SQLite.
features=()
if [[ "$input" == *.db3 ]] || compgen -G "$input/*.db3" >/dev/null; then features=(--features sqlite); fi
build ${features[@]+"${features[@]}"}
say "replaying $input into $output"
exec "$flexdrill" replay "$input" --out "$output" "$@"
