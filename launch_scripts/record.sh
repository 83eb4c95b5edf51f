#!/usr/bin/env bash
# The twin with a recording: launch_scripts/record.sh [FILE.mcap] [options of `flexdrill run`].
# Without a file the name is made from the date. The bag is finished on Ctrl-C; after a crash use `flexdrill recover`.
set -euo pipefail
. "$(dirname "$0")/common.sh"
build
file="flexdrill_$(date +%Y%m%d_%H%M%S).mcap"
case ${1:-} in
"" | -*) ;;
*) file=$1 && shift ;;
esac
[ ! -e "$file" ] || fail "$file is there already; choose another name"
case " $* " in
*" --config"*) ;;
*) set -- --config "$root/config/default.yaml" "$@" ;;
esac
say "recording to $file; Ctrl-C ends it"
exec "$flexdrill" run --record "$file" "$@"
