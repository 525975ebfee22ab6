"""Files on the disk, whatever their contents: read within limits, written whole, locked.

In: paths, and contents to write.
Out: bytes, arrays and JSON; files that are whole or absent; locks that end with their process.
Imports: nothing of the project but `app.errors`.
"""
