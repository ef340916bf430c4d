"""ProgressRow: what is being done to a file or to very many keys, how far it is, and the way to stop it."""

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QHBoxLayout, QLabel, QProgressBar, QSizePolicy, QToolButton, QWidget

from app.jobs import Jobs

PATIENCE_MILLISECONDS = 150  # what is over by then was never seen to begin
REFRESH_MILLISECONDS = 50
FINE = 1000  # steps of the bar
BAR_WIDTH, BAR_HEIGHT, TEXT_WIDTH = 160, 8, 260


class ProgressRow(QWidget):
    """Text, bar and a Cancel button for the job under way; Esc in *window* cancels too, from the first moment on."""

    def __init__(self, jobs: Jobs, window: QWidget) -> None:
        super().__init__()
        self._jobs = jobs
        self.text = QLabel()
        self.text.setTextFormat(Qt.TextFormat.PlainText)
        self.bar = QProgressBar()
        self.bar.setRange(0, FINE)
        self.bar.setTextVisible(False)
        self.bar.setFixedSize(BAR_WIDTH, BAR_HEIGHT)
        self.bar.setAccessibleName("Progress")
        self.cancel = QToolButton()
        self.cancel.setText("Cancel")
        self.cancel.setFixedHeight(self.text.sizeHint().height())  # as high as the words, so that nothing moves
        self.cancel.setToolTip("Stop it and leave everything as it was  (Esc)")
        self.cancel.setFocusPolicy(Qt.FocusPolicy.NoFocus)  # with the focus it would take Space from playing
        self.cancel.clicked.connect(self.stop)
        self._escape = QShortcut(QKeySequence(Qt.Key.Key_Escape), window)
        self._escape.activated.connect(self.stop)
        self._escape.setEnabled(False)
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Preferred)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(10)
        for widget in (self.text, self.bar, self.cancel):
            row.addWidget(widget)
        self._patience = QTimer(self)
        self._patience.setSingleShot(True)
        self._patience.timeout.connect(self._appear)
        self._pulse = QTimer(self)
        self._pulse.timeout.connect(self._tell_share)
        jobs.changed.connect(self._job_changed)
        self.hide()

    def stop(self) -> None:
        """Cancel the job under way."""
        if self._jobs.job is not None:
            self._jobs.job.cancel()
            self.cancel.setEnabled(False)

    def _job_changed(self) -> None:
        self._escape.setEnabled(self._jobs.job is not None)
        self.cancel.setEnabled(True)
        if self._jobs.job is not None:
            self._patience.start(PATIENCE_MILLISECONDS)
        else:
            self._patience.stop()
            self._pulse.stop()
            self.hide()

    def _appear(self) -> None:
        if self._jobs.job is not None:
            text = self._jobs.job.text
            self.text.setText(self.fontMetrics().elidedText(text, Qt.TextElideMode.ElideMiddle, TEXT_WIDTH))
            self.bar.setAccessibleDescription(text)
            self._tell_share()
            self._pulse.start(REFRESH_MILLISECONDS)
            self.show()

    def _tell_share(self) -> None:
        if self._jobs.job is not None:
            self.bar.setValue(round(FINE * self._jobs.job.share))
