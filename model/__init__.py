"""Channels, clips, edits and files: numpy and the standard library only."""
