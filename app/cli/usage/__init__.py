"""Command-line arguments, one module per command: `add_arguments(parser)` and a help `EPILOG`.

In: words of a command line.
Out: parsed arguments, or an error of usage.
Imports: nothing that computes, so that help and errors of usage come at once.
"""
