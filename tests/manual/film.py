"""The window on film: a hand that moves as a person's does, and what is seen meanwhile."""

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from harness import PATIENCE, Harness, Robot
from imgui_bundle import ImVec2, imgui
from PIL import Image, ImageDraw

EVERY = 6  # frames of the window for one of the film
RATE = 60 / EVERY  # frames of the film a second
BREATH = 12  # frames that a hand rests before it presses, and after
RING = 15.0  # pixels around the pointer while it is pressed
WIDTH = 720  # of a film, in pixels
QUALITY = 42


class Film(Harness):
    """A window that can be filmed."""

    def __init__(self) -> None:
        self._count = 0
        self._shots: list[Image.Image] | None = None
        self._place = ImVec2(0, 0)
        self._is_down = False
        super().__init__()

    @contextmanager
    def filmed(self, path: Path) -> Iterator[None]:
        """Film what is done meanwhile into an animated WebP file."""
        self._shots = []
        imgui.get_io().mouse_draw_cursor = True
        try:
            yield
        finally:
            shots, self._shots = self._shots, None
            imgui.get_io().mouse_draw_cursor = False
        size = WIDTH, round(shots[0].height * WIDTH / shots[0].width)
        frames = [shot.resize(size, Image.Resampling.LANCZOS) for shot in shots]
        save_film(path.with_suffix(".webp"), frames, RATE)

    @contextmanager
    def cut(self) -> Iterator[None]:
        """Leave out of the film what is done meanwhile."""
        shots, self._shots = self._shots, None
        try:
            yield
        finally:
            self._shots = shots

    def seen_by(self, play: Callable[[Robot], None]) -> Image.Image:
        """Let the robot do something, and return what is seen last, as while a menu is open."""
        self._shots = []
        self.run(play)
        shots, self._shots = self._shots, None
        return shots[-1]

    def go(self, to: ImVec2, frames: int = 24) -> None:
        """Move the pointer to a place of the window, as a hand does: slowly at both ends."""
        begin = ImVec2(self._place)
        for number in range(1, frames + 1):
            share = 0.5 - 0.5 * math.cos(math.pi * number / frames)
            self.put(begin + (to - begin) * share)
            self.frames()

    def stay(self, frames: int = BREATH) -> None:
        """Let some frames go by."""
        self.frames(frames)

    def press(self, *, down: bool) -> None:
        """Press the button of the mouse, or let it go."""
        self._is_down = down
        self._screen.press(down=down)
        self.frames(2)

    def click(self, at: ImVec2) -> None:
        """Go to a place and click there."""
        self.go(at)
        self.stay()
        self.press(down=True)
        self.stay(4)
        self.press(down=False)
        self.stay()

    def drag(self, *way: ImVec2, frames: int = 40) -> None:
        """Go to the first place, and drag from there to the others one by one."""
        self.go(way[0])
        self.stay()
        self.press(down=True)
        for place in way[1:]:
            self.go(place, frames)
        self.stay()
        self.press(down=False)
        self.stay()

    def type(self, key: imgui.Key) -> None:
        """Press a key and let it go."""
        for down in (True, False):
            imgui.get_io().add_key_event(key, down)
            self.frames(2)

    def item(self, path: str) -> ImVec2:
        """Return the middle of an item of the interface."""
        low, high = self.room_of(path)
        return (low + high) * 0.5

    def room_of(self, path: str) -> tuple[ImVec2, ImVec2]:
        """Return the corners of an item of the interface."""
        found: list[imgui.internal.ImRect] = []

        def look(robot: Robot) -> None:
            found.append(robot.item_info(path).rect_full)

        with self.cut():
            self.run(look)
            self.put(self._place)
            self.frames(2)
        return ImVec2(found[0].min), ImVec2(found[0].max)

    def put(self, place: ImVec2) -> None:
        self._place = ImVec2(place)
        self._screen.move_mouse(place)

    def _frame(self, *, painted: bool = False) -> None:
        self._count += 1
        is_shot = self._shots is not None and self._count % EVERY == 0
        super()._frame(painted=painted or is_shot)
        if self._shots is not None or self._is_down:
            # As on a fast machine, the drawing follows at once.
            self.session.jobs.wait_until_idle(PATIENCE)
        if self._shots is not None and is_shot:
            self._shots.append(self._marked(self._screen.picture()))

    def _marked(self, shot: Image.Image) -> Image.Image:
        """Return a shot with a ring around the pointer where it is pressed."""
        if not self._is_down:
            return shot
        x, y = self._place.x, self._place.y
        around = (x - RING, y - RING, x + RING, y + RING)
        ImageDraw.Draw(shot).ellipse(around, outline=(255, 190, 60), width=3)
        return shot


def save_film(path: Path, frames: Sequence[Image.Image], rate: float) -> None:
    """Write frames into an animated WebP file; those that are alike are one that lasts longer."""
    kept, times = [frames[0]], [0.0]
    for frame in frames:
        if frame.tobytes() != kept[-1].tobytes():
            kept.append(frame)
            times.append(0.0)
        times[-1] += 1000 / rate
    first, *others = kept
    first.save(
        path,
        save_all=True,
        append_images=others,
        duration=[round(time) for time in times],
        loop=0,
        quality=QUALITY,
        method=4,
    )
