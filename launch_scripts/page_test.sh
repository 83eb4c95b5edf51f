#!/usr/bin/env bash
# The rig page in a headless browser against a running twin, rig and server, in a network of its own. Does its own
# set-up on a fresh Debian or Ubuntu (as root or with sudo): Chromium, Node.js 18 or newer, the page's packages; then
# checks that dist/ is what the sources give, runs the unit tests and the browser's. The last line sums up.
#   --shots FOLDER   keep screenshots
#   --no-browser     only the build's check and the unit tests
#   --heap MINUTES   only the page's memory, measured so long beside a twin and a rig; fails where it grows
#   --pictures FOLDER  only the pictures of the documents, written there
# FLEXDRILL_BINARY names the program if it is built already.
set -euo pipefail
. "$(dirname "$0")/common.sh"
# Longest time of the browser's tests (s).
limit=${FLEXDRILL_PAGE_TEST_LIMIT:-900}
shots="" browser=yes heap="" pictures=""
while [ $# -gt 0 ]; do
    case $1 in
    --shots) shots=$(realpath -m "${2:?--shots needs a folder}") && shift ;;
    --no-browser) browser="" ;;
    --heap) heap=${2:?--heap needs minutes} && shift ;;
    --pictures) pictures=$(realpath -m "${2:?--pictures needs a folder}") && shift ;;
    *) sed -n '2,9s/^# \{0,1\}//p' "$0" >&2 && exit 2 ;;
    esac
    shift
done

command -v node >/dev/null && command -v npm >/dev/null || need_packages nodejs npm
[ "$(node -p 'process.versions.node.split(".")[0]')" -ge 18 ] ||
    fail "Node.js $(node --version) is too old, 18 or newer is needed"
# A relative path is that of the caller.
[ -z "${FLEXDRILL_BINARY:-}" ] || FLEXDRILL_BINARY=$(realpath "$FLEXDRILL_BINARY")
page=$root/crates/flexdrill-dashboard/web
cd "$page"
say "step 1 of 3: packages of the page, as package-lock.json has them"
timeout 600 npm ci --no-fund --no-audit --loglevel=error ||
    fail "npm could not install what package-lock.json names; is there a network?"
own_network=(unshare --net)
[ "$(id -u)" -eq 0 ] || own_network=(unshare --user --map-root-user --net)
# Runs a script of e2e/ for at most so long (s), in a network of its own, against the program.
in_browser() {
    local seconds=$1 script=$2
    shift 2
    need_packages util-linux iproute2
    [ -x "${CHROMIUM:-/usr/bin/chromium}" ] || need_packages chromium
    flexdrill=${FLEXDRILL_BINARY:-}
    # The pictures show a rig that sends WITS.
    [ -n "$flexdrill" ] || build ${pictures:+--features bridge}
    exec timeout -k 30 "$seconds" "${own_network[@]}" \
        sh -c 'ip link set lo up && exec node "$@"' page "e2e/$script" --flexdrill "$(realpath "$flexdrill")" "$@"
}
if [ -n "$heap" ]; then
    say "the page's memory over $heap minutes"
    in_browser $((60 * heap + 300)) heap.mjs --minutes "$heap"
fi
if [ -n "$pictures" ]; then
    say "the pictures of the documents"
    mkdir -p "$pictures"
    in_browser "$limit" pictures.mjs --out "$pictures"
fi
say "step 2 of 3: dist/ is what the sources give; unit tests"
npm run --silent check || fail "dist/ is not what the sources give"
timeout 300 npm test --silent || fail "unit tests of the page"
[ -n "$browser" ] || exit 0

say "step 3 of 3: the page in Chromium (at most $((limit / 60)) minutes)"
in_browser "$limit" run.mjs ${shots:+--shots "$shots"}
