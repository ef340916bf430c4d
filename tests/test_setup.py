"""What a stranger meets: the right Python found, what is missing told in one sentence, no abort where no screen is."""

import ast
import importlib.util
import io
import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

from app import preflight

ROOT = Path(__file__).resolve().parent.parent
SAMPLE = ROOT / "resources" / "samples" / "bounce.hermite"
SCRIPTS_ONLY = pytest.mark.skipif(os.name == "nt", reason="make and its scripts are for Linux and macOS")
LINUX_ONLY = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux has system libraries to miss")


def main_py(*words: str, python: tuple[str, ...] = (), **environment: str) -> subprocess.CompletedProcess[str]:
    """Runs main.py without any screen, in a process of its own."""
    kept = {
        name: value
        for name, value in os.environ.items()
        if name not in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
    }
    return subprocess.run(
        [sys.executable, *python, str(ROOT / "main.py"), *words],
        env=kept | environment,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


def one_sentence(done: subprocess.CompletedProcess[str]) -> str:
    assert done.returncode == 2, done
    assert done.stderr.count("\n") == 1, done.stderr
    return done.stderr


@LINUX_ONLY
def test_without_a_screen_there_is_a_sentence_and_no_abort() -> None:
    assert "DISPLAY" in one_sentence(main_py(str(SAMPLE)))


@LINUX_ONLY
@pytest.mark.parametrize("environment", [{"DISPLAY": ":987"}, {"DISPLAY": ":987", "QT_QPA_PLATFORM": "xcb"}])
def test_a_screen_that_does_not_answer_is_named(environment: dict[str, str]) -> None:
    assert ":987" in one_sentence(main_py(**environment))


@LINUX_ONLY
def test_a_dead_wayland_screen_counts_as_none() -> None:
    assert "No screen" in one_sentence(main_py(WAYLAND_DISPLAY="wayland-987", XDG_RUNTIME_DIR="/nowhere"))


def test_missing_packages_are_named_with_the_way_to_get_them() -> None:
    sentence = one_sentence(main_py(python=("-S",)))
    assert "pyqtgraph" in sentence
    assert "make run" in sentence


def test_an_old_python_is_refused_before_anything_new_is_read() -> None:
    ast.parse((ROOT / "main.py").read_text(encoding="utf-8"), feature_version=(3, 6))
    main = str(ROOT / "main.py")
    pretend = f"import runpy, sys; sys.version_info = (3, 9, 2); runpy.run_path({main!r}, run_name='__main__')"
    done = subprocess.run([sys.executable, "-c", pretend], capture_output=True, text=True, check=False)
    assert "needs Python 3.12 or newer, this is 3.9" in one_sentence(done)


def test_help_and_version_come_without_qt_and_without_a_screen() -> None:
    assert main_py("--version").stdout.startswith("hermite ")
    told = main_py("--help", python=("-X", "importtime"))
    assert "evaluate" in told.stdout
    assert "PySide6" not in told.stderr
    assert "numpy" not in told.stderr


def test_a_mistyped_command_is_one_sentence_and_no_window() -> None:
    for words in (("frob",), ("frob", "walk.anim")):
        told = main_py(*words)
        assert told.returncode == 2
        assert "'frob'" in told.stderr
        assert "convert" in told.stderr
        assert len(told.stderr.splitlines()) == 1


def test_the_window_starts_without_a_look_into_the_source_of_its_modules() -> None:
    code = (
        "import inspect; from app.quick_qt import import_qt; import_qt(); read = []; "
        "inspect.getsource = lambda module: read.append(module.__name__) or ''; "
        "import app.main_window, pyqtgraph; print(read)"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.stdout.strip() == "[]", done


@LINUX_ONLY
def test_missing_libraries_are_named_at_once_with_the_command_that_brings_them(monkeypatch: pytest.MonkeyPatch) -> None:
    absent = {"libEGL.so.1", "libxcb-cursor.so.0"}
    monkeypatch.setattr(preflight, "_loads", lambda soname: soname not in absent)
    monkeypatch.setattr(shutil, "which", lambda name: f"/bin/{name}" if name == "apt-get" else None)
    monkeypatch.setattr(os, "geteuid", lambda: 1000)
    told = preflight.library_problem(preflight.missing_libraries("xcb"))
    assert told is not None
    assert told.endswith("sudo apt-get install -y --no-install-recommends libegl1 libxcb-cursor0")
    assert [need.file for need in preflight.missing_libraries("offscreen")] == ["libEGL.so.1"]


@LINUX_ONLY
def test_only_root_or_ci_installs_without_being_asked(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    done: list[list[str]] = []
    monkeypatch.setattr(preflight, "_loads", lambda soname: bool(done))
    monkeypatch.setattr(preflight, "_install", lambda needs: done.append([need.apt for need in needs]))
    monkeypatch.setattr(sys, "stdin", io.StringIO())
    monkeypatch.delenv("CI", raising=False)
    monkeypatch.setattr(os, "geteuid", lambda: 1000)
    assert preflight.main(["--tests"]) == 2
    assert preflight.main(["--install"]) == 2
    assert not done
    assert capsys.readouterr().err.count("\n") == 2
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    assert preflight.main(["--install"]) == 2, "make run asks, even root"
    assert preflight.main(["--tests"]) == 0
    assert "libegl1" in done[0]


def tools_install() -> ModuleType:
    spec = importlib.util.spec_from_file_location("tools_install", ROOT / "tools" / "install.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_packages_are_installed_again_only_when_the_list_changes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install = tools_install()
    calls: list[list[str]] = []

    def run(command: list[str], **_: object) -> subprocess.CompletedProcess[str]:
        calls.append(command)
        return subprocess.CompletedProcess(command, 1 if "broken" in command else 0)

    def pyproject(*runtime: str) -> None:
        lists = f'[project]\ndependencies = {list(runtime)}\n[dependency-groups]\ndev = ["pytest"]\n'
        (tmp_path / "pyproject.toml").write_text(lists, encoding="utf-8")

    monkeypatch.setattr(install, "ROOT", tmp_path)
    monkeypatch.setattr(install, "ENVIRONMENT", tmp_path)
    monkeypatch.setattr(install, "installer", lambda: ["pip"])
    monkeypatch.setattr(install.subprocess, "run", run)
    pyproject("numpy")
    assert [install.main("run"), install.main("run")] == [0, 0]
    assert calls == [["pip", "numpy"]]
    assert [install.main("dev"), install.main("run"), install.main("dev")] == [0, 0, 0]
    assert calls[1:] == [["pip", "numpy", "pytest"]]
    pyproject("numpy", "broken")
    assert [install.main("run"), install.main("run")] == [2, 2], "a failed attempt is not taken for done"
    assert not (tmp_path / ".making").exists()


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A checkout with venv.sh alone, an empty home, and a PATH with no Python at all."""
    (tmp_path / "tools").mkdir()
    shutil.copy(ROOT / "tools" / "venv.sh", tmp_path / "tools")
    (tmp_path / "tools" / "install.py").write_text("import sys; print('ready', sys.argv[1])", encoding="utf-8")
    (tmp_path / "bin").mkdir()
    for name in ("cat", "chmod", "cut", "dirname", "id", "ln", "mkdir", "rm", "sh", "sleep"):
        program = shutil.which(name)
        assert program
        (tmp_path / "bin" / name).symlink_to(program)
    return tmp_path


def program(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
    path.chmod(0o755)
    return path


def venv_sh(checkout: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(checkout / "tools" / "venv.sh"), "run"],
        env={"PATH": str(checkout / "bin"), "HOME": str(checkout)} | environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


@SCRIPTS_ONLY
def test_no_python_at_all_is_one_sentence_that_says_how_to_get_one(checkout: Path) -> None:
    assert "install uv" in one_sentence(venv_sh(checkout))
    assert not (checkout / ".venv").exists()
    program(checkout / "bin" / "apt-get", "exit 0")
    assert "apt-get install -y python3 python3-venv" in one_sentence(venv_sh(checkout))


@SCRIPTS_ONLY
def test_a_python_without_venv_is_one_sentence_with_its_package(checkout: Path) -> None:
    program(checkout / "bin" / "apt-get", "exit 0")
    program(checkout / "bin" / "python3", f'case "$*" in *ensurepip*) exit 1;; esac; exec "{sys.executable}" "$@"')
    version = "{}.{}".format(*sys.version_info)
    assert f"apt-get install -y python{version}-venv" in one_sentence(venv_sh(checkout))


@SCRIPTS_ONLY
def test_without_a_python_uv_makes_the_environment(checkout: Path) -> None:
    python = program(checkout / "fetched", f'exec "{sys.executable}" "$@"')
    makes = f'for place; do :; done; mkdir -p "$place/bin"; ln -s "{python}" "$place/bin/python"'
    program(checkout / ".local" / "bin" / "uv", makes)
    assert venv_sh(checkout).stdout.endswith("ready run\n")
    program(checkout / ".local" / "bin" / "uv", "echo 'no network' >&2; exit 1")
    shutil.rmtree(checkout / ".venv")
    done = venv_sh(checkout)
    assert done.returncode == 2
    assert "make PYTHON=" in done.stderr


@SCRIPTS_ONLY
def test_an_old_python_asked_for_by_name_is_refused(checkout: Path) -> None:
    old = program(checkout / "old", 'case "$*" in *platform*) echo 3.9.2;; *) exit 1;; esac')
    assert "is Python 3.9.2, Hermite needs 3.12 or newer" in one_sentence(venv_sh(checkout, PYTHON=str(old)))
    assert "is not there" in one_sentence(venv_sh(checkout, PYTHON=str(checkout / "none")))


@SCRIPTS_ONLY
def test_a_shim_that_refuses_is_passed_over_and_a_half_made_venv_made_anew(checkout: Path) -> None:
    program(checkout / "bin" / "python3.13", "echo 'pyenv: python3.13: command not found' >&2; exit 127")
    makes = 'case "$*" in "-m venv "*) mkdir -p "$3/bin"; ln -s "$0" "$3/bin/python"; exit;; esac'
    program(checkout / ".pyenv" / "versions" / "3.12.9" / "bin" / "python", f'{makes}; exec "{sys.executable}" "$@"')
    (checkout / ".venv").mkdir()
    (checkout / ".venv" / ".making").write_text("999999999", encoding="ascii")
    (checkout / ".venv" / "half").touch()
    done = venv_sh(checkout)
    assert done.returncode == 0, done
    assert "interrupted" in done.stdout
    assert done.stdout.endswith("ready run\n")
    assert not (checkout / ".venv" / "half").exists()
    assert venv_sh(checkout).stdout == "ready run\n"


@pytest.mark.window
def test_the_virtual_screen_has_a_window_manager() -> None:
    from PySide6.QtTest import QTest
    from PySide6.QtWidgets import QApplication, QWidget

    application = QApplication.instance() or QApplication([])
    window = QWidget()
    window.show()
    assert QTest.qWaitForWindowActive(window, 5000)
    QTest.qWait(100)
    assert window.frameGeometry().height() > window.geometry().height(), "no title bar: nobody manages windows here"
    window.close()
    assert application


def test_a_platform_that_qt_does_not_have_is_named_with_those_it_has() -> None:
    environment = {**os.environ, "QT_QPA_PLATFORM": "bogus"}
    done = subprocess.run(
        [sys.executable, "main.py"], cwd=ROOT, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert "'bogus'" in done.stderr
    assert "offscreen" in done.stderr
    assert done.stderr.count("\n") == 1
