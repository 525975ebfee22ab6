"""The command line: the only place that connects all rooms.

In: words of a command line.
Out: files, text, a window, and an exit status.
Imports: everything; only the requested command is loaded.
"""
