"""The commands, one module each: a help `EPILOG`, `add_arguments(parser)` and `run(arguments)`.

In: words of a command line.
Out: an exit status.
Imports: everything below `app.cli`; what computes only within `run`, so that help and errors of
usage come at once.
"""
