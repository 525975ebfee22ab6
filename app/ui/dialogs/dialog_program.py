"""A program that shows the file dialogs of a Linux desktop, with its exit status."""

import os
import subprocess
from contextlib import suppress
from pathlib import Path
from typing import Final

from app.editor import FileDialog
from app.errors import display_name

CHOSEN, CANCELLED = 0, 1  # exit statuses of all these programs; any other is a failure
# Options of each kind of program: zenity and its clones, and kdialog.
KDIALOG: Final = "kdialog"


class DialogProgram:
    """A running program, from its start to its answer."""

    def __init__(self, program: str, dialog: FileDialog, filters: tuple[str, str]) -> None:
        words = _kdialog_words if Path(program).name == KDIALOG else _zenity_words
        self._process: subprocess.Popen[bytes] | None = None
        self._output = b""
        with suppress(OSError, ValueError):  # then it has failed
            self._process = subprocess.Popen(  # noqa: S603 - one of the known programs
                [program, *words(dialog, filters)],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
            )

    @property
    def is_over(self) -> bool:
        return self._process is None or self._process.poll() is not None

    @property
    def has_failed(self) -> bool:
        """Whether the program ended neither with an answer nor with a cancelled dialog."""
        return self._process is None or self._process.returncode not in {CHOSEN, CANCELLED}

    def answer(self) -> str:
        """Return the chosen path, empty without one. The program must be over."""
        if self._process is not None and self._process.stdout is not None:
            with self._process.stdout as output:
                self._output += output.read()
            self._process.stdout = None
        return os.fsdecode(self._output.rstrip(b"\n"))

    def close(self) -> None:
        """End the program."""
        if self._process is not None and self._process.poll() is None:
            self._process.kill()
            self._process.wait()
        self.answer()


def _zenity_words(dialog: FileDialog, filters: tuple[str, str]) -> list[str]:
    # With a slash at its end, the folder is where to begin and not the preselected file.
    words = ["--file-selection", "--title", dialog.title]
    if dialog.wants_folder:
        return [*words, "--directory", f"--filename={display_name(f'{dialog.folder}/')}"]
    words += ["--file-filter", "|".join(filters)]
    if dialog.writes:
        start = display_name(dialog.folder / dialog.name)
        return [*words, "--save", "--confirm-overwrite", f"--filename={start}"]
    return [*words, f"--filename={display_name(f'{dialog.folder}/')}"]


def _kdialog_words(dialog: FileDialog, filters: tuple[str, str]) -> list[str]:
    names, patterns = filters
    folder = display_name(f"{dialog.folder}/")
    if dialog.wants_folder:
        return ["--title", dialog.title, "--getexistingdirectory", folder]
    verb = "--getsavefilename" if dialog.writes else "--getopenfilename"
    start = display_name(dialog.folder / dialog.name) if dialog.writes else folder
    return ["--title", dialog.title, verb, start, f"{patterns}|{names}"]
