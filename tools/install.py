"""Installs what pyproject.toml lists into the environment whose Python runs this: `install.py run` or `install.py dev`.

The lists have one home, pyproject.toml; what was installed last is kept in the environment, so that an unchanged
list costs a look at one file and needs no network.
"""

import importlib.util
import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ENVIRONMENT = Path(sys.prefix)


def wanted(kind: str) -> list[str]:
    """The requirements of the editor ("run"), or of the editor and its tests ("dev")."""
    table = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    requirements: list[str] = table["project"]["dependencies"]
    if kind == "dev":
        requirements = requirements + table["dependency-groups"]["dev"]
    return requirements


def installer() -> list[str] | None:
    """The command that installs packages here: pip, or uv where the environment was made without pip."""
    if importlib.util.find_spec("pip"):
        return [sys.executable, "-m", "pip", "install", "-qq", "--disable-pip-version-check", "--no-input"]
    if uv := os.environ.get("UV") or shutil.which("uv"):
        return [uv, "pip", "install", "--quiet", "--python", sys.executable]
    if importlib.util.find_spec("ensurepip"):
        subprocess.run([sys.executable, "-m", "ensurepip"], check=True, stdout=subprocess.DEVNULL)
        return installer()
    return None


def installed(kind: str) -> bool:
    """Whether the list of this kind, or a longer one that holds it, is what was installed last."""
    text = "\n".join(wanted(kind))
    return any(
        stamp.exists() and stamp.read_text(encoding="utf-8").startswith(text)
        for stamp in (ENVIRONMENT / ".installed-run", ENVIRONMENT / ".installed-dev")
    )


def main(kind: str) -> int:
    """Installs what is missing; 0 when everything is there, 2 after one sentence when it cannot be had."""
    if installed(kind):
        return 0
    command = installer()
    if command is None:
        print(f"{ENVIRONMENT} has neither pip nor uv: rm -r {ENVIRONMENT}, then make again.", file=sys.stderr)
        return 2
    requirements = wanted(kind)
    print(f"Installing the {len(requirements)} packages that pyproject.toml lists for this (once) ...", flush=True)
    # The mark stays when this process is killed: the next make then starts from nothing instead of from half a package.
    mark = ENVIRONMENT / ".making"
    mark.write_text(str(os.getpid()), encoding="ascii")
    failed = subprocess.run([*command, *requirements], stdin=subprocess.DEVNULL, check=False).returncode
    mark.unlink()
    if failed:
        print("The packages could not be installed; the lines above say why. Then make again.", file=sys.stderr)
        return 2
    (ENVIRONMENT / f".installed-{kind}").write_text("\n".join(requirements), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
