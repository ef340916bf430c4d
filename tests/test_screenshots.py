"""The pictures of the README come from the window as it is, and the script that takes them works."""

import re
import subprocess
import sys
from pathlib import Path

from PySide6.QtGui import QImage

from tools.screenshots import IMAGES, PICTURES, SIZE

ROOT = Path(__file__).resolve().parent.parent


def test_the_readme_shows_the_pictures_that_are_taken() -> None:
    shown = re.findall(r"docs/images/([\w-]+\.png)", (ROOT / "README.md").read_text(encoding="utf-8"))
    assert set(shown) == {picture.file for picture in PICTURES} == {path.name for path in IMAGES.iterdir()}


def test_every_picture_can_be_taken_anew_and_shows_a_window_in_its_colours(tmp_path: Path) -> None:
    code = "import sys; from pathlib import Path; from tools.screenshots import main; main(Path(sys.argv[1]))"
    subprocess.run([sys.executable, "-c", code, str(tmp_path)], cwd=ROOT, check=True, capture_output=True, timeout=120)
    for picture in PICTURES:
        image = QImage(str(tmp_path / picture.file))
        assert (image.width(), image.height()) == SIZE
        assert (image.pixelColor(5, SIZE[1] - 60).lightness() > 128) == (picture.appearance == "light")
        assert (tmp_path / picture.file).stat().st_size < 300_000
