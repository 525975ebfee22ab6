"""`lissom pose`: picture + pose script → project."""

import argparse

from app.cli.console import StatusLine, print_line, print_notices
from app.cli.options import add_cut_out_options, add_meshing_options, add_out, input_file
from app.errors import LissomError
from app.texts import _, ngettext

EPILOG = _(
    """\
SCRIPT.json is an animation as a small text. Coordinates are pixels of the picture with the origin
at its lower left corner and y up, as in `lissom domain`:

  {"schema": 1, "fps": 24, "loop": false, "variant": "metric",
   "bounds": {"k": 0.5, "sigma_a": 2.0, "sigma_b": 0.5}, "anchor": [400, 500],
   "handles": {"nose": [120, 880], "hoof": [300, 40]},
   "keys": [{"frame": 0}, {"frame": 24, "targets": {"nose": [90, 400]}, "ease": "in-out"}]}

By default fps is 24, loop false, and variant "metric" (or nu, scaled-eta, eta, linear). The limits
are called bounds; by default they are those above, which are "Natural" in the window ("Rubbery" is
0.8, 5.0, 0.2 and "Stiff" 0.35, 1.5, 0.67). By default Lissom chooses the anchor, and ease is
"linear" (or in, out, in-out, hold, or four numbers from 0 to 1 of a Bézier curve). The ease of a
key leads to the next key. The passing of a key is "through", "corner", "stop" or "hold". "through"
is the default between two other keys: the motion goes through the key at one velocity. At a
"corner" it comes and goes straight; this is the default of keys with an ease. "hold" stays until
the next key. A handle that a key does not name keeps its target of the key before, at first its
place in the picture. Each key is solved by a drag from the key before. If the limits stop a handle,
the key is kept, and a notice says how far the handle is from its target.

A key with "turn": {"nose": 20} turns the shape at a handle by 20 degrees, counter-clockwise, from
the drawing. Later keys without "turn" keep it.

A key with "pull": 10 pulls the handles that it names with at most this force, as a drag in the
window does. Handles that cannot reach their targets then move nothing else, and their targets move
to where the handles are.

A handle with equal targets in two neighbouring keys stays there in between, as a foot does on the
ground. With "still": false in {"at": [300, 40], "still": false} it follows the shape instead. At
the top, or in a layer, "still" is for all handles. A handle has a track of its own with

   "tracks": [{"handle": "nose", "with": "pose", "delay": 4, "reach": 0.3,
               "keys": [{"frame": 0, "offset": [0, 0]}, {"frame": 9, "offset": [12, 5]},
                        {"frame": 24, "offset": [0, 0]}]},
              {"handle": "hoof", "with": "picture", "keys": [{"frame": 6, "at": [310, 40]}]}],
   "springs": [{"handle": "ear", "preset": "ear", "lag": 1, "strength": 0.5},
               {"handle": "tail", "frequency": 1.6, "damping": 0.18, "root": "hip"}]

A track acts from its first key to its last key, both included. An offset is relative to the
handle's place in the motion of the poses, in axes that turn with the shape there. With "picture",
"at" is the place on the canvas. Several handles move together as "handles": ["hoof", "heel"]; the
keys are those of the first handle. A key may turn the shape at the handle by degrees,
counter-clockwise ("turn": 20), and has ease and passing as above. At its first and last key the
handle starts and ends at rest, unless they meet in a loop. A key with passing "through" may set the
velocity, in pixels a frame, in the axes of its offset or of the canvas ("velocity": [2, -0.5]). By
default "with" is "pose", delay is 0 frames (in a loop it wraps around), and reach is 1. Reach, from
0 to 1, says how far around the handle the body gives way. The animation ends at the last key of
poses or tracks, or at the end of the last cycle.

A spring makes a handle follow the motion late and swing. Frequency is in Hz; damping 1 does not
overshoot; by default lag is 0 frames, and strength is 1. The presets are tail, ear, hair, cloth and
jelly. The handle swings about its "root", another handle, and keeps its distance to it. By default
the root is the nearest handle without a spring, along bones, or else along the drawing. "stretch",
from 0, the default, to 1, lets that distance change; 1 swings freely. Keys do not hold handles with
springs: in poses the body carries them.

A slider adds poses of the drawing to the motion of the keys:

   "sliders": [{"name": "turn",
                "poses": [{"at": -1, "targets": {"nose": [90, 880]}}, {"at": 0},
                          {"at": 1, "targets": {"nose": [150, 880]}}],
                "keys": [{"frame": 0, "value": -1}, {"frame": 20, "value": 1}]}]

It has 2 to 8 poses. Each is dragged from the undeformed drawing, with "targets", "turn" and "pull"
as in a key, and "turns", further whole turns. A handle that no pose moves stays. The limits hold
for all values, also for 30 % beyond the outer poses. A pad has two numbers, "at": [0, 1] and
"value": [0.5, 1], and poses on a grid of at most 5 by 5. Keys have ease and passing as above.
"value" is used without keys, and "delay" is in frames. With "spring": {"preset": "hair"}, or a
frequency and a damping, the value swings. With "driver": "head", the slider of this name in the
layer "head" gives the value, and several layers turn together.

A stretch of time repeats with

   "cycles": [{"from": 0, "to": 24, "until": 96}]

Its last frame is the same moment as its first frame, as in a loop. Set keys from frame 0 to 23; a
key at 24 must equal the key at 0. Every repeat is the same motion, without a seam. Without "until"
it repeats to the end of the animation. Tracks with all their keys in the cycle repeat with it. So
do "movement" and "opacity" if they end as they begin, and "front", "visible" and "order". "attach"
repeats if all its changes are in the cycle. Each repeat then begins as the cycle does; the last
entry with "keep" leads there, and nothing jumps. The keys of "choices" repeat with a cycle that all
of their layers have. Keys before the cycle lead to its first key. Keys after it continue from the
frame shown at its end, which must be one of its keys. Cycles do not overlap.

A handle may set the depth of the drawing around it, from -1 (behind) to 1 (in front), and how far
around, in pixels: {"at": [120, 880], "front": 0.5, "extent": 60}. A key with "front": {"nose": 1}
sets it from there on.

Limbs have bones, which keep their length:

   "bones": [["shoulder", "elbow", "hand"], ["hip", "knee", "foot"]]

Each chain names its handles from root to end. A key that names the end alone bends the whole chain:
{"frame": 12, "targets": {"hand": [300, 330]}}. An end beyond reach stays on its circle, and a
notice says how far it is off. A key that names a joint turns the chain around its root. A key that
names roots alone moves the body with them. A joint bends to the side to which it bends in the key
before, at first as it is drawn. A key with "side": {"elbow": 1} bends it to the left of the way
from root to end, and -1 to the right. The foot, hand or head beyond an end is rigid.
"angle": {"foot": 0} sets its rotation, in degrees from the drawing; later keys keep it. Without an
angle it turns with its bone. An end that stays keeps its rotation, too. Several chains may start at
a handle, but only one bone may end there.

Parts of the drawing are stiffer or softer with

   "stiff": [{"around": [530, 800], "radius": 250, "amount": 10},
             {"from": "elbow", "to": "wrist", "amount": 30}]

The first entry paints the outline within so many pixels of a point, as far as it is visible from
there. The second entry is a chain of one bone from root to end, and sets how stiff the drawing is
beside it. "amount" is from 1/30, soft, to 100. Above 1 the limits are tighter, too: k and the
logarithms of sigma_a and sigma_b are divided by the square root of the amount.

DRAWING may have layers (OpenRaster .ora, or .psd if psd-tools is installed). Coordinates are then
pixels of the canvas. In place of anchor, handles, bones, keys, tracks, springs, cycles and stiff, a
script of several layers has

   "layers": [{"layer": "body", "handles": {}, "keys": [{"frame": 0}]},
               {"layer": "arm", "handles": {"hand": [310, 240]},
                "keys": [{"frame": 0}, {"frame": 12, "targets": {"hand": [300, 330]}}],
                "attach": {"to": "body", "at": [200, 260], "turn": true},
                "visible": [[0, true], [40, false]]}],
   "choices": [{"name": "mouth", "layers": ["closed", "ah"], "keys": [[0, "closed"], [8, "ah"]]}]

Layers of one part, such as ink and colour, bend as one with a common entry. Its "layer" names their
deform group. An entry of "ink" alone has only what is its own: opacity, visible and order.

   "layers": [{"layers": ["ink", "colour"], "layer": "fish", "handles": {...}, "keys": [...]}]

Each layer may have its own variant, bounds, anchor, tracks, springs, cycles and stiff. An attached
layer moves as a whole, so that in every frame its anchor is at the point "at" of its parent. With
"turn", which is true by default, it turns with the parent there. "at" is a point of the undeformed
parent. Without an anchor, "at" is the anchor, too, and must be on both layers. Handles and targets
are those of the layer without its parent. A list changes the parent; each entry counts from its
frame on. With "keep" nothing jumps then, and "at" may be left out. "to": null detaches the layer:

   "attach": [{"to": "hand A", "at": [310, 240]}, {"frame": 80, "to": "hand B", "keep": true}]

Layers without an entry stand still. An entry may leave out handles and keys. "visible" lists the
frames from which a layer is visible or not; it also shows layers that are hidden in DRAWING.
"choices" are switches: exactly one of their layers is visible, from the frame on that the key
names. In place of a layer, a switch may have a group by its path ("mouth/happy"), which switches as
one; its layers may have "visible" and switches of their own. A layer is in one switch only, and has
no "visible" then.

The camera and its canvas are at the top of the script:

   "camera": {"keys": [{"frame": 0, "centre": [400, 300]},
                       {"frame": 48, "centre": [520, 340], "zoom": 2, "turn": 10]}},
   "canvas": [1280, 720]

Every frame of an export then shows the camera's view. The point centre is in its middle. The view
is zoom times enlarged (1 by default; blended by its logarithm), and turned by degrees,
counter-clockwise as seen (0 by default). Its size is the canvas, by default as large as DRAWING.
Before its first key and after its last key the camera stands still; in a loop the last key leads to
the first key. A layer has

   "movement": {"keys": [{"frame": 0}, {"frame": 24, "shift": [60, 0], "turn": 90}]},
   "opacity": [[0, 1], [12, 0.2]],
   "order": [[24, {"in_front_of": "arm"}], [36, {"behind": "body"}], [48, null]]

"movement" moves the posed layer as a whole ("shift"), turns it around its joint by degrees
("turn"), and scales it there ("scale"). The joint of an attached layer is its anchor. Another layer
turns around its anchor, or else around the middle of its shape. Attached layers move with it.
"opacity" is a number, or changes evenly from key to key. "order" moves the layer right in front of
or right behind another layer from a frame on; null returns it to its place in DRAWING. A layer that
stands still has these too, with "handles": {} and "keys": [{"frame": 0}]. Keys of the camera and of
movements have ease and passing as those of poses; without an ease they start and end at rest.

"bones" at the top of the script names attached layers that bend as a limb, from root to end. The
last one then goes to the places of its channel "ik_target", and the others turn at their joints:

   "bones": [["thigh", "shin", "foot"], {"layers": ["upper arm", "forearm", "hand"], "side": -1}],
   "layers": [..., {"layer": "foot", ...,
      "channels": {"ik_target": [{"frame": 0, "place": [310, 60]},
                                 {"frame": 12, "place": [310, 60]},
                                 {"frame": 18, "place": [250, 90], "turn": 20}]}}]

"place" is where the joint of the foot is in the scene, and "turn" how far the foot is turned there,
in degrees. Between two keys at the same place the foot stays planted. "mix" is 1 by default; with 0
the foot follows its parents, and their own turns hold. Beyond reach the limb is straight. "side" is
1 for a bend to the left of the way from root to end, -1 to the right, and by default as drawn.

"channels" sets any channel of a layer, with an easing and a tangent for every key:

   "channels": {"transform": [{"frame": 0}, {"frame": 24, "shift": [60, 0], "turn": 90}],
                "opacity": [{"frame": 0, "opacity": 1, "easing": "in-out"},
                            {"frame": 12, "opacity": 0.2, "tangent_mode": "stop"}],
                "draw_order": [{"frame": 24, "beside": "arm", "in_front": true}],
                "visibility": [{"frame": 0, "visible": true}, {"frame": 40, "visible": false}],
                "depth": {"hand": [{"frame": 8, "depth": -1}]}}

"depth" has a channel for each handle. "easing" is as "ease" above, by default linear.
"tangent_mode" is through, corner or stop. It is corner by default for opacity, otherwise through.
A channel is set in one place: here, or by "movement", "opacity", "order", "visible" or "front".

A drawing that was changed in its program is reloaded with --reload NEW PROJECT. Handles, keys and
joints stay. Layers are found by the ids in the file, by group and name, by a name that is unique,
or by equal pixels. A table lists what is redrawn, moved, new and gone. Settings, names, groups and
order come from the file if they changed only there. Layers that are gone stay, hidden.

Sounds are files beside the script:

   "sounds": [{"file": "talk.wav", "at": 12, "from": 0.5, "to": 3, "volume": 0.8}]

A sound (WAV, FLAC, MP3 or OGG Vorbis) begins at the frame "at", by default 0, and is heard at its
own speed. "from" and "to" are seconds of its file, by default all of it. "volume" is from 0 to 1,
by default 1, or a list of keys: [{"frame": 0, "volume": 0}, {"frame": 12, "volume": 1}]. "name" is
its name, by default that of the file. "muted": true silences it. The project keeps the bytes of the
file. Sounds do not make the animation longer.

examples:
  lissom pose giraffe.png nod.json --out nod.lissom
  lissom pose giraffe.png nod.json --out nod.lissom --triangles 20000 --detail fine
  lissom pose photo.jpg nod.json --out nod.lissom --mask mask.png
  lissom pose --reload character.psd walk.lissom
"""
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "picture",
        metavar="DRAWING",
        type=input_file,
        help=_("the drawing, or with --reload the project"),
    )
    script = _("handles and keys")
    parser.add_argument("script", metavar="SCRIPT.json", type=input_file, nargs="?", help=script)
    add_out(parser, "PROJECT.lissom", is_required=False)
    parser.add_argument(
        "--reload",
        metavar="NEW",
        type=input_file,
        help=_(
            "replace the drawing in a project by its changed file NEW, and keep handles, keys and "
            "joints; --out is by default the project itself"
        ),
    )
    parser.add_argument(
        "--layer",
        metavar="NAME",
        help=_("with --reload, reload only the layer of this name"),
    )
    parser.add_argument(
        "--one-picture",
        action="store_true",
        help=_("open the layers of the drawing merged into one picture"),
    )
    add_meshing_options(parser)
    add_cut_out_options(parser)


def run(arguments: argparse.Namespace) -> int:
    """Solve the keys of a script and write the project, or reload a project's drawing."""
    if arguments.reload is not None:
        if arguments.script is not None:
            raise LissomError(_("--reload takes a project alone; leave out the script"))
        from app.cli.reload import reload_project

        reload_project(arguments.picture, arguments.reload, arguments.out, arguments.layer)
        return 0
    for name, value in (("SCRIPT.json", arguments.script), ("--out", arguments.out)):
        if value is None:
            raise LissomError(_("{name} is missing").format(name=name))
    if arguments.layer is not None:
        raise LissomError(_("--layer needs --reload"))
    from app.cli.drawings import open_drawing, save_drawing
    from app.solving import load_pose_script, pose_document
    from app.storage import check_writable

    read = arguments.picture, arguments.script, arguments.mask
    check_writable(arguments.out, sources=filter(None, read))
    script = load_pose_script(arguments.script)
    members = {name for part in script.layers for name in part.members}
    opened = open_drawing(arguments, merges_layers=arguments.one_picture, members=members)
    with StatusLine() as status:
        document, notices = pose_document(opened.document, script, status.show)
    print_notices(notices)
    save_drawing(arguments.out, opened, document)
    posed = [layer for layer in document.layers if not layer.still]
    keys = sum(len(layer.keys) for layer in posed)
    handles = sum(len(layer.handles) for layer in posed)
    counts = [
        ngettext("{count} key", "{count} keys", keys).format(count=keys),
        ngettext("{count} handle", "{count} handles", handles).format(count=handles),
    ]
    if (layers := len(document.layers)) > 1:
        counts.insert(0, ngettext("{count} layer", "{count} layers", layers).format(count=layers))
    print_line(_("{path}: {counts}").format(path=arguments.out, counts=", ".join(counts)))
    return 0
