#!/bin/sh
# Makes the environment in .venv good for a use, and does nothing when it already is:
#   tools/venv.sh run     what the editor needs        tools/venv.sh dev     what its tests need as well
# PYTHON=/path/to/python chooses the interpreter, VENV=folder the place, UV=/path/to/uv the uv to fall back on.
set -eu
cd "$(dirname "$0")/.."
kind=$1
venv=${VENV:-.venv}
python='' uv='' packages='python3 python3-venv'
sudo=$([ "$(id -u)" = 0 ] || echo sudo)

stop() {
    echo "$*" >&2
    exit 2
}

new_enough() { "$1" -c 'import sys; sys.exit(sys.version_info < (3, 12))' >/dev/null 2>&1; }
can_make_venv() { "$1" -c 'import ensurepip, venv' >/dev/null 2>&1; }
version_of() { "$1" -c 'import platform; print(platform.python_version())' 2>/dev/null; }

# Every interpreter is asked, not only looked up: a pyenv shim answers to its name and then refuses to run.
find_python() {
    pyenv=${PYENV_ROOT:-${HOME:-}/.pyenv}/versions
    for name in python3.13 python3.14 python3.12 python3 \
        "$pyenv"/3.13*/bin/python "$pyenv"/3.14*/bin/python "$pyenv"/3.12*/bin/python; do
        if python=$(command -v "$name") && new_enough "$python"; then
            can_make_venv "$python" && return 0
            packages=python$(version_of "$python" | cut -d . -f 1,2)-venv
        fi
    done
    python=''
    return 1
}

# uv fetches a Python where none is. An older Python is enough to get uv itself; both then live in .uv.
find_uv() {
    for name in "${UV:-uv}" "${HOME:-}/.local/bin/uv" "${HOME:-}/.cargo/bin/uv"; do
        uv=$(command -v "$name") && return 0
    done
    if [ ! -x .uv/bin/uv ]; then
        can_make_venv python3 || return 1
        echo "No Python 3.12 or newer here: uv will fetch one into .uv ..."
        rm -rf .uv
        python3 -m venv .uv && .uv/bin/python -m pip install -qq --disable-pip-version-check uv || return 1
    fi
    uv=.uv/bin/uv
    export UV_PYTHON_INSTALL_DIR="$PWD/.uv/python" UV_CACHE_DIR="$PWD/.uv/cache"
}

# Root, or CI with a sudo that does not ask, installs by itself for `make test`; nobody else is taken by surprise.
install_python() {
    [ "$kind" = dev ] && command -v apt-get >/dev/null || return 1
    [ -z "$sudo" ] || { [ "${CI:-}" = true ] && sudo -n true 2>/dev/null; } || return 1
    echo "Installing $packages ..."
    # shellcheck disable=SC2086  # the words of both are meant to part
    $sudo apt-get update -q >/dev/null && $sudo env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -q --no-install-recommends $packages >/dev/null
}

make_venv() {
    mkdir -p "$venv"
    echo $$ >"$venv/.making"
    if [ -n "$python" ]; then
        "$python" -m venv "$venv"
    else
        "$uv" venv -q --seed --allow-existing --python 3.13 "$venv"
    fi && rm "$venv/.making"
}

remedy() {
    command -v apt-get >/dev/null || {
        echo "install uv, which fetches one (pip install --user uv)"
        return
    }
    echo "${sudo:+$sudo }apt-get update && ${sudo:+$sudo }apt-get install -y $packages"
}

# A venv under the hands of a living process is waited for; one whose maker died is half-made.
while [ -e "$venv/.making" ] && kill -0 "$(cat "$venv/.making")" 2>/dev/null; do
    [ -n "${told:-}" ] || echo "Another make is at work on $venv: waiting for it ..."
    told=yes
    sleep 1
done
if [ -n "${PYTHON:-}" ]; then
    python=$(command -v "$PYTHON") || stop "PYTHON=$PYTHON is not there: make PYTHON=/path/to/python3.13 ..."
    new_enough "$python" || stop "PYTHON=$PYTHON is Python $(version_of "$python")," \
        "Hermite needs 3.12 or newer: make PYTHON=/path/to/python3.13 ..."
fi
if [ -e "$venv/.making" ]; then
    echo "Making $venv anew: the last attempt was interrupted."
    rm -rf "$venv"
elif [ -e "$venv" ] && ! new_enough "$venv/bin/python"; then
    echo "Making $venv anew: its Python does not start or is older than 3.12."
    rm -rf "$venv"
elif [ -e "$venv" ] && [ -n "$python" ] && [ "$(version_of "$python")" != "$(version_of "$venv/bin/python")" ]; then
    echo "Making $venv anew with $PYTHON."
    rm -rf "$venv"
fi
if [ ! -e "$venv" ]; then
    [ -n "$python" ] || find_python || find_uv || { install_python && { find_python || find_uv; }; } ||
        stop "No Python 3.12 or newer that can make an environment: $(remedy), then make again."
    if ! make_venv; then
        rm -rf "$venv"
        stop "The environment could not be made, as said above; another Python is taken with" \
            "make PYTHON=/path/to/python3.13 ..."
    fi
    echo "$venv has Python $(version_of "$venv/bin/python")."
fi
exec "$venv/bin/python" tools/install.py "$kind"
