"""KeySection: the numbers and rules of the selected keys."""

from typing import Final

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QSizePolicy, QToolButton, QVBoxLayout, QWidget

from model import edits
from model.document import Document
from model.keyframe import TangentRule
from model.labels import keys_text
from model.tangents import TANGENT_RULES
from widgets.form import DimLabel, Heading, PanelButton, QuietCombo, form_grid
from widgets.key_targets import KeyTarget, SelectedKeys
from widgets.numbers import frame_text, suffix_of
from widgets.scrub_label import ScrubLabel
from widgets.theme import Theme
from widgets.value_field import MIXED, ValueField

NUMBERS: Final = (
    ("time", "Time", "Time of the selected keys in seconds"),
    ("value", "Value", "Value of the selected keys"),
    ("slope_in", "Slope in", "Slope of the tangent before the key, value per second; typing one fixes it"),
    ("slope_out", "Slope out", "Slope of the tangent after the key, value per second; typing one fixes it"),
)
WIDEST_UNIT: Final = "s  f 1234"  # so that the fields keep their width
SIDES: Final = (("in", "Rule in"), ("out", "Rule out"))


class KeySection(QWidget):
    """Fields for time, value and slopes, the rules of both sides, broken or unified; mixed where the keys differ."""

    status = Signal(str)

    def __init__(self, document: Document, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._theme = theme
        self._keys = SelectedKeys(document)
        self.heading = Heading(theme, "Key", self)
        self.fields: dict[str, ValueField] = {}
        self.rules: dict[str, QuietCombo] = {}
        self.units: dict[str, DimLabel] = {}
        body = QWidget(self)
        self._grid = form_grid(body)
        self._grid.setColumnMinimumWidth(2, self.fontMetrics().horizontalAdvance(WIDEST_UNIT))
        for name, label, tip in NUMBERS:
            self._add_number(name, label, tip)
        for side, label in SIDES:
            self._add_rule(side, label)
        self.unified = self._half("unify", "Unified", "Both tangents turn together")
        self.unified.clicked.connect(self._unify)
        self.broken = self._half("break", "Broken", "Each tangent turns alone")
        self.broken.clicked.connect(self._break)
        self._add_halves()
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.heading)
        layout.addWidget(body)
        self.refresh()

    def refresh(self) -> None:
        """Show the selected keys as they are now."""
        selection = self._document.session.selection
        self.heading.detail.setText(keys_text(selection) if selection else "nothing selected")
        for name, field in self.fields.items():
            field.refresh()
            self.units[name].setText(self._unit_text(name))
        some = bool(selection)
        for side, combo in self.rules.items():
            combo.setEnabled(some)
            rule = _shared(self._keys.column(f"rule_{side}"))
            combo.show_data(None if rule is None else int(rule), MIXED if some else "")
        broken = _shared(self._keys.column("broken"))
        for half, state in ((self.unified, False), (self.broken, True)):
            half.setEnabled(some)
            half.setChecked(broken is not None and bool(broken) == state)

    def _unit_text(self, name: str) -> str:
        if not self._document.session.selection:
            return ""
        if name == "time":
            times = self._keys.numbers("time")
            if not len(times) or (times != times[0]).any():
                return "s"
            return f"s  f {frame_text(self._document.clip.frame_of(float(times[0])))}"
        unit = suffix_of(self._keys.unit()).strip()
        return unit if name == "value" else f"{unit}/s"

    # --- making

    def _add_row(self, label: QLabel, widget: QWidget, span: int = 2) -> int:
        row = self._grid.rowCount()
        self._grid.addWidget(label, row, 0)
        self._grid.addWidget(widget, row, 1, 1, span)
        return row

    def _add_number(self, name: str, label: str, tip: str) -> None:
        field = ValueField(KeyTarget(self._document, self._keys, name), self._theme, label, tip)
        field.status.connect(self.status)
        self.fields[name] = field
        row = self._add_row(ScrubLabel(label, field), field, span=1)
        self.units[name] = DimLabel(self._theme)
        self._grid.addWidget(self.units[name], row, 2)

    def _add_rule(self, side: str, label: str) -> None:
        combo = QuietCombo(label, self)
        for rule, table_row in TANGENT_RULES.items():
            if side in table_row.sides:
                combo.addItem(self._theme.icon(rule.word), table_row.label, int(rule))
                combo.setItemData(combo.count() - 1, table_row.tip, Qt.ItemDataRole.ToolTipRole)
        combo.setToolTip(f"Who sets the slope {'before' if side == 'in' else 'after'} the key")
        combo.activated.connect(self._set_rule_in if side == "in" else self._set_rule_out)
        words = QLabel(label, self)
        words.setBuddy(combo)
        self._add_row(words, combo)
        self.rules[side] = combo

    def _half(self, icon: str, text: str, tip: str) -> QToolButton:
        button = PanelButton(self._theme, icon, text, self)
        button.setText(text)
        button.setToolTip(tip)
        button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        button.setCheckable(True)
        button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        button.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        return button

    def _add_halves(self) -> None:
        pair = QWidget(self)
        layout = QHBoxLayout(pair)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        layout.addWidget(self.unified)
        layout.addWidget(self.broken)
        self._add_row(QLabel("Tangents", self), pair)

    # --- acting

    def _set_rule_in(self, index: int) -> None:
        self._set_rule("in", TangentRule(self.rules["in"].itemData(index)))

    def _set_rule_out(self, index: int) -> None:
        self._set_rule("out", TangentRule(self.rules["out"].itemData(index)))

    def _set_rule(self, side: str, rule: TangentRule) -> None:
        selection = self._document.session.selection
        label = self._document.label_of(f"Set {rule.word} {side} on", selection)
        self._document.do(label, lambda clip: edits.set_rule(clip, selection, rule, side), keys=selection.count)
        self.refresh()

    def _unify(self) -> None:
        selection = self._document.session.selection
        label = self._document.label_of("Unify", selection)
        self._document.do(label, lambda clip: edits.unify_tangents(clip, selection), keys=selection.count)
        self.refresh()

    def _break(self) -> None:
        selection = self._document.session.selection
        label = self._document.label_of("Break", selection)
        self._document.do(label, lambda clip: edits.break_tangents(clip, selection), keys=selection.count)
        self.refresh()


def _shared(column: NDArray[np.generic]) -> np.generic | None:
    """What all rows of the column are, None if they differ or there are none."""
    return column[0] if len(column) and bool((column == column[0]).all()) else None
