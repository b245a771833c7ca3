#!/bin/sh
# Sets up what `make` needs, and does nothing when it is all there.
#
#     sh tools/setup.sh run | test | chart | site | tools
#
# run: the virtual environment, the package in editable form, the GL libraries. test, chart, site and tools: their extras as well.
# VENV names the folder of the environment (.venv), PYTHON the interpreter it is made with.
set -eu
cd "$(dirname "$0")/.."
level=${1:-run}
venv=${VENV:-.venv}

say() { printf '%s\n' "$@"; }
stop() { printf '%s\n' "$@" >&2; exit 1; }

case $level in
    run) target=. ;;
    test | chart | site | tools) target=".[$level]" ;;
    *) stop "tools/setup.sh: '$level' is none of run, test, chart, site, tools." ;;
esac
case $(uname -s) in
    MINGW* | MSYS* | CYGWIN*) venv_python=$venv/Scripts/python.exe ;;
    *) venv_python=$venv/bin/python ;;
esac

# --- the interpreter ---------------------------------------------------------------------------------------------------------

recent_enough() { "$1" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; }

find_python() {
    if [ -n "${PYTHON:-}" ]; then
        recent_enough "$PYTHON" || stop "PYTHON=$PYTHON is no Python 3.11 or newer."
        python=$PYTHON
        return
    fi
    for python in python3 python3.14 python3.13 python3.12 python3.11 python; do
        if recent_enough "$python"; then return; fi
    done
    stop "Blackhole GL needs Python 3.11 or newer, and found none (looked for python3, python3.11 to python3.14, python)." \
        "Install one, or name it: make PYTHON=/path/to/python3.12"
}

# --- what the system brings ------------------------------------------------------------------------------------------------

can_load() {  # can_load PYTHON LIBRARY…
    loader=$1
    shift
    "$loader" -c 'import ctypes, sys; [ctypes.CDLL(name) for name in sys.argv[1:]]' "$@" 2>/dev/null
}

venv_package() {  # the package that brings ensurepip to $python
    own=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    if [ "$(/usr/bin/python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])' 2>/dev/null)" = "$own" ]; then
        say python3-venv
    else
        say "python$own-venv"
    fi
}

administrator() {  # prints the prefix that runs a command as root; fails when there is no way without a password
    if [ "$(id -u)" = 0 ]; then return 0; fi
    if sudo -n true 2>/dev/null; then say "sudo -n"; return 0; fi
    return 1
}

apt_line() { say "sudo apt-get update && sudo apt-get install -y --no-install-recommends $1"; }

apt_install() {  # apt_install PACKAGE…: output is kept from the screen unless it fails
    as_root=$(administrator) || return 1
    command -v apt-get >/dev/null 2>&1 || return 1
    say "Installing system packages with apt-get: $* …"
    log=$(mktemp)
    if { $as_root apt-get update && $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$@"; } >"$log" 2>&1 </dev/null
    then
        rm -f "$log"
        return 0
    fi
    tail -n 15 "$log" >&2
    rm -f "$log"
    return 1
}

require() {  # require WHAT PACKAGE…
    what=$1
    shift
    if apt_install "$@"; then return; fi
    if command -v apt-get >/dev/null 2>&1; then
        stop "Missing: $what. Install, then run make again:" "" "    $(apt_line "$*")" ""
    fi
    stop "Missing: $what." "Install it with your system's package manager (Fedora: dnf install mesa-libEGL mesa-libGL; Arch: pacman -S mesa), then run make again."
}

check_system() {
    missing=
    if [ ! -x "$venv_python" ] && ! "$python" -c 'import ctypes, ensurepip, venv' 2>/dev/null; then
        what="Python's venv module"
        missing=$(venv_package)
    fi
    if [ "$(uname -s)" = Linux ] && ! can_load "$python" libEGL.so.1 libGL.so.1; then
        what="${what:+$what and }the OpenGL libraries libEGL.so.1 and libGL.so.1"
        missing="$missing libegl1 libgl1"
    fi
    # shellcheck disable=SC2086 # a list of package names
    if [ -n "$missing" ]; then require "$what" $missing; fi
    if [ "$level" = test ]; then check_test_tools; fi
}

has_all() {  # has_all PROGRAM…
    for program in "$@"; do command -v "$program" >/dev/null 2>&1 || return 1; done
}

check_test_tools() {  # what some tests need and the rest does not: brought where it may be, and named where not
    if [ "$(uname -s)" = Linux ] && ! can_load "$python" libOSMesa.so.8 && ! apt_install libosmesa6; then
        say "libOSMesa.so.8 is missing, so the tests marked osmesa will fail. Either bring it or leave them out:" "" \
            "    $(apt_line libosmesa6)" "    make test PYTEST_ARGS='-m \"not osmesa\"'" ""
    fi
    if ! command -v glslangValidator >/dev/null 2>&1 && ! apt_install glslang-tools; then
        say "glslangValidator is missing, so the tests marked glslang will fail. Either bring it or leave them out:" "" \
            "    $(apt_line glslang-tools)" "    make test PYTEST_ARGS='-m \"not glslang\"'" ""
    fi
    display_tools="xvfb x11-utils x11-xkb-utils xkb-data xdotool"
    # shellcheck disable=SC2086 # a list of package names
    if [ "$(uname -s)" = Linux ] && ! has_all Xvfb xprop setxkbmap xdotool && ! apt_install $display_tools; then
        say "Xvfb, xprop, setxkbmap or xdotool is missing, so the tests marked display will fail. Either bring them or leave them out:" "" \
            "    $(apt_line "$display_tools")" "    make test PYTEST_ARGS='-m \"not display\"'" ""
    fi
}

# --- the virtual environment -----------------------------------------------------------------------------------------------

# The environment is as it should be when its key names these very pins, this pyproject.toml and this folder (an editable install
# points at the folder it was made in).
wanted_key() { { cat constraints.txt pyproject.toml tools/setup.sh && pwd; } | cksum; }

ready() { recent_enough "$venv_python" && [ "$(cat "$venv/.ready-$level" 2>/dev/null)" = "$(wanted_key)" ]; }

pip() { "$venv_python" -m pip --disable-pip-version-check "$@"; }

fill_venv() {
    if ! recent_enough "$venv_python" || ! pip --version >/dev/null 2>&1; then
        say "Making the virtual environment $venv with $("$python" --version) …"
        "$python" -m venv --clear "$venv"
    fi
    rm -f "$venv/.ready-$level" "$venv/.ready-run"
    say "Installing Python packages into $venv (once; a minute or two) …"
    # The build tools first, so that they are the pinned ones too.
    pip install --quiet --constraint constraints.txt hatchling editables &&
        pip install --quiet --constraint constraints.txt --no-build-isolation --editable "$target" ||
        stop "pip could not install the packages: its message is above. Is the package index reachable? Then run make again."
    wanted_key | tee "$venv/.ready-run" >"$venv/.ready-$level"  # every level holds what run asks for
}

find_python
check_system
if ! ready; then fill_venv; fi
