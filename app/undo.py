"""UndoStack: what the document committed, as steps that can be taken back."""

from typing import NamedTuple

from PySide6.QtCore import QEvent, QModelIndex, QObject, QPersistentModelIndex, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QHelpEvent, QPalette, QUndoCommand, QUndoStack
from PySide6.QtWidgets import QAbstractItemView, QStyledItemDelegate, QStyleOptionViewItem, QToolTip, QUndoView

from model.document import Document, Edit
from model.progress import CancelledError
from widgets.guard import guarded


class EditCommand(QUndoCommand):
    """One committed edit. The document has already changed when it is pushed, so its first redo does nothing.

    It is never merged and has no children: PySide6 leaks the one and crashes on the other.
    """

    def __init__(self, stack: "UndoStack", edit: Edit) -> None:
        super().__init__(edit.label)
        self._stack = stack
        self.edit = edit
        self._already_done = True

    @guarded()
    def redo(self) -> None:
        if self._already_done:
            self._already_done = False
            return
        self._stack.apply(self, self.edit)

    @guarded()
    def undo(self) -> None:
        self._stack.apply(self, self.edit.inverse())


class Mark(NamedTuple):
    """A state of the document in its history."""

    step: int
    edit: Edit | None  # that led there; None where the history begins
    history: int  # they are counted: each clip has its own

    def same(self, other: "Mark") -> bool:
        """Whether both are one state."""
        return self.edit is other.edit and (self.step, self.history) == (other.step, other.history)


class UndoStack(QUndoStack):
    """The history of one document; its clean index is the state that was last opened or saved."""

    stayed = Signal(str)  # a step, so called, was cancelled

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._history = 0
        # While this is set, what Qt undoes and redoes is nothing to the document.
        self._passing = False
        # Where the document has stayed since a step, so called, was cancelled: Qt takes it all the same.
        self._left_at: int | None = None
        self._left = ""
        document.committed.connect(self._push)
        document.clip_replaced.connect(self._forget)

    def _push(self, edit: Edit) -> None:
        self._come_back()
        self.push(EditCommand(self, edit))

    def mark(self) -> Mark:
        """The state that the document is in."""
        self._come_back()
        return self._mark_at(self.index())

    def _mark_at(self, index: int) -> Mark:
        command = self.command(index - 1) if index else None
        return Mark(index, command.edit if isinstance(command, EditCommand) else None, self._history)

    def set_saved(self, mark: Mark) -> None:
        """Let *mark*, in which the document was when it was saved, be the clean state, wherever it is by now."""
        if mark.step > self.count() or not self._mark_at(mark.step).same(mark):
            self.resetClean()  # the way there is gone
            return
        self._come_back()
        here = self.index()
        if here == mark.step:
            self.setClean()
            return
        # Qt can only call the present state clean: the history goes there and back while the document stays.
        self._pass_to(mark.step)
        self.setClean()
        self._pass_to(here)

    def _pass_to(self, index: int) -> None:
        self._passing = True
        try:
            self.setIndex(index)
        finally:
            self._passing = False

    def _come_back(self) -> None:
        """Have the history where the document has stayed."""
        if self._left_at is not None:
            index, self._left_at = self._left_at, None
            self._pass_to(index)
            self.stayed.emit(self._left)

    def _forget(self) -> None:
        self._left_at = None
        self._history += 1
        self.clear()
        self.setClean()  # clear() leaves the mark alone when there is nothing to clear

    def apply(self, command: EditCommand, edit: Edit) -> None:
        """Bring the document to the other side of *edit*, that of *command*; an open gesture is cancelled first."""
        if self._passing or self._left_at is not None:
            return
        try:
            if self._document.gesture is not None:
                self._document.gesture.cancel()
            self._document.apply(edit)
        except CancelledError:
            place = next(i for i in range(self.count()) if self.command(i) is command)
            self._left_at, self._left = place + (edit is not command.edit), edit.label
            QTimer.singleShot(0, self, self._come_back)
        except Exception:
            # The stack moves on whatever happens here, and a history that does not fit the clip can only harm it.
            QTimer.singleShot(0, self._drop_history)
            raise

    @guarded()
    def undo(self) -> None:
        """Take the last step back; nothing while a step is being taken already."""
        if not self._document.working:
            self._come_back()
            super().undo()
            self._come_back()

    @guarded()
    def redo(self) -> None:
        """Make the next step again; nothing while a step is being taken already."""
        if not self._document.working:
            self._come_back()
            super().redo()
            self._come_back()

    def _drop_history(self) -> None:
        if self._document.working:  # a step of this history is under way
            QTimer.singleShot(50, self, self._drop_history)
            return
        self._left_at = None
        self._history += 1
        self.clear()
        self.resetClean()


class UndoSteps(QUndoView):
    """The list of steps: those that are taken back are dim, long ones are cut and told in full by the mouse."""

    def __init__(self, stack: UndoStack) -> None:
        super().__init__(stack)
        self.setEmptyLabel("As opened")
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setTextElideMode(Qt.TextElideMode.ElideRight)
        self.setItemDelegate(_Step(self))
        stack.indexChanged.connect(self._repaint)

    def _repaint(self, _index: int) -> None:
        self.viewport().update()


class _Step(QStyledItemDelegate):
    """One step; the first row is the state before all of them."""

    def __init__(self, steps: UndoSteps) -> None:
        super().__init__(steps)
        self._steps = steps

    @guarded()
    def initStyleOption(self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex) -> None:
        super().initStyleOption(option, index)
        stack = self._steps.stack()
        if stack is not None and index.row() > stack.index():
            dim = option.palette.color(QPalette.ColorGroup.Disabled, QPalette.ColorRole.Text)
            option.palette.setColor(QPalette.ColorRole.Text, dim)

    @guarded(False)
    def helpEvent(
        self,
        event: QHelpEvent,
        view: QAbstractItemView,
        option: QStyleOptionViewItem,
        index: QModelIndex | QPersistentModelIndex,
    ) -> bool:
        if event.type() != QEvent.Type.ToolTip or not index.isValid():
            return super().helpEvent(event, view, option, index)
        QToolTip.showText(event.globalPos(), str(index.data()), view)
        return True

    @guarded(QSize(1, 20))
    def sizeHint(self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex) -> QSize:
        return QSize(1, super().sizeHint(option, index).height())  # as wide as the list, whatever it says
