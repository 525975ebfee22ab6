"""The commands, one module each with `run(arguments)`.

In: parsed arguments.
Out: an exit status.
Imports: everything below `app.cli`.
"""
