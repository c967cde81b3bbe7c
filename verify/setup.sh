# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by verify/run, reports/run and reports/compare: reads their options, installs missing packages,
# configures, builds. Needs neither network nor root if nothing is missing.
#   root   the source tree
#   build  the build folder (BUILD=DIR, else build/ in the tree), after setup_packages
#   out    the report's folder, after setup_report
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd -P)
targets= # targets of setup_build; empty: all

# setup_help: prints the head comment of the running script, without its first two lines.
setup_help() { sed -n '3,/^[^#]/s/^# \{0,1\}//p' "$0"; }

setup_refuse() {
    echo "${0##*/}: $1 (--help says what there is)" >&2
    exit 2
}

# setup_options "OPTION ..." "OPTION ..." WORD ...: checks that the words are options, each at most once. First
# list: options without a value; second: with one, as --option VALUE or --option=VALUE. Answers --help.
setup_options() {
    plain=" $1 " valued=" $2 " seen=' '
    shift 2
    for word; do
        case $word in -h | --help) setup_help; exit 0 ;; esac
    done
    while [ $# -gt 0 ]; do
        option=${1%%=*}
        case $1 in -*) ;; *) setup_refuse "what is '$1'?" ;; esac
        case $seen in *" $option "*) setup_refuse "$option is given twice" ;; esac
        seen="$seen$option "
        case $plain in *" $1 "*) shift; continue ;; esac
        case $valued in *" $option "*) ;; *) setup_refuse "unknown option '$1'" ;; esac
        if [ "$option" = "$1" ]; then
            [ $# -ge 2 ] || setup_refuse "$1 needs a value"
            shift
        fi
        shift
    done
}

# setup_exclude OPTION OPTION WORD ...: refuses both options together.
setup_exclude() {
    one=$1 other=$2 both=
    shift 2
    for word; do
        case $word in "$one" | "$other") both=$both+ ;; esac
    done
    [ "$both" != ++ ] || setup_refuse "$one and $other exclude each other"
}

# Options of every command of the program.
setup_plain='--quiet'
setup_valued='--json --threads --color'

setup_has() { command -v "$1" >/dev/null 2>&1; }
setup_library() { pkg-config --exists "$@" 2>/dev/null; }
# Does this compiler make a program? Without the C library it does not.
setup_compiles() {
    setup_has "$1" || return 1
    printf '#include <stdio.h>\nint main(void) { return puts("") < 0; }\n' |
        "$@" -x c -o /dev/null - >/dev/null 2>&1
}

# Python's libclang, for the mutation score.
setup_libclang() {
    python3 -c 'import sys; sys.path.append("/usr/lib/python3/dist-packages"); import clang.cindex' 2>/dev/null
}

# numpy and h5py, for the Python of the system: that of the package meson.
setup_numpy() { /usr/bin/python3 -c 'import numpy, h5py' 2>/dev/null; }

# PySPH for the same Python: a code that `sphproof run --code` runs.
setup_pysph() { /usr/bin/python3 -c 'import pysph.solver.application' 2>/dev/null; }

# Slurm's daemons, and munge, which authenticates them.
setup_cluster() { (PATH=$PATH:/usr/sbin; setup_has slurmctld && setup_has slurmd && setup_has munged); }

# Missing packages for building (and with `full` or `nightly`, for those).
setup_missing() {
    setup_compiles gcc || echo gcc libc6-dev
    setup_has pkg-config || echo pkg-config
    setup_has meson || echo meson
    setup_has ninja || echo ninja-build
    setup_library gsl || echo libgsl-dev
    setup_library cmocka || echo libcmocka-dev
    setup_library inih || echo libinih-dev
    setup_library jansson || echo libjansson-dev
    setup_library hdf5 || echo libhdf5-dev
    setup_has gnuplot || echo gnuplot-nox
    case $1 in full | nightly)
        setup_has ccache || echo ccache # some tests build copies of the tree
        setup_compiles clang || echo clang
        setup_compiles clang -fopenmp || echo libomp-dev
        setup_libclang || echo python3-clang
        setup_numpy || echo python3-numpy python3-h5py
        # without apt, tests that need a cluster or PySPH are skipped
        setup_pysph || ! setup_has apt-get || echo python3-pysph
        setup_cluster || ! setup_has apt-get || echo slurm-wlm munge ;;
    esac
    case $1 in nightly)
        setup_has valgrind || echo valgrind
        [ -e /usr/share/i18n/locales/de_DE ] || echo locales ;;
    esac
}

# setup_install PACKAGES: exits with 4 if they cannot be installed.
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
    mkdir -p -- "${BUILD:-$root/build}"
    build=$(CDPATH='' cd -- "${BUILD:-$root/build}" && pwd -P)
    # shellcheck disable=SC2046 # words on purpose
    setup_install $(setup_missing "${1:-}")
    # clang's sanitizers are in a separate package, named after clang's version.
    case ${1:-} in full | nightly)
        setup_compiles clang -fsanitize=address ||
            setup_install "libclang-rt-$(clang -dumpversion | cut -d. -f1)-dev" ;;
    esac
}

# setup_report: out, the folder of the report.
setup_report() {
    out=$root/reports/out
    mkdir -p "$out" 2>/dev/null && [ -w "$out" ] || out=$build/report
    mkdir -p "$out"
}

# setup_watch LOG: prints the progress of ninja every ten seconds (on a terminal every second). Its sleep may
# outlive it, and must not keep the output open, or a reader of a pipe would wait for it.
setup_watch() {
    every=10 begin='   ' end='\n'
    if [ -t 1 ]; then every=1 begin='\r   ' end='\033[K'; fi
    while sleep "$every" >/dev/null 2>&1; do
        printf "$begin%s$end" "$(sed -n '$s/^\(\[[0-9/]*\]\) .*/\1 compiled/p' "$1")"
    done
}

# setup_build DIR [meson options]: configures DIR unless that was done, and builds. A long build is announced, with
# its time.
setup_build() {
    directory=$1
    shift
    mkdir -p "$directory"
    if [ ! -f "$directory/build.ninja" ]; then
        echo "configuring $directory"
        meson setup "$@" "$directory" "$root" >"$directory/setup.log" 2>&1 ||
            { cat "$directory/setup.log"; return 1; }
    fi
    # shellcheck disable=SC2086 # words on purpose
    steps=$(ninja -n -C "$directory" $targets 2>/dev/null | grep -c '^\[' || true)
    [ "$steps" -lt 10 ] ||
        echo "compiling, $steps steps; a first build takes about a minute on two cores"
    began=$(date +%s)
    setup_watch "$directory/build.log" &
    watch=$!
    well=0
    # shellcheck disable=SC2086 # words on purpose
    ninja -C "$directory" $targets >"$directory/build.log" 2>&1 || well=1
    kill "$watch" 2>/dev/null || true
    wait "$watch" 2>/dev/null || true
    if [ "$steps" -ge 10 ] && [ -t 1 ]; then printf '\r\033[K'; fi
    [ "$well" = 0 ] || { tail -n 60 "$directory/build.log"; return 1; }
    [ "$steps" -lt 10 ] || echo "compiled in $(($(date +%s) - began)) s"
}
