"""OpenGL contexts without a window, and their support on this machine."""

import ctypes
import subprocess
import sys
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from typing import Any, Final, Literal

import moderngl

from app.errors import LissomError
from app.texts import _

if sys.platform != "win32":
    import resource

# Exported, because only this package imports ModernGL.
Context = moderngl.Context
GlError = moderngl.Error

Backend = Literal["egl", "osmesa", "native"]
# The system's own contexts (WGL, CGL) need no display on Windows and macOS; on Linux GLX does.
AUTOMATIC: Final[tuple[Backend, ...]] = (
    ("native",) if sys.platform in {"win32", "darwin"} else ("egl", "osmesa")
)
LIBGL: Final = "libGL.so.1"
# Bytes of address space. With less, software OpenGL ends the process in the midst of its work.
LEAST_MEMORY: Final = 1_500_000_000
OPENGL: Final = 330  # the version of every shader
REMEDIES: Final[dict[Backend, str]] = {
    "egl": _("install EGL: {command}").format(
        command="sudo apt install libegl1 libgl1 libgl1-mesa-dri"
    ),
    "osmesa": _("install OSMesa, if your Mesa still has it: {command}").format(
        command="sudo apt install libosmesa6"
    ),
    "native": _(
        "install a graphics driver with OpenGL 3.3, and run Lissom where there is a display"
    ),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class BackendReport:
    """Support of one offscreen backend on this machine."""

    backend: Backend
    # The failure and the package to install; empty if the backend works. After a failure the fields
    # below are empty.
    problem: str = ""
    # GL_RENDERER and GL_VERSION.
    renderer: str = ""
    version: str = ""
    largest_size: int = 0  # longest side of a picture or frame, in pixels


def create_context(backend: Backend | None = None) -> moderngl.Context:
    """Return a new OpenGL context without a window; the caller releases it.

    Parameters
    ----------
    backend : Backend, optional
        The only backend to try; by default the first working one of EGL and OSMesa.

    Raises
    ------
    LissomError
        If no backend works. The message names the package to install.
    """
    _require_memory()
    wanted = (backend,) if backend else AUTOMATIC
    problems = []
    for name in wanted:
        try:
            return _create(name)
        except LissomError as error:
            problems.append(str(error))
    reasons = _("; or ").join(problems)
    raise LissomError(_("cannot draw on this machine: {reasons}").format(reasons=reasons))


def window_context() -> moderngl.Context:
    """Return the OpenGL context of the current window.

    Raises `LissomError` if the context lacks required features. The message names the package to
    install.
    """
    _require_memory()
    try:
        return moderngl.create_context(require=OPENGL)
    except Exception as error:  # moderngl's loaders raise nothing more specific
        raise LissomError(
            _(
                "the window has no OpenGL to draw with: {error} ({remedy}). The command line "
                "works without a window"
            ).format(error=error, remedy=REMEDIES["native"])
        ) from error


def _require_memory() -> None:
    if sys.platform != "win32" and 0 <= resource.getrlimit(resource.RLIMIT_AS)[0] < LEAST_MEMORY:
        raise MemoryError


def is_software(context: moderngl.Context) -> bool:
    """Return whether the processor draws, because there is no graphics card or no driver."""
    renderer = context.info["GL_RENDERER"].lower()
    return any(name in renderer for name in ("llvmpipe", "softpipe", "swiftshader", "swr"))


def describe_graphics(context: moderngl.Context) -> str:
    """Return the renderer's own name, and the version of OpenGL."""
    return f"{context.info['GL_RENDERER']}, OpenGL {context.info['GL_VERSION']}"


def finish_drawing(context: moderngl.Context) -> None:
    """Wait until the current context has drawn everything, while other threads run.

    ModernGL itself waits with Python's lock held.
    """
    with suppress(OSError):  # not every system has it
        ctypes.CDLL(LIBGL).glFinish()
    context.finish()


def probe_backend(backend: Backend) -> BackendReport:
    """Test a backend by creating and releasing a context."""
    try:
        context = _create(backend)
    except LissomError as error:
        return BackendReport(backend=backend, problem=str(error))
    try:
        return BackendReport(
            backend=backend,
            renderer=context.info["GL_RENDERER"],
            version=context.info["GL_VERSION"],
            largest_size=largest_size(context),
        )
    finally:
        context.release()


def largest_size(context: moderngl.Context) -> int:
    """Return the largest side, in pixels, of a texture or frame in the context."""
    info = context.info
    return int(
        min(
            info["GL_MAX_TEXTURE_SIZE"],
            info["GL_MAX_RENDERBUFFER_SIZE"],
            *info["GL_MAX_VIEWPORT_DIMS"],
        )
    )


def _create(backend: Backend) -> moderngl.Context:
    settings: dict[str, Any] = {"standalone": True}
    if backend == "egl":
        # By soname: looking the libraries up by name needs ldconfig or a compiler.
        settings |= {"backend": "egl", "libegl": "libEGL.so.1", "libgl": LIBGL}
    try:
        if backend == "osmesa":
            settings = {"context": _OSMesa()}
        return moderngl.create_context(require=OPENGL, **settings)
    except Exception as error:  # moderngl's loaders raise nothing more specific
        raise LissomError(f"{backend}: {error} ({REMEDIES[backend]})") from error


# Only creates a context of a library with attributes.
_TRIAL: Final = """
import ctypes, sys
library, *pairs = sys.argv[1:]
make = ctypes.CDLL(library).OSMesaCreateContextAttribs
make.restype = ctypes.c_void_p
make((ctypes.c_int * (len(pairs) + 1))(*map(int, pairs), 0), None)
"""


@cache
def _survives(library: str, pairs: tuple[int, ...]) -> bool:
    """Return whether OSMesa can create a context; without a driver it crashes.

    The attempt runs in another process, because a crash would end this one.
    """
    command = [sys.executable, "-I", "-S", "-c", _TRIAL, library, *map(str, pairs)]
    done = subprocess.run(command, capture_output=True, check=False)  # noqa: S603 - Python itself
    return done.returncode == 0


class _OSMesa:
    """Mesa's offscreen context with the interface that moderngl requires of custom contexts."""

    _NAMES = ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.8.dylib", "osmesa.dll")
    _FORMAT, _RGBA = 0x22, 0x1908
    _PROFILE, _CORE_PROFILE = 0x33, 0x34
    _MAJOR, _MINOR = 0x36, 0x37
    _UNSIGNED_BYTE = 0x1401

    def __init__(self) -> None:
        self._library = self._load_library()
        wanted = {
            self._FORMAT: self._RGBA,
            self._PROFILE: self._CORE_PROFILE,
            self._MAJOR: OPENGL // 100,
            self._MINOR: OPENGL // 10 % 10,
        }
        pairs = [number for pair in wanted.items() for number in pair]
        attributes = (ctypes.c_int * (len(pairs) + 1))(*pairs, 0)
        if not _survives(self._library._name, tuple(pairs)):  # noqa: SLF001 - by which it was found
            raise LissomError(_("it crashes on this machine"))
        self._context = self._library.OSMesaCreateContextAttribs(attributes, None)
        if not self._context:
            raise LissomError(_("no context with OpenGL 3.3"))
        # All drawing goes to our own framebuffers, but OSMesa requires a buffer of one pixel.
        self._pixel = (ctypes.c_ubyte * 4)()
        if not self._make_current():
            raise LissomError(_("its context cannot be made current"))

    def _make_current(self) -> bool:
        return bool(
            self._library.OSMesaMakeCurrent(self._context, self._pixel, self._UNSIGNED_BYTE, 1, 1)
        )

    def _load_library(self) -> ctypes.CDLL:
        for name in self._NAMES:
            try:
                library = ctypes.CDLL(name)
            except OSError:
                continue
            pointer, integer = ctypes.c_void_p, ctypes.c_int
            library.OSMesaCreateContextAttribs.restype = pointer
            library.OSMesaCreateContextAttribs.argtypes = [pointer, pointer]
            library.OSMesaMakeCurrent.argtypes = [pointer, pointer, ctypes.c_uint, integer, integer]
            library.OSMesaDestroyContext.argtypes = [pointer]
            library.OSMesaGetProcAddress.restype = pointer
            library.OSMesaGetProcAddress.argtypes = [ctypes.c_char_p]
            return library
        raise LissomError(_("{library} could not be loaded").format(library=self._NAMES[0]))

    def load_opengl_function(self, name: str) -> int:
        """Return the address of an OpenGL function, or 0."""
        return self._library.OSMesaGetProcAddress(name.encode()) or 0

    load = load_opengl_function

    def __enter__(self) -> None:
        self._make_current()

    def __exit__(self, *_: object) -> None:
        pass

    def release(self) -> None:
        """Destroy the context; none of its objects may be used any more."""
        if self._context:
            self._library.OSMesaMakeCurrent(None, None, 0, 0, 0)
            self._library.OSMesaDestroyContext(self._context)
            self._context = None
