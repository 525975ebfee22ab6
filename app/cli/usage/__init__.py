"""What is said to each command, a module each: `add_arguments(parser)`, and an `EPILOG` of help.

In: words of a command line.
Out: parsed arguments, or an error of usage.
Imports: nothing that computes, so that help and errors of usage come at once.
"""
