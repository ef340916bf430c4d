"""Transport: the row of buttons and fields that moves the playhead."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Final, NamedTuple

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QPalette, QResizeEvent
from PySide6.QtWidgets import QBoxLayout, QFrame, QHBoxLayout, QLabel, QSizePolicy, QToolButton, QWidget

from model.document import Document
from widgets.form import PanelButton
from widgets.guard import guarded
from widgets.number_targets import PlayheadTarget, SettingTarget
from widgets.playback import Playback
from widgets.scrub_label import ScrubLabel
from widgets.soon import Soon
from widgets.theme import Theme
from widgets.value_field import Target, ValueField

FIELD_WIDTH: Final = 72


class Button(NamedTuple):
    """One button: its name, icon, words, what it does to the playback; a gap before it begins a group."""

    name: str
    icon: str
    label: str
    act: Callable[[Playback], object]
    gap: bool = False


BUTTONS: Final = (
    Button("to_start", "first", "Go to the start", Playback.to_start),
    Button("previous_key", "previous-key", "Previous key", lambda playback: playback.step_key(-1)),
    Button("previous_frame", "previous-frame", "Previous frame", lambda playback: playback.step_frame(-1)),
    Button("play", "play", "Play or pause", Playback.toggle_play),
    Button("next_frame", "next-frame", "Next frame", lambda playback: playback.step_frame(1)),
    Button("next_key", "next-key", "Next key", lambda playback: playback.step_key(1)),
    Button("to_end", "last", "Go to the end", Playback.to_end),
    Button("stop", "stop", "Stop and go back to where playing began", Playback.stop, gap=True),
)


class Number(NamedTuple):
    """One field: its name, label, what a person is told, its unit, what it is about."""

    name: str
    label: str
    tip: str
    unit: str
    target: Callable[[Document], Target]


PLAYHEAD: Final = (
    Number("frame", "Frame", "The playhead in frames", "", lambda document: PlayheadTarget(document, in_frames=True)),
    Number("time", "Time", "The playhead in seconds", "s", lambda document: PlayheadTarget(document, in_frames=False)),
)
RANGE: Final = (
    Number("start", "Range", "Start of the range in seconds", "", partial(SettingTarget, field="start")),
    Number("end", "to", "End of the range in seconds", "s", partial(SettingTarget, field="end")),
    Number("frame_rate", "Rate", "Frames per second", "fps", partial(SettingTarget, field="frame_rate")),
)


class Transport(QWidget):
    """Play, stop, loop, steps; frame, time, range and frame rate as fields."""

    status = Signal(str)

    def __init__(self, document: Document, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._theme = theme
        self.playback = Playback(document, self)
        self.playback.status.connect(self.status)
        self.buttons: dict[str, QToolButton] = {}
        self.fields: dict[str, ValueField] = {}
        self._refresh = Soon(self, self._show_numbers, document=document)
        # Beside each other, or one above the other where there is little room.
        self._lines = QBoxLayout(QBoxLayout.Direction.LeftToRight, self)
        self._lines.setContentsMargins(6, 3, 6, 3)
        self._lines.setSpacing(2)
        self._parts = first, second = QHBoxLayout(), QHBoxLayout()
        for line, stretch in ((first, 0), (second, 1)):
            line.setSpacing(2)
            self._lines.addLayout(line, stretch)
        self._layout = first
        self._add_buttons()
        self._add_line()
        for row in PLAYHEAD:
            self._add_field(row)
        self._layout.addStretch(1)
        self._layout = second
        self._layout.addStretch(1)
        for row in RANGE:
            self._add_field(row)
        self._needed = self.sizeHint().width()
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        self._listen()
        self._show_options("playing")
        self._show_options("loop")

    # --- Qt

    @guarded(QSize(0, 0))
    def minimumSizeHint(self) -> QSize:
        margins = self._lines.contentsMargins()
        widest = max(part.minimumSize().width() for part in self._parts)
        return QSize(widest + margins.left() + margins.right(), super().minimumSizeHint().height())

    @guarded()
    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        beside = event.size().width() >= self._needed
        directions = QBoxLayout.Direction
        self._lines.setDirection(directions.LeftToRight if beside else directions.TopToBottom)

    # --- for the actions of the window

    def toggle_play(self) -> None:
        """Play from the playhead, or pause there."""
        self.playback.toggle_play()

    def stop(self) -> None:
        """Stop and go back to where playing began; when already stopped, to the start."""
        self.playback.stop()

    def toggle_loop(self) -> None:
        """Begin again at the end of the range, or stop there."""
        session = self._document.session
        session.loop = not session.loop

    def step_frame(self, frames: int) -> None:
        """Go so many frames on or back."""
        self.playback.step_frame(frames)

    def step_key(self, direction: int) -> None:
        """Go to the next (1) or the previous (-1) key."""
        self.playback.step_key(direction)

    def to_start(self) -> None:
        """Go to the start of the range."""
        self.playback.to_start()

    def to_end(self) -> None:
        """Go to the end of the range."""
        self.playback.to_end()

    def show_shortcuts(self, shortcuts: Mapping[str, str]) -> None:
        """Name the shortcuts, as people read them, in the tooltips of the buttons of these names."""
        for name, text in shortcuts.items():
            button = self.buttons[name]
            label = button.toolTip().partition("  (")[0]
            button.setToolTip(f"{label}  ({text})" if text else label)

    # --- making

    def _add_buttons(self) -> None:
        for row in BUTTONS:
            if row.gap:
                self._layout.addSpacing(8)
            button = self._add_button(row.name, row.icon, row.label)
            # The function holds the playback, not this widget: a slot that holds its widget keeps it alive for ever.
            button.clicked.connect(lambda _checked=False, act=row.act, playback=self.playback: act(playback))
        loop = self._add_button("loop", "loop", "Loop: begin again at the end of the range")
        loop.setCheckable(True)
        loop.clicked.connect(self.toggle_loop)

    def _add_button(self, name: str, icon: str, label: str) -> QToolButton:
        button = PanelButton(self._theme, icon, label, self)
        button.setAutoRaise(True)
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.buttons[name] = button
        self._layout.addWidget(button)
        return button

    def _add_field(self, row: Number) -> None:
        field = ValueField(row.target(self._document), self._theme, row.tip, row.tip)
        field.setFixedWidth(FIELD_WIDTH)
        field.setAlignment(Qt.AlignmentFlag.AlignRight)
        field.status.connect(self.status)
        self._layout.addSpacing(8)
        self._layout.addWidget(ScrubLabel(row.label, field))
        self._layout.addSpacing(4)
        self._layout.addWidget(field)
        if row.unit:
            self._layout.addSpacing(2)
            self._layout.addWidget(QLabel(row.unit))
        self.fields[row.name] = field

    def _add_line(self) -> None:
        line = QFrame(self)
        line.setFrameShape(QFrame.Shape.VLine)
        line.setFrameShadow(QFrame.Shadow.Plain)
        line.setForegroundRole(QPalette.ColorRole.Mid)
        self._layout.addSpacing(6)
        self._layout.addWidget(line)
        self._layout.addSpacing(2)

    # --- keeping up

    def _listen(self) -> None:
        document, session = self._document, self._document.session
        session.playhead_changed.connect(self._refresh.ask)
        session.option_changed.connect(self._show_options)
        document.setting_changed.connect(self._refresh.ask)
        document.clip_replaced.connect(self._refresh.ask)

    def _show_numbers(self) -> None:
        for field in self.fields.values():
            field.refresh()

    def _show_options(self, name: str) -> None:
        session = self._document.session
        if name == "playing":
            icon, words = ("pause", "Pause") if session.playing else ("play", "Play")
            self.buttons["play"].setIcon(self._theme.icon(icon))
            self.buttons["play"].setAccessibleName(words)
        elif name == "loop":
            self.buttons["loop"].setChecked(session.loop)
