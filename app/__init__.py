"""Assembly of the window and the commands that need none."""
