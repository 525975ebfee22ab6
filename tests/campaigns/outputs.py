"""Outputs upon what they are made from, by any name, and upon what is no plain file.

Each command is asked to write where it must not: it refuses in one line, and every file, link, pipe
and device stays what it is, byte for byte.
"""

import os
import socket
import stat
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from layered import blob, png

from tests.campaigns.commands import CALLS, Call, drawings, forked
from tests.campaigns.kills import expect
from tests.campaigns.slowest import note

# What there is besides: a later input, and outputs of which the second is the input.
MORE = {
    "mask": Call(("domain", "DRAWING", "--mask", "IN", "--out", "OUT"), lambda: {"m.png": MASK}),
    "preview": Call(
        ("domain", "IN", "--out", "ELSEWHERE", "--preview", "OUT"), lambda: {"a.png": MASK}
    ),
    "script's drawing": Call(
        ("pose", "IN", "SCRIPT", "--out", "OUT"), lambda: {"a.png": drawings()["drawing.png"]}
    ),
    "second mesh": Call(
        ("interpolate", "MESH", "IN", "--variant", "arap", "--times", "0", "--out", "OUT"),
        CALLS["interpolate meshes"].files,
    ),
    **{
        f"export {name}": Call(
            ("export", "IN", "--format", name, "--frames", "0:2", "--out", "OUT"),
            CALLS["export"].files,
        )
        for name in ("png", "apng", "webp", "gif", "mp4", "spritesheet", "glb", "html")
    },
}
MASK = png(blob(120, 90))
WRITING = {name: call for name, call in {**CALLS, **MORE}.items() if "--out" in call.words}


def _link(given: Path, name: str = "link") -> Path:
    link = given.parent / name
    link.symlink_to(given.name)
    return link


def _hard_link(given: Path) -> Path:
    link = given.parent / "hard"
    link.hardlink_to(given)
    return link


def _linked_folder(given: Path) -> Path:
    folder = given.parent / "folder"
    folder.symlink_to(".")
    return folder / given.name


def _pipe(given: Path) -> Path:
    os.mkfifo(given.parent / "pipe")
    return given.parent / "pipe"


def _socket(given: Path) -> Path:
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(str(given.parent / "socket"))
    return given.parent / "socket"


def _circle(given: Path) -> Path:
    (given.parent / "round").symlink_to("round")
    return given.parent / "round"


def _nowhere(given: Path) -> Path:
    (given.parent / "lost").symlink_to("missing/a")
    return given.parent / "lost"


PLACES: dict[str, Callable[[Path], Path]] = {
    "itself": lambda given: given,
    "roundabout": lambda given: given.parent / "." / ".." / given.parent.name / given.name,
    "relative": lambda given: Path(os.path.relpath(given)),
    "link": _link,
    "link to a link": lambda given: _link(_link(given), "far"),
    "hard link": _hard_link,
    "linked folder": _linked_folder,
    "pipe": _pipe,
    "link to a pipe": lambda given: _link(_pipe(given)),
    "socket": _socket,
    "device": lambda _: Path("/dev/null"),
    "full device": lambda _: Path("/dev/full"),
    "link in a circle": _circle,
    "link to nowhere": _nowhere,
    "standard output": lambda _: Path("/dev/stdout"),
    "dash": lambda _: Path("-"),
}


def _all_there(folder: Path) -> dict[str, object]:
    """Return what there is in a folder, by its name: contents of files, kinds of others."""
    found: dict[str, object] = {}
    for path in sorted(folder.rglob("*")):
        status = path.lstat()
        plain = stat.S_ISREG(status.st_mode)
        found[str(path)] = path.read_bytes() if plain else (status.st_mode, status.st_ino)
    return found


def refused(call: Call, rng: np.random.Generator, how: str) -> None:
    """Ask a command to write where it must not."""
    with tempfile.TemporaryDirectory() as name:
        folder, others = Path(name) / "here", Path(name) / "others"
        folder.mkdir()
        others.mkdir()
        files = call.files()
        file = list(files)[rng.integers(len(files))]
        given = folder / file
        given.write_bytes(files[file])
        for other, data in (
            *drawings().items(),
            ("script", CALLS["pose"].files()["a.json"]),
            ("mesh.obj", CALLS["interpolate meshes"].files()["a.obj"]),
        ):
            (others / other).write_bytes(data)
        out = PLACES[how](given)
        places = {"IN": given, "OUT": out, "OUT.gif": out, "ELSEWHERE": others / "elsewhere"}
        places |= {other: others / other for other in drawings()}
        places |= {"DRAWING": others / "drawing.png", "SCRIPT": others / "script"}
        places |= {"MESH": others / "mesh.obj"}
        device = Path("/dev/null").stat()
        before = _all_there(Path(name))
        ended = forked([str(places.get(word, word)) for word in call.words], Path(f"{name}.told"))
        what = f"{' '.join(call.words)} to {how}: {ended.status} {ended.said}"
        note(f"{call.words[0]} to {how}", ended.seconds)
        expect(ended.status == 2, what)
        expect(sum("lissom: error:" in line for line in ended.said.splitlines()) == 1, what)
        expect("Traceback" not in ended.said, what)
        expect(_all_there(Path(name)) == before, f"something is changed: {what}")
        expect(os.path.samestat(Path("/dev/null").stat(), device), f"no device any more: {what}")
        Path(f"{name}.told").unlink()


def campaign(seed: int, amount: int) -> Iterator[tuple[str, dict[str, float]]]:
    """Ask so often, of all commands and places in turns, and yield how often each refused."""
    pairs = [(call, how) for call in WRITING for how in PLACES]
    rng = np.random.default_rng(seed)
    for start in range(0, amount, len(pairs)):
        for call, how in pairs[: amount - start]:
            refused(WRITING[call], rng, how)
    yield "refused", {"outputs": amount, "commands": len(WRITING), "places": len(PLACES)}
