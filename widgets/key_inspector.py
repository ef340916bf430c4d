"""KeyInspector: the selected keys and the active channel in numbers and words."""

from typing import Final

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import QFrame, QScrollArea, QVBoxLayout, QWidget

from model.document import Document
from widgets.channel_section import ChannelSection
from widgets.guard import guarded
from widgets.key_section import KeySection
from widgets.soon import Soon
from widgets.theme import Theme

# So many selected keys are read again only when a drag is over.
MOST_KEYS_IN_A_DRAG: Final = 20_000


class KeyInspector(QScrollArea):
    """Two sections, kept up to date a little after the document, so that a drag does not wait for them."""

    status = Signal(str)

    def __init__(self, document: Document, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self.key = KeySection(document, theme)
        self.channel = ChannelSection(document, theme)
        self.key.status.connect(self.status)
        self.channel.status.connect(self.status)
        self._keys_soon = Soon(self, self._refresh_keys, document=document)
        self._channel_soon = Soon(self, self.channel.refresh, least_pause=0.1, document=document)
        self._lay_out()
        self._listen()

    def _lay_out(self) -> None:
        body = QWidget()
        layout = QVBoxLayout(body)
        layout.setContentsMargins(10, 8, 10, 8)
        layout.setSpacing(10)
        line = QFrame()
        line.setFrameShape(QFrame.Shape.HLine)
        line.setFrameShadow(QFrame.Shadow.Plain)
        line.setForegroundRole(self.backgroundRole().Mid)
        for widget in (self.key, line, self.channel):
            layout.addWidget(widget)
        layout.addStretch(1)
        self.setWidget(body)
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setAccessibleName("Key inspector")

    def _listen(self) -> None:
        document, session = self._document, self._document.session
        for event in (document.changed, document.gesture_changed, session.selection_changed, document.clip_replaced):
            event.connect(self._keys_soon.ask)
        document.setting_changed.connect(self._keys_soon.ask)
        document.setting_changed.connect(self._channel_soon.ask)
        for event in (document.gesture_changed, session.active_changed, document.clip_replaced):
            event.connect(self._channel_soon.ask)
        document.changed.connect(self._channel_soon.ask)

    def _refresh_keys(self) -> None:
        large = self._document.session.selection.count > MOST_KEYS_IN_A_DRAG
        if not (large and self._document.gesture is not None):
            self.key.refresh()

    @guarded(QSize(240, 400))
    def sizeHint(self) -> QSize:
        return QSize(264, 520)

    @guarded(QSize(200, 100))
    def minimumSizeHint(self) -> QSize:
        return QSize(210, 120)
