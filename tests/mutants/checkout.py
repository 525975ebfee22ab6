"""A checkout of the project whose files are changed for a while, and its tests run."""

import os
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Event

ROOT = Path(__file__).parents[2]
PYTHON = Path(".venv/bin/python")
PAUSE = 0.2  # seconds between looks at a run


class CheckoutError(Exception):
    """A checkout cannot be used, in words."""


class StoppedError(Exception):
    """The person wants no more."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """What a run of tests came to; `hangs` where it was ended by the time limit."""

    status: int
    output: str
    hangs: bool


def require_clean(folder: Path) -> str:
    """Return the revision of a checkout; an error where mistakes must not be written into it."""
    if folder.resolve() == ROOT:
        raise CheckoutError(f"{folder} is the tree of this program. Make a clone of it.")
    if (
        not folder.is_dir()
        or Path(_ask_git(folder, "rev-parse", "--show-toplevel")) != folder.resolve()
    ):
        raise CheckoutError(f"{folder} is not a checkout of the project.")
    if not (folder / PYTHON).exists():
        raise CheckoutError(f"{folder} has no {PYTHON}.")
    if changes := _ask_git(folder, "status", "--porcelain", "--untracked-files=no"):
        raise CheckoutError(f"{folder} has changes. Undo or commit them:\n{changes}")
    return _ask_git(folder, "rev-parse", "HEAD")


def _ask_git(folder: Path, *words: str) -> str:
    command = ["git", "-C", str(folder), *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise CheckoutError(f"{folder}: {done.stderr.strip()}")
    return done.stdout.strip()


class Checkout:
    """A checkout that nobody works in.

    Parameters
    ----------
    folder : Path
        Its folder, in which `.venv` has an environment for the tests.
    stop : Event
        Ends what runs in it.
    """

    def __init__(self, folder: Path, stop: Event) -> None:
        self.folder = folder.resolve()
        self._stop = stop

    @contextmanager
    def changed(self, files: Mapping[str, str]) -> Iterator[None]:
        """Write these files, and put back what was there at the end, whatever happens."""
        paths = {name: self.folder / name for name in files}
        before = {name: path.read_bytes() for name, path in paths.items() if path.exists()}
        try:
            for name, text in files.items():
                paths[name].write_text(text, encoding="utf-8")
                _forget_compiled(paths[name])
            yield
        finally:
            for name, path in paths.items():
                if name in before:
                    path.write_bytes(before[name])
                else:
                    path.unlink(missing_ok=True)
                _forget_compiled(path)

    def run_tests(
        self,
        words: Sequence[str],
        *,
        patience: float | None = None,
        variables: Mapping[str, str] | None = None,
    ) -> Run:
        """Run pytest; end it and all that it started after so many seconds.

        Child processes of the tests import the checkout as well, wherever they run.
        """
        environment = {**os.environ, "PYTHONPATH": str(self.folder), **(variables or {})}
        command = [str(self.folder / PYTHON), "-m", "pytest", "-p", "no:cacheprovider", *words]
        hangs = False
        # A file, as a pipe stays open as long as anything holds it that the tests left behind.
        with tempfile.TemporaryFile() as output:
            process = subprocess.Popen(
                command,
                cwd=self.folder,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
            try:
                end = time.monotonic() + patience if patience else float("inf")
                while process.poll() is None and not hangs:
                    if self._stop.wait(PAUSE):
                        raise StoppedError
                    hangs = time.monotonic() > end
            finally:
                _end_group(process)
            output.seek(0)
            told = output.read().decode(errors="replace")
            return Run(status=process.returncode, output=told, hangs=hangs)


def _forget_compiled(path: Path) -> None:
    """Remove what Python compiled: another file of the same size and second would pass for it."""
    for compiled in (path.parent / "__pycache__").glob(f"{path.stem}.*.pyc"):
        compiled.unlink(missing_ok=True)


def _end_group(process: subprocess.Popen[bytes]) -> None:
    """End a process and all that it left behind."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
