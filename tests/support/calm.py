"""How calm the window is: its visible controls, and the drawing's share of it.

`PYTHONPATH=.:tests/support python tests/support/calm.py` prints both for a drawing that was just
opened, with the panel open and folded.
"""

from typing import NamedTuple

from harness import Harness, Robot
from imgui_bundle import imgui

from app.storage.assets import sample_images
from app.ui.shortcuts.table import MENUS

# Width and height in pixels, and the interface's scale.
SIZES = (((1280, 800), 1.0), ((1024, 700), 1.0), ((1600, 1000), 2.0))
# The drawing and the lanes are handled directly; the controls serve them.
SURFACES = ("###Viewport", "###Timeline/", "MainDockSpace")


class Calm(NamedTuple):
    """The visible controls by window, and the drawing's share of the window's area."""

    controls: dict[str, int]
    share: float

    @property
    def count(self) -> int:
        return sum(self.controls.values())


def measure_calm(window: Harness) -> Calm:
    """Count menus, tabs, and each button, field, slider and list row that can be seen."""
    windows = [
        each
        for each in imgui.get_current_context().windows
        if each.active and not each.hidden and not any(name in each.name for name in SURFACES)
    ]
    found = imgui.test_engine.TestItemList()

    def gather(robot: Robot) -> None:
        for each in windows:
            robot.gather_items(found, f"//{each.name}", -1)

    window.run(gather)
    items = {item.id_: item for item in map(found.get_by_index, range(found.get_size()))}
    counts = {"menus": len(MENUS), "tabs": _count_tabs()}
    frames = {each.id_ for each in imgui.get_current_context().windows}
    frames |= {each.child_id for each in imgui.get_current_context().windows}
    for identity, item in items.items():
        name, box = item.window.name, item.rect_clipped
        is_surface = any(surface in name for surface in SURFACES) or identity in frames
        if not is_surface and box.get_width() > 0 and box.get_height() > 0:
            counts[name] = counts.get(name, 0) + 1
    size, density = imgui.get_io().display_size, imgui.get_io().display_framebuffer_scale.x
    width, height = window.session.display.screen
    return Calm(counts, width * height / density**2 / (size.x * size.y))


def _count_tabs() -> int:
    """Return how many tabs can be seen; a single panel of a dock has none."""
    windows = imgui.get_current_context().windows
    tabs = [each.dc.dock_tab_item_rect for each in windows if each.active and each.dock_node]
    return sum(tab.get_width() > 0 for tab in tabs)


def main() -> None:
    window = Harness()
    window.reset()
    window.open(sample_images() / "giraffe.png")
    for size, scale in SIZES:
        window.resize(size, scale)
        window.frames(10)
        calm = measure_calm(window)
        print(f"{size}, {scale:.0%}: {calm.count} controls, {calm.share:.1%}  {calm.controls}")


if __name__ == "__main__":
    main()
