"""Valid files of every kind that Lissom reads, what is done to them, and a watch over reading.

A mutation is a list of small steps, each a few numbers: hypothesis makes and shrinks them.
"""

import io
import json
import struct
import sys
import time
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from documents import full_document
from hypothesis import strategies as st
from layered import blob, openraster
from PIL import Image
from psd_tools import PSDImage

from app.cli.main import main
from app.errors import EXPECTED_ERRORS
from app.folders import settings_folder
from app.solving.script.pose_script import load_pose_script
from app.storage.autosave import Autosave, SourceInfo, load_recoverable_file, read_source_info
from app.storage.files.reading import read_file
from app.storage.pictures.openraster import read_openraster
from app.storage.pictures.photoshop import read_photoshop
from app.storage.pictures.picture import decode_mask, decode_picture
from app.storage.preferences import (
    Preferences,
    load_preferences,
    save_preferences,
)
from app.storage.project_file import load_project, save_project
from app.storage.thumbnail import draw_thumbnail, read_thumbnail

STRANGE = (
    *(float("nan"), float("inf"), 1e308, -1e308, 5e-324, -1, 0, 2**31, 10**30, 1e6, 0.5),
    *(True, False, None, "", "x" * 5000, "\ud800", "../../x", "\0", [], {}, [[]], [0, 0], [1e308]),
)
TRAVERSING = ("../../../../tmp/evil", "/etc/evil", "layers/../../evil", "a\0b", "C:\\evil", "")
SIZES = (0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0xFFFF, 0x00FFFFFF)
RUNS = {"pickle.find_class", "subprocess.Popen", "os.system", "os.exec", "os.fork"}
MOVES = {"socket.connect", "os.remove", "os.rename", "os.mkdir", "ctypes.dlopen"}
BOMB = bytes(4_000_000)

Step = tuple[int, float, float, int]
STEPS = st.lists(
    st.tuples(
        st.integers(0, 15),
        st.floats(0, 1, exclude_max=True),
        st.floats(0, 1, exclude_max=True),
        st.integers(0, 255),
    ),
    min_size=1,
    max_size=4,
)


class Reader(NamedTuple):
    """Something that reads a file, and valid files for it, by their names."""

    read: Callable[[Path], object]
    samples: Callable[[], dict[str, bytes]]


def changed(content: bytes, steps: list[Step]) -> bytes:
    """Return the contents of a file with some steps done to them."""
    for step in steps:
        if content[:4] == b"PK\3\4" and step[0] >= 6:
            content = _changed_zip(content, step)
        elif content[:1] in {b"{", b"["} and step[0] >= 4:
            content = _changed_json(content, step)
        else:
            content = _changed_bytes(content, step)
    return content


def _changed_bytes(content: bytes, step: Step) -> bytes:
    kind, where, length, value = step
    at = int(where * len(content))
    end = min(len(content), at + 1 + int(length**4 * len(content)))
    match kind % 6:
        case 0:
            return content[:at] + bytes([value]) + content[at + 1 :]
        case 1:
            return content[:at]
        case 2:
            number = struct.pack("<>"[value % 2] + "L", SIZES[value % len(SIZES)])
            return content[:at] + number + content[at + 4 :]
        case 3:
            return content[:at] + content[end:]
        case 4:
            return content[:end] + content[at:end] + content[end:]
    return content[:at] + bytes([value]) * (end - at) + content[end:]


def _changed_zip(content: bytes, step: Step) -> bytes:
    """Change one member, or which there are, and pack them again with checksums that fit."""
    kind, where, length, value = step
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            members = {name: archive.read(name) for name in archive.namelist()}
    except Exception:  # noqa: BLE001 - an earlier step has broken it
        return _changed_bytes(content, step)
    names = list(members)
    name, other = names[int(where * len(names))], names[int(length * len(names))]
    match kind - 6:
        case 0 | 1 | 2 | 3:
            inner = (value % 16, length, where, value)
            members[name] = changed(members[name], [inner])
        case 4:
            members[name], members[other] = members[other], members[name]
        case 5:
            del members[name]
        case 6:
            members[TRAVERSING[value % len(TRAVERSING)]] = members.pop(name)
        case 7:
            members[name] = BOMB
        case 8:
            members[f"{name}{value}"] = BOMB[: value * 1000]
        case _:
            members[name] = members[name] * (value % 8)
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for each, data in members.items():
            archive.writestr(each or "x", data)
    return file.getvalue()


def _changed_json(content: bytes, step: Step) -> bytes:
    kind, where, length, value = step
    try:
        read = json.loads(content)
    except (ValueError, RecursionError):
        return _changed_bytes(content, step)
    if kind == 4:
        deep = b"[" * (value * 400)
        return b'{"deep": ' + deep + b"]" * (value * 400) + b"," + content[1:]
    places = list(_places(read))
    if not places:
        return _changed_bytes(content, step)
    holder, key = places[int(where * len(places))]
    source, other = places[int(length * len(places))]
    match kind % 4:
        case 0 | 1:
            holder[key] = STRANGE[value % len(STRANGE)]
        case 2:
            holder[key] = json.loads(json.dumps(source[other]))
        case _:
            del holder[key]
    return json.dumps(read).encode("utf-8", "surrogatepass")


def _places(content: object) -> Iterator[tuple[object, object]]:
    parts = content.items() if isinstance(content, dict) else enumerate(content)
    for key, value in list(parts):
        yield content, key
        if isinstance(value, (dict, list)):
            yield from _places(value)


@cache
def _pictures() -> dict[str, bytes]:
    rgba = blob(40, 30)
    files = {}
    for name, mode in (
        *(("png", "RGBA"), ("jpg", "RGB"), ("gif", "RGB"), ("webp", "RGBA"), ("bmp", "RGB")),
        *(("tiff", "RGBA"), ("ppm", "RGB"), ("tga", "RGBA"), ("ico", "RGBA"), ("avif", "RGB")),
    ):
        file = io.BytesIO()
        image = rgba.convert(mode)
        exif = Image.Exif()
        exif[0x0112] = 6
        extra = {"exif": exif} if name in {"png", "jpg", "webp", "tiff"} else {}
        image.save(file, {"jpg": "JPEG"}.get(name, name.upper()), **extra)
        files[f"a.{name}"] = file.getvalue()
    deep = io.BytesIO()
    Image.fromarray(np.arange(1200, dtype=np.uint16).reshape(30, 40)).save(deep, "PNG")
    return {**files, "deep.png": deep.getvalue()}


@cache
def _project() -> dict[str, bytes]:
    path = _scratch() / "a.lissom"
    small = draw_thumbnail(np.asarray(blob(40, 30)))
    save_project(path, full_document(), thumbnail=small)
    return {"a.lissom": path.read_bytes()}


@cache
def _leftover() -> dict[str, bytes]:
    keeper = Autosave(_scratch())
    keeper.write(full_document(), SourceInfo("a", Path("/a/b.lissom")))
    (path,) = _scratch().glob("unsaved-*.lissom")
    content = path.read_bytes()
    keeper.remove()
    return {"unsaved-1.lissom": content}


@cache
def _openraster() -> dict[str, bytes]:
    stack = (
        '<stack name="g" opacity="0.5"><layer name="a" src="data/0.png" x="3" y="2"/></stack>'
        '<layer name="b" src="data/1.png" visibility="hidden" composite-op="svg:multiply"/>'
    )
    return {"a.ora": openraster((60, 50), stack, [blob(30, 20), blob(60, 50)])}


@cache
def _photoshop() -> dict[str, bytes]:
    drawing = PSDImage.new("RGB", (60, 50))
    drawing.create_pixel_layer(blob(30, 20), name="a", top=4, left=5)
    inner = drawing.create_pixel_layer(blob(20, 20), name="b", top=20, left=10)
    drawing.create_group([inner], name="g", opacity=128)
    file = io.BytesIO()
    drawing.save(file)
    return {"a.psd": file.getvalue()}


def _square() -> dict[str, object]:
    corners = np.array([0, 1, 1 + 1j, 1j])
    return {"outline": corners, "cage": (corners - 0.5 - 0.5j) * 1.4 + 0.5 + 0.5j}


def _npz(**arrays: object) -> bytes:
    file = io.BytesIO()
    np.savez(file, **arrays)
    return file.getvalue()


@cache
def _deform_case() -> dict[str, bytes]:
    handles = np.array([0.2 + 0.5j, 0.8 + 0.5j])
    limits = {"k_max": 0.6, "sigma_a_max": 3.0, "sigma_b_min": 0.3}
    return {"a.npz": _npz(**_square(), handles=handles, targets=handles * 1.1, **limits)}


@cache
def _interpolate_case() -> dict[str, bytes]:
    square = _square()
    cage = square["cage"]
    phi, psi = np.array([cage, 1.2j * cage]), np.zeros((2, 4), complex)
    points = np.array([0.5 + 0.5j, 0.3 + 0.4j])
    return {"a.npz": _npz(**square, phi=phi, psi=psi, points=points)}


@cache
def _script() -> dict[str, bytes]:
    samples = Path(__file__).parents[2] / "sample_images"
    return {f"{name}.json": (samples / f"{name}.json").read_bytes() for name in ("friend", "ring")}


@cache
def _preferences() -> dict[str, bytes]:
    save_preferences(_scratch(), Preferences(recent=(Path("/a.png"),), folder=Path("/b")))
    return {"preferences.json": (_scratch() / "preferences.json").read_bytes()}


@cache
def _scratch() -> Path:
    import tempfile  # noqa: PLC0415 - where the samples are made, once

    return Path(tempfile.mkdtemp(prefix="lissom-hostile-"))


def _run(command: str, *options: str) -> Callable[[Path], None]:
    def run(path: Path) -> None:
        told = io.StringIO()
        with redirect_stdout(told), redirect_stderr(told):
            try:
                main([command, str(path), "--out", str(path.with_name("out.npz")), *options])
            except SystemExit as end:
                # The one way in which bad input ends, with a message.
                if end.code != 2 or "lissom: error: " not in told.getvalue():
                    raise AssertionError(told.getvalue()) from end

    return run


READERS = {
    "pictures": Reader(lambda path: decode_picture(read_file(path), "it"), _pictures),
    "masks": Reader(lambda path: decode_mask(read_file(path), "it"), _pictures),
    "thumbnails": Reader(read_thumbnail, lambda: {**_pictures(), **_project()}),
    "projects": Reader(load_project, _project),
    "unsaved work": Reader(
        lambda path: (read_source_info(path), load_recoverable_file(path)), _leftover
    ),
    "OpenRaster": Reader(lambda path: read_openraster(read_file(path)), _openraster),
    "Photoshop": Reader(lambda path: read_photoshop(read_file(path)), _photoshop),
    "scripts": Reader(load_pose_script, _script),
    "preferences": Reader(lambda path: load_preferences(path.parent), _preferences),
    "deform cases": Reader(_run("deform"), _deform_case),
    "interpolate cases": Reader(
        _run("interpolate", "--variant", "metric", "--times", "0.5"), _interpolate_case
    ),
}


class Watch:
    """What was opened, started or unpickled while it was on; there is one for a process."""

    def __init__(self) -> None:
        self._allowed: tuple[str, ...] | None = None
        self.strayed: list[str] = []
        sys.addaudithook(self._note)

    @contextmanager
    def over(self, folder: Path) -> Iterator[None]:
        """Watch that nothing but this folder and what is installed is opened."""
        installed = {sys.prefix, sys.base_prefix, str(Path(__file__).parents[2])}
        settings = str(settings_folder())  # how much memory pictures may take is asked there
        self._allowed = (str(folder), *installed, settings, "/proc/", "/sys/", "/dev/null", "/etc/")
        self.strayed = []
        try:
            yield
        finally:
            self._allowed = None
        assert not self.strayed, self.strayed

    def _note(self, event: str, arguments: tuple[object, ...]) -> None:
        if self._allowed is None:
            return
        if event == "open" and isinstance(arguments[0], (str, bytes)):
            path = arguments[0]
            path = path.decode("utf-8", "replace") if isinstance(path, bytes) else path
            writes = isinstance(arguments[1], str) and set(arguments[1]) & set("wax+")
            if not path.startswith(self._allowed) or (
                writes and not path.startswith((self._allowed[0], "/dev/null"))
            ):
                self.strayed.append(f"open {path} {arguments[1]}")
        elif event in RUNS or (event in MOVES and not str(arguments[0]).startswith(self._allowed)):
            self.strayed.append(f"{event} {arguments}")


def read_changed(reader: Reader, name: str, steps: list[Step], folder: Path, watch: Watch) -> float:
    """Let a reader read a sample that was changed; return the seconds of the processor it took.

    Raises
    ------
    Exception
        Whatever it raises but the errors that people are told.
    """
    path = folder / name
    path.write_bytes(changed(reader.samples()[name], steps))
    begun = time.process_time()
    with watch.over(folder):
        try:
            reader.read(path)
        except EXPECTED_ERRORS as error:
            assert str(error)  # noqa: PT017 - it may be read as well
    return time.process_time() - begun
