"""What starts in a bundle: Lissom, with the surroundings that a Python of its own would give it."""

import os
import sys


def main() -> int:
    """Run Lissom, or the trial for which it would start a Python."""
    # The bundle finds its own libraries first, by a variable that whatever it starts must not
    # inherit: a file dialog or a file manager needs those of the system.
    theirs = os.environ.pop("LD_LIBRARY_PATH_ORIG", None)
    os.environ.pop("LD_LIBRARY_PATH", None)
    if theirs is not None:
        os.environ["LD_LIBRARY_PATH"] = theirs
    if sys.argv[1:4] == ["-I", "-S", "-c"]:
        # What may crash is tried in another process, by Python, which here is this program.
        code, sys.argv[:] = sys.argv[4], ["-c", *sys.argv[5:]]
        exec(code, {"__name__": "__main__"})  # noqa: S102 - app.render.gpu wrote it
        return 0
    from app.cli.main import main as lissom  # noqa: PLC0415 - it would delay the trial

    return lissom()


if __name__ == "__main__":
    raise SystemExit(main())
