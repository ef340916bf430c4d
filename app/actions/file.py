"""Actions of the File menu."""

from PySide6.QtGui import QKeySequence

from app.actions.row import Action, Need

HAS_A_FILE = Need(lambda w: bool(w.files.path), "the clip has no file yet")
HAS_CHANGES = Need(
    # What is being typed is kept before the clip is saved.
    lambda w: w.files.modified or not w.files.path or w.in_entry,
    "there is nothing to save",
)
NO_JOB = Need(lambda w: w.jobs.job is None, "a file is being opened or saved; Esc cancels that")
DIFFERS_FROM_FILE = Need(lambda w: w.files.modified, "the clip is as it is in its file")


FILE_ACTIONS = (
    Action(
        id="file.new",
        menu="File",
        label="&New",
        function=lambda w: w.files.new(),
        shortcuts=(QKeySequence.StandardKey.New,),
        icon="new",
        tip="Start an empty clip",
        needs=(NO_JOB,),
    ),
    Action(
        id="file.open",
        menu="File",
        label="&Open…",
        function=lambda w: w.files.ask_and_open(),
        shortcuts=(QKeySequence.StandardKey.Open,),
        icon="open",
        tip="Open a clip; a .skel file opened with it names its channels",
        needs=(NO_JOB,),
    ),
    Action(
        id="file.name_channels",
        menu="File",
        label="Name &Channels from Skeleton…",
        function=lambda w: w.files.ask_and_name_channels(),
        tip="Name the channels by the joints of a .skel file",
        needs=(Need(lambda w: bool(w.document.clip.channels), "the clip has no channels"),),
    ),
    Action(
        id="file.save",
        menu="File",
        label="&Save",
        function=lambda w: w.save(),
        shortcuts=(QKeySequence.StandardKey.Save,),
        icon="save",
        tip="Write the clip to its file",
        needs=(NO_JOB, HAS_CHANGES),
        begins_group=True,
    ),
    Action(
        id="file.save_as",
        menu="File",
        label="Save &As…",
        function=lambda w: w.save_as(),
        shortcuts=("Ctrl+Shift+S",),
        icon="save-as",
        tip="Write the clip to another file or in another format",
        needs=(NO_JOB,),
    ),
    Action(
        id="file.revert",
        menu="File",
        label="Re&vert to File…",
        function=lambda w: w.files.revert(),
        tip="Read the file again and drop the changes made since",
        needs=(NO_JOB, HAS_A_FILE, DIFFERS_FROM_FILE),
    ),
    Action(
        id="file.quit",
        menu="File",
        label="&Quit",
        function=lambda w: w.close(),
        shortcuts=("Ctrl+Q",),
        tip="Close the window; asks when there are unsaved changes",
        begins_group=True,
    ),
)
