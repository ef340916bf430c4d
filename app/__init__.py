"""Assembly: the window, its actions, files, settings and the command line."""

__version__ = "0.1.0"
