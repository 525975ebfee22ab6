"""Draws scenes: the same for the window and without one."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import moderngl

from app.render.gpu import PosedMesh, Programs, RenderTarget, ShaderFiles
from app.render.overlay import Overlay
from app.render.ramp import heat_ramp
from app.render.scene import Backdrop, Colour, Ghost, Heat, Scene, Wireframe
from app.render.view import View

_MESH: Final = ("mesh.vert", "placed.glsl")
_HEATED: Final = ("heat.vert", "placed.glsl")
_BACKGROUND: Final = ShaderFiles(vertex=("screen.vert",), fragment=("background.frag",))
_PICTURE: Final = ShaderFiles(vertex=_MESH, fragment=("picture.frag", "sample.glsl"))
_HEAT: Final = ShaderFiles(vertex=_HEATED, fragment=("heat.frag", "sample.glsl"))
_WIRE: Final = ShaderFiles(vertex=_MESH, geometry="wire.geom", fragment=("wire.frag",))
_BORDER: Final = replace(_WIRE, geometry="border.geom")
_GHOST: Final = ShaderFiles(vertex=("screen.vert",), fragment=("ghost.frag",))
_PICTURE_UNIT, _RAMP_UNIT, _LAYER_UNIT = 0, 1, 0


class Renderer:
    """Owner of the programs of a context and of what is drawn on the way."""

    def __init__(self, context: moderngl.Context) -> None:
        self.programs = Programs(context)
        self._context = context
        self._overlay = Overlay(self.programs)
        self._layer: RenderTarget | None = None
        ramp = heat_ramp()
        self._ramp = context.texture((len(ramp), 1), 3, ramp.tobytes())
        self._ramp.repeat_x = self._ramp.repeat_y = False

    def draw(self, target: RenderTarget, view: View, scene: Scene) -> None:
        """Draw a scene in place of whatever the target holds, and leave the target bound.

        The view has the target's size.
        """
        if view.size != target.size:
            raise ValueError(f"a view of {view.size} pixels cannot fill a frame of {target.size}")
        target.framebuffer.use()
        self._draw_background(scene.background, view, target.oversampling)
        self._draw_meshes(scene, scene.meshes[: scene.ghosts_over], target, view)
        for ghost in scene.ghosts:
            self._draw_ghost(ghost, target, view)
        self._draw_meshes(scene, scene.meshes[scene.ghosts_over :], target, view)
        if scene.wireframe is not None:
            for mesh in scene.meshes:
                self._draw_wireframe(mesh, view, scene.wireframe)
        self._overlay.draw(view, scene.lines, scene.discs)

    def _draw_meshes(
        self, scene: Scene, meshes: Sequence[PosedMesh], target: RenderTarget, view: View
    ) -> None:
        self._blend_over()
        for mesh in meshes:
            if mesh.opacity == 1:
                self._draw_mesh(mesh, view, scene.heat)
            else:
                faint = Ghost(meshes=(mesh,), tint=None, opacity=mesh.opacity)
                self._draw_ghost(faint, target, view, scene.heat)
                self._blend_over()

    def _blend_over(self) -> None:
        self._context.enable_only(moderngl.BLEND)
        self._context.blend_func = (moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA)

    def _draw_background(self, background: Backdrop, view: View, samples: int) -> None:
        if background.checks is None:
            self._context.fbo.clear(*_premultiplied(background.colour))
            return
        self._context.enable_only(moderngl.NOTHING)
        width, height = view.size
        origin_x, origin_y = view.transform[2:]
        uniforms = {
            "light": _premultiplied(background.colour),
            "dark": _premultiplied(background.checks),
            "origin": ((origin_x + 1) / 2 * width * samples, (origin_y + 1) / 2 * height * samples),
            "square": background.square * samples,
        }
        self.programs.draw_screen(_BACKGROUND, uniforms)

    def _draw_mesh(self, mesh: PosedMesh, view: View, heat: Heat | None) -> None:
        uniforms: dict[str, object] = {"view": view.transform, "picture": _PICTURE_UNIT}
        with mesh.picture.bound(_PICTURE_UNIT):
            if heat is None:
                mesh.draw(_PICTURE, uniforms)
                return
            self._ramp.use(_RAMP_UNIT)
            uniforms |= {
                "ramp": _RAMP_UNIT,
                "limits": (heat.low, heat.high),
                "contours": float(heat.contours),
                "strength": heat.strength,
                "two_sided": float(heat.two_sided),
            }
            mesh.draw(_HEAT, uniforms)

    def _draw_wireframe(self, mesh: PosedMesh, view: View, wireframe: Wireframe) -> None:
        uniforms: Mapping[str, object] = {
            "view": view.transform,
            "frame_size": view.size,
            "ink": wireframe.colour,
            "width": wireframe.width,
        }
        mesh.draw(_WIRE, uniforms)
        mesh.draw_border(_BORDER, uniforms)

    def _draw_ghost(
        self, ghost: Ghost, target: RenderTarget, view: View, heat: Heat | None = None
    ) -> None:
        # On a layer of its own: limbs that overlap would shine through each other.
        wanted = (target.size, target.oversampling)
        if self._layer is None or (self._layer.size, self._layer.oversampling) != wanted:
            self._release_layer()
            self._layer = RenderTarget(self.programs, *wanted)
        self._layer.framebuffer.use()
        self._layer.framebuffer.clear()
        self._blend_over()
        for mesh in ghost.meshes:
            self._draw_mesh(mesh, view, heat)
        target.framebuffer.use()
        self._layer.texture.use(_LAYER_UNIT)
        uniforms = {
            "frame": _LAYER_UNIT,
            "tint": ghost.tint or (0.0, 0.0, 0.0),
            "strength": 0.0 if ghost.tint is None else 1.0,
            "opacity": ghost.opacity,
        }
        self.programs.draw_screen(_GHOST, uniforms)

    def _release_layer(self) -> None:
        if self._layer is not None:
            self._layer.release()
            self._layer = None

    def release(self) -> None:
        """Let everything go that the renderer made; targets, poses and pictures are not its own."""
        self._release_layer()
        self._ramp.release()
        self._overlay.release()
        self.programs.release()


def _premultiplied(colour: Colour) -> Colour:
    red, green, blue, alpha = colour
    return red * alpha, green * alpha, blue * alpha, alpha
