import moderngl
import pytest
from drawings import BACKENDS, NEEDS_OSMESA, Easel, grid_mesh, soft_blob
from numpy.testing import assert_array_equal

from app.errors import LissomError
from app.render.gpu import context as context_module
from app.render.gpu.context import create_context, largest_size, probe_backend
from app.render.scene import Scene
from app.render.view import canvas_view


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_probe_tells_what_a_backend_offers(backend):
    report = probe_backend(backend)
    assert report.problem == ""
    assert report.renderer
    assert report.version[0] in "34"
    assert report.largest_size >= 2048


def test_the_first_backend_is_egl_and_the_next_takes_over(monkeypatch):
    tried = []

    def create(backend):
        tried.append(backend)
        if backend == "egl":
            raise LissomError("egl: libEGL.so.1 could not be loaded")
        return "a context"

    monkeypatch.setattr(context_module, "AUTOMATIC", ("egl", "osmesa"))
    monkeypatch.setattr(context_module, "_create", create)
    assert create_context() == "a context"
    assert tried == ["egl", "osmesa"]


def test_a_forced_backend_has_no_fallback(monkeypatch):
    monkeypatch.setattr(context_module._OSMesa, "_NAMES", ("libNotThere.so.1",))
    with pytest.raises(LissomError, match=r"osmesa: .*libNotThere\.so\.1.*apt install libosmesa6"):
        create_context("osmesa")
    assert "apt install libosmesa6" in probe_backend("osmesa").problem


@NEEDS_OSMESA
def test_a_library_that_crashes_crashes_somebody_else(monkeypatch):
    """As OSMesa does where it finds no driver."""
    monkeypatch.setattr(context_module, "_TRIAL", "import os; os.abort()")
    context_module._survives.cache_clear()
    try:
        with pytest.raises(LissomError, match="osmesa: it crashes on this machine"):
            create_context("osmesa")
    finally:
        context_module._survives.cache_clear()


def test_where_nothing_works_the_error_names_the_packages(monkeypatch):
    def create_context_of_moderngl(**_):
        raise Exception("not loaded")  # noqa: TRY002 - as moderngl's loaders do

    monkeypatch.setattr(context_module, "AUTOMATIC", ("egl", "osmesa"))
    monkeypatch.setattr(moderngl, "create_context", create_context_of_moderngl)
    with pytest.raises(LissomError, match=r"libegl1 libgl1 .*libosmesa6"):
        create_context()


@NEEDS_OSMESA
def test_contexts_follow_and_accompany_each_other():
    def draw(gl):
        with gl:
            easel = Easel(gl)
            rest, triangles = grid_mesh(120, 90, 4)
            pose = easel.pose(easel.mesh(soft_blob(), rest, triangles), rest)
            frame = easel.frame(canvas_view((120, 90)), Scene(meshes=(pose,)))
            easel.release()
            return frame

    egl, osmesa = create_context("egl"), create_context("osmesa")
    frames = [draw(egl), draw(osmesa), draw(egl)]
    osmesa.release()
    frames.append(draw(egl))
    egl.release()
    again = create_context("osmesa")
    frames.append(draw(again))
    again.release()
    for frame in frames[1:]:
        assert_array_equal(frame, frames[0])


def test_the_largest_size_can_be_made(gl):
    side = largest_size(gl)
    texture = gl.texture((side, 1), 4, dtype="f2")
    framebuffer = gl.framebuffer([texture])
    assert framebuffer.viewport == (0, 0, side, 1)
    framebuffer.release()
    texture.release()
