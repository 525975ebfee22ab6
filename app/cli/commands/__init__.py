"""What each command does, one command a module with `run(arguments)`.

In: parsed arguments.
Out: an exit status.
Imports: everything below `app.cli`.
"""
