"""A drawing that another program changes while it is posed here."""

import os

import numpy as np
import pytest
from layered import blob, openraster
from PIL import ImageDraw

from app.document import Attachment, handle_commands, layer_commands
from app.editor.actions import editing
from app.editor.layering import reloading
from app.editor.layering.seams import close_seam
from app.editor.parts.dialogs import FileDialog, ReloadDialog
from app.storage import save_project


def write(path, *, arm=None, body=None, left=100, at=1):
    """Write a drawing with an arm in front of a body, changed at this second."""
    stack = (
        f'<layer name="arm" src="data/0.png" x="{left}" y="60"/>'
        '<layer name="body" src="data/1.png" x="40" y="40"/>'
    )
    pictures = [arm or blob(90, 30), body or blob(80, 130, (30, 60, 200))]
    path.write_bytes(openraster((240, 200), stack, pictures))
    os.utime(path, (at, at))


def redrawn():
    arm = blob(90, 30)
    ImageDraw.Draw(arm).rectangle((60, 0, 88, 12), fill=(20, 20, 20, 255))
    return arm


@pytest.fixture
def project(window, tmp_path):
    write(tmp_path / "man.ora")
    project = window.open(tmp_path / "man.ora")
    arm = project.document.layers[1].id
    window.act(editing.edit_document, handle_commands.add_handle(arm, 120 + 125j))
    window.settle()
    return project


def test_redrawn_layer_keeps_its_closed_seam(window, project, tmp_path):
    body, arm = project.document.layers
    joint = Attachment(parent=body.id, parent_point=110 + 120j)
    window.act(editing.edit_document, layer_commands.attach_layer(arm.id, 110 + 120j, joint))
    window.act(close_seam, arm.id)
    window.settle()
    changed = blob(80, 130, (30, 60, 200))
    ImageDraw.Draw(changed).rectangle((20, 40, 60, 70), fill=(250, 240, 20, 255))
    write(tmp_path / "man.ora", body=changed, at=9)
    window.act(reloading.reload_drawing)
    window.settle()
    window.act(reloading.begin_reload, window.session.dialogs.current)
    window.settle()
    wide = project.document.layers[0]
    assert wide.closed_seam == arm.id
    assert wide.picture.size == (82, 132)
    assert wide.corner == body.corner - 1 - 1j
    pixels = project.runtimes.layers[body.id].picture.rgba
    assert tuple(pixels[56, 41]) == (250, 240, 20, 255)
    # Under the arm it reaches a pixel farther than in the file.
    own = np.pad(np.asarray(changed), ((1, 1), (1, 1), (0, 0)))
    assert (pixels[..., 3] >= own[..., 3]).all()
    assert (pixels[..., 3] > own[..., 3]).any()


def look(window):
    """Let the window look at the times of files."""
    window.clock.now += 3
    window.frames(2)
    window.settle()


def offers(window):
    return [toast for toast in window.session.notices.toasts if toast.label == "Reload…"]


def test_changed_file_is_offered_shown_reloaded_and_undone_in_one_step(window, project, tmp_path):
    look(window)
    assert not offers(window)
    write(tmp_path / "man.ora", arm=redrawn(), left=106, at=2)
    look(window)
    (offer,) = offers(window)
    before = project.document
    window.act(offer.action.verb, *offer.action.arguments)
    window.settle()
    assert isinstance(window.session.dialogs.current, ReloadDialog)
    assert project.document is before
    window.run(lambda robot: robot.item_click("//###dialog/Reload"))
    window.settle()
    arm = project.document.layers[1]
    assert arm.picture is not before.layers[1].picture
    assert arm.handles[0].position in {120 + 125j, 126 + 125j}
    assert project.document.layers[0].picture is before.layers[0].picture
    runtime = project.runtimes.layers[arm.id]
    assert runtime.file is arm.picture
    assert not offers(window)
    window.act(editing.undo)
    window.settle()
    assert project.document is before
    window.act(editing.redo)
    window.settle()
    window.act(reloading.reload_drawing)
    window.settle()
    assert window.session.dialogs.current is None
    assert "man.ora has not changed." in [toast.text for toast in window.session.notices.toasts]


def test_touched_file_is_not_offered(window, project, tmp_path):
    os.utime(tmp_path / "man.ora", (2, 2))
    look(window)
    assert project.file.times[tmp_path / "man.ora"] == 2e9
    assert not offers(window)


def test_unreadable_file_changes_nothing(window, project, tmp_path):
    before = project.document
    (tmp_path / "man.ora").write_bytes(b"half a file")
    os.utime(tmp_path / "man.ora", (3, 3))
    look(window)
    window.act(reloading.reload_drawing)
    window.settle()
    assert project.document is before
    assert any("not an OpenRaster file" in each.text for each in window.session.notices.toasts)
    (tmp_path / "man.ora").unlink()
    look(window)
    window.act(reloading.reload_drawing)
    window.settle()
    assert isinstance(window.session.dialogs.current, FileDialog)
    assert project.document is before


def test_project_finds_its_drawing_beside_it_and_reloads_one_layer(window, project, tmp_path):
    save_project(tmp_path / "man.lissom", project.document)
    write(tmp_path / "man.ora", arm=redrawn(), at=5)
    again = window.open(tmp_path / "man.lissom")
    look(window)
    assert offers(window)
    body, arm = again.document.layers
    window.act(reloading.reload_layers, body.id)
    window.settle()
    assert window.session.dialogs.current is None
    window.act(reloading.reload_layers, arm.id)
    window.settle()
    dialog = window.session.dialogs.current
    assert [each.name for each in dialog.plan.changes] == ["arm"]
    # A project that was edited meanwhile is not reloaded over the edit.
    window.session.dialogs.close()
    window.act(editing.edit_document, handle_commands.rename_handle(arm.id, 0, "hand"))
    now = again.document
    window.act(reloading.begin_reload, dialog)
    window.settle()
    assert again.document is now


def test_seam_between_a_layer_and_its_parent_is_closed_in_one_step(window, project):
    body, arm = project.document.layers
    window.act(close_seam, arm.id)
    window.settle()
    assert project.document.layers == (body, arm)  # it has no parent
    joint = Attachment(parent=body.id, parent_point=110 + 120j)
    window.act(editing.edit_document, layer_commands.attach_layer(arm.id, 110 + 120j, joint))
    before = project.document
    window.act(close_seam, arm.id)
    window.settle()
    wide, same = project.document.layers
    assert same is before.layers[1]
    assert wide.picture.size == tuple(side + 2 for side in body.picture.size)
    assert wide.corner == body.corner - 1 - 1j
    assert project.history.undo_label == "Close seam"
    # The file has not changed by that.
    window.act(reloading.reload_drawing)
    window.settle()
    assert window.session.dialogs.current is None
    window.act(editing.undo)
    window.settle()
    assert project.document is before
