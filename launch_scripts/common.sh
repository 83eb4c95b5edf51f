# Shared by the scripts in this folder; sourced, not run.
# Sets $root (the repository) and offers say, fail, need_packages, need_rust, build, progress, python_tools,
# python_wheel and python_audit.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
name=$(basename "$0")

say() { printf '[%s] %s\n' "$name" "$*"; }

fail() {
    printf '[%s] error: %s\n' "$name" "$*" >&2
    exit 1
}

# need_packages PACKAGE...: installs those Debian or Ubuntu packages that are missing, as root or with sudo.
need_packages() {
    command -v dpkg-query >/dev/null || {
        say "no dpkg here: make sure yourself that these are installed: $*"
        return 0
    }
    local missing=() package
    for package in "$@"; do
        [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
    done
    if [ ${#missing[@]} -eq 0 ]; then
        say "packages are there: $*"
        return 0
    fi
    local sudo=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || fail "packages are missing (${missing[*]}) and there is no sudo; run: apt-get install ${missing[*]}"
        sudo=(sudo)
    fi
    say "installing packages: ${missing[*]}"
    "${sudo[@]}" apt-get -q update || say "apt-get update failed; trying with the lists that are there"
    "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q install -y --no-install-recommends "${missing[@]}" ||
        fail "apt-get could not install: ${missing[*]}"
}

# Rust: rustup's own folder counts even when the shell does not know it yet.
need_rust() {
    command -v cargo >/dev/null || PATH="$HOME/.cargo/bin:$PATH"
    command -v cargo >/dev/null || fail "cargo is not there; install Rust from https://rustup.rs and run this again"
    local wanted have
    wanted=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' "$root/Cargo.toml")
    have=$(cd "$root" && rustc --version | cut -d' ' -f2)
    [ "$(printf '%s\n%s\n' "$wanted" "$have" | sort -V | head -n 1)" = "$wanted" ] ||
        fail "Rust $have is too old, $wanted or newer is needed; run: rustup update stable"
    say "Rust $have"
}

# Builds the release binary, with the options that are given to cargo, and sets $flexdrill. Shows how much of the build is
# done and how long the rest takes.
build() {
    need_packages build-essential
    need_rust
    say "building; the first time takes several minutes"
    # cargo draws its progress only when it is asked to: one line that it overwrites again and again.
    (
        cd "$root"
        export CARGO_TERM_COLOR=never CARGO_TERM_PROGRESS_WHEN=always CARGO_TERM_PROGRESS_WIDTH=100
        cargo build --release --locked "$@" 2>&1
    ) | progress || fail "the build failed; see above"
    flexdrill="${CARGO_TARGET_DIR:-$root/target}/release/flexdrill"
}

# Reads what cargo writes and shows its progress: in a terminal as one line that changes, in a log as a line every half
# minute. Warnings, errors and cargo's last line pass through.
progress() {
    local chunk line text first="" began=$SECONDS next=0 every=30 clear="" end=$'\n'
    if [ -t 1 ]; then every=1 clear=$'\r\033[K' end=""; fi
    # A chunk ends where cargo goes back to the beginning of its line; the last one ends with the output.
    while IFS= read -r -d $'\r' chunk || [ -n "$chunk" ]; do
        while IFS= read -r line; do
            line=${line//$'\033[K'/}
            if [[ $line =~ ^\ *Building\ \[.*\]\ ([0-9]+)/([0-9]+) ]]; then
                # Steps that an earlier build has done take no time.
                first=${first:-${BASH_REMATCH[1]}}
                [ "$SECONDS" -ge "$next" ] || continue
                next=$((SECONDS + every))
                text=$(time_left "$first" "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}" $((SECONDS - began)))
                printf '%s[%s] built %s of %s%s%s' "$clear" "$name" "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}" "$text" "$end"
            elif [[ -n $line && ! $line =~ ^\ *(Compiling|Downloaded|Downloading|Fetch|Locking|Updating) ]]; then
                printf '%s%s\n' "$clear" "$line"
            fi
        done <<<"$chunk"
    done
}

# time_left FIRST DONE TOTAL SECONDS: ", about 5 minutes left" for a build that has done DONE of TOTAL steps in SECONDS,
# FIRST of which took no time; nothing before there is something to go by. The large crates come last: `at` is the share
# of the time that a share of the steps takes, as `cargo build --timings` shows it.
time_left() {
    awk -v first="$1" -v done="$2" -v total="$3" -v seconds="$4" '
        function at(share, i) {
            for (i = 2; i < count && share > x[i]; i++);
            return y[i - 1] + (y[i] - y[i - 1]) * (share - x[i - 1]) / (x[i] - x[i - 1])
        }
        BEGIN {
            count = split("0 0.3 0.5 0.7 0.85 0.95 1", x, " ")
            split("0 0.15 0.3 0.45 0.6 0.75 1", y, " ")
            spent = at(done / total) - at(first / total)
            if (seconds < 10 || spent < 0.03) exit
            minutes = seconds * (1 - at(done / total)) / spent / 60
            if (minutes < 1) printf ", less than a minute left"
            else printf ", about %.0f minute%s left", minutes, (minutes < 1.5 ? "" : "s")
        }'
}

# Where the scripts of the Python package keep what they make.
python_out=$root/target/python

# The tools of the Python package, versions pinned, in an environment of their own that comes first in PATH: $tools.
python_tools() {
    local wanted=$root/crates/flexdrill-python/tests/requirements.txt
    tools=$python_out/tools
    [ -x "$tools/bin/python" ] && "$tools/bin/python" -c '' 2>/dev/null || {
        rm -rf "$tools"
        mkdir -p "$python_out"
        python3 -m venv "$tools" || fail "python3 -m venv failed; the package python3-venv of this very Python is needed"
    }
    if ! cmp -s "$wanted" "$tools/installed.txt"; then
        timeout 900 "$tools/bin/python" -m pip install --quiet --disable-pip-version-check -r "$wanted" ||
            fail "pip could not install what crates/flexdrill-python/tests/requirements.txt names; is there a network?"
        cp "$wanted" "$tools/installed.txt"
    fi
    PATH="$tools/bin:$PATH"
}

# python_wheel TARGET DIR: builds the wheel for that target of Rust into DIR and checks it: $wheel. zig links against the
# symbols of glibc 2.17, the oldest that Rust supports, so that the wheel runs on every distribution since 2014.
python_wheel() {
    local target=$1 dist=$2
    maturin build --release --locked --zig --compatibility manylinux_2_17 --target "$target" \
        --manifest-path "$root/crates/flexdrill-python/Cargo.toml" --out "$dist"
    wheel=$(find "$dist" -name "*_${target%%-*}.whl")
    [ -f "$wheel" ] || fail "no wheel for $target in $dist, or more than one"
    python_audit "$wheel"
}

# python_audit WHEEL: two judges that are not the builder look at all that is compiled in it: the shared libraries and
# versions of symbols that manylinux allows, and the functions of Python that its stable interface has had since 3.9.
python_audit() {
    local wheel=$1 said
    said=$(auditwheel show "$wheel" 2>&1) || fail "auditwheel: $said"
    printf '%s\n' "$said" | tr '\n' ' ' | grep -Eq 'following platform tag: +"manylinux_2_(5|12|17)_' ||
        fail "$(basename "$wheel") needs more than manylinux_2_17 has: $said"
    said=$(abi3audit --strict "$wheel" 2>&1) || fail "abi3audit: $said"
}
