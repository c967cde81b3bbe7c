# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by verify/run and reports/run: installs what is missing, configures, builds. Needs neither
# network nor root where everything is there.
#   root   the source tree          build  the build folder (BUILD=DIR, else build/ in the tree)
#   out    the report's folder, after setup_report
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd -P)
mkdir -p -- "${BUILD:-$root/build}"
build=$(CDPATH='' cd -- "${BUILD:-$root/build}" && pwd -P)

setup_has() { command -v "$1" >/dev/null 2>&1; }
setup_library() { pkg-config --exists "$@" 2>/dev/null; }
# Does a compiler make a program out of this? A compiler alone, without the C library, does not.
setup_compiles() {
    setup_has "$1" || return 1
    printf '#include <stdio.h>\nint main(void) { return puts("") < 0; }\n' |
        "$@" -x c -o /dev/null - >/dev/null 2>&1
}

# Packages that are missing, among those for building (and with `full` or `nightly`, for those).
setup_missing() {
    setup_compiles gcc || echo gcc libc6-dev
    setup_has pkg-config || echo pkg-config
    setup_has meson || echo meson
    setup_has ninja || echo ninja-build
    setup_library gsl || echo libgsl-dev
    setup_library cmocka || echo libcmocka-dev
    setup_library inih || echo libinih-dev
    setup_library jansson || echo libjansson-dev
    setup_has gnuplot || echo gnuplot-nox
    case $1 in full | nightly)
        setup_compiles clang || echo clang
        setup_compiles clang -fopenmp || echo libomp-dev ;;
    esac
    case $1 in nightly) setup_has valgrind || echo valgrind ;; esac
}

# setup_install PACKAGES: exit 4 where they cannot be installed.
setup_install() {
    [ $# -gt 0 ] || return 0
    echo "missing packages: $*"
    if ! setup_has apt-get; then
        echo "This script installs with apt only; the README names the packages of other systems." >&2
        exit 4
    fi
    if [ "$(id -u)" = 0 ]; then
        as_root=
    elif setup_has sudo; then
        as_root=sudo
    else
        echo "Neither root nor sudo here. As root: apt-get install $*" >&2
        exit 4
    fi
    { $as_root apt-get update -q && $as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -q -y --no-install-recommends "$@"; } ||
        { echo "apt-get could not install: $*" >&2; exit 4; }
}

# setup_packages [full|nightly]
setup_packages() {
    # shellcheck disable=SC2046 # words on purpose
    setup_install $(setup_missing "${1:-}")
    # clang's sanitizers are a package of their own, named after clang's version.
    if [ "${1:-}" = nightly ] && ! setup_compiles clang -fsanitize=thread; then
        setup_install "libclang-rt-$(clang -dumpversion | cut -d. -f1)-dev"
    fi
}

# setup_report: out, the folder of the report.
setup_report() {
    out=$root/reports/out
    mkdir -p "$out" 2>/dev/null && [ -w "$out" ] || out=$build/report
    mkdir -p "$out"
}

# setup_build DIR [meson options]: configures DIR unless that was done, and builds. Quiet while all
# is well.
setup_build() {
    directory=$1
    shift
    mkdir -p "$directory"
    if [ ! -f "$directory/build.ninja" ]; then
        meson setup "$@" "$directory" "$root" >"$directory/setup.log" 2>&1 ||
            { cat "$directory/setup.log"; return 1; }
    fi
    ninja -C "$directory" >"$directory/build.log" 2>&1 ||
        { tail -n 60 "$directory/build.log"; return 1; }
}
