"""last_picture: what the screen shows of a widget, without asking the widget to paint."""

from PySide6.QtCore import QPoint, QRect
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QWidget


def last_picture(widget: QWidget) -> QImage:
    """The pixels of *widget* as they were painted last, in the pixels of the screen; empty if it is not shown."""
    if not widget.isVisible():
        return QImage()
    store = widget.window().backingStore()
    painted = store.paintDevice() if store is not None else None
    if not isinstance(painted, QImage):  # the platform paints elsewhere
        return widget.grab().toImage()
    ratio = painted.devicePixelRatio()
    place = widget.mapTo(widget.window(), QPoint(0, 0))
    return painted.copy(
        QRect(
            round(place.x() * ratio),
            round(place.y() * ratio),
            round(widget.width() * ratio),
            round(widget.height() * ratio),
        )
    )
