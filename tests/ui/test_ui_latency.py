"""How soon the picture answers, in frames."""

from app.actions import posing
from app.assets import sample_images
from app.document.keyframe import Target


def test_the_picture_follows_a_pull_in_the_next_frame(window):
    session = window.session
    project = window.open(sample_images() / "bar.png")
    width, height = project.picture.size
    start = complex(0.9 * width, height / 2)
    posing.add_handle(session, complex(0.1 * width, height / 2))
    posing.add_handle(session, start)
    window.settle()
    for step in range(1, 6):
        wish = Target(position=start + 40j * step)
        # The solver has always something to do, and is as quick as can be.
        assert session.jobs.settle()
        window.act(posing.pull, {1: wish})
        assert session.jobs.settle()
        window.frames()
        assert project.shown.pose.targets[1] == wish
