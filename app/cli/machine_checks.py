"""Checks of what works on this machine: rendering, the window, and optional libraries."""

import os
import sys
from typing import Final, NamedTuple

import numpy as np

from app.errors import LIBRARIES, Extra, LissomError, install_hint
from app.export_formats import EXPORT_FORMATS
from app.render import Renderer, Scene, canvas_view
from app.render.gpu.context import AUTOMATIC, Backend, GlError, create_context, probe_backend
from app.render.gpu.mesh import GpuMesh, PosedMesh, PositionBuffer, to_float32_points
from app.render.gpu.picture import GpuPicture
from app.render.gpu.target import RenderTarget
from app.reports import library_version
from app.sound import open_device
from app.texts import _, message_of
from app.ui.dialogs.native_dialog import find_system_dialogs

USES: Final[dict[Extra, str]] = {
    "video": ", ".join(name for name, each in EXPORT_FORMATS.items() if each.extra == "video"),
    "psd": _("Photoshop files"),
    "figures": "lissom figures",
}


class CheckResult(NamedTuple):
    """Whether a feature works, and its version or remedy."""

    name: str
    text: str
    works: bool = True


def check_rendering() -> list[CheckResult]:
    return [_rendering(backend) for backend in AUTOMATIC]


def check_surroundings() -> list[CheckResult]:
    """Check what only the window or some commands need."""
    return [_display(), _dialogs(), _sound(), *map(_extra, LIBRARIES)]


def _rendering(backend: Backend) -> CheckResult:
    name = _("rendering with {backend}").format(backend=backend)
    report = probe_backend(backend)
    if report.problem:
        return CheckResult(name, report.problem, works=False)
    text = _("{renderer}, OpenGL {version}, up to {size} pixels each way").format(
        renderer=report.renderer, version=report.version, size=report.largest_size
    )
    try:
        if _draws_exactly(backend):
            return CheckResult(name, text)
        problem = _("it draws wrong pictures")
    except (LissomError, GlError) as error:
        problem = message_of(error)
    failure = _("{text}. Drawing fails: {problem}. Install another graphics driver")
    return CheckResult(name, failure.format(text=text, problem=problem), works=False)


def _draws_exactly(backend: Backend) -> bool:
    """Draw a small picture at its own size and compare."""
    picture = np.random.default_rng(0).integers(1, 256, (12, 16, 4), dtype=np.uint8)
    rest = np.array([0, 16, 16 + 12j, 12j])
    triangles = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)
    context = create_context(backend)
    try:
        renderer = Renderer(context)
        texture = GpuPicture(context, picture)
        mesh = GpuMesh(renderer.programs, texture, rest=rest, triangles=triangles)
        vertices = PositionBuffer(context, len(rest))
        vertices.write(to_float32_points(rest))
        target = RenderTarget(renderer.programs, (16, 12))
        renderer.draw(target, canvas_view((16, 12)), Scene(meshes=(PosedMesh(mesh, vertices),)))
        return np.array_equal(target.read_straight_rgba(), picture)
    finally:
        # Releases also all objects of the context.
        context.release()


def _display() -> CheckResult:
    name = _("display for the window")
    if sys.platform in {"win32", "darwin"}:
        return CheckResult(name, _("the system's own"))
    for variable in ("WAYLAND_DISPLAY", "DISPLAY"):
        if os.environ.get(variable):
            return CheckResult(name, f"{variable}={os.environ[variable]}")
    return CheckResult(name, _("none; the command line does not need one"), works=False)


def _dialogs() -> CheckResult:
    name = _("file dialogs of the system")
    found = find_system_dialogs()
    if found:
        return CheckResult(name, found)
    remedy = _(
        "none; Lissom uses its own dialogs. For the system's dialogs: sudo apt install zenity"
    )
    return CheckResult(name, remedy, works=False)


def _sound() -> CheckResult:
    name = _("sound device")
    try:
        device = open_device()
    except LissomError as error:
        text = _("{problem}; exports still contain sounds").format(problem=message_of(error))
        return CheckResult(name, text, works=False)
    return CheckResult(name, _("{rate:,} samples a second").format(rate=device.rate))


def _extra(extra: Extra) -> CheckResult:
    """Return the state of an optional extra."""
    name, library = USES[extra], LIBRARIES[extra]
    if remedy := install_hint(extra):
        text = _("{library} is not installed: {remedy}").format(library=library, remedy=remedy)
        return CheckResult(name, text, works=False)
    return CheckResult(name, f"{library} {library_version(library)}")
