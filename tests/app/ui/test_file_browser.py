"""Our own file browser, through its widgets."""

import os
from functools import partial

import numpy as np
import pytest
from imgui_bundle import hello_imgui, imgui
from PIL import Image

from app.editor.action import do
from app.editor.actions import dialog_actions
from app.editor.parts.dialogs import FileDialog
from app.storage.assets import sample_images
from app.ui.dialogs.browser_shortcuts import list_recent_shortcuts, list_standard_shortcuts
from app.ui.dialogs.folder_listing import Entry, read_folder
from app.ui.style.theme import PALETTES


def note(chosen, _, path):
    chosen.append(path)


@pytest.fixture
def folder(tmp_path):
    """A folder with two folders and some files in it."""
    place = tmp_path / "place"
    for name in ("drawings", "empty", ".hidden"):
        (place / name).mkdir(parents=True)
    for name, size in (("bat.png", 2_500), ("Ant.PNG", 20), ("notes.txt", 3), (".secret.png", 3)):
        (place / name).write_bytes(bytes(size))
    os.utime(place / "bat.png", (1_000_000, 1_000_000))
    (place / "drawings" / "cow.png").write_bytes(b"")
    return place


@pytest.fixture
def chosen():
    """What was chosen, in turn."""
    return []


@pytest.fixture
def show(window, folder, chosen):
    """Opens the browser in the folder."""

    def open_browser(**changes):
        settings = {
            "title": "Open",
            "folder": folder,
            "suffixes": (".png", ".jpg"),
            "writes": False,
            "chosen": lambda path: do(partial(note, chosen), path),
        }
        window.act(dialog_actions.show_dialog, FileDialog(**(settings | changes)))
        window.frames(3)

    return open_browser


@pytest.fixture
def listed(window):
    """Tells whether an entry is in the list."""

    def is_listed(name):
        found = []
        window.run(lambda robot: found.append(robot.item_exists(f"//###dialog/**/###entry {name}")))
        return found[0]

    return is_listed


def click(window, *items, double=False):
    def play(robot):
        for item in items:
            (robot.item_double_click if double else robot.item_click)(f"//###dialog/{item}")

    window.run(play)
    window.frames(2)


def entry(name):
    return f"**/###entry {name}"


def press(window, *keys):
    def play(robot):
        for key in keys:
            robot.key_press(int(key))

    window.run(play)
    window.frames(2)


def type_name(window, text, *, enter=False):
    """Type into whatever has the focus, as a person does who sees the cursor blink."""
    window.run(lambda robot: robot.key_chars(text))
    if enter:
        window.run(lambda robot: robot.key_press(int(window.Key.enter)))
    window.frames(2)


def test_it_lists_folders_and_the_files_of_its_kinds(show, listed):
    show()
    assert all(map(listed, ("drawings", "empty", "bat.png", "Ant.PNG")))
    assert not any(map(listed, (".hidden", ".secret.png", "notes.txt")))


def test_a_double_click_enters_a_folder_and_opens_a_file(window, show, folder, chosen):
    show()
    click(window, entry("drawings"))
    assert window.session.dialogs.current.folder == folder
    click(window, entry("drawings"), double=True)
    assert window.session.dialogs.current.folder == folder / "drawings"
    assert chosen == []
    click(window, entry("cow.png"), double=True)
    assert chosen == [folder / "drawings" / "cow.png"]
    assert window.session.dialogs.current is None
    assert window.session.settings.usual_folder == folder / "drawings"


@pytest.mark.parametrize("is_split", [False, True], ids=["in one frame", "in two frames"])
def test_a_double_click_counts_however_slow_the_frames_are(
    window, show, folder, chosen, monkeypatch, is_split
):
    """Between frames of half a second, both come at once, or one a frame later."""
    show()
    boxes = []
    window.run(
        lambda robot: boxes.append(robot.item_info(f"//###dialog/{entry('bat.png')}").rect_full)
    )
    io, calls = imgui.get_io(), hello_imgui.get_runner_params().callbacks
    place = boxes[0].get_center()
    io.add_mouse_pos_event(place.x, place.y)
    window.frames(2)
    begin = calls.pre_new_frame

    def begin_slowly():
        io.delta_time = 0.5
        begin()

    monkeypatch.setattr(io, "delta_time", io.delta_time)  # the later tests' own
    monkeypatch.setattr(calls, "pre_new_frame", begin_slowly)
    for _ in range(2):
        io.add_mouse_button_event(0, True)  # noqa: FBT003 - ImGui's own
        io.add_mouse_button_event(0, False)  # noqa: FBT003
        window.frames(is_split)
    window.frames(6)
    assert chosen == [folder / "bat.png"]


def test_two_slow_clicks_are_no_double_click(window, show, chosen):
    show()
    for _ in range(2):
        click(window, entry("bat.png"))
        window.frames(30)
    assert chosen == []


def test_a_click_marks_a_file_and_the_button_opens_it(window, show, folder, chosen):
    show()
    click(window, entry("bat.png"))
    assert window.session.dialogs.current.name == "bat.png"
    assert chosen == []
    click(window, "Open")
    assert chosen == [folder / "bat.png"]


def test_the_button_enters_a_marked_folder_where_one_reads(window, show, folder, chosen):
    show()
    click(window, entry("empty"), "Open")
    assert window.session.dialogs.current.folder == folder / "empty"
    assert chosen == []


def test_the_ways_up_and_home(window, show, folder, monkeypatch):
    home = folder / "drawings"
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.setenv("USERPROFILE", str(home))
    show()
    click(window, "###home")
    assert window.session.dialogs.current.folder == home
    click(window, "###up")
    assert window.session.dialogs.current.folder == folder
    # Where one comes from is marked, to go back with Enter.
    press(window, window.Key.enter)
    assert window.session.dialogs.current.folder == home
    press(window, int(window.Key.mod_alt) | int(window.Key.up_arrow))
    assert window.session.dialogs.current.folder == folder
    click(window, f"###in {len(folder.parts) - 1}")
    assert window.session.dialogs.current.folder == folder.parent


def test_arrows_and_enter(window, show, folder, chosen):
    show()
    key = window.Key
    press(window, key.down_arrow)
    assert window.session.dialogs.current.marked == "drawings"
    press(window, key.up_arrow, key.down_arrow, key.down_arrow)
    assert (
        window.session.dialogs.current.name == "Ant.PNG"
    )  # folders first, capitals like small letters
    press(window, *[key.down_arrow] * 5)
    assert window.session.dialogs.current.name == "bat.png"
    press(window, key.up_arrow, key.up_arrow, key.up_arrow, key.enter)
    assert window.session.dialogs.current.folder == folder / "drawings"
    press(window, key.up_arrow, key.enter)
    assert chosen == [folder / "drawings" / "cow.png"]


def test_the_columns_sort(window, show):
    show()

    def order():
        window.frames()
        names = []
        window.session.dialogs.current = None
        show()
        for _ in range(4):
            press(window, window.Key.down_arrow)
            names.append(window.session.dialogs.current.marked)
        return names

    assert order() == ["drawings", "empty", "Ant.PNG", "bat.png"]
    click(window, "**/Size")
    click(window, "**/Size")
    assert order() == ["drawings", "empty", "bat.png", "Ant.PNG"]
    click(window, "**/Changed")
    assert order()[2:] == ["bat.png", "Ant.PNG"]
    click(window, "**/Name")
    assert order()[2:] == ["Ant.PNG", "bat.png"]


def test_a_name_is_typed_at_once_and_enter_opens_it(window, show, folder, chosen):
    show()
    type_name(window, "bat.png", enter=True)
    assert chosen == [folder / "bat.png"]


def test_a_name_that_is_not_there_opens_nothing(window, show, chosen):
    show()
    for name in ("dog.png", "x" * 300, "../nowhere/bat.png"):
        type_name(window, name, enter=True)
        assert window.session.dialogs.current is not None
        show()
    assert chosen == []


def test_a_typed_path_leads_there(window, show, folder):
    show()
    type_name(window, "drawings/../drawings", enter=True)
    assert window.session.dialogs.current.folder == folder / "drawings"
    assert window.session.dialogs.current.name == ""


def test_saving_adds_the_suffix(window, show, folder, chosen):
    show(title="Save", writes=True, name="walk", suffixes=(".lissom",))
    type_name(window, "run", enter=True)  # in place of what was suggested
    assert chosen == [folder / "run.lissom"]
    show(title="Save", writes=True, name="walk v1.2", suffixes=(".lissom",))
    click(window, "Save")
    assert chosen[1:] == [folder / "walk v1.2.lissom"]


def test_saving_keeps_its_name_while_one_looks_for_a_place(window, show, folder, chosen):
    show(title="Save", writes=True, name="walk", suffixes=(".png",))
    press(window, window.Key.down_arrow, window.Key.enter)
    assert window.session.dialogs.current.folder == folder / "drawings"
    assert window.session.dialogs.current.name == "walk"
    click(window, "###up", entry("empty"), "Save")
    assert chosen == [folder / "walk.png"]


def test_it_says_what_saving_would_replace(window, show):
    show(title="Save", writes=True, name="dog", suffixes=(".png",))
    window.frames(30)  # until what lies behind the dialog is dimmed
    before = window.picture()
    type_name(window, "bat")
    replacing = window.picture()
    type_name(window, "m")
    fresh = window.picture()
    assert coloured(replacing, window) > coloured(before, window) == coloured(fresh, window)


def coloured(picture, window):
    """Count the pixels that are nearly in the colour of warnings."""
    palette = PALETTES[window.session.settings.preferences.theme]
    warning = np.array([palette.warning.x, palette.warning.y, palette.warning.z]) * 255
    distance = np.abs(np.asarray(picture, dtype=float) - warning).max(axis=2)
    return int((distance < 40).sum())


def test_a_marked_name_shows_in_the_field_that_is_being_typed_into(window, show, chosen, folder):
    show(title="Save", writes=True, name="walk", suffixes=(".png",))
    type_name(window, "ru")
    press(window, window.Key.up_arrow)
    assert window.session.dialogs.current.name == "bat.png"
    # What is typed now goes on from there.
    type_name(window, ".png", enter=True)
    assert chosen == [folder / "bat.png.png"]


def test_a_folder_to_write_to_is_named(window, show, folder, chosen, listed):
    show(title="Export", writes=True, name="frames", suffixes=())
    assert listed("drawings")
    assert not listed("bat.png")
    click(window, "Save")
    show(title="Export", writes=True, name="drawings", suffixes=())
    press(window, window.Key.enter)
    assert chosen == [folder / "frames", folder / "drawings"]


def test_a_folder_that_cannot_be_read_says_so(window, show, folder, monkeypatch):
    def refused(path):
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr("app.ui.dialogs.folder_listing.os.scandir", refused)
    show()
    window.frames(3)
    listing = read_folder(folder, (".png",))
    assert listing.problem == "This folder cannot be read: Permission denied"
    assert listing.entries == ()
    assert window.session.notices.toasts == []


def test_a_folder_that_is_gone_leaves_a_way_out(window, show, folder, listed):
    show(folder=folder / "gone")
    assert window.session.notices.toasts == []
    click(window, "###up")
    assert listed("bat.png")


def test_new_files_appear_by_themselves(show, listed, folder):
    show()
    assert not listed("eel.png")
    (folder / "eel.png").write_bytes(b"")
    os.utime(folder, ns=(1, 2))
    assert listed("eel.png")


def test_escape_and_cancel_close_it(window, show, chosen):
    show()
    press(window, window.Key.escape)
    assert window.session.dialogs.current is None
    show(name="bat.png", writes=True)
    type_name(window, "b")
    press(window, window.Key.escape)
    assert window.session.dialogs.current is None
    show()
    click(window, "Cancel")
    assert window.session.dialogs.current is None
    assert chosen == []


@pytest.mark.parametrize(
    ("size", "words"),
    [
        (0, "0 bytes"),
        (999, "999 bytes"),
        (1_500, "1.5 kB"),
        (20_400, "20 kB"),
        (7 * 10**13, "70000 GB"),
    ],
)
def test_sizes_in_words(tmp_path, size, words):
    entry = Entry(path=tmp_path, is_folder=False, size=size, changed=0.0)
    assert entry.size_in_words == words


def test_places_and_recent_folders_are_one_click_away(window, show, folder, monkeypatch, listed):
    home = folder.parent / "home"
    (home / "Bilder").mkdir(parents=True)
    (home / "Desktop").mkdir()
    (home / "Bilder" / "seal.png").write_bytes(b"")
    settings = home / ".config"
    settings.mkdir()
    (settings / "user-dirs.dirs").write_text('XDG_PICTURES_DIR="$HOME/Bilder"\n', encoding="utf-8")
    monkeypatch.setattr("pathlib.Path.home", lambda: home)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(settings))
    recent = (folder / "drawings" / "cow.png", folder / "drawings" / "b.png", home / "no" / "c.png")
    session = window.session
    session.settings.prefer(recent=recent)
    assert [place.name for place in list_standard_shortcuts()] == [
        "Home folder",
        "Desktop",
        "Bilder",
    ]
    assert [place.folder for place in list_recent_shortcuts(recent)] == [folder / "drawings"]
    show()
    window.run(lambda robot: robot.item_click("//###dialog/**/###Places 2"))
    assert session.dialogs.current.folder == home / "Bilder"
    assert listed("seal.png")
    window.run(lambda robot: robot.item_click("//###dialog/**/###Recent 0"))
    assert session.dialogs.current.folder == folder / "drawings"


def test_pictures_and_projects_show_as_they_are(window, show, folder):
    """Red, green: seen in the list beside their names; also while a project is open."""
    window.open(sample_images() / "bar.png")
    for name, colour in (("bat.png", (255, 0, 0)), ("Ant.PNG", (0, 255, 0))):
        Image.new("RGB", (40, 40), colour).save(folder / name, format="PNG")
    show()
    window.frames(6)
    picture = np.asarray(window.picture()).astype(int)[..., :3]
    for colour in ((255, 0, 0), (0, 255, 0)):
        seen = (np.abs(picture - colour).max(axis=2) < 30).sum()
        assert seen > 100
