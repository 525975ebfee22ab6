"""One command a module, with `add_arguments(parser)` and `run(arguments)`.

In: parsed arguments.
Out: an exit status.
Imports: everything below `app.cli`, and `app.cli.bench`.
"""
