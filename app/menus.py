"""Menus, toolbar and QActions, all made from the rows of ACTIONS."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QMenu, QToolBar, QToolButton

from app.actions import ACTIONS
from app.actions.row import Action, Need, Shortcut
from widgets.theme import ICON_SIZE, Theme

if TYPE_CHECKING:
    from app.main_window import MainWindow

MENUS = {
    "File": "&File",
    "Edit": "&Edit",
    "View": "&View",
    "Key": "&Key",
    "Tangent": "&Tangent",
    "Channel": "&Channel",
    "Curve": "C&urve",
    "Play": "&Play",
    "Help": "He&lp",  # Alt+H reveals channels
}
# Paths of menus that have a button in the toolbar: its icon while nothing is checked, its tip.
TOOLBAR_MENUS = {
    "Curve/Before the First Key": ("pre-constant", "What the curve does before its first key"),
    "Curve/After the Last Key": ("post-constant", "What the curve does after its last key"),
}
# Groups of the toolbar: ids of actions and paths of TOOLBAR_MENUS.
TOOLBAR: tuple[tuple[str, ...], ...] = (
    ("file.open", "file.save"),
    ("key.tool.select", "key.tool.scale", "key.tool.retime"),
    ("tangent.smooth", "tangent.linear", "tangent.flat", "tangent.fixed", "tangent.step", "tangent.auto"),
    ("tangent.break", "tangent.unify"),
    ("Curve/Before the First Key", "Curve/After the Last Key"),
    ("key.snap",),
)


class WindowAction(QAction):
    """The QAction of one row of ACTIONS."""

    def __init__(self, row: Action, window: "MainWindow") -> None:
        super().__init__(row.label, window)
        self.row = row
        self._window = window
        self.setObjectName(row.id)
        self.setShortcuts(key_sequences(row.shortcuts))
        self.setCheckable(row.checked_when is not None)
        self.setIconVisibleInMenu(True)
        if row.icon:
            self.setIcon(Theme.current().icon(row.icon))
        self._unmet = ""
        self._heading = self._headed()
        self._set_tips()
        self.triggered.connect(self.run)

    def run(self) -> None:
        """Do it, unless something it needs is missing or a drag is going on."""
        if self._window.document.working:
            return
        if self.row.keeps_entry:
            self._window.finish_entry()
        self._window.look_at_hand()
        unmet = self.row.unmet_need(self._window)
        if unmet:
            self._window.say(f"{self.row.plain_label}: {unmet}")
        elif self._window.document.gesture is not None and not self.row.in_mid_drag:
            self._window.say(f"{self.row.plain_label}: finish the drag first, or press Esc to cancel it")
        else:
            self.row.function(self._window)
        self._window.refresh_actions()

    def refresh(self, known: dict[Need, bool]) -> None:
        """Show what holds now: enabled or not, checked or not, its words; *known* keeps what was looked up."""
        self._unmet = ""
        for need in self.row.needs:
            if need not in known:
                known[need] = need.met(self._window)
            if not known[need]:
                self._unmet = need.otherwise
                break
        self.setEnabled(not self._unmet)
        if self.row.checked_when is not None:
            self.setChecked(self.row.checked_when(self._window))
        if self.row.label_now is not None:
            self.setText(self.row.label_now(self._window))

    def refresh_tip(self) -> None:
        """Say in the tips why it cannot run, if that has changed."""
        if self._unmet != self._unmet_in_tips:
            self._set_tips()

    def _set_tips(self) -> None:
        self._unmet_in_tips = self._unmet
        reason = f"Not now: {self._unmet}" if self._unmet else ""
        self.setToolTip("\n".join(part for part in (self._heading, self.row.tip, reason) if part))
        self.setStatusTip(" – ".join(part for part in (self.row.tip, reason) if part))

    def _headed(self) -> str:
        keys = shortcut_text(self.row)
        return self.row.plain_label + (f"  ({keys})" if keys else "")


def key_sequences(shortcuts: Iterable[Shortcut]) -> list[QKeySequence]:
    """All sequences of *shortcuts*, each once; a standard key stands for the desktop's first choice."""
    sequences = [QKeySequence(shortcut) for shortcut in shortcuts]
    return [sequence for place, sequence in enumerate(sequences) if sequence not in sequences[:place]]


def shortcut_text(row: Action) -> str:
    """The shortcuts as a person reads them: ``Ctrl+K, F3``."""
    native = QKeySequence.SequenceFormat.NativeText
    return ", ".join(sequence.toString(native) for sequence in key_sequences(row.shortcuts))


def make_actions(window: "MainWindow") -> dict[str, WindowAction]:
    """One QAction a row, added to the window so that its shortcuts work."""
    actions = {row.id: WindowAction(row, window) for row in ACTIONS}
    window.addActions(list(actions.values()))
    return actions


def make_menus(window: "MainWindow", submenus: Mapping[str, QMenu]) -> dict[str, QMenu]:
    """The menu bar, by path. *submenus* maps the id of an action to a menu that stands before it."""
    menus: dict[str, QMenu] = {}

    def menu_of(path: str) -> QMenu:
        if path not in menus:
            parent, _, name = path.rpartition("/")
            title = name if parent else MENUS[name]
            menu = menu_of(parent).addMenu(title) if parent else window.menuBar().addMenu(title)
            menu.setToolTipsVisible(True)
            menus[path] = menu
        return menus[path]

    for name in MENUS:
        menu_of(name)
    for row in ACTIONS:
        if row.begins_group:
            menu_of(row.menu).addSeparator()
        if row.id in submenus:
            menu_of(row.menu).addMenu(submenus[row.id])
        menu_of(row.menu).addAction(window.actions_by_id[row.id])
    for menu in menus.values():
        give_mnemonics(menu)
    return menus


def give_mnemonics(menu: QMenu) -> None:
    """Give each entry without a mnemonic the first free letter, beginnings of words first."""
    texts = [action.text().replace("&&", "") for action in menu.actions()]
    taken = {text[text.index("&") + 1].lower() for text in texts if "&" in text}
    for action in menu.actions():
        text = action.text()
        if not text or "&" in text:
            continue
        starts = [place for place in range(len(text)) if place == 0 or text[place - 1] == " "]
        for place in (*starts, *range(len(text))):
            if text[place].isalpha() and text[place].lower() not in taken:
                taken.add(text[place].lower())
                action.setText(f"{text[:place]}&{text[place:]}")
                break


def make_toolbar(window: "MainWindow") -> QToolBar:
    """The toolbar, as TOOLBAR groups it."""
    bar = Toolbar(window)
    for group in TOOLBAR:
        if bar.actions():
            bar.addSeparator()
        for name in group:
            if name in TOOLBAR_MENUS:
                bar.addWidget(MenuButton(window, name, *TOOLBAR_MENUS[name]))
            else:
                bar.addAction(window.actions_by_id[name])
                button = bar.widgetForAction(window.actions_by_id[name])
                button.setAccessibleName(window.actions_by_id[name].row.plain_label)
    window.addToolBar(Qt.ToolBarArea.TopToolBarArea, bar)
    bar.dress()
    return bar


class Toolbar(QToolBar):
    """A toolbar in which what is on can be seen from afar, in every theme."""

    def __init__(self, window: "MainWindow") -> None:
        super().__init__("Toolbar", window)
        self.setObjectName("toolbar")
        self.setIconSize(QSize(ICON_SIZE))
        Theme.current().theme_changed.connect(self.dress)

    def dress(self) -> None:
        """Take the colours of the theme."""
        self.setStyleSheet(Theme.current().button_style())


class MenuButton(QToolButton):
    """A button of the toolbar that opens a menu; it wears the icon of the menu's checked entry."""

    def __init__(self, window: "MainWindow", path: str, icon: str, tip: str) -> None:
        super().__init__()
        menu = window.menus[path]
        self._icon = Theme.current().icon(icon)
        self._choices = [action for action in menu.actions() if isinstance(action, WindowAction)]
        self.setMenu(menu)
        self.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.setToolTip(tip)
        self.setStatusTip(tip)
        self.setAccessibleName(tip)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        for action in self._choices:
            action.changed.connect(self._wear)
        self._wear()

    def _wear(self) -> None:
        checked = next((action for action in self._choices if action.isChecked()), None)
        self.setIcon(checked.icon() if checked is not None else self._icon)
