"""The picture of a clip, drawn without a window."""

from pathlib import Path

from PySide6.QtGui import QImage
from pytestqt.qtbot import QtBot

from app.render import render
from tests.widgets.screens import pixels_of, sample_clip


def test_a_clip_becomes_a_picture_of_the_size_asked_for(qtbot: QtBot, tmp_path: Path) -> None:
    clip = sample_clip()
    whole, part = tmp_path / "whole.png", tmp_path / "part.png"
    render(clip, clip.channels, str(whole), size=(640, 360))
    render(clip, clip.channels[:1], str(part), size=(640, 360), start=0.5, end=1.0)
    images = [QImage(str(path)).convertToFormat(QImage.Format.Format_RGB32) for path in (whole, part)]
    assert all((image.width(), image.height()) == (640, 360) for image in images)
    assert (pixels_of(images[0]) != pixels_of(images[1])).sum() > 1000
