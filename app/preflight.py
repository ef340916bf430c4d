"""What must be there before Qt is touched, told in one sentence with the command that mends it.

Standard library only: this runs where nothing is installed yet. What only a failure needs is imported then: every
start of the window passes here.

    python -m app.preflight            report what is missing
    python -m app.preflight --install  offer to install it (asks at a terminal)
    python -m app.preflight --tests    what the tests need too; installs by itself as root or under CI
"""

import ctypes
import importlib.util
import os
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple


class Need(NamedTuple):
    """A shared library or a program, and the package that brings it under each of PACKAGE_MANAGERS."""

    file: str
    apt: str
    dnf: str
    pacman: str


MODULES = ("PySide6.QtWidgets", "pyqtgraph", "numpy", "simpleeval")

# Qt stops at the first of these that is missing, one after the other; here they are named all at once.
QT_LIBRARIES = (
    Need("libglib-2.0.so.0", "libglib2.0-0", "glib2", "glib2"),
    Need("libGL.so.1", "libgl1", "libglvnd-glx", "libglvnd"),
    Need("libEGL.so.1", "libegl1", "libglvnd-egl", "libglvnd"),
    Need("libdbus-1.so.3", "libdbus-1-3", "dbus-libs", "dbus"),
    Need("libfontconfig.so.1", "libfontconfig1", "fontconfig", "fontconfig"),
    Need("libxkbcommon.so.0", "libxkbcommon0", "libxkbcommon", "libxkbcommon"),
)
X11_LIBRARIES = (
    Need("libxcb-cursor.so.0", "libxcb-cursor0", "xcb-util-cursor", "xcb-util-cursor"),
    Need("libxcb-icccm.so.4", "libxcb-icccm4", "xcb-util-wm", "xcb-util-wm"),
    Need("libxcb-keysyms.so.1", "libxcb-keysyms1", "xcb-util-keysyms", "xcb-util-keysyms"),
    Need("libxcb-shape.so.0", "libxcb-shape0", "libxcb", "libxcb"),
    Need("libxkbcommon-x11.so.0", "libxkbcommon-x11-0", "libxkbcommon-x11", "libxkbcommon-x11"),
)
WAYLAND_LIBRARIES = (
    Need("libwayland-cursor.so.0", "libwayland-cursor0", "libwayland-cursor", "wayland"),
    Need("libwayland-egl.so.1", "libwayland-egl1", "libwayland-egl", "wayland"),
)
# What the window tests run on: a screen without hardware, a window manager, and a hand for mouse and keys.
TEST_PROGRAMS = (
    Need("Xvfb", "xvfb", "xorg-x11-server-Xvfb", "xorg-server-xvfb"),
    Need("openbox", "openbox", "openbox", "openbox"),
    Need("xdotool", "xdotool", "xdotool", "xdotool"),
)
PACKAGE_MANAGERS = (
    ("apt", ("apt-get", "install", "-y", "--no-install-recommends")),
    ("dnf", ("dnf", "install", "-y")),
    ("pacman", ("pacman", "-S", "--needed", "--noconfirm")),
)


def missing_modules() -> list[str]:
    """The packages, by import name, that this Python does not have."""
    return [name for name in MODULES if importlib.util.find_spec(name.partition(".")[0]) is None]


def _loads(soname: str) -> bool:
    try:
        ctypes.CDLL(soname)
    except OSError:
        return False
    return True


def missing_libraries(platform: str) -> list[Need]:
    """The system libraries that Qt needs and this Linux lacks, for "xcb", "wayland" or "offscreen"."""
    if not sys.platform.startswith("linux"):
        return []
    more = {"xcb": X11_LIBRARIES, "wayland": WAYLAND_LIBRARIES}.get(platform, ())
    return [need for need in (*QT_LIBRARIES, *more) if not _loads(need.file)]


def missing_programs() -> list[Need]:
    """The programs that the window tests need and this Linux lacks."""
    if not sys.platform.startswith("linux"):
        return []
    import shutil

    return [need for need in TEST_PROGRAMS if shutil.which(need.file) is None]


def _wayland_answers() -> bool:
    name = os.environ.get("WAYLAND_DISPLAY")
    if not name:
        return False
    import socket

    with socket.socket(socket.AF_UNIX) as wire:
        try:
            wire.connect(os.path.join(os.environ.get("XDG_RUNTIME_DIR", ""), name))
        except OSError:
            return False
    return True


def platform_name() -> str:
    """The Qt platform that a window would open on: what the user set, else Wayland where it answers, else X."""
    chosen = os.environ.get("QT_QPA_PLATFORM", "").partition(":")[0].partition(";")[0].removesuffix("-egl")
    if chosen or not sys.platform.startswith("linux"):
        return chosen
    return "wayland" if not os.environ.get("DISPLAY") and _wayland_answers() else "xcb"


def _known_platforms() -> list[str]:
    """The platforms that come with the Qt that is installed; none if it cannot be found."""
    spec = importlib.util.find_spec("PySide6")
    folders = [Path(place) for place in (spec.submodule_search_locations or [])] if spec else []
    names = {path.stem for folder in folders for path in (folder / "Qt" / "plugins" / "platforms").glob("libq*.so")}
    return sorted(name.removeprefix("libq") for name in names)


def _x_answers() -> bool:
    """Whether the X server of DISPLAY lets us in; true also when there is no way to ask."""
    try:
        xcb = ctypes.CDLL("libxcb.so.1")
    except OSError:
        return True
    xcb.xcb_connect.restype = ctypes.c_void_p
    connection = ctypes.c_void_p(xcb.xcb_connect(None, None))
    failed = bool(xcb.xcb_connection_has_error(connection))
    xcb.xcb_disconnect(connection)
    return not failed


def display_problem() -> str | None:
    """One sentence when no window can open. Qt itself would abort, and blame a library that is there."""
    known = _known_platforms()
    if known and platform_name() not in ("", *known):
        return f"QT_QPA_PLATFORM is {platform_name()!r}, which Qt does not have here; it has {', '.join(known)}."
    if not sys.platform.startswith("linux") or platform_name() not in ("xcb", "wayland") or _wayland_answers():
        return None
    name = os.environ.get("DISPLAY")
    if not name:
        return (
            "No screen to open a window on (neither DISPLAY nor WAYLAND_DISPLAY is set); "
            "the commands info, evaluate, convert and render work without one."
        )
    if not _x_answers():
        return f"The screen {name} (from DISPLAY) does not answer: start it, or set DISPLAY to one that does."
    return None


def install_command(needs: Iterable[Need]) -> list[str] | None:
    """The command that brings these needs on this system, or None where no known package manager is."""
    import shutil

    for manager, command in PACKAGE_MANAGERS:
        if shutil.which(command[0]):
            packages = sorted({getattr(need, manager) for need in needs})
            return [*([] if os.geteuid() == 0 else ["sudo"]), *command, *packages]
    return None


def library_problem(needs: list[Need]) -> str | None:
    """One sentence that names missing needs and the command that brings them; None when none is missing."""
    if not needs:
        return None
    command = install_command(needs)
    remedy = " ".join(command) if command else "install them with your system's package manager"
    if command and "apt-get" in command:
        remedy = " ".join([*command[: command.index("apt-get")], "apt-get update"]) + " && " + remedy
    return f"Missing on this system: {', '.join(need.file for need in needs)}; mend it with: {remedy}"


def window_problem() -> str | None:
    """One sentence when the window cannot open here, else None."""
    absent = missing_modules()
    if absent:
        return f"Python packages are missing here ({', '.join(absent)}): start with make run, or with uv run main.py"
    return library_problem(missing_libraries(platform_name())) or display_problem()


def _may_install(needs: list[Need], *, tests: bool, offer: bool) -> bool:
    if tests:
        if os.geteuid() == 0:
            return True
        import shutil
        import subprocess

        quiet_sudo = ["sudo", "-n", "true"]
        return (
            os.environ.get("CI") == "true"
            and shutil.which("sudo") is not None
            and subprocess.run(quiet_sudo, stderr=subprocess.DEVNULL, check=False).returncode == 0
        )
    if not offer or not sys.stdin.isatty():
        return False
    print(library_problem(needs))
    return input("Run that now? [y/N] ").strip().lower() in ("y", "yes")


def _install(needs: list[Need]) -> None:
    command = install_command(needs)
    if command is None:
        return
    import subprocess

    print("Installing:", *command, flush=True)
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    if "apt-get" in command:
        update = [*command[: command.index("apt-get")], "apt-get", "update", "-q"]
        subprocess.run(update, stdout=subprocess.DEVNULL, check=False)
    subprocess.run(command, env=environment, stdout=subprocess.DEVNULL, check=False)


def main(words: list[str]) -> int:
    """Checks, installs what it may, and tells the rest in one sentence; 0 when Qt can start, else 2.

    Missing test programs are told but are no reason to stop: all other tests run without them.
    """
    tests = "--tests" in words
    platform = "xcb" if tests else platform_name()

    def needs() -> list[Need]:
        return missing_libraries(platform) + (missing_programs() if tests else [])

    missing = needs()
    if missing and _may_install(missing, tests=tests, offer="--install" in words):
        _install(missing)
        missing = needs()
    if missing:
        print(library_problem(missing), file=sys.stderr)
    return 2 if missing_libraries(platform) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
