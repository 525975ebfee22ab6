"""What is said to each command, one command a module with `add_arguments(parser)`.

In: words of a command line.
Out: parsed arguments, or an error of usage.
Imports: nothing that computes, so that help and errors of usage come at once.
"""
