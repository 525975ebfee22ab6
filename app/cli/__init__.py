"""The command line: the only place where everything is wired together.

In: words of a command line.
Out: files, text, a window, and an exit status.
Imports: everything; only the command that is asked for is loaded.
"""
