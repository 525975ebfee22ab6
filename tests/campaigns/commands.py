"""Commands upon damaged files, each in a process of its own.

The damage knows what it damages: arrays change their numbers, kinds and shapes, pictures their
chunks with checksums that fit, meshes and scripts their words. Each command does what it is asked
or tells in one line why not, in bounded time and memory.
"""

import importlib
import io
import json
import os
import re
import resource
import signal
import struct
import sys
import tempfile
import warnings
import zipfile
import zlib
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from animations import moving_document
from hostile_files import changed
from layered import blob, openraster
from PIL import Image

from app.cli.main import main
from app.storage import draw_thumbnail, save_project
from tests.campaigns.kills import expect
from tests.campaigns.slowest import note

PATIENCE = 120  # seconds of the processor
MEMORY = 3 * 1024**3  # bytes of addresses beyond those of this process
FACTORS = (0.0, -1.0, 1e-300, 1e-9, 1e9, 1e154, 1e300, np.nan, np.inf)
KINDS = ("f2", "f4", "f8", "c8", "c16", "i1", "i4", "i8", "u1", "u8", "?", "U3", ">f8", ">i4")
MILD = (-1.0, 0.0, 0.1, 0.5, 1.0, 1.01, 2.0, 30.0)
NUMBER = re.compile(rb"(?<![\w.])-?\d+(?:\.\d+)?(?![\w.])")
PACKINGS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2)
CHUNKS = (b"eXIf", b"iCCP", b"tEXt", b"zTXt", b"iTXt", b"gAMA", b"tRNS", b"PLTE", b"acTL", b"IDAT")


class Call(NamedTuple):
    """A command: its words, IN for the damaged file and OUT for what it writes, and valid files."""

    words: tuple[str, ...]
    files: Callable[[], dict[str, bytes]]


def _npz(**arrays: npt.ArrayLike) -> bytes:
    file = io.BytesIO()
    np.savez(file, **{name: np.asarray(values) for name, values in arrays.items()})
    return file.getvalue()


@cache
def _round(count: int = 12) -> dict[str, npt.NDArray[Any]]:
    """An outline, its cage, and a mesh of its inside."""
    outline = np.exp(2j * np.pi * np.arange(count) / count)
    triangles = np.array([[0, k, k % count + 1] for k in range(1, count + 1)])
    points = np.concatenate([[0.0], 0.8 * outline])
    return {"outline": outline, "cage": 1.5 * outline, "points": points, "triangles": triangles}


@cache
def _ring() -> dict[str, npt.NDArray[Any]]:
    hole = 0.3 * np.exp(-2j * np.pi * np.arange(8) / 8)
    sizes = np.array([8])
    return {
        "hole_outlines": hole,
        "hole_cages": 0.5 * hole,
        "hole_outline_sizes": sizes,
        "hole_cage_sizes": sizes,
        "hole_centres": np.array([0j]),
    }


@cache
def _cases() -> dict[str, bytes]:
    handles = np.array([0.5, -0.5, 0.6j])
    case = {"handles": handles, "targets": handles * (1.2 + 0.2j)}
    case |= {"k_max": 0.6, "sigma_a_max": 3.0, "sigma_b_min": 0.3}
    shape = {name: _round()[name] for name in ("outline", "cage")}
    return {"a.npz": _npz(**shape, **case), "ring.npz": _npz(**shape, **case, **_ring())}


@cache
def _keyframes() -> dict[str, bytes]:
    shape = _round()
    cage = shape["cage"]
    maps = {"phi": [cage, 1.2j * cage + 0.02 * cage**2], "psi": np.zeros((2, len(cage)))}
    plain = {name: shape[name] for name in ("outline", "cage", "points")}
    boundary = [shape["outline"], 1.3 * shape["outline"]]
    return {
        "maps.npz": _npz(**plain, **maps),
        "meshed.npz": _npz(**shape, **maps, turns=[0], anchor=[0.0]),
        "boundary.npz": _npz(**plain, boundary=boundary, triangles=shape["triangles"]),
    }


@cache
def _poses() -> dict[str, bytes]:
    positions, triangles = _round()["points"], _round()["triangles"]
    posed = {"positions": [positions, 1.1j * positions], "triangles": triangles}
    maps = {name: file for name, file in _keyframes().items() if name != "maps.npz"}
    return {"poses.npz": _npz(**posed), **maps}


@cache
def _pictures() -> dict[str, bytes]:
    files = {}
    for name in ("PNG", "JPEG", "WEBP", "GIF", "TIFF"):
        file = io.BytesIO()
        image = blob(120, 90)
        (image.convert("RGB") if name == "JPEG" else image).save(file, name)
        files[f"a.{name.lower()}"] = file.getvalue()
    stack = '<stack name="g" opacity="0.5"><layer name="a" src="data/0.png" x="3"/></stack>'
    return {**files, "a.ora": openraster((120, 90), stack, [blob(80, 60)])}


@cache
def drawings() -> dict[str, bytes]:
    """Return what scripts pose: a blob, and a ring with an arm upon it."""
    file, ring = io.BytesIO(), np.array(blob(120, 90))
    blob(120, 90).save(file, "PNG")
    y, x = np.mgrid[:90, :120]
    ring[np.hypot(x - 60, y - 45) < 20] = 0
    stack = '<layer name="arm" src="data/0.png" x="50" y="5"/><layer name="ring" src="data/1.png"/>'
    layers = openraster((140, 100), stack, [blob(80, 30), Image.fromarray(ring)])
    return {"drawing.png": file.getvalue(), "layers.ora": layers}


@cache
def _scripts() -> dict[str, bytes]:
    keys = [{"frame": 0}, {"frame": 6, "targets": {"a": [70, 50]}, "ease": "in-out"}]
    bounds = {"k": 0.5, "sigma_a": 2.0, "sigma_b": 0.5}
    handles = {"a": [60, 45], "b": [40, 45]}
    script = {"schema": 1, "fps": 24, "bounds": bounds, "handles": handles, "keys": keys}
    return {"a.json": json.dumps(script).encode()}


@cache
def _scenes() -> dict[str, bytes]:
    ring = {
        "layer": "ring",
        "handles": {"left": [10, 55], "right": [110, 55]},
        "keys": [{"frame": 3 * k, "targets": {"right": [110 - 9 * k, 60]}} for k in range(3)],
    }
    arm = {
        "layer": "arm",
        "handles": {"hand": [120, 80], "shoulder": {"at": [60, 80], "front": 0.5, "extent": 30}},
        "keys": [{"frame": 0}, {"frame": 6, "targets": {"hand": [110, 95]}, "ease": "out"}],
        "attach": {"to": "ring", "at": [60, 80], "turn": True},
        "visible": [[0, True], [5, False]],
    }
    scene = {"schema": 1, "loop": True, "variant": "nu", "layers": [ring, arm]}
    return {"scene.json": json.dumps(scene).encode()}


@cache
def _projects() -> dict[str, bytes]:
    with tempfile.TemporaryDirectory() as name:
        path, scene = Path(name) / "a.lissom", Path(name) / "scene.lissom"
        small = draw_thumbnail(np.asarray(blob(40, 30)))
        save_project(path, moving_document(), thumbnail=small)
        drawing, script = Path(name) / "a.ora", Path(name) / "a.json"
        drawing.write_bytes(drawings()["layers.ora"])
        script.write_bytes(_scenes()["scene.json"])
        # Elsewhere, so that this process stays small.
        words = ["pose", str(drawing), str(script), *FEW, "--out", str(scene)]
        made = forked(words, Path(name) / "told")
        expect(made.status == 0, made.said)
        return {each.name: each.read_bytes() for each in (path, scene)}


@cache
def _meshes() -> dict[str, bytes]:
    points, triangles = _round()["points"], _round()["triangles"] + 1
    lines = [f"v {z.real} {z.imag} 0" for z in points]
    lines += ["f " + " ".join(map(str, corners)) for corners in triangles]
    return {"a.obj": "\n".join(lines).encode()}


FEW = ("--triangles", "1000")
INTERPOLATE = ("interpolate", "IN", "--times", "0,0.4", "--out", "OUT", "--variant")
CALLS = {
    "domain": Call(("domain", "IN", *FEW, "--out", "OUT"), _pictures),
    "deform": Call(("deform", "IN", "--out", "OUT"), _cases),
    **{
        f"interpolate {variant}": Call((*INTERPOLATE, variant), files)
        for files, variants in (
            (_keyframes, ("nu", "eta", "scaled-eta", "metric")),
            (_poses, ("arap", "mesh-eta", "ffmp")),
        )
        for variant in variants
    },
    "interpolate meshes": Call(
        ("interpolate", *INTERPOLATE[1:2], *INTERPOLATE[1:], "arap"), _meshes
    ),
    "pose": Call(("pose", "drawing.png", "IN", *FEW, "--out", "OUT"), _scripts),
    "pose layers": Call(("pose", "layers.ora", "IN", *FEW, "--out", "OUT"), _scenes),
    "certify": Call(("certify", "IN"), _projects),
    "export": Call(("export", "IN", "--format", "gif", "--out", "OUT.gif"), _projects),
    "export sheets": Call(("export", "IN", "--format", "spritesheet", "--out", "OUT"), _projects),
    "export models": Call(("export", "IN", "--format", "glb", "--out", "OUT"), _projects),
    "thumbnail": Call(("thumbnail", "IN", "--out", "OUT"), _projects),
}


def damaged(content: bytes, rng: np.random.Generator) -> bytes:
    """Return the contents of a file with one to three faults that fit what it is."""
    for _ in range(1 + rng.binomial(2, 0.25)):
        if content[:4] == b"PK\3\4" and rng.random() < 0.8:
            content = _damaged_zip(content, rng)
        elif content.startswith(b"\x89PNG") and rng.random() < 0.8:
            content = _damaged_png(content, rng)
        elif content[:2] == b"v " and rng.random() < 0.8:
            content = _damaged_words(content, rng)
        elif content[:1] == b"{" and rng.random() < 0.5:
            content = _damaged_number(content, rng)
        else:
            step = (int(rng.integers(16)), rng.random(), rng.random(), int(rng.integers(256)))
            content = changed(content, [step])
    return content


def _damaged_zip(content: bytes, rng: np.random.Generator) -> bytes:
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            members = {name: archive.read(name) for name in archive.namelist()}
    except Exception:  # noqa: BLE001 - an earlier fault has broken it
        return content
    name = str(rng.choice(list(members)))
    if name.endswith(".npy"):
        file = io.BytesIO()
        with suppress(Exception):  # an earlier fault, or one that this array cannot have
            np.save(file, _damaged_array(np.load(io.BytesIO(members[name])), rng))
            members[name] = file.getvalue()
    else:
        members[name] = damaged(members[name], rng)
    if rng.random() < 0.1:
        del members[str(rng.choice(list(members)))]
    file = io.BytesIO()
    packing = int(rng.choice(PACKINGS, p=[0.4, 0.4, 0.1, 0.1]))
    with zipfile.ZipFile(file, "w", packing) as archive:
        for each, data in members.items():
            archive.writestr(each, data)
    return file.getvalue()


def _damaged_array(array: npt.NDArray[Any], rng: np.random.Generator) -> npt.NDArray[Any]:
    flat = array.copy().ravel()
    here = np.arange(flat.size) == rng.integers(max(1, flat.size))
    nudge = rng.normal() * 10.0 ** rng.integers(-9, 9)
    rows = np.atleast_1d(array)
    faults: tuple[Callable[[], npt.NDArray[Any]], ...] = (
        lambda: array * rng.choice(FACTORS),
        lambda: array.astype(str(rng.choice(KINDS))),
        lambda: rows[: rng.integers(len(rows) + 1)],
        lambda: np.concatenate([rows] * int(rng.integers(2, 40))),
        lambda: array[..., None],
        lambda: flat,
        lambda: rows[::-1],
        lambda: np.where(here, rng.choice(FACTORS), flat).reshape(array.shape),
        lambda: np.where(here, np.roll(flat, 1), flat).reshape(array.shape),
        lambda: (flat + here * nudge).astype(array.dtype).reshape(array.shape),
    )
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return faults[rng.integers(len(faults))]()


def _damaged_png(content: bytes, rng: np.random.Generator) -> bytes:
    chunks, at = [], 8
    while at + 12 <= len(content):
        (length,) = struct.unpack_from(">I", content, at)
        chunks.append((content[at + 4 : at + 8], content[at + 8 : at + 8 + length]))
        at += 12 + length
    if not chunks:
        return content
    place = int(rng.integers(len(chunks)))
    kind, data = chunks[place]
    if rng.random() < 0.4:
        chunks.insert(max(1, place), (bytes(rng.choice(CHUNKS)), rng.bytes(rng.integers(40))))
    elif data:
        torn = bytearray(data)
        torn[rng.integers(len(torn))] = rng.integers(256)
        chunks[place] = (kind, bytes(torn))
    packed = [
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    ]
    return content[:8] + b"".join(packed)


def _damaged_words(content: bytes, rng: np.random.Generator) -> bytes:
    words = content.split(b" ")
    strange = (b"nan", b"-1", b"0", b"1e300", b"4294967297", b"9" * 30, b"f", b"v", b"", b"1/2/3")
    words[rng.integers(len(words))] = strange[rng.integers(len(strange))]
    return b" ".join(words)


def _damaged_number(content: bytes, rng: np.random.Generator) -> bytes:
    """Change one number of JSON to another that may do as well."""
    numbers = list(NUMBER.finditer(content))
    if not numbers:
        return content
    found = numbers[rng.integers(len(numbers))]
    other = float(found[0]) * rng.choice(MILD) + rng.integers(2)
    return content[: found.start()] + f"{other:g}".encode() + content[found.end() :]


class Ended(NamedTuple):
    """How a command ended, what it said, and what it took."""

    status: int
    said: str
    seconds: float
    kilobytes: int


def forked(words: list[str], told: Path) -> Ended:
    """Run a command in a process forked from this one, its output in a file."""
    process = os.fork()
    if process == 0:
        status = 70
        try:
            os.dup2(os.open(told, os.O_RDWR | os.O_CREAT | os.O_TRUNC), 2)
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
            sys.stdout, sys.stderr = open(1, "w", closefd=False), open(2, "w", closefd=False)  # noqa: SIM115
            own = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
            resource.setrlimit(resource.RLIMIT_AS, (own + MEMORY, own + MEMORY))
            resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE + 1))
            status = main(words)
        except SystemExit as end:
            status = int(end.code or 0)
        except BaseException:  # noqa: BLE001 - it is what is looked for
            import traceback  # noqa: PLC0415 - seldom

            traceback.print_exc()
        finally:
            sys.stderr.flush()
            os._exit(status)
    _, ending, used = os.wait4(process, 0)
    seconds = used.ru_utime + used.ru_stime
    return Ended(
        os.waitstatus_to_exitcode(ending),
        told.read_text("utf-8", "replace"),
        seconds,
        used.ru_maxrss,
    )


def many(call: Call, rng: np.random.Generator, count: int) -> dict[str, float]:
    """Run a command upon so many damaged files."""
    ends, bad = [], []
    kept = Path(tempfile.gettempdir()) / "lissom-found"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for drawing, data in drawings().items():
            (folder / drawing).write_bytes(data)
        for number in range(-len(call.files()), count):
            # First all as they are, which must work.
            file = list(call.files())[number if number < 0 else rng.integers(len(call.files()))]
            path, out = folder / file, folder / "out"
            content = call.files()[file]
            path.write_bytes(damaged(content, rng) if number >= 0 else content)
            places = {"IN": str(path), "OUT": str(out), "OUT.gif": f"{out}.gif"}
            places |= {drawing: str(folder / drawing) for drawing in drawings()}
            ended = forked([places.get(word, word) for word in call.words], folder / "told")
            ends.append(ended)
            note(f"{call.words[0]} {file} {number}", ended.seconds)
            lines = [line for line in ended.said.splitlines() if "lissom: error:" in line]
            fine = ended.status in (0, 1, 3) or (ended.status == 2 and len(lines) == 1)
            fine &= number >= 0 or ended.status != 2
            if not fine or "Traceback" in ended.said:
                kept.mkdir(exist_ok=True)
                found = kept / f"{call.words[0]}-{number}-{file}"
                found.write_bytes(path.read_bytes())
                bad.append(f"{found}: {ended.status} {ended.said[-300:]}")
    expect(not bad, "\n".join([f"{len(bad)} of {count}", *bad[:12]]))
    return {
        "inputs": count,
        "refused": sum(ended.status == 2 for ended in ends),
        "most memory, MB": max(ended.kilobytes for ended in ends) / 1024,
    }


# What the commands load when they run: once, and not in every process.
ROOMS = (
    "app.cli.arrays.deform_case",
    "app.cli.arrays.keyframe_blend",
    "app.cli.drawings",
    "app.cli.project_export",
    "app.reports",
    "app.solving",
)


def campaign(seed: int, amount: int) -> Iterator[tuple[str, dict[str, float]]]:
    """Run each command upon its share of so many damaged files, and yield the figures of each."""
    signal.signal(signal.SIGXCPU, signal.SIG_DFL)
    commands = {call.words[0] for call in CALLS.values()}
    for room in ROOMS:
        importlib.import_module(room)
    for number, (name, call) in enumerate(CALLS.items()):
        alike = sum(each.words[0] == call.words[0] for each in CALLS.values())
        share = max(1, amount // len(commands) // alike)
        yield name, many(call, np.random.default_rng([seed, number]), share)
