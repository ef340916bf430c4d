"""The wheel: one package and one command, started from an environment that has never seen this checkout."""

import importlib.util
import os
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

import pytest

from app import __version__

ROOT = Path(__file__).resolve().parent.parent
SAMPLE = ROOT / "resources" / "samples" / "bounce.hermite"


def done(*words: str | Path, cwd: Path) -> str:
    """Runs a command away from the checkout, with no path of it in the environment; what it printed."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    result = subprocess.run(
        [str(word) for word in words],
        cwd=cwd,
        env=environment,
        capture_output=True,
        text=True,
        timeout=170,
        check=False,
    )
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


@pytest.fixture(scope="session")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    done(sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", folder, ROOT, cwd=folder)
    (result,) = folder.glob("*.whl")
    return result


@pytest.fixture(scope="session")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, set[str]]:
    """A clean environment with the wheel in it: its folder of programs, and what the wheel added to site-packages."""
    place = tmp_path_factory.mktemp("clean")
    # An environment that uv made has no pip to lend; making one takes seconds.
    lent = importlib.util.find_spec("pip") is not None
    done(sys.executable, "-m", "venv", *(["--without-pip"] if lent else []), place, cwd=place)
    programs = place / ("Scripts" if os.name == "nt" else "bin")
    python = programs / "python"
    site = Path(done(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))", cwd=place).strip())
    before = {path.name for path in site.iterdir()}
    pip = [sys.executable, "-m", "pip", "--python", python] if lent else [python, "-m", "pip"]
    done(*pip, "install", "--quiet", "--no-index", "--no-deps", wheel, cwd=place)
    added = {path.name for path in site.iterdir()} - before
    # Qt and numpy are borrowed from the environment of the tests: they are 150 MB, and a test needs no network.
    lenders = {sysconfig.get_path("purelib"), sysconfig.get_path("platlib")}
    (site / "borrowed.pth").write_text("\n".join(lenders), encoding="utf-8")
    return programs, added


def test_the_wheel_holds_the_rooms_and_nothing_of_the_workshop(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    assert "hermite_editor/__main__.py" in names
    assert "hermite_editor/resources/samples/bounce.hermite" in names
    assert any(name.endswith("share/applications/hermite.desktop") for name in names)
    assert not [name for name in names if "/tests/" in name or "__pycache__" in name or name.endswith((".pyc", ".tmp"))]


def test_the_wheel_adds_one_name_to_everybody_elses(installed: tuple[Path, set[str]]) -> None:
    assert installed[1] == {"hermite_editor", f"hermite_editor-{__version__}.dist-info"}


def test_the_installed_command_tells_its_version_and_reads_a_clip(
    installed: tuple[Path, set[str]], tmp_path: Path
) -> None:
    hermite = installed[0] / "hermite"
    assert done(hermite, "--version", cwd=tmp_path).strip() == f"hermite {__version__}"
    assert "ball.ty" in done(hermite, "info", SAMPLE, cwd=tmp_path)


def test_the_installed_window_opens_and_draws(installed: tuple[Path, set[str]], tmp_path: Path) -> None:
    assert "8 channels, 51 keys" in done(installed[0] / "hermite", "--check", SAMPLE, cwd=tmp_path)
    assert "8 channels, 51 keys" in done(installed[0] / "python", "-m", "hermite_editor", "--check", cwd=tmp_path)
