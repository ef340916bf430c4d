#!/bin/sh
# Runs a command on a virtual X screen with a window manager, and ends with the command's exit code:
#   tools/screen.sh python -m pytest -m window
# The server chooses a free display by itself (-displayfd), so any number of these may run at once.
# Where there is no X server or window manager to be had it says so and ends with 77, "not run".
set -eu
[ "$(uname)" = Linux ] || exec "$@"
for program in Xvfb openbox; do
    command -v "$program" >/dev/null || {
        echo "The window tests need a virtual screen: sudo apt-get install -y xvfb openbox xdotool, then make test again." >&2
        [ "${CI:-}" = true ] && exit 2
        exit 77
    }
done
work=$(mktemp -d)
server='' manager=''
finish() {
    [ -z "$manager" ] || kill "$manager" 2>/dev/null || true
    [ -z "$server" ] || kill "$server" 2>/dev/null || true
    rm -rf "$work"
}
trap finish EXIT
trap 'exit 130' INT TERM HUP

wait_for() {
    for _ in $(seq 100); do
        [ -s "$1" ] && return 0
        sleep 0.1
    done
    echo "$2 did not start within 10 seconds: $(tail -n 1 "$work/log")" >&2
    exit 2
}

Xvfb -displayfd 3 -screen 0 1600x1000x24 -nolisten tcp -noreset 3>"$work/display" 2>"$work/log" &
server=$!
wait_for "$work/display" Xvfb
DISPLAY=":$(cat "$work/display")"
export DISPLAY QT_QPA_PLATFORM=xcb
unset WAYLAND_DISPLAY XDG_SESSION_TYPE || true

openbox --sm-disable --startup "sh -c 'echo up >\"$work/manager\"'" >>"$work/log" 2>&1 &
manager=$!
wait_for "$work/manager" openbox

status=0
"$@" || status=$?
exit "$status"
