#!/bin/sh
# Makes the environment in .venv good for a use, and does nothing when it already is:
#   tools/venv.sh run     what the editor needs        tools/venv.sh dev     what its tests need as well
# PYTHON=/path/to/python chooses the interpreter, VENV=folder the place, UV=/path/to/uv the uv to fall back on.
set -eu
cd "$(dirname "$0")/.."
kind=$1
venv=${VENV:-.venv}
needed='import sys; sys.exit(sys.version_info < (3, 12))'

stop() {
    echo "$*" >&2
    exit 2
}

new_enough() { "$1" -c "$needed" >/dev/null 2>&1; }
can_make_venv() { "$1" -c 'import ensurepip, venv' >/dev/null 2>&1; }
version_of() { "$1" -c 'import platform; print(platform.python_version())' 2>/dev/null; }

# Root, or CI with a sudo that does not ask, installs by itself for `make test`; nobody else is taken by surprise.
may_install() {
    [ "$kind" = dev ] && command -v apt-get >/dev/null || return 1
    [ "$(id -u)" = 0 ] && return 0
    [ "${CI:-}" = true ] && sudo -n true 2>/dev/null
}
install() {
    echo "Installing $* ..."
    as_root=$([ "$(id -u)" = 0 ] || echo sudo)
    $as_root apt-get update -q >/dev/null && DEBIAN_FRONTEND=noninteractive \
        $as_root apt-get install -y -q --no-install-recommends "$@" >/dev/null
}

# Every interpreter is asked, not only looked up: a pyenv shim answers to its name and then refuses to run.
find_python() {
    pyenv=${PYENV_ROOT:-$HOME/.pyenv}/versions
    for name in python3.13 python3.14 python3.12 python3 \
        "$pyenv"/3.13*/bin/python "$pyenv"/3.14*/bin/python "$pyenv"/3.12*/bin/python; do
        if found=$(command -v "$name") && new_enough "$found"; then
            python=$found
            can_make_venv "$found" && return 0
        fi
    done
    [ -n "${python:-}" ]
}

# uv fetches a Python where none is. With an older Python there is, uv itself can be had; both then live in .uv.
find_uv() {
    uv=${UV:-$(command -v uv || true)}
    [ -n "$uv" ] && return 0
    [ -x .uv/bin/uv ] || {
        command -v python3 >/dev/null && can_make_venv python3 || return 1
        echo "No Python 3.12 or newer here: making uv in .uv to fetch one ..."
        python3 -m venv .uv && .uv/bin/python -m pip install -q --disable-pip-version-check uv || {
            rm -rf .uv
            return 1
        }
    }
    uv=.uv/bin/uv
    export UV_PYTHON_INSTALL_DIR="$PWD/.uv/python" UV_CACHE_DIR="$PWD/.uv/cache"
}

make_venv() {
    mkdir -p "$venv"
    echo $$ >"$venv/.making"
    if [ -n "${python:-}" ] && can_make_venv "$python"; then
        "$python" -m venv "$venv"
    else
        find_uv && "$uv" venv -q --seed --allow-existing --python "${python:-3.13}" "$venv"
    fi && rm "$venv/.making"
}

apt_python() { [ "$(apt-cache policy python3 2>/dev/null | sed -n 's/.*Candidate: 3\.\([0-9]*\).*/\1/p')" -ge 12 ] 2>/dev/null; }

choose_python() {
    if [ -n "${PYTHON:-}" ]; then
        python=$(command -v "$PYTHON") || stop "PYTHON=$PYTHON is not there: make PYTHON=/path/to/python3.13 ..."
        new_enough "$python" ||
            stop "PYTHON=$PYTHON is Python $(version_of "$python"), Hermite needs 3.12 or newer: make PYTHON=/path/to/python3.13 ..."
    elif ! find_python || { ! can_make_venv "$python" && ! command -v uv >/dev/null; }; then
        if may_install && { [ -d /var/lib/apt/lists ] && apt_python || { install ca-certificates && apt_python; }; }; then
            install python3 python3-venv && find_python || true
        fi
    fi
}

# A venv under the hands of a living process is waited for; one whose maker died is half-made.
while [ -e "$venv/.making" ] && kill -0 "$(cat "$venv/.making")" 2>/dev/null; do
    [ -n "${told:-}" ] || echo "Another make is at work on $venv: waiting for it ..."
    told=1
    sleep 1
done
if [ -e "$venv/.making" ]; then
    echo "Making $venv anew: the last attempt was interrupted."
    rm -rf "$venv"
elif [ -e "$venv" ] && ! new_enough "$venv/bin/python"; then
    echo "Making $venv anew: its Python does not start or is older than 3.12."
    rm -rf "$venv"
elif [ -e "$venv" ] && [ -n "${PYTHON:-}" ] && [ "$(version_of "$PYTHON")" != "$(version_of "$venv/bin/python")" ]; then
    echo "Making $venv anew with $PYTHON."
    rm -rf "$venv"
fi
if [ ! -e "$venv" ]; then
    choose_python
    if ! make_venv; then
        rm -rf "$venv"
        if [ -n "${python:-}" ]; then
            stop "$python has no venv module: sudo apt-get install -y python$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')-venv, then make again."
        elif apt_python; then
            stop "Hermite needs Python 3.12 or newer: sudo apt-get install -y python3 python3-venv, then make again."
        fi
        stop "Hermite needs Python 3.12 or newer and found none: install uv, which fetches one (sudo apt-get install -y pipx && pipx install uv), then make again."
    fi
    echo "$venv has Python $(version_of "$venv/bin/python")."
fi
exec "$venv/bin/python" tools/install.py "$kind"
