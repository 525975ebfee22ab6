"""Frames to draw into, and reading back their pixels."""

import moderngl
import numpy as np

from app.errors import LissomError
from app.render.gpu.context import finish_drawing, largest_size
from app.render.gpu.programs import Programs, ShaderFiles
from app.texts import _
from engine.arrays import Bytes

Rectangle = tuple[int, int, int, int]


class RenderTarget:
    """Owner of a premultiplied RGBA16F frame.

    Parameters
    ----------
    size : tuple of int
        Width and height in pixels.
    oversampling : int
        Samples of each pixel along both axes. With 1, a drawing at its own size is exact; 2 is
        finer for a reduced drawing.

    Raises
    ------
    LissomError
        If the context cannot hold a frame of this size.
    """

    def __init__(self, programs: Programs, size: tuple[int, int], oversampling: int = 1) -> None:
        context = programs.context
        limit = largest_size(context) // oversampling
        if max(size) > limit:
            raise LissomError(
                _(
                    "a frame of {width} × {height} pixels is too large for this machine's "
                    "graphics, which allow at most {limit} × {limit}; choose a smaller size"
                ).format(width=size[0], height=size[1], limit=limit)
            )
        self.size = size
        self.oversampling = oversampling
        samples = (size[0] * oversampling, size[1] * oversampling)
        self.texture = context.texture(samples, 4, dtype="f2")
        self.texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self.framebuffer = context.framebuffer([self.texture])
        self._programs = programs
        self._finish = ShaderFiles(
            vertex=("screen.vert",),
            fragment=("straight.frag",),
            constants=(("SAMPLES", oversampling),),
        )
        self._straight: moderngl.Framebuffer | None = None

    def read_straight_rgba(self, part: Rectangle | None = None) -> Bytes:
        """Return the frame, uint8 (h, w, 4), with straight alpha and its first row on top.

        `part` is left, top, width and height of the requested part, in pixels of the frame.
        """
        left, top, width, height = part or (0, 0, *self.size)
        context = self._programs.context
        if self._straight is None:
            self._straight = context.framebuffer([context.renderbuffer(self.size, 4)])
        self._straight.use()
        # The frame's first row is OpenGL's lowest row.
        self._straight.scissor = (left, top, width, height)
        context.enable_only(moderngl.NOTHING)
        self.texture.use(0)
        self._programs.draw_screen(self._finish, {"frame": 0})
        finish_drawing(context)
        pixels = np.empty((height, width, 4), dtype=np.uint8)
        self._straight.read_into(pixels, (left, top, width, height), components=4)
        return pixels

    def release(self) -> None:
        # moderngl binds the previous framebuffer again when it makes the next one. If the previous
        # one is released by then, this is an OpenGL error.
        self._programs.context.detect_framebuffer(0).use()
        for framebuffer in filter(None, (self.framebuffer, self._straight)):
            attachments = framebuffer.color_attachments
            framebuffer.release()
            for attachment in attachments:
                attachment.release()
