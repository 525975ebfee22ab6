"""Draws scenes, for the window and offscreen."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

import moderngl

from app.document import (
    BLENDS,
    DEFAULT_EFFECTS,
    CompositeGroup,
)
from app.render.colormap import heat_colormap
from app.render.gpu.mesh import PosedMesh
from app.render.gpu.programs import Programs, ShaderFiles
from app.render.gpu.target import RenderTarget
from app.render.members import draw_members, split_runs
from app.render.overlay import Overlay
from app.render.scene import Backdrop, Colour, Heat, Painted, Scene, Wireframe
from app.render.view import View

_MESH: Final = ("mesh.vert", "placed.glsl")
_HEATED: Final = ("heat.vert", "placed.glsl")
_BACKGROUND: Final = ShaderFiles(vertex=("screen.vert",), fragment=("background.frag",))
_PICTURE: Final = ShaderFiles(vertex=_MESH, fragment=("picture.frag", "sample.glsl"))
_HEAT: Final = ShaderFiles(vertex=_HEATED, fragment=("heat.frag", "sample.glsl"))
_WIRE: Final = ShaderFiles(vertex=_MESH, geometry="wire.geom", fragment=("wire.frag",))
_BORDER: Final = replace(_WIRE, geometry="border.geom")
_COMPOSITES: Final = {
    blend: ShaderFiles(
        vertex=("screen.vert",),
        fragment=("ghost.frag", "blend.glsl"),
        constants=() if blend == "normal" else (("BLEND", blend.replace("-", "_")),),
    )
    for blend in BLENDS
}
_PICTURE_UNIT, _RAMP_UNIT, _LAYER_UNIT, _BACKDROP_UNIT = 0, 1, 0, 1
# "Compositing and Blending Level 1" of the W3C, Section 9.1.4, for premultiplied colours: factors
# of the source and of the backdrop, for the colours and for alpha. The shader blends the source's
# colours with the backdrop first.
_OVER: Final = (moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA)
# A clipped source keeps the backdrop's alpha, as if painted first and then cut out.
_CLIPPED: Final = (moderngl.DST_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA, moderngl.ZERO, moderngl.ONE)
_ADDED: Final = (moderngl.ONE, moderngl.ONE)


class Renderer:
    """Owner of the programs of a context and of its offscreen targets."""

    def __init__(self, context: moderngl.Context) -> None:
        self.programs = Programs(context)
        self._context = context
        self._overlay = Overlay(self.programs)
        self._layers: list[RenderTarget] = []
        ramp = heat_colormap()
        self._ramp = context.texture((len(ramp), 1), 3, ramp.tobytes())
        self._ramp.repeat_x = self._ramp.repeat_y = False

    def draw(self, target: RenderTarget, view: View, scene: Scene) -> None:
        """Draw a scene over the target's previous content, and leave the target bound.

        The view has the target's size.
        """
        if view.size != target.size:
            raise ValueError(f"a view of {view.size} pixels cannot fill a frame of {target.size}")
        target.framebuffer.use()
        self._draw_background(scene.background, view, target.oversampling)
        # A checkerboard stands for clear ground, with which nothing blends.
        is_clear = scene.background.checks is not None
        whole = CompositeGroup(scene.meshes)
        ground, depth = target, 0
        if is_clear and whole.needs_backdrop:
            ground, depth = self._clear_layer(0, target), 1
        behind, before = scene.meshes[: scene.ghosts_over], scene.meshes[scene.ghosts_over :]
        self._draw_parts(behind, ground, view, scene.heat, depth)
        for ghost in scene.ghosts:
            faded = CompositeGroup(ghost.meshes, ghost.opacity)
            self._draw_layer(faded, ground, view, tint=ghost.tint, depth=depth)
        self._draw_parts(before, ground, view, scene.heat, depth)
        if ground is not target:
            self._lay(ground, target, whole)
        if scene.wireframe is not None:
            self._blend_over()
            for mesh in _meshes(scene.meshes):
                self._draw_wireframe(mesh, view, scene.wireframe)
        self._overlay.draw(view, scene.lines, scene.discs)

    def _blend_over(self) -> None:
        self._context.enable_only(moderngl.BLEND)
        self._context.blend_func = _OVER

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
        uniforms: dict[str, object] = {**view.uniforms, "picture": _PICTURE_UNIT}
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
            **view.uniforms,
            "frame_size": view.size,
            "ink": wireframe.colour,
            "width": wireframe.width,
        }
        mesh.draw(_WIRE, uniforms)
        mesh.draw_border(_BORDER, uniforms)

    def _draw_parts(
        self,
        parts: Sequence[Painted],
        target: RenderTarget,
        view: View,
        heat: Heat | None,
        depth: int = 0,
    ) -> None:
        self._blend_over()
        # A heat map shows one mesh at a time.
        for part in split_runs(parts) if heat is None else parts:
            if isinstance(part, list):
                draw_members(part, view.uniforms)
            elif isinstance(part, CompositeGroup):
                self._draw_layer(part, target, view, heat=heat, depth=depth)
                self._blend_over()
            else:
                self._draw_mesh(part, view, heat)

    def _draw_layer(
        self,
        whole: CompositeGroup[PosedMesh],
        target: RenderTarget,
        view: View,
        *,
        tint: tuple[float, float, float] | None = None,
        heat: Heat | None = None,
        depth: int = 0,
    ) -> None:
        """Draw parts into the offscreen target of this depth, then composite it on `target`.

        Drawn directly, overlapping limbs would show through each other.
        """
        layer = self._clear_layer(depth, target)
        if whole.is_pass_through:
            # The offscreen target holds the final colours. First subtract its share of the old
            # colours from the target, then add the same share of the final colours.
            self._context.copy_framebuffer(layer.framebuffer, target.framebuffer)
            old = layer
            if whole.kept:
                target.framebuffer.use()
                self._draw_parts(whole.kept, target, view, heat, depth + 1)
                old = self._clear_layer(depth + 1, target)
                self._context.copy_framebuffer(old.framebuffer, target.framebuffer)
            self._context.blend_equation = moderngl.FUNC_REVERSE_SUBTRACT  # type: ignore[assignment]
            self._lay(old, target, whole, tint=tint)
            self._context.blend_equation = moderngl.FUNC_ADD  # type: ignore[assignment]
            layer.framebuffer.use()
        self._draw_parts(whole.parts, layer, view, heat, depth + 1)
        if whole.blend != "normal":
            # The parts are drawn, so the next target is free for a copy of the backdrop. Clearing
            # it makes software OpenGL finish the backdrop before the copy.
            backdrop = self._clear_layer(depth + 1, target)
            self._context.copy_framebuffer(backdrop.framebuffer, target.framebuffer)
            backdrop.texture.use(_BACKDROP_UNIT)
        self._lay(layer, target, whole, tint=tint)

    def _lay(
        self,
        layer: RenderTarget,
        target: RenderTarget,
        whole: CompositeGroup[PosedMesh],
        tint: tuple[float, float, float] | None = None,
    ) -> None:
        """Composite the drawn parts of a group on a target."""
        target.framebuffer.use()
        layer.texture.use(_LAYER_UNIT)
        uniforms = {
            "frame": _LAYER_UNIT,
            "tint": tint or (0.0, 0.0, 0.0),
            "strength": 0.0 if tint is None else 1.0,
            "opacity": whole.opacity,
            **DEFAULT_EFFECTS,
            **whole.effects,
        }
        if whole.blend != "normal":
            uniforms |= {"backdrop": _BACKDROP_UNIT, "clipped": float(whole.clipped)}
        factors = _ADDED if whole.is_pass_through else _CLIPPED if whole.clipped else _OVER
        self._context.enable_only(moderngl.BLEND)
        self._context.blend_func = factors  # type: ignore[assignment]
        self.programs.draw_screen(_COMPOSITES[whole.blend], uniforms)

    def _clear_layer(self, depth: int, target: RenderTarget) -> RenderTarget:
        """Return the offscreen target of this depth, cleared and bound."""
        layer = self._layer_at(depth, target)
        layer.framebuffer.use()
        layer.framebuffer.clear()
        return layer

    def _layer_at(self, depth: int, target: RenderTarget) -> RenderTarget:
        wanted = (target.size, target.oversampling)
        if self._layers and (self._layers[0].size, self._layers[0].oversampling) != wanted:
            self._release_layers()
        while len(self._layers) <= depth:
            self._layers.append(RenderTarget(self.programs, *wanted))
        return self._layers[depth]

    def _release_layers(self) -> None:
        for layer in self._layers:
            layer.release()
        self._layers.clear()

    def release(self) -> None:
        """Release everything the renderer made; targets, poses and pictures have other owners."""
        self._release_layers()
        self._ramp.release()
        self._overlay.release()
        self.programs.release()


def _premultiplied(colour: Colour) -> Colour:
    red, green, blue, alpha = colour
    return red * alpha, green * alpha, blue * alpha, alpha


def _meshes(parts: Sequence[Painted]) -> Iterator[PosedMesh]:
    for part in parts:
        if isinstance(part, CompositeGroup):
            yield from _meshes(part.parts)
        else:
            yield part
