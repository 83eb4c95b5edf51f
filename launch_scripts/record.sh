#!/usr/bin/env bash
# The twin with a recording: launch_scripts/record.sh [FOLDER | FILE.mcap] [options of `flexdrill run`].
# A bag is a folder, as rosbag2 makes them; without a name it is made from the date. The bag is finished on Ctrl-C; after
# a crash use `flexdrill recover`.
set -euo pipefail
. "$(dirname "$0")/common.sh"
build
bag="flexdrill_$(date +%Y%m%d_%H%M%S)"
case ${1:-} in
"" | -*) ;;
*) bag=$1 && shift ;;
esac
[ ! -e "$bag" ] || fail "$bag is there already; choose another name"
case " $* " in
*" --config"*) ;;
*) set -- --config "$root/config/default.yaml" "$@" ;;
esac
say "recording to $bag; Ctrl-C ends it"
exec "$flexdrill" run --record "$bag" "$@"
