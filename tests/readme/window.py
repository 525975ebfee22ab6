"""The README's pictures of the window: sample projects, opened and used as a person would."""

from collections.abc import Callable, Sequence
from pathlib import Path

from harness import Harness

from app.document import Target
from app.editor.actions import editing, playback, viewing
from app.editor.actions.posing.pose_drag import set_targets
from app.editor.layering.layer_selection import set_active_layer
from app.editor.poses import library
from app.editor.project import Project
from app.storage import sample_images
from app.storage.preferences import ThemeName
from tests.readme.shown import shown_in, write_list

AT_REST = 10  # frames until nothing moves or fades any more
LOOK_UP = {"snout": 90 + 740j, "brow": 270 + 810j}  # where handles of the dragon's head are pulled


def draw(names: Sequence[str], folder: Path) -> None:
    """Take pictures of the window into a folder, and write beside each what it shows.

    Parameters
    ----------
    names : sequence of str
        Of `PICTURES`.
    folder : Path
    """
    if not names:
        return
    window = Harness()
    for name in names:
        window.reset()
        PICTURES[name](window)
        come_to_rest(window)
        path = folder / f"{name}.png"
        window.picture().save(path, optimize=True)
        write_list(path, shown_in(window))
        print(path, flush=True)


def come_to_rest(window: Harness) -> None:
    """Let all be done and faded; refuse messages, which would cover what is to be shown."""
    window.settle()
    window.frames(AT_REST)
    told = [toast.text for toast in window.session.notices.toasts]
    if told:
        raise RuntimeError(f"a message covers the picture: {told}")


def _posing(window: Harness) -> None:
    """A dragon that looks up, drawn by handles; where it was an in-between, there is a key now."""
    project = open_sample(window, "dragon", frame=36)
    wishes = {handle_named(project, name): Target(position=at) for name, at in LOOK_UP.items()}
    window.act(set_targets, wishes)
    window.settle()
    window.act(editing.select_handles, frozenset({handle_named(project, "snout")}))
    window.show_tab("Handle")


def _onion_skin(window: Harness) -> None:
    """The poses before and after, and those that are kept for later."""
    project = open_sample(window, "dragon", frame=0, theme="light")
    for frame, name in {0: "calm", 24: "tail up", 48: "tail back"}.items():
        window.act(playback.seek, frame)
        window.settle()
        window.act(library.save_pose_to_library)
        window.settle()
        window.act(library.rename_library_pose, project.layer.library[-1].name, name)
    window.act(playback.seek, 37)
    window.act(viewing.toggle_overlay, "onion")
    window.show_tab("Animate")


def _layers(window: Harness) -> None:
    """A child of many layers waves: the arms hang on the body, and mouths are seen in turns."""
    project = open_sample(window, "friend", frame=14)
    arm = next(layer.id for layer in project.document.layers if layer.name == "left arm")
    window.act(set_active_layer, arm)
    window.act(editing.select_handles, frozenset({handle_named(project, "hand")}))
    window.show_tab("Layers")


def _heat_map(window: Harness) -> None:
    """How far a giraffe is squeezed where it bends to the ground."""
    open_sample(window, "giraffe", frame=30)
    window.act(viewing.zoom_to_pose)
    window.act(viewing.show_heat_map, "sigma_b")
    window.show_tab("Measure")


def _export(window: Harness) -> None:
    """What will be exported of an octopus."""
    open_sample(window, "octopus", frame=28, theme="light")
    window.act(viewing.toggle_overlay, "handles")
    window.show_tab("Export")


def _split_view(window: Harness) -> None:
    """A giraffe by two methods, side by side."""
    open_sample(window, "giraffe", frame=15)
    window.act(viewing.toggle_overlay, "handles")
    window.act(viewing.toggle_comparison)
    viewing.set_side_by_side(window.session, beside=True)
    window.settle()
    window.act(viewing.zoom_to_pose)
    window.show_tab("Measure")


def open_sample(window: Harness, sample: str, *, frame: int, theme: ThemeName = "dark") -> Project:
    """Open a sample project, which begins to play, and stop at a frame."""
    project = window.again(Harness.open, sample_images() / f"{sample}.lissom")
    if window.session.settings.preferences.theme != theme:
        window.act(viewing.toggle_theme)
    window.act(playback.stop_playback)
    window.act(playback.seek, frame)
    window.settle()
    return project


def handle_named(project: Project, name: str) -> int:
    """Return the handle of a name."""
    return next(handle.id for handle in project.layer.handles if handle.name == name)


PICTURES: dict[str, Callable[[Harness], None]] = {
    "posing": _posing,
    "layers": _layers,
    "onion-skin": _onion_skin,
    "heat-map": _heat_map,
    "export": _export,
    "split-view": _split_view,
}
