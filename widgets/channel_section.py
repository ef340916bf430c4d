"""ChannelSection: name, unit and extrapolations of the active channel, and what can be said about it in numbers."""

from typing import Final

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QLabel, QLineEdit, QVBoxLayout, QWidget

from model import edits
from model.channel import Channel
from model.document import Document
from model.extrapolation import EXTRAPOLATIONS, Extrapolation
from model.labels import counted
from widgets.channel_verbs import rename, settings
from widgets.form import DimText, Heading, QuietCombo, form_grid
from widgets.numbers import factor_of, shown, suffix_of
from widgets.theme import Theme

UNITS: Final = (("", "Plain number"), ("angle", "Angle (shown in degrees)"), ("m", "m"), ("cm", "cm"), ("%", "%"))
SIDES: Final = (("pre", "Before", "before its first key"), ("post", "After", "after its last key"))
# A channel with more keys is measured again only when a drag is over.
MOST_KEYS_IN_A_DRAG: Final = 20_000


class ChannelSection(QWidget):
    """What belongs to the active channel as a whole."""

    status = Signal(str)

    def __init__(self, document: Document, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._theme = theme
        self._measured: tuple[Channel, int] | None = None
        self.heading = Heading(theme, "Channel", self)
        self.name = QLineEdit(self)
        self.unit = QuietCombo("Unit", self)
        self._unit_line = QLineEdit(self)
        self.modes: dict[str, QuietCombo] = {}
        self.facts = DimText(theme, self)
        body = QWidget(self)
        self._grid = form_grid(body)
        self._set_up_name()
        self._set_up_unit()
        for side, label, place in SIDES:
            self._add_mode(side, label, place)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.heading)
        layout.addWidget(body)
        layout.addWidget(self.facts)
        self.refresh()

    def refresh(self) -> None:
        """Show the active channel as it is now."""
        channel = self._document.session.active
        for widget in (self.name, self.unit, *self.modes.values()):
            widget.setEnabled(channel is not None)
        self.heading.detail.setText("none active" if channel is None else "locked" if channel.locked else "")
        if not self.name.isModified():
            text = "" if channel is None else channel.name
            if text != self.name.text():
                self.name.setText(text)
        if channel is None:
            self.unit.show_data(None, "")
        elif channel.unit != self.unit.currentData():
            self._show_unit(channel.unit)
        for side, combo in self.modes.items():
            combo.setEnabled(channel is not None and not channel.locked)
            combo.show_data(None if channel is None else int(getattr(channel, side)), "")
        self._measure(channel)

    def _measure(self, channel: Channel | None) -> None:
        if channel is None:
            self._measured = None
            self.facts.say("")
            return
        in_drag = self._document.gesture is not None and len(channel) > MOST_KEYS_IN_A_DRAG
        if in_drag or self._measured == (channel, channel.revision):
            return
        self._measured = channel, channel.revision
        lines = [counted(len(channel), "key")]
        if channel.first is not None and channel.last is not None:
            lowest, highest = channel.extrema()
            factor, suffix = factor_of(channel.unit), suffix_of(channel.unit)
            lines.append(f"Times {shown(channel.first.time)} to {shown(channel.last.time)} s")
            lines.append(f"Values {shown(lowest * factor, 5)} to {shown(highest * factor, 5)}{suffix}")
        self.facts.say("\n".join(lines))

    # --- making

    def _add_row(self, label: str, widget: QWidget) -> None:
        words = QLabel(label, self)
        words.setBuddy(widget)
        row = self._grid.rowCount()
        self._grid.addWidget(words, row, 0)
        self._grid.addWidget(widget, row, 1)

    def _set_up_name(self) -> None:
        self.name.setAccessibleName("Name")
        self.name.setToolTip("The name of the active channel; what stands before the last dot is its group")
        self.name.editingFinished.connect(self._rename)
        self._add_row("Name", self.name)

    def _set_up_unit(self) -> None:
        self.unit.setLineEdit(self._unit_line)
        self.unit.setInsertPolicy(QComboBox.InsertPolicy.NoInsert)
        self.unit.setToolTip("What the values are measured in; angles are stored in radians and shown in degrees")
        for unit, label in UNITS:
            self.unit.addItem(label, unit)
        self.unit.activated.connect(self._unit_chosen)
        self._unit_line.setAccessibleName("Unit")
        self._unit_line.editingFinished.connect(self._unit_typed)
        self._add_row("Unit", self.unit)

    def _add_mode(self, side: str, label: str, place: str) -> None:
        combo = QuietCombo(f"Extrapolation {place}", self)
        for mode, row in EXTRAPOLATIONS.items():
            combo.addItem(self._theme.icon(f"{side}-{mode.word.replace('_', '-')}"), row.label, int(mode))
            combo.setItemData(combo.count() - 1, row.tip, Qt.ItemDataRole.ToolTipRole)
        combo.setToolTip(f"How the channel goes on {place}")
        combo.activated.connect(self._set_pre if side == "pre" else self._set_post)
        self.modes[side] = combo
        self._add_row(label, combo)

    # --- acting

    def _rename(self) -> None:
        channel, changed = self._document.session.active, self.name.isModified()
        self.name.setModified(False)
        if channel is not None and changed:
            problem = rename(self._document, {channel: self.name.text().strip()})
            if problem:
                self.status.emit(problem)
        self.refresh()

    def _show_unit(self, unit: str) -> None:
        index = self.unit.findData(unit)
        self.unit.setCurrentIndex(index)
        if index < 0:
            self.unit.setEditText(unit)

    def _unit_chosen(self, index: int) -> None:
        self._set_unit(self.unit.itemData(index))

    def _unit_typed(self) -> None:
        line, channel = self._unit_line, self._document.session.active
        if channel is None or not line.isModified():
            return
        line.setModified(False)
        text = line.text().strip()
        labels = {label: unit for unit, label in UNITS}
        self._set_unit(labels.get(text, text))

    def _set_unit(self, unit: str) -> None:
        channel = self._document.session.active
        if channel is not None and unit != channel.unit:
            label = f"Set the unit of {channel.name} to {unit or 'none'}"
            try:
                self._document.do(label, lambda clip: settings([channel], "unit", unit))
            except ValueError as error:
                self.status.emit(f"{error}")
                self._show_unit(channel.unit)
        self._measured = None
        self.refresh()

    def _set_pre(self, index: int) -> None:
        self._set_mode("pre", Extrapolation(self.modes["pre"].itemData(index)))

    def _set_post(self, index: int) -> None:
        self._set_mode("post", Extrapolation(self.modes["post"].itemData(index)))

    def _set_mode(self, side: str, mode: Extrapolation) -> None:
        channel = self._document.session.active
        if channel is None:
            return
        place = "before" if side == "pre" else "after"
        label = f"Set {EXTRAPOLATIONS[mode].label.lower()} {place} {channel.name}"
        pre, post = (mode, None) if side == "pre" else (None, mode)
        self._document.do(label, lambda clip: edits.set_extrapolation(clip, [channel], pre, post))
        self.refresh()
