"""From the start to an exported loop, as somebody does it who sees Lissom for the first time."""

from PIL import Image

MOST = 12  # clicks and drags


class Newcomer:
    """Whoever has only a mouse, and counts what it is pressed for; typing does not come into it."""

    def __init__(self, window):
        self.window = window
        self.presses = 0

    def click(self, item):
        """Click on a widget that is seen."""
        self.presses += 1
        self.window.run(lambda robot: robot.item_click(item))
        self.window.frames(3)

    def show_tab(self, title):
        """Click on the tab of a panel."""
        self.presses += 1
        self.window.show_tab(title)

    def drag(self, start, end):
        """Drag something on the drawing from a place to another."""
        self.presses += 1

        def act(robot):
            robot.mouse_move_to_pos(self.window.point(start))
            robot.mouse_down(0)
            for step in range(1, 5):
                robot.mouse_move_to_pos(self.window.point(start + (end - start) * step / 4))
            robot.mouse_up(0)

        self.window.run(act)
        self.window.settle()

    def drag_playhead(self, share):
        """Drag the playhead along the ruler to a share of its length."""
        self.presses += 1

        def act(robot):
            ruler = robot.item_info("//**/ruler").rect_full
            middle = (ruler.min.y + ruler.max.y) / 2
            robot.mouse_move_to_pos(type(ruler.min)(ruler.min.x + 2, middle))
            robot.mouse_down(0)
            x = ruler.min.x + share * (ruler.max.x - ruler.min.x)
            robot.mouse_move_to_pos(type(ruler.min)(x, middle))
            robot.mouse_up(0)

        self.window.run(act)
        self.window.settle()


def test_a_loop_takes_few_clicks_and_drags(window, tmp_path):
    session = window.session
    window.frames(10)
    person = Newcomer(window)
    person.click("//Welcome/**/sample Bar")
    window.settle()
    project = session.project
    person.show_tab("Handle")
    person.click("//Handle/**/###Suggest handles")
    first = project.document
    assert len(project.figure.handles) >= 3
    person.drag_playhead(0.5)
    assert project.playhead.frame > 5
    handle = max(project.puppet.shown.handle_places, key=lambda place: place.real)
    person.drag(complex(handle), complex(handle) + 0.3j * project.document.canvas[1])
    assert [key.frame for key in project.figure.keys] == [0, project.playhead.frame]
    assert project.figure.keys[1].pose is not first.figures[0].keys[0].pose
    person.click("//Timeline/**/Loop")
    assert project.document.loop
    person.click("//Timeline/**/Play")
    window.frames(20)
    assert project.playhead.since is not None
    person.show_tab("Export")
    session.preferences = type(session.preferences)(folder=tmp_path)
    person.click("//Export/**/###start")
    person.click("//###dialog/Export")
    while session.export is not None or session.jobs.kinds:
        window.settle()
    exported = sorted(next(tmp_path.glob("* frames")).glob("*.png"))
    count = project.document.frames.last - project.document.frames.first
    assert len(exported) in {count, count + 1}
    shown = [Image.open(path).tobytes() for path in (exported[0], exported[len(exported) // 2])]
    assert shown[0] != shown[1], "it moves"
    assert person.presses <= MOST, person.presses
