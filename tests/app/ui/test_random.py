"""A random walk over all that a person can do, which nothing may break."""

from collections import deque
from contextlib import ExitStack
from pathlib import Path

import harness
import numpy as np
import pytest
from documents import differences
from hands import HANDS, WIDGET
from imgui_bundle import imgui
from invariants import check_invariants
from layered import openraster
from PIL import Image, ImageDraw
from sessions import run_update_steps
from unrest import is_shown, unrest

from app.cut_out import Stroke
from app.document import (
    CAMERA,
    DEPTH,
    DRAW_ORDER,
    OPACITY,
    TRANSFORM,
    VISIBILITY,
    Channel,
    Document,
    DrawOrder,
    KeysByChannel,
    Layer,
    Transform,
    all_keys,
    channel_commands,
    frames_in,
    key_commands,
    pose_channel,
    pose_commands,
    scene_commands,
    stiffness_commands,
    switch_group_commands,
)
from app.document.channels.easing import PRESETS, Easing
from app.document.channels.springs import Spring
from app.document.commands import (
    handle_commands,
    shape_commands,
)
from app.document.commands.keys import (
    track_commands,
)
from app.document.commands.layers import layer_commands
from app.document.keyframe import Target
from app.document.settings import VARIANTS, ExportSettings, FrameRange, Meshing
from app.editor.action import Action, do
from app.editor.actions import editing, playback, viewing
from app.editor.actions.layer_setup import (
    cut_out_editing,
    handle_editing,
    resolving,
    stiffness_editing,
)
from app.editor.actions.posing.handles import (
    add_handle,
    mirror_handles,
    suggest_handles,
)
from app.editor.actions.posing.pose_drag import (
    free_rotation,
    pin_selected_handles,
    release_drag,
    set_targets,
)
from app.editor.actions.project_files import saving
from app.editor.actions.timing import channel_keys, keys, springs, timeline_drag, tracks
from app.editor.actions.updates import frame_update
from app.editor.layering.anchors import toggle_anchor_at_handle
from app.editor.layering.deletion import delete_layers
from app.editor.layering.layer_list import (
    duplicate_layer,
    rename_layer,
    toggle_layers_hidden,
    toggle_layers_locked,
    toggle_reference,
    toggle_visibility_key,
)
from app.editor.layering.layer_selection import set_active_layer
from app.editor.layering.parenting import (
    attach_layer,
    detach_layer,
    set_inherits_rotation,
)
from app.editor.layering.pictures import add_layers, make_posable, make_still
from app.editor.layering.switches import create_switch
from app.editor.parts.timeline.time_range import TimeRangeView
from app.editor.poses import copying, flipping, library, pasting, pasting_targets
from app.editor.work import drag_session
from app.editor.work.jobs import JobKind, Jobs
from app.export_formats import EXPORT_FORMATS
from app.storage.project_file import load_project, save_project
from app.ui.shortcuts.key_input import ARROWS
from app.ui.shortcuts.keys import MODIFIERS, chords_of
from app.ui.shortcuts.table import ACTIONS
from engine.domain.outline import enclosure, fitting
from engine.interpolation.added.pins import pinning
from engine.maps import boundary
from engine.maps.bounds import Bounds

# Both drawings, one of them by two variants.
SEEDS = (1, 2, *(pytest.param(seed, marks=pytest.mark.long) for seed in (15, 3)))
FAR = {3: 1_000}  # steps of walks that go farther than the others
MOST_FRAMES = 400  # until the worker has caught up
REMEMBERED = 20  # actions that are reported when the walk fails
PATIENCE = 300.0  # seconds, for pins of hard poses on a busy machine
# Steps between two looks at the invariants, between two saves, and until all work is done.
LOOKED_AT, SAVED, RESTED = 10, 100, 500
USUAL, SMALL = (1280, 800), (800, 560)
MOST_HANDLES, MOST_KEYS, MOST_LAYERS = 4, 5, 3
LAST = 16  # frame beyond which the walk does not go
NEW_DOCUMENT, NEW_LAYER = Document.__init__.__kwdefaults__, Layer.__init__.__kwdefaults__
# What makes drawings cheap to pose: few edges of outlines, few samples on them, few frames, a
# variant that costs little, rough auto-pins, and few Newton steps, many of them at once.
CHEAP = (
    (fitting.Candidates.on.__func__, "__kwdefaults__", {"fewest_edges": 12}),
    (fitting, "LONGEST_EDGE", 0.14),
    (boundary, "SEGMENT_PER_SIZE", 1 / 40),
    (boundary, "SEGMENT_PER_DISTANCE", 1.0),
    (pinning, "TOLERANCE", 1e-3),
    (pinning, "LEFT_OUT", 2e-4),
    (Document.__init__, "__kwdefaults__", {**NEW_DOCUMENT, "frames": FrameRange(0, LAST)}),
    (Layer.__init__, "__kwdefaults__", {**NEW_LAYER, "variant": "nu"}),
    (pinning, "DEGREES", (4, 8, 16, 32)),
    (drag_session, "MOST_STEPS", 60),
    (harness, "STEP", 0.001),
    (enclosure, "MARGINS", {"coarse": 0.03, "normal": 0.025, "fine": 0.02}),
)
# What ends the project is left out; what asks first is answered by Escape.
LEAVING = {"Close", "Quit"}
NAMED = [name for name in ACTIONS if name not in {*LEAVING, "Manual", "Your first animation"}]
BOUND = [
    key for name, binding in ACTIONS.items() if name not in LEAVING for key in chords_of(binding)
]
TABS = ("Handle", "Layers", "Animate", "Shape", "Export", "Measure")
WIDGETS = (
    *("button", "invisible_button", "selectable", "checkbox", "begin_combo", "slider_int"),
    *("menu_item", "menu_item_simple", "input_text", "input_int", "input_float"),
    *("drag_int", "drag_float"),
)


class Widgets:
    """Where the widgets are that the panels have drawn last, by their names."""

    def __init__(self, monkeypatch) -> None:
        self._seen = {}
        for kind in WIDGETS:
            monkeypatch.setattr(imgui, kind, self._watched(getattr(imgui, kind)))

    def _watched(self, draw):
        def drawn(name, *arguments, **options):
            result = draw(name, *arguments, **options)
            rectangle = imgui.get_item_rect_min(), imgui.get_item_rect_size()
            self._seen[name] = imgui.get_frame_count(), *rectangle
            return result

        return drawn

    def any(self, rng) -> str | None:
        """Return one of those that are on the screen."""
        now = imgui.get_frame_count()
        names = [name for name, (frame, *_) in self._seen.items() if frame >= now - 1]
        return names[rng.integers(len(names))] if names else None

    def place(self, name: str, rng) -> tuple[float, float]:
        """Return a point of a widget."""
        _, low, size = self._seen[name]
        across, down = rng.random(2)
        return low.x + across * size.x, low.y + down * size.y


class Workers:
    """The worker threads, which do one kind of job after another, and only when they may.

    What comes when depends on the walk alone, so that it can be walked again.
    """

    def __init__(self, jobs: Jobs) -> None:
        self._jobs = jobs
        self._hold = ExitStack()

    def hold(self) -> None:
        """Let them begin nothing that they may not."""
        self._hold.enter_context(self._jobs.held())

    def do(self, kind: JobKind) -> None:
        """Let them do what waits of a kind, while the window stands still."""
        others = {other for other in self._jobs.kinds if other != kind}
        before, self._hold = self._hold, ExitStack()
        with ExitStack() as rest:
            if others:
                rest.enter_context(self._jobs.held(*others))
            before.close()
            assert self._jobs.wait_until_idle(PATIENCE), kind
            self._hold.enter_context(self._jobs.held())

    def do_all(self) -> None:
        """Let them do all that waits."""
        for kind in dict.fromkeys(self._jobs.kinds):
            self.do(kind)

    def release(self) -> None:
        """Let them work as always."""
        self._hold.close()


class Walk:
    """Somebody who does anything at random, and a look at what comes of it.

    Parameters
    ----------
    window : Harness
        With an open project.
    seed : int
    workers : Workers
    widgets : Widgets
    folder : Path
        For saved projects.
    """

    def __init__(self, window, seed: int, workers: Workers, widgets: Widgets, folder: Path) -> None:
        self.window = window
        self.workers = workers
        self.widgets = widgets
        self.session = window.session
        self.project = window.session.project
        self.path = folder / "walk.lissom"
        self.picture = draw_bone(folder / "bone.png")
        self.rng = np.random.default_rng(seed)
        self.actions = deque(maxlen=REMEMBERED)
        self.is_down = False
        self.modifier = 0

    def step(self, number: int) -> None:
        """Do one thing, let some frames pass, and see whether all is well."""
        if self.session.dialogs.current is not None:
            self.press(int(imgui.Key.escape))
        elif self.is_down and self.rng.random() < 0.8:
            self.pick(HOLDING)
        else:
            self.pick(ALL)
        if self.chance(0.01):
            self.catch_up()
        else:
            if (kinds := self.session.jobs.kinds) and self.chance(1 / 16):
                self.workers.do(self.choice(kinds))
            self.window.frames(int(self.chance(1 / 10)))
        self.finish_waiting()
        if number % RESTED == 0:
            self.catch_up(wholly=True)
        self.look(thorough=number % LOOKED_AT == 0, saves=number % SAVED == 0)

    def catch_up(self, *, wholly: bool = False) -> None:
        """Let the workers prepare what is to be shown, or all that there is to do."""
        for _ in range(MOST_FRAMES):
            self.window.frames()
            if is_shown(self.session) and not (wholly and self.session.jobs.kinds):
                if wholly:
                    self.check_rest()
                return
            self.workers.do_all()
        raise AssertionError(f"never at rest:\n{unrest(self.session)}")

    def check_rest(self) -> None:
        """See that nothing has changed unnoticed, for which the window did not look."""
        session, project = self.session, self.project
        self.window.frames(2)
        if session.jobs.kinds or frame_update.is_due_in_time(session):
            return
        before = project.document, [each.shown for each in project.runtimes.layers.values()]
        run_update_steps(session)
        assert (
            project.document,
            [each.shown for each in project.runtimes.layers.values()],
        ) == before
        assert not session.jobs.kinds, f"late jobs: {session.jobs.kinds}"

    def pick(self, verbs) -> None:
        odds = np.array([weight for _, weight in verbs], dtype=float)
        verb, _ = verbs[self.rng.choice(len(verbs), p=odds / odds.sum())]
        self.actions.append(verb.__name__)
        verb(self)

    def note(self, *words: object) -> None:
        self.actions[-1] += " " + " ".join(map(str, words))

    def choice(self, options):
        """Return one of some options as it is, whatever NumPy would make of it."""
        options = list(options)
        return options[self.rng.integers(len(options))]

    def chance(self, share: float) -> bool:
        return bool(self.rng.random() < share)

    def act(self, verb, *arguments: object) -> None:
        """Do something as a key would ask for it, whatever is in hand."""
        self.note(Action(verb).name, *arguments)
        self.window.act(verb, *arguments, is_by_key=True)
        self.finish_waiting()

    def finish_waiting(self) -> None:
        """Let the workers find the pose that actions wait for."""
        for _ in range(MOST_FRAMES):
            if not self.window.program.shell.queue.waiting:
                return
            # Not what else follows each step of the pose, unless that is all there is.
            kinds = self.session.jobs.kinds
            first = next((kind for kind in kinds if kind.lane == "hand"), None)
            if first is None:
                self.workers.do_all()
            else:
                self.workers.do(first)
            self.window.frames(1)
        raise AssertionError(f"actions wait:\n{unrest(self.session)}")

    def edit(self, command) -> None:
        self.note(command.label)
        self.window.act(editing.edit_document, command)
        self.finish_waiting()

    # What the hands do.

    def press(self, chord: int) -> None:
        io = imgui.get_io()
        modifiers = [modifier for modifier in MODIFIERS if chord & modifier]
        key = imgui.Key(chord & ~sum(MODIFIERS))
        # Its release comes with the frames after.
        for is_down in (True, False):
            for modifier in modifiers:
                io.add_key_event(imgui.Key(modifier), is_down)
            io.add_key_event(key, is_down)
        self.window.frames(1)

    def press_bound_key(self) -> None:
        chord = self.choice(BOUND)
        self.note(chord)
        self.press(int(chord))

    def do_named(self) -> None:
        """Do something of the menus, whatever is in hand."""
        possible = [name for name in NAMED if ACTIONS[name].disabled_reason(self.session) is None]
        name = self.choice(possible)
        self.note(name)
        self.window.act(ACTIONS[name].action.apply, is_by_key=True)

    def press_arrow(self) -> None:
        shift = int(imgui.Key.mod_shift) if self.chance(0.2) else 0
        self.press(int(self.choice(ARROWS)) | shift)

    def tap_space(self) -> None:
        self.press(int(imgui.Key.space))

    def press_escape(self) -> None:
        self.press(int(imgui.Key.escape))

    def type_something(self) -> None:
        io = imgui.get_io()
        text = self.choice(("7", "12", "0.5", "-3", "x", "", "90"))
        self.note(text)
        for letter in text:
            io.add_input_character(ord(letter))
        self.window.frames(1)
        self.press(int(self.choice((imgui.Key.enter, imgui.Key.tab, imgui.Key.escape))))

    def point(self) -> None:
        """Move the pointer to a handle, to a widget, or anywhere."""
        io = imgui.get_io()
        shown = self.project.layer_runtime.shown
        if self.chance(0.35) and shown is not None and len(shown.handle_positions):
            place = self.window.point(complex(self.choice(shown.handle_positions)))
            at = (place.x, place.y)
        elif self.chance(0.7) and (name := self.widgets.any(self.rng)) is not None:
            self.note(name)
            at = self.widgets.place(name, self.rng)
        else:
            at = tuple(self.rng.random(2) * SMALL)
        self.note(f"{at[0]:.0f},{at[1]:.0f}")
        io.add_mouse_pos_event(*map(float, at))
        self.window.frames(1)

    def push(self) -> None:
        """Press a button of the mouse at a place, perhaps with a modifier."""
        if self.is_down:
            return
        self.point()
        io = imgui.get_io()
        self.modifier = int(self.choice(MODIFIERS)) if self.chance(0.35) else 0
        if self.modifier:
            io.add_key_event(imgui.Key(self.modifier), down=True)
        self.button = 0 if self.chance(0.85) else int(self.rng.integers(1, 3))
        self.note(f"button {self.button}", f"modifier {self.modifier}")
        io.add_mouse_button_event(self.button, down=True)
        self.is_down = True
        self.window.frames(1)

    def move_pointer(self) -> None:
        io = imgui.get_io()
        x, y = io.mouse_pos.x, io.mouse_pos.y
        step = self.rng.normal(0, 30, 2)
        io.add_mouse_pos_event(float(x + step[0]), float(y + step[1]))
        self.window.frames(1)

    def release(self) -> None:
        if not self.is_down:
            return
        io = imgui.get_io()
        io.add_mouse_button_event(self.button, down=False)
        if self.modifier:
            io.add_key_event(imgui.Key(self.modifier), down=False)
        self.is_down, self.modifier = False, 0
        self.window.frames(1)

    def click(self) -> None:
        self.push()
        self.release()

    def double_click(self) -> None:
        io = imgui.get_io()
        if self.is_down:
            return
        self.point()
        for is_down in (True, False) * 2:
            io.add_mouse_button_event(0, is_down)
        self.window.frames(4)

    def turn_wheel(self) -> None:
        self.point()
        imgui.get_io().add_mouse_wheel_event(0.0, float(self.choice((-2, -1, 1, 2))))
        self.window.frames(1)

    def hold_and_do(self) -> None:
        """Change something by a drag of any kind, with other things in the middle of it."""
        if self.is_down or self.session.dialogs.current is not None:
            return
        kind = self.choice(HANDS)
        self.note(kind)
        hand = HANDS[kind](self.session, self.act_held)
        if not hand.is_possible:
            return
        if kind in {"track", "turn"}:
            self.project.selection.select_track(self.project.layer, hand.layer.tracks[0].handles[0])
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(imgui, "is_mouse_down", lambda _: True)
            patch.setattr(imgui.internal, "get_active_id", lambda: WIDGET)
            hand.press()
            for amount in range(1, int(self.rng.integers(2, 6))):
                hand.move(amount)
                if self.chance(0.4):
                    self.pick(MEANWHILE)
                if kinds := self.session.jobs.kinds:
                    self.workers.do(self.choice(kinds))
        hand.let_go()
        self.session.tools.end()
        self.window.frames(1)
        self.finish_waiting()
        assert not self.project.history.is_held, kind

    def act_held(self, verb, *arguments: object, **words: object) -> None:
        self.window.program.queue_action(do(verb, *arguments, **words))
        self.window.frames(1)

    def save(self) -> None:
        """Save, perhaps while something else is on its way; it is looked at when it is there."""
        path = self.path.with_stem(f"saved {self.rng.integers(3)}")
        self.act(saving.write_project, path, None)

    def make_layer_active(self) -> None:
        self.act(set_active_layer, self.choice(self.document.layers).id)

    # What the hands reach rarely by chance.

    def show_tab(self) -> None:
        title = self.choice(TABS)
        self.note(title)
        self.window.show_tab(title)

    def add_handle(self) -> None:
        shown = self.project.layer_runtime.shown
        if len(self.project.layer.handles) < MOST_HANDLES:
            self.act(add_handle, complex(self.choice(shown.positions)))

    def pull(self) -> None:
        shown = self.project.layer_runtime.shown
        targets = {}
        for handle, place in zip(shown.clip.layer.handles, shown.handle_positions, strict=True):
            if handle in self.project.layer.handles and self.chance(0.4):
                far = 1.0 if self.chance(0.05) else 0.05
                offset = complex(*self.rng.normal(0, far * self.size, 2))
                turn = float(self.rng.normal()) if self.chance(0.2) else None
                targets[handle.id] = Target(position=complex(place) + offset, rotation=turn)
        if targets:
            self.act(set_targets, targets)

    def change_handle(self) -> None:
        handles = self.project.layer.handles
        if not handles:
            return
        handle = self.choice(handles)
        match self.rng.integers(8):
            case 7:
                self.act(self.choice((suggest_handles, mirror_handles)))
            case 6:
                self.act(pin_selected_handles)
            case 5:
                self.act(
                    self.choice(
                        (
                            handle_editing.toggle_handles_locked,
                            handle_editing.group_handles,
                            handle_editing.ungroup_handles,
                        )
                    )
                )
            case 0:
                name = self.choice(("paw", "tail", "x", f"{self.rng.integers(99)}"))
                self.edit(
                    handle_commands.rename_handle(self.project.selection.active, handle.id, name)
                )
            case 1:
                weight = float(10 ** self.rng.uniform(-2, 2))
                self.edit(
                    handle_commands.set_handle_weight(
                        self.project.selection.active, {handle.id}, weight
                    )
                )
            case 2:
                outline = self.project.layer.domain.mesh.vertices
                self.edit(
                    handle_commands.move_handle(
                        self.project.selection.active, handle.id, complex(self.choice(outline))
                    )
                )
            case 3:
                self.act(free_rotation, handle.id)
            case 4:
                self.act(toggle_anchor_at_handle, handle.id)

    def set_anchor(self) -> None:
        inside = complex(self.choice(self.project.layer.domain.mesh.vertices))
        self.edit(
            shape_commands.set_anchor(
                self.project.selection.active, None if self.chance(0.5) else inside
            )
        )

    def select(self) -> None:
        chosen = [handle.id for handle in self.project.layer.handles if self.chance(0.5)]
        self.act(editing.select_handles, frozenset(chosen))

    def choose_keys(self) -> None:
        self.act(editing.select_channel_keys, self.some_keys())

    def delete(self) -> None:
        self.act(editing.delete_selection)

    def insert_key(self) -> None:
        if len(self.project.layer.keys) < MOST_KEYS:
            self.act(keys.insert_key_in_row_at, int(self.rng.integers(LAST)))

    def seek(self) -> None:
        self.act(playback.scrub, int(self.rng.integers(LAST)))

    def move_keys(self) -> None:
        chosen = self.some_keys()
        by = int(self.rng.integers(-9, 10))
        if chosen and max(map(max, chosen.values())) + by < LAST:
            most = max(
                len(frames_in(self.document, channel) | at) for channel, at in chosen.items()
            )
            copies = self.chance(0.3) and 2 * most <= MOST_KEYS
            verb = channel_commands.copy_keys if copies else channel_commands.move_keys
            self.edit(verb(chosen, by))

    def change_easing(self) -> None:
        easing = (
            self.choice(PRESETS.values())
            if self.chance(0.5)
            else Easing(tuple(map(float, self.rng.random(4))))
        )
        self.act(keys.set_easing, self.some_keys(), easing)

    def change_turns(self) -> None:
        self.act(keys.set_revolutions, self.some_keys(), int(self.rng.integers(-2, 3)))

    def change_variant(self) -> None:
        # The costlier ones are left again soon.
        self.act(
            editing.edit_layer,
            shape_commands.set_variant,
            self.choice((*VARIANTS, *("nu", "linear") * 4)),
        )

    def change_bounds(self) -> None:
        wanted = Bounds(
            k=float(self.rng.uniform(0.2, 0.8)),
            sigma_a=float(self.rng.uniform(1.2, 6)),
            sigma_b=float(self.rng.uniform(0.1, 0.8)),
        )
        wanted = self.choice((wanted, Bounds()))
        if self.chance(0.5):
            self.act(resolving.preview_limits, wanted)
        self.act(resolving.set_limits, wanted)

    def solve_again(self) -> None:
        self.act(resolving.solve_keys_again)

    def rebuild(self) -> None:
        detail = "normal" if self.chance(0.1) else "coarse"
        triangles = int(self.rng.integers(1_000, 2_000))
        meshing = Meshing(triangles=triangles, detail=detail)
        self.act(viewing.preview_meshing, meshing)
        self.act(resolving.rebuild_mesh)

    def cancel_solving(self) -> None:
        self.act(resolving.cancel_solving_keys)

    def copy_and_paste(self) -> None:
        if len(self.project.layer.keys) < MOST_KEYS:
            way = self.choice(("as it is", "swapped", "flipped"))
            pastes = ((pasting.paste_copied, way), (pasting_targets.paste_on_selected, way))
            self.act(
                *self.choice(((copying.copy_pose_or_keys,), (copying.copy_all_poses,), *pastes))
            )

    def use_library(self) -> None:
        layer = self.project.layer
        if len(layer.library) < 3:
            self.act(library.save_pose_to_library)
        elif self.chance(0.2):
            self.act(editing.edit_layer, pose_commands.delete_pose, self.choice(layer.library).name)
        for kept in self.project.layer.library[:1]:
            match self.rng.integers(4):
                case 0:
                    self.act(
                        library.rename_library_pose, kept.name, f"pose {self.rng.integers(99)}"
                    )
                case 1 if len(layer.keys) < MOST_KEYS:
                    self.act(library.apply_library_pose_at, kept.name, int(self.rng.integers(LAST)))
                case 2:
                    self.act(library.blend_library_pose, kept.name, float(self.rng.random() * 1.2))
                    self.act(library.end_pose_blend)
                case 3:
                    middle = float(self.rng.uniform(0, 160))
                    self.act(flipping.set_mirror_axis, self.choice((None, middle)))

    def change_markers(self) -> None:
        self.act(keys.add_marker_at_playhead)
        marker = self.choice(self.document.markers)
        match self.rng.integers(3):
            case 0:
                self.act(
                    editing.edit_document,
                    scene_commands.rename_marker(marker.frame, f"m {self.rng.integers(99)}"),
                )
            case 1:
                self.act(keys.delete_marker, marker.frame)
            case 2:
                self.act(playback.go_to_marker, int(self.choice((-1, 1))))

    def change_time(self) -> None:
        match self.rng.integers(9):
            case 0:
                self.act(keys.set_fps, float(self.choice((1, 12, 23.976, 60, 240))))
            case 1:
                self.act(playback.set_playback_speed, self.choice(playback.SPEEDS))
            case 2:
                last = self.rng.integers(self.document.frames.first + 1, LAST)
                self.act(keys.set_last_frame, int(last))
            case 3 if self.document.frames.last < LAST / 2:
                self.act(keys.scale_selected_keys, 2.0)
            case 3 | 4:
                self.act(keys.scale_selected_keys, self.choice((0.5, 0.9)))
            case 5:
                self.act(keys.reverse_selected_keys)
            case 6:
                self.act(editing.edit_layer, key_commands.match_loop_ends)
            case 7:
                self.act(keys.toggle_loop)
            case 8:
                self.act(keys.clear_preview_range)

    def look_at_time(self) -> None:
        strip = TimeRangeView(float(self.rng.uniform(-10, LAST)), float(self.rng.uniform(0.1, 3)))
        self.act(timeline_drag.set_time_range, self.choice((strip, None)))

    def change_onion_skin(self) -> None:
        self.act(viewing.set_onion_skin, *map(int, self.rng.integers(0, 3, 3)))
        if not self.session.display.overlays.onion:
            self.act(viewing.toggle_overlay, "onion")

    def change_layers(self) -> None:
        layers = self.document.layers
        layer = self.choice(layers)
        match self.rng.integers(9):
            case 0:
                self.act(set_active_layer, layer.id)
            case 1 if len(layers) < MOST_LAYERS:
                self.act(add_layers, [self.picture])
            case 2 if len(layers) < MOST_LAYERS:
                self.act(duplicate_layer, layer.id)
            case 3 | 1 | 2 if len(layers) > 1:
                self.act(delete_layers, layer.id)
            case 4:
                self.act(
                    editing.edit_document,
                    layer_commands.move_layer(layer.id, int(self.rng.integers(len(layers)))),
                )
            case 5:
                verb = self.choice(
                    (
                        toggle_layers_hidden,
                        toggle_layers_locked,
                        toggle_reference,
                    )
                )
                self.act(verb, layer.id)
            case 6:
                self.act(rename_layer, layer.id, self.choice(("arm", "leg", "")))
                self.act(
                    editing.edit_document,
                    layer_commands.set_opacity(layer.id, float(self.rng.random())),
                )
            case 7:
                delete = channel_keys.delete_channel_key, Channel(VISIBILITY, layer.id)
                self.act(*self.choice(((toggle_visibility_key, layer.id), delete)))
            case 8:
                self.act(self.choice((make_still, make_posable)), layer.id)

    def change_joints(self) -> None:
        child, parent = self.choice(self.document.layers), self.choice(self.document.layers)
        match self.rng.integers(4):
            case 0:
                self.act(detach_layer, child.id)
            case 1:
                self.act(set_inherits_rotation, child.id, self.chance(0.5))
            case _:
                self.act(attach_layer, child.id, parent.id, self.chance(0.5))

    def change_tracks(self) -> None:
        """Move a handle by a track of its own, or by a spring."""
        layer = self.project.layer
        if not layer.handles:
            return
        handle = self.choice(layer.handles).id
        place = complex(*self.rng.normal(0, 0.05 * self.size, 2))
        match self.rng.integers(8):
            case 0:
                self.act(tracks.key_handles_at_playhead, (handle,))
            case 1 | 2:
                self.act(tracks.set_handle_value, handle, place)
            case 3:
                self.act(tracks.set_track_space, handle, self.chance(0.5))
            case 4:
                frequency, damping = self.rng.uniform((0.5, 0), (4, 1))
                spring = Spring(handle=handle, frequency=float(frequency), damping=float(damping))
                self.act(editing.edit_layer, track_commands.put_spring, spring)
            case 5:
                self.act(springs.bake_spring, handle)
            case 6:
                remove = self.choice((track_commands.remove_tracks, track_commands.remove_springs))
                self.act(editing.edit_layer, remove, (handle,))
            case 7:
                selection, chosen = self.project.selection, self.chance(0.5)
                selection.select_channel(None)
                if chosen:
                    selection.select_track(self.project.layer, handle)

    def change_staging(self) -> None:
        """Let layers fade, move, take turns, or be painted in another order; and the camera."""
        layers = self.document.layers
        layer, other = self.choice(layers).id, self.choice(layers).id
        opacity, transform, order = (
            Channel(kind, layer) for kind in (OPACITY, TRANSFORM, DRAW_ORDER)
        )
        match self.rng.integers(7):
            case 0:
                self.act(channel_keys.set_channel_value, opacity, float(self.rng.random()))
            case 1:
                shift = complex(*self.rng.normal(0, 0.1 * self.size, 2))
                moved = Transform(shift, float(self.rng.normal()))
                self.act(channel_keys.set_channel_value, transform, moved)
            case 2:
                placed = DrawOrder(None if other == layer else other, self.chance(0.5))
                self.act(channel_keys.set_channel_value, order, placed)
            case 3:
                verbs = (channel_keys.insert_channel_key, channel_keys.delete_channel_key)
                channels = (opacity, transform, order, Channel(CAMERA))
                self.act(self.choice(verbs), self.choice(channels))
            case 4:
                self.act(channel_keys.key_camera)
            case 5:
                self.act(create_switch, *{layer, other})
            case 6 if self.document.switch_groups:
                self.act(
                    editing.edit_document,
                    switch_group_commands.delete_switch_group(
                        self.choice(self.document.switch_groups).name
                    ),
                )

    def change_depth(self) -> None:
        layer = self.project.layer
        if not layer.handles:
            return
        handle = self.choice(layer.handles)
        depth = float(self.choice((-1, -0.3, 0, 0.5, 1)))
        if self.chance(0.5):
            extent = self.choice((None, float(self.rng.uniform(2, 200))))
            self.edit(layer_commands.set_depth(layer.id, handle.id, depth, extent))
        else:
            frame = self.choice(layer.keys).frame
            channel = Channel(DEPTH, layer.id, handle.id)
            delete = channel_commands.delete_keys({channel: frozenset({frame})})
            self.edit(self.choice((channel_commands.set_key(channel, frame, depth), delete)))
        self.act(viewing.set_tint, "depth" if self.chance(0.3) else None)

    def change_material(self) -> None:
        layer = self.project.layer
        match self.choice(("tool", "paint", "bone", "amount", "clear", "mirror", "names", "again")):
            case "tool":
                self.act(
                    stiffness_editing.toggle_stiffness_tool,
                    self.choice(("stiff", "soft", "normal", "bone", None)),
                )
            case "paint" if self.session.tools.stiffness_tool is not None:
                start = complex(*self.rng.uniform(0, self.size, 2))
                self.act(
                    stiffness_editing.paint_stiffness, [start, start + self.rng.uniform(0, 30)]
                )
            case "bone" if len(layer.handles) > 1:
                first, second = self.rng.choice([h.id for h in layer.handles], 2, replace=False)
                self.act(stiffness_editing.add_bone, (int(first), int(second)))
            case "amount" if layer.bones:
                bone = self.choice(layer.bones)
                self.act(
                    editing.edit_layer,
                    stiffness_commands.set_bone_stiffness,
                    bone.ends,
                    float(self.rng.uniform(0.1, 100)),
                )
            case "clear":
                self.act(editing.edit_layer, stiffness_commands.clear_stiffness)
            case "mirror":
                self.act(stiffness_editing.mirror_stiffness)
            case "names":
                self.act(stiffness_editing.suggest_stiffness)
            case "again":
                self.act(stiffness_editing.solve_shown_pose_again)

    def cut_out(self) -> None:
        match self.rng.integers(5):
            case 0:
                self.act(
                    cut_out_editing.toggle_cut_tool,
                    self.choice(("keep", "remove", "pick", "holes", None)),
                )
            case 1 | 2:
                width, height = self.project.document.canvas
                count = self.rng.integers(1, 4)
                way = self.rng.uniform(0, width, count) + 1j * self.rng.uniform(0, height, count)
                radius = float(self.rng.uniform(2, 12))
                stroke = Stroke(points=way, radius=radius, keeps=self.chance(0.7))
                self.act(editing.edit_layer, shape_commands.cut_with_brush, stroke)
            case 3:
                self.act(cut_out_editing.set_background_tolerance, int(self.rng.integers(10, 30)))
            case 4:
                self.act(cut_out_editing.clear_cut_out_strokes)

    def change_view(self) -> None:
        match self.rng.integers(4):
            case 0:
                self.act(viewing.show_heat_map, self.choice(viewing.HEAT_MAPS))
            case 1:
                self.act(viewing.toggle_theme)
            case 2:
                self.act(viewing.set_backdrop, self.choice(("checker", "#123456")))
            case 3:
                self.act(viewing.toggle_overlay, "cage")

    def change_export(self) -> None:
        frames = sorted(map(int, self.rng.integers(self.document.frames.last + 1, size=2)))
        settings = ExportSettings(
            format=self.choice(EXPORT_FORMATS),
            size=self.choice((None, (64, 48))),
            background=self.choice(("transparent", "#ff8000")),
            framing=self.choice(("canvas", "fit")),
            frames=self.choice((None, FrameRange(*frames))),
        )
        self.act(editing.edit_document, scene_commands.set_export(settings))

    def undo(self) -> None:
        for _ in range(self.rng.integers(1, 4)):
            self.act(editing.undo)

    def redo(self) -> None:
        for _ in range(self.rng.integers(1, 4)):
            self.act(editing.redo)

    def some_keys(self) -> KeysByChannel:
        """Choose keys of the active layer's poses, or of all channels."""
        poses = pose_channel(self.project.selection.active)
        keyed = all_keys(self.document)
        keyed = keyed if self.chance(0.5) else {poses: keyed[poses]}
        chosen = {
            channel: frozenset(frame for frame in sorted(frames) if self.chance(0.5))
            for channel, frames in keyed.items()
        }
        return {channel: frames for channel, frames in chosen.items() if frames}

    @property
    def document(self):
        return self.project.document

    @property
    def size(self) -> float:
        return float(abs(complex(*self.project.document.canvas)))

    # What must hold.

    def look(self, *, thorough: bool, saves: bool) -> None:
        session, project = self.session, self.project
        surprises = [toast.details for toast in session.notices.toasts if toast.details]
        assert not surprises, surprises[0]
        assert session.project is project
        if thorough:
            check_invariants(session)
        if not saves:
            return
        save_project(self.path, self.document)
        assert not differences(self.document, load_project(self.path))


# In the middle of a drag.
MEANWHILE = (
    (Walk.undo, 3),
    (Walk.redo, 1),
    (Walk.save, 2),
    (Walk.make_layer_active, 2),
    (Walk.press_escape, 1),
    (Walk.seek, 1),
    (Walk.tap_space, 0.5),
    (Walk.change_layers, 2),
    (Walk.change_easing, 1),
    (Walk.delete, 1),
    (Walk.change_time, 1),
    (Walk.pull, 1),
    (Walk.copy_and_paste, 1),
    (Walk.change_export, 0.5),
    (Walk.do_named, 2),
)
HOLDING = (
    (Walk.move_pointer, 7),
    (Walk.release, 3),
    (Walk.press_escape, 0.3),
    (Walk.do_named, 0.6),
    (Walk.press_bound_key, 0.3),
)
ALL = (
    (Walk.press_bound_key, 12),
    (Walk.do_named, 10),
    (Walk.press_arrow, 3),
    (Walk.tap_space, 2),
    (Walk.press_escape, 1),
    (Walk.type_something, 1),
    (Walk.push, 14),
    (Walk.release, 2),
    (Walk.move_pointer, 2),
    (Walk.click, 4),
    (Walk.hold_and_do, 6),
    (Walk.double_click, 1),
    (Walk.turn_wheel, 2),
    (Walk.show_tab, 2),
    (Walk.add_handle, 4),
    (Walk.pull, 6),
    (Walk.change_handle, 3),
    (Walk.set_anchor, 1),
    (Walk.select, 2),
    (Walk.choose_keys, 2),
    (Walk.delete, 2),
    (Walk.insert_key, 4),
    (Walk.seek, 4),
    (Walk.move_keys, 2),
    (Walk.change_easing, 2),
    (Walk.change_turns, 1),
    (Walk.change_variant, 1),
    (Walk.change_bounds, 0.4),
    (Walk.solve_again, 0.1),
    (Walk.rebuild, 0.2),
    (Walk.cancel_solving, 0.2),
    (Walk.copy_and_paste, 3),
    (Walk.use_library, 2),
    (Walk.change_markers, 1),
    (Walk.change_time, 4),
    (Walk.look_at_time, 1),
    (Walk.change_onion_skin, 1),
    (Walk.change_view, 2),
    (Walk.change_layers, 3),
    (Walk.change_joints, 3),
    (Walk.change_tracks, 4),
    (Walk.change_staging, 2),
    (Walk.change_depth, 2),
    (Walk.change_material, 3),
    (Walk.cut_out, 0.5),
    (Walk.change_export, 1),
    (Walk.undo, 4),
    (Walk.redo, 2),
)


def draw_bone(path: Path) -> Path:
    """Write a small picture of something that bends."""
    picture = Image.new("RGBA", (160, 100))
    pen = ImageDraw.Draw(picture)
    pen.rounded_rectangle((20, 40, 140, 60), 8, fill=(200, 120, 60, 255))
    for x in (25, 135):
        pen.ellipse((x - 18, 32, x + 18, 68), fill=(90, 140, 200, 255))
    picture.save(path)
    return path


def draw_bones(path: Path) -> Path:
    """Write a small drawing of two bones that cross, on layers, before a wall."""
    bone = Image.open(draw_bone(path.with_name("bone.png")))
    wall = Image.new("RGBA", bone.size, (220, 230, 220, 255))
    stack = "".join(f'<layer name="{n}" src="data/{n}.png"/>' for n in range(3))
    path.write_bytes(openraster(bone.size, stack, [bone.rotate(30), bone, wall]))
    return path


@pytest.fixture
def small_window(window, monkeypatch):
    """A window that costs little to draw, with drawings that cost little to pose."""
    for constant in CHEAP:
        monkeypatch.setattr(*constant)
    window.resize(SMALL)
    window.session.settings.default_meshing = Meshing(triangles=1_000, detail="coarse")
    yield window
    window.resize(USUAL)


@pytest.fixture
def workers(small_window):
    workers = Workers(small_window.session.jobs)
    yield workers
    workers.release()


def number_of_steps(config, seed):
    """Return how far a walk goes; one that is asked for, as far as it is asked to."""
    steps = config.getoption("--steps")
    return steps if config.getoption("--walks") else FAR.get(seed, steps)


def pytest_generate_tests(metafunc):
    if "seed" in metafunc.fixturenames:
        walks = metafunc.config.getoption("--walks")
        metafunc.parametrize("seed", range(1, walks + 1) if walks else SEEDS)


def test_random_walk_ends_where_it_began(small_window, workers, tmp_path, seed, request):
    window, monkeypatch = small_window, request.getfixturevalue("monkeypatch")
    drawing = draw_bones if seed % 2 else draw_bone
    project = window.open(drawing(tmp_path / ("bones.ora" if seed % 2 else "bone.png")))
    first = project.document
    if seed % 5 == 0:
        editing.edit_layer(window.session, shape_commands.set_variant, "metric")
    walk = Walk(window, seed, workers, Widgets(monkeypatch), tmp_path)
    workers.hold()
    for number in range(number_of_steps(request.config, seed)):
        try:
            walk.step(number)
        except Exception as error:
            last = "\n".join(walk.actions)
            raise AssertionError(f"seed {seed}, step {number}: {error}\nafter\n{last}") from error
    walk.release()
    walk.act(release_drag)
    # What is still on its way, such as a rebuilt domain, would come where undo leads back to.
    workers.release()
    window.settle()
    # So would what waits for a mesh that waits for the brush to rest.
    project.pending.deferred.clear()
    last = project.document, project.history.preview_pose
    steps = 0
    while project.history.undo_label is not None:
        window.act(editing.undo)
        steps += 1
    assert (project.document, project.history.preview_pose) == (first, None)
    for _ in range(steps):
        window.act(editing.redo)
    assert (project.document, project.history.preview_pose) == last
    walk.catch_up(wholly=True)
    walk.look(thorough=True, saves=True)
