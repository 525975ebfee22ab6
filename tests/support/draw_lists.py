"""Draws Dear ImGui's draw lists with moderngl, so that the whole window works without a display."""

import ctypes
from pathlib import Path

import moderngl
import numpy as np
from imgui_bundle import imgui

CHUNK = 1 << 16  # bytes that the buffers start with


class DrawLists:
    """Owner of the GL objects that turn ImGui's draw data into pixels of a framebuffer.

    Parameters
    ----------
    gl : moderngl.Context
        It is current whenever a method is called. ImGui's context exists already.
    """

    def __init__(self, gl: moderngl.Context) -> None:
        self._gl = gl
        self._program = gl.program(
            vertex_shader=_source("interface.vert"), fragment_shader=_source("interface.frag")
        )
        self._vertices = gl.buffer(reserve=CHUNK, dynamic=True)
        self._indices = gl.buffer(reserve=CHUNK, dynamic=True)
        self._array = self._make_array()
        self._textures: dict[int, moderngl.Texture] = {}
        imgui.get_io().backend_flags |= imgui.BackendFlags_.renderer_has_textures
        limit = int(gl.info["GL_MAX_TEXTURE_SIZE"])
        platform = imgui.get_platform_io()
        platform.renderer_texture_max_width = limit
        platform.renderer_texture_max_height = limit

    def draw(self, target: moderngl.Framebuffer) -> None:
        """Draw what ImGui rendered last."""
        data = imgui.get_draw_data()
        self._update_textures()
        left, top = data.display_pos
        width, height = data.display_size
        if width <= 0 or height <= 0:
            return
        target.use()
        self._gl.enable_only(moderngl.BLEND)
        # Alpha is kept apart, so that the picture stays opaque where panels are translucent.
        self._gl.blend_func = (  # type: ignore[assignment]  # the stub knows two of the four
            *(moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA),
            *(moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA),
        )
        self._program["place"] = (
            *(2 / width, -2 / height),
            *(-1 - 2 * left / width, 1 + 2 * top / height),
        )
        scale = data.framebuffer_scale
        for commands in data.cmd_lists:
            if not self._upload(commands):
                continue
            for command in commands.cmd_buffer:
                x0, y0, x1, y1 = command.clip_rect
                low = round((x0 - left) * scale.x), round(target.height - (y1 - top) * scale.y)
                high = round((x1 - left) * scale.x), round(target.height - (y0 - top) * scale.y)
                corner = max(low[0], 0), max(low[1], 0)
                extent = high[0] - corner[0], high[1] - corner[1]
                if min(extent) <= 0:
                    continue
                target.scissor = (corner[0], corner[1], extent[0], extent[1])
                # Also those of panels, which are known by their names alone.
                name = command.tex_ref.get_tex_id()
                self._gl.external_texture(name, (1, 1), 4, 0, "f1").use(0)
                self._array.render(
                    moderngl.TRIANGLES, vertices=command.elem_count, first=command.idx_offset
                )
        target.scissor = (0, 0, target.width, target.height)

    def _make_array(self) -> moderngl.VertexArray:
        return self._gl.vertex_array(
            self._program,
            [(self._vertices, "2f 2f 4f1", "position", "uv", "colour")],
            index_buffer=self._indices,
            index_element_size=imgui.INDEX_SIZE,
        )

    def _upload(self, commands: imgui.ImDrawList) -> bool:
        counts = commands.vtx_buffer.size(), commands.idx_buffer.size()
        if not all(counts):
            return False
        sizes = counts[0] * imgui.VERTEX_SIZE, counts[1] * imgui.INDEX_SIZE
        addresses = commands.vtx_buffer.data_address(), commands.idx_buffer.data_address()
        grown = False
        for buffer, size in zip((self._vertices, self._indices), sizes, strict=True):
            grown |= size > buffer.size
            buffer.orphan(max(buffer.size, 2 * size if size > buffer.size else 0))
        if grown:
            self._array.release()
            self._array = self._make_array()
        for buffer, size, address in zip(
            (self._vertices, self._indices), sizes, addresses, strict=True
        ):
            buffer.write((ctypes.c_char * size).from_address(address))
        return True

    def _update_textures(self) -> None:
        status = imgui.ImTextureStatus
        for image in imgui.get_platform_io().textures:
            if image.status == status.want_create:
                everything = np.ascontiguousarray(image.get_pixels_array()).tobytes()
                texture = self._gl.texture((image.width, image.height), 4, everything)
                texture.repeat_x = texture.repeat_y = False
                self._textures[texture.glo] = texture
                image.set_tex_id(texture.glo)
                image.set_status(status.ok)
            elif image.status == status.want_updates:
                pixels = image.get_pixels_array().reshape(image.height, image.width, 4)
                for part in image.updates:
                    block = pixels[part.y : part.y + part.h, part.x : part.x + part.w]
                    self._textures[image.tex_id].write(
                        np.ascontiguousarray(block).tobytes(),
                        viewport=(part.x, part.y, part.w, part.h),
                    )
                image.set_status(status.ok)
            elif image.status == status.want_destroy and image.unused_frames > 0:
                self._textures.pop(image.tex_id).release()
                image.set_tex_id(0)
                image.set_status(status.destroyed)


def _source(name: str) -> str:
    return "#version 330 core\n" + Path(__file__).with_name(name).read_text(encoding="utf-8")
