"""Pictures, meshes and a place to draw them for the tests of drawing."""

import ctypes
from contextlib import suppress

import moderngl
import numpy as np
import pytest

from app.render.gpu.mesh import GpuMesh, PosedMesh, PositionBuffer, VertexSource, to_float32_points
from app.render.gpu.picture import GpuPicture
from app.render.gpu.target import RenderTarget
from app.render.renderer import Renderer
from app.render.scene import Scene
from app.render.view import View
from engine.arrays import Bytes, Complexes, Integers


def _has_osmesa() -> bool:
    for name in ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.8.dylib", "osmesa.dll"):
        with suppress(OSError):
            return bool(ctypes.CDLL(name))
    return False


HAS_OSMESA = _has_osmesa()
NEEDS_OSMESA = pytest.mark.skipif(
    not HAS_OSMESA, reason="no OSMesa here: bash .ci/setup installs it where Mesa still has it"
)
BACKENDS = ["egl", pytest.param("osmesa", marks=NEEDS_OSMESA)]


class Easel:
    """A renderer and everything made for it, released together."""

    def __init__(self, gl: moderngl.Context) -> None:
        self.gl = gl
        self.renderer = Renderer(gl)
        self._owned: list[GpuPicture | GpuMesh | PosedMesh] = []

    def mesh(self, picture: Bytes, rest: Complexes, triangles: Integers) -> GpuMesh:
        gpu_picture = GpuPicture(self.gl, picture)
        mesh = GpuMesh(self.renderer.programs, gpu_picture, rest=rest, triangles=triangles)
        self._owned += [gpu_picture, mesh]
        return mesh

    def pose(self, mesh: GpuMesh, points: Complexes) -> PosedMesh:
        source = PositionBuffer(self.gl, len(points))
        source.write(to_float32_points(points))
        return self.pose_of(mesh, source)

    def pose_of(self, mesh: GpuMesh, source: VertexSource) -> PosedMesh:
        pose = PosedMesh(mesh, source)
        self._owned.append(pose)
        return pose

    def frame(self, view: View, scene: Scene, *, oversampling: int = 1) -> Bytes:
        target = RenderTarget(self.renderer.programs, view.size, oversampling)
        self.renderer.draw(target, view, scene)
        pixels = target.read_straight_rgba()
        target.release()
        return pixels

    def release(self) -> None:
        for owner in reversed(self._owned):
            owner.release()
        self.renderer.release()
        assert self.gl.error == "GL_NO_ERROR"


def all_levels() -> Bytes:
    """Every pair of an alpha and a colour once, in random order, so that neighbours differ."""
    rng = np.random.default_rng(11)
    pairs = rng.permutation(256 * 256)
    picture = np.empty((256, 256, 4), np.uint8)
    picture[..., 3] = (pairs // 256).reshape(256, 256)
    picture[..., 0] = (pairs % 256).reshape(256, 256)
    picture[..., 1] = 255 - picture[..., 0]
    picture[..., 2] = rng.permutation(picture[..., 0].ravel()).reshape(256, 256)
    return picture


def soft_blob(width: int = 120, height: int = 90) -> Bytes:
    """A striped ellipse with an edge eight pixels wide, and bright colours hidden outside."""
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    away = np.hypot((x - width / 2) / (width / 2 - 6), (y - height / 2) / (height / 2 - 6))
    alpha = np.clip((1 - away) * min(width, height) / 16, 0, 1)
    stripe = 0.5 + 0.5 * np.sin(x / 5)
    colours = [0.95 - 0.5 * stripe, 0.45 + 0.4 * y / height, 0.2 + 0.6 * stripe, alpha]
    picture = np.rint(255 * np.stack(colours, axis=-1)).astype(np.uint8)
    picture[alpha == 0, :3] = 255, 0, 255
    return picture


def grid_mesh(
    width: float, height: float, cells: int, *, margin: float = 3.0, seed: int = 5
) -> tuple[Complexes, Integers]:
    """A grid of triangles over a picture and a margin around it, its inner vertices shaken."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(
        np.linspace(-margin, width + margin, cells + 1),
        np.linspace(-margin, height + margin, cells + 1),
    )
    vertices = x + 1j * y
    inner = vertices[1:-1, 1:-1]
    shake = 0.2 * min(width, height) / cells
    inner += rng.uniform(-shake, shake, inner.shape) + 1j * rng.uniform(-shake, shake, inner.shape)
    index = np.arange(vertices.size).reshape(vertices.shape)
    a, b, c, d = (
        index[rows, columns].ravel()
        for rows, columns in (
            (slice(-1), slice(-1)),
            (slice(-1), slice(1, None)),
            (slice(1, None), slice(1, None)),
            (slice(1, None), slice(-1)),
        )
    )
    triangles = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return vertices.ravel(), triangles.astype(np.int32)
