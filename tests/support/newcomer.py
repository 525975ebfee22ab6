"""Whoever has only a mouse, in tests of the window."""

from harness import Harness, Robot


class Newcomer:
    """Whoever has only a mouse, and counts what it is pressed for; typing does not come into it."""

    def __init__(self, window: Harness) -> None:
        self.window = window
        self.presses = 0

    def wait(self) -> None:
        """Wait for what comes of it."""
        self.window.settle()

    def click(self, item: str) -> None:
        """Click on a widget that is seen."""
        self.presses += 1
        self.window.run(lambda robot: robot.item_click(item))
        self.window.frames(3)

    def show_tab(self, title: str) -> None:
        """Click on the tab of a panel."""
        self.presses += 1
        self.window.show_tab(title)

    def drag(self, start: complex, end: complex) -> None:
        """Drag something on the drawing from a place to another."""
        self.presses += 1

        def act(robot: Robot) -> None:
            robot.mouse_move_to_pos(self.window.point(start))
            robot.mouse_down(0)
            for step in range(1, 5):
                robot.mouse_move_to_pos(self.window.point(start + (end - start) * step / 4))
            robot.mouse_up(0)

        self.window.run(act)
        self.wait()

    def drag_playhead(self, share: float) -> None:
        """Drag the playhead along the ruler to a share of its length."""
        self.presses += 1

        def act(robot: Robot) -> None:
            ruler = robot.item_info("//**/ruler").rect_full
            middle = (ruler.min.y + ruler.max.y) / 2
            robot.mouse_move_to_pos(type(ruler.min)(ruler.min.x + 2, middle))
            robot.mouse_down(0)
            x = ruler.min.x + share * (ruler.max.x - ruler.min.x)
            robot.mouse_move_to_pos(type(ruler.min)(x, middle))
            robot.mouse_up(0)

        self.window.run(act)
        self.wait()
