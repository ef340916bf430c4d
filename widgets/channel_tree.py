"""ChannelTree: all channels of the clip with their values, to be found, chosen, shown, locked and renamed."""

from typing import Final

from PySide6.QtCore import QEvent, QModelIndex, QObject, Qt, Signal
from PySide6.QtGui import QContextMenuEvent, QKeyEvent
from PySide6.QtWidgets import QLineEdit, QVBoxLayout, QWidget

from model.channel import Channel
from model.clip import Clip
from model.document import Document
from widgets import channel_verbs
from widgets.channel_menu import channel_menu
from widgets.channel_rows import Column
from widgets.channel_view import ChannelView
from widgets.guard import guarded
from widgets.soon import Soon
from widgets.theme import Theme

NO_CHANNELS: Final = "No channels\n\nOpen a clip, or add a channel from the Channel menu."
NO_MATCH: Final = "No channel matches “{}”\n\nEsc in the filter field clears it."


class ChannelTree(QWidget):
    """A filter field above the tree of groups and channels; it never moves but to show the active channel."""

    frame_requested = Signal(object)
    status = Signal(str)
    left = Signal()  # from the filter, to the graph

    def __init__(self, document: Document, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document = document
        self.theme = theme
        self._follows = False  # while the tree itself sets the active channel or is being filled
        self.filter = QLineEdit(self)
        self.view = ChannelView(document, theme, self)
        self._values = Soon(self, self.view.update_values, least_pause=0.015, document=document)
        self._set_up_filter()
        self._set_up_view()
        layout = QVBoxLayout(self)
        layout.setContentsMargins(6, 6, 6, 6)
        layout.setSpacing(6)
        layout.addWidget(self.filter)
        layout.addWidget(self.view)
        self.setTabOrder(self.filter, self.view)
        self._listen()
        self.rebuild()

    def _set_up_filter(self) -> None:
        field = self.filter
        field.setPlaceholderText("Filter channels")
        field.setAccessibleName("Filter channels")
        field.setToolTip(
            "Show the channels whose full names hold all these words.\n"
            "Esc clears, and again goes to the graph; Down goes on to the channels."
        )
        field.setClearButtonEnabled(True)
        field.addAction(self.theme.icon("search"), QLineEdit.ActionPosition.LeadingPosition)
        field.textChanged.connect(self.rebuild)
        field.installEventFilter(self)

    def _set_up_view(self) -> None:
        view = self.view
        view.setAccessibleName("Channels")
        view.setAccessibleDescription(
            "Arrow keys move, Right goes to the icons show, lock and solo, Space turns one over. "
            "F2 renames, Enter frames."
        )
        view.rows.rename = self._rename
        view.framed.connect(self.frame_requested)
        view.refused.connect(self.status)
        view.collapsed.connect(self._remember_fold)
        view.expanded.connect(self._remember_fold)
        view.selectionModel().currentChanged.connect(self._current_changed)

    def _listen(self) -> None:
        document, session = self.document, self.document.session
        document.changed.connect(self._values.ask)
        document.setting_changed.connect(self._setting_changed)
        document.membership_changed.connect(self.rebuild)
        document.clip_replaced.connect(self._clip_replaced)
        session.playhead_changed.connect(self._values.ask)
        session.visibility_changed.connect(self._repaint)
        session.active_changed.connect(self._show_active)
        self.theme.theme_changed.connect(self.view.recolor)

    # --- for the window

    def chosen(self) -> list[Channel]:
        """The channels of the chosen rows in the clip's order, else the active channel."""
        chosen = self.view.chosen()
        active = self.document.session.active
        return chosen if chosen or active is None else [active]

    def hide_chosen(self) -> None:
        """Hide the chosen channels."""
        channel_verbs.set_shown(self.document.session, self.chosen(), False)

    def show_only_chosen(self) -> None:
        """Hide all but the chosen channels."""
        channel_verbs.show_only(self.document, self.chosen())

    def reveal_all(self) -> None:
        """Show every channel."""
        channel_verbs.reveal_all(self.document.session)

    def rename_chosen(self) -> None:
        """Edit the name in the row of the current or active channel."""
        active = self.document.session.active
        index = self.view.currentIndex()
        if not index.isValid() and active is not None:
            index = self.view.rows.index_of(active)
        if index.isValid():
            self.view.setFocus()
            self.view.edit(index.siblingAtColumn(Column.NAME))

    def focus_filter(self) -> None:
        """Go to the filter field."""
        self.filter.setFocus(Qt.FocusReason.ShortcutFocusReason)
        self.filter.selectAll()

    # --- keeping up

    def rebuild(self, *_: object) -> None:
        """Take the channels from the clip again; folds, chosen rows and the place stay."""
        view, words = self.view, self.filter.text().split()
        chosen, place = view.chosen(), view.verticalScrollBar().value()
        folded = self.document.session.folded
        self._follows = True
        view.cells.forget_colors()
        view.rows.show(words)
        view.blockSignals(True)  # one for each of thousands of groups otherwise
        view.expandAll()
        for row, group in enumerate(view.rows.groups if not words and folded else ()):
            if group.name in folded:
                view.collapse(view.rows.index(row, 0))
        view.blockSignals(False)
        view.forget_places()
        view.choose(chosen)
        self._follows = False
        self._show_active()
        view.verticalScrollBar().setValue(place)
        view.empty_text = NO_MATCH.format(self.filter.text()) if self.document.clip.channels else NO_CHANNELS
        view.viewport().update()

    def _clip_replaced(self) -> None:
        self._follows = True
        self.view.clearSelection()
        self._follows = False
        self.filter.clear()
        self.rebuild()
        self.view.scrollToTop()

    def _setting_changed(self, target: Channel | Clip, field: str) -> None:
        if isinstance(target, Clip):
            return
        if field == "name":
            self.rebuild()
        else:
            self.view.cells.forget_colors()
            self._repaint()

    def _repaint(self) -> None:
        self.view.viewport().update()

    def _remember_fold(self, index: QModelIndex) -> None:
        if self._follows or self.filter.text():
            return
        name = self.view.rows.groups[index.row()].name
        session = self.document.session
        session.folded = session.folded - {name} if self.view.isExpanded(index) else session.folded | {name}

    def _current_changed(self, index: QModelIndex, _previous: QModelIndex) -> None:
        channel = self.view.rows.channel_of(index)
        if not self._follows and channel is not None:
            self._follows = True
            self.document.session.active = channel
            self._follows = False
            self._repaint()

    def _show_active(self) -> None:
        """Choose the row of the active channel, unless it is one of those chosen already."""
        self._repaint()
        active = self.document.session.active
        if self._follows or active is None:
            return
        index = self.view.rows.index_of(active)
        if not index.isValid():
            return
        self._follows = True
        if active not in self.view.chosen():
            self.view.choose([active])
        if self.view.rows.channel_of(self.view.currentIndex()) is not active:
            self.view.selectionModel().setCurrentIndex(index, self.view.selectionModel().SelectionFlag.NoUpdate)
        self.view.scrollTo(index)
        self._follows = False

    def _rename(self, names: dict[Channel, str]) -> bool:
        problem = channel_verbs.rename(self.document, names)
        if problem:
            self.status.emit(problem)
        return not problem

    @guarded()
    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        channels = self.chosen()
        if channels:
            channel_menu(self, channels).popup(event.globalPos())

    @guarded(False)
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if watched is self.filter and isinstance(event, QKeyEvent):
            esc = event.key() == Qt.Key.Key_Escape
            down = event.key() in (Qt.Key.Key_Down, Qt.Key.Key_Return, Qt.Key.Key_Enter)
            if (esc or down) and event.type() == QEvent.Type.ShortcutOverride:
                event.accept()
                return True
            if esc and event.type() == QEvent.Type.KeyPress:
                if self.filter.text():
                    self.filter.clear()
                else:
                    self.left.emit()
                return True
            if down and event.type() == QEvent.Type.KeyPress:
                self._enter_rows()
                return True
        return super().eventFilter(watched, event)

    def _enter_rows(self) -> None:
        """Go from the filter to the first channel found."""
        rows = self.view.rows
        if rows.groups and rows.channel_of(self.view.currentIndex()) is None:
            self.view.setCurrentIndex(rows.index_of(rows.groups[0].channels[0]))
        self.view.setFocus(Qt.FocusReason.TabFocusReason)
