"""The rules of the house, checked on every file: who may import whom, what is never called, what the papers promise."""

import ast
import functools
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from app import __version__

ROOT = Path(__file__).resolve().parent.parent
ROOMS = ("app", "model", "widgets", "tests", "tools", "resources", "docs")
MODULES = sorted([ROOT / "main.py", *(path for room in ROOMS for path in (ROOT / room).rglob("*.py"))])
SHIPPED = [path for path in MODULES if path.relative_to(ROOT).parts[0] in ("main.py", "app", "model", "widgets")]
PAPERS = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
TEXTS = sorted(
    path
    for path in [*ROOT.iterdir(), *(path for room in ROOMS for path in (ROOT / room).rglob("*"))]
    if path.is_file() and path.suffix in (".py", ".md", ".toml", ".sh", ".svg", ".xml", ".desktop", "")
)

FORBIDDEN_CALLS = {"eval", "exec", "compile", "__import__"}
FORBIDDEN_IMPORTS = {"pickle", "marshal", "shelve", "dill", "cloudpickle", "yaml"}
FORBIDDEN_ATTRIBUTES = {"os.system", "os.popen", "yaml.load", "torch.load", "numpy.load", "np.load"}


def name_of(path: Path) -> str:
    return str(path.relative_to(ROOT))


@functools.cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"), str(path))


def dangers(tree: ast.AST) -> Iterator[str]:
    """What in a module could run text or data as a program."""
    for node in ast.walk(tree):
        match node:
            case ast.Call(func=ast.Name(id=called)) if called in FORBIDDEN_CALLS:
                yield f"line {node.lineno}: {called}()"
            case ast.Attribute(value=ast.Name(id=owner), attr=attribute) if (
                f"{owner}.{attribute}" in FORBIDDEN_ATTRIBUTES
            ):
                yield f"line {node.lineno}: {owner}.{attribute}"
            case ast.Import(names=names) if {alias.name.partition(".")[0] for alias in names} & FORBIDDEN_IMPORTS:
                yield f"line {node.lineno}: import"
            case ast.ImportFrom(module=str(module)) if module.partition(".")[0] in FORBIDDEN_IMPORTS:
                yield f"line {node.lineno}: from {module}"
            case ast.keyword(arg="shell" | "allow_pickle", value=ast.Constant(value=True)):
                yield f"line {node.value.lineno}: {node.arg}=True"


@pytest.mark.parametrize(
    "text",
    [
        "eval('1')",
        "exec(x)",
        "import pickle",
        "from marshal import loads",
        "os.system('ls')",
        "np.load(f, allow_pickle=True)",
        "subprocess.run('ls', shell=True)",
    ],
)
def test_a_planted_danger_is_seen(text: str) -> None:
    assert list(dangers(ast.parse(text)))


def test_nothing_runs_data_as_a_program() -> None:
    assert not {name_of(path): found for path in SHIPPED if (found := list(dangers(tree_of(path))))}


def test_every_module_says_what_it_is() -> None:
    assert not [name_of(path) for path in MODULES if tree_of(path).body and not ast.get_docstring(tree_of(path))]


def test_every_module_stays_small() -> None:
    lengths = {name_of(path): path.read_text(encoding="utf-8").count("\n") for path in MODULES}
    assert not {name: lines for name, lines in lengths.items() if lines > 400}, "what do they hide?"


def offenders(paths: list[Path], pattern: str) -> dict[str, str]:
    """The files whose text matches, with what matched."""
    found = {name_of(path): re.search(pattern, path.read_text(encoding="utf-8")) for path in paths}
    return {name: match[0] for name, match in found.items() if match}


def test_nothing_is_left_unfinished() -> None:
    assert not offenders(SHIPPED, r"\b(TODO|FIXME|XXX|HACK)\b")


def test_no_file_names_a_place_on_one_machine_or_where_packages_come_from() -> None:
    texts = [path for path in TEXTS if path != Path(__file__).resolve()]
    assert not offenders(texts, r"(?<![\w.])/(work|farm|root|tmp|home)/\w")
    assert not offenders(texts, r"pypi\.org|pythonhosted|deb\.debian|npmjs|registry\.")


def test_the_rooms_import_each_other_one_way_only() -> None:
    check = (
        "import sys; from importlinter.cli import lint_imports_command; sys.exit(lint_imports_command(['--no-cache']))"
    )
    done = subprocess.run([sys.executable, "-c", check], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_no_module_of_the_model_brings_qt_with_it() -> None:
    names = [
        ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
        for path in SHIPPED
        if path.is_relative_to(ROOT / "model")
    ]
    code = (
        f"import importlib, sys\nfor name in {names}: importlib.import_module(name)\n"
        "print(*(name for name in sys.modules if name.startswith(('PySide6', 'shiboken6', 'pyqtgraph'))))"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""


def test_what_a_paper_links_to_is_there() -> None:
    for path in PAPERS:
        text = path.read_text(encoding="utf-8")
        targets = re.findall(r"\]\(([^)#\s]+)[^)]*\)", text) + re.findall(r'(?:src|href)="([^"#]+)"', text)
        missing = [target for target in targets if "://" not in target and not (path.parent / target).exists()]
        assert not missing, path


def test_pictures_of_the_papers_stay_light() -> None:
    heavy = [path for path in (ROOT / "docs").rglob("*.png") if path.stat().st_size > 300_000]
    assert not heavy


def test_the_changelog_knows_this_version_or_what_comes_next() -> None:
    headings = re.findall(r"^## \[(.+?)\]", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert {"Unreleased", __version__} & set(headings)
