"""`lissom pose`: picture + pose script → project."""

import argparse

from app.cli.console import StatusLine, print_line, print_notices
from app.cli.options import add_cut_out_options, add_meshing_options, add_out, input_file
from app.texts import _

EPILOG = """\
SCRIPT.json is an animation as a small text. Coordinates are pixels of the picture with the origin
at its lower left corner and y up, as in `lissom domain`:

  {"schema": 1, "fps": 24, "loop": false, "variant": "metric",
   "bounds": {"k": 0.5, "sigma_a": 2.0, "sigma_b": 0.5}, "anchor": [400, 500],
   "handles": {"nose": [120, 880], "hoof": [300, 40]},
   "keys": [{"frame": 0}, {"frame": 24, "targets": {"nose": [90, 400]}, "ease": "in-out"}]}

Left out, fps is 24, loop false, variant "metric" (or nu, scaled-eta, eta, linear), bounds as above,
which is "Natural" in the window ("Rubbery" is 0.8, 5.0, 0.2 and "Stiff" 0.35, 1.5, 0.67), the
anchor the engine's choice, and ease "linear" (or in, out, in-out, hold, or four numbers from 0 to 1
of a Bézier curve); it leads to the next key. A key's passing is "through", where it is between two
others the motion passes it at one velocity; "corner", come and go straight, which is what a key has
that names an ease; "stop"; or "hold", stay until the next key. A handle that a key does not name
keeps its target of the key before, at first its place in the picture. Each key is solved by a drag
from the key before; where the bounds hold a handle back, the key is kept and a notice says by how
much.

A key with "turn": {"nose": 20} turns the shape at handles by so many degrees, counter-clockwise,
from how it is drawn; a later key that names none leaves them turned so.

A key with "pull": 10 pulls the handles that it names with no more force than that, as the hand does
in the window: what is beyond their reach moves nothing else, and is wanted where it came to.

A handle that two neighbouring keys have at one place stays there in between, as a foot does on the
ground. With "still": false in {"at": [300, 40], "still": false} it moves as the shape takes it; the
same at the top, or in a layer, says so of all handles. A handle has a clock of its own with

   "tracks": [{"handle": "nose", "with": "pose", "delay": 4, "reach": 0.3,
               "keys": [{"frame": 0, "offset": [0, 0]}, {"frame": 9, "offset": [12, 5]},
                        {"frame": 24, "offset": [0, 0]}]},
              {"handle": "hoof", "with": "picture", "keys": [{"frame": 6, "at": [310, 40]}]}],
   "springs": [{"handle": "ear", "preset": "ear", "lag": 1, "strength": 0.5},
               {"handle": "tail", "frequency": 1.6, "damping": 0.18, "root": "hip"}]

A track acts from its first key to its last one, both included, and changes nothing elsewhere. Its
offset is by how much the handle is beside its place in the motion of the poses, in axes that turn
with the shape there; with "picture", at is its place on the canvas. Several handles move together
as "handles": ["hoof", "heel"]: keys are of the first one. A key may turn the shape at the handle by
so many degrees, counter-clockwise ("turn": 20), and has ease and passing as those above; through
the first and the last one the handle comes from rest and to rest, unless they meet in a loop. One
that is passed through may say at which velocity, in pixels a frame in the axes of its offset or of
the canvas ("velocity": [2, -0.5]). Left out, with is "pose", delay 0 frames (in a loop it comes
round), and reach 1: from 0 to 1, how far around the handle the body gives. The last key, of poses
or of a track, or the end of what repeats, is where the animation ends.

A spring lets a handle follow the motion late and swing: frequency in Hz; damping, 1 where it comes
back without swinging over; lag 0 frames, and strength 1. The presets are tail, ear, hair, cloth and
jelly. It swings about another handle and keeps its distance to that: about its "root", or where
that is left out about the nearest handle along bones, or else along the drawing, that has no
spring. "stretch": from 0, which is the default, to 1, lets that distance change; 1 swings freely.
Keys do not hold what follows: in poses it goes where the body carries it.

A stretch of time repeats with

   "cycles": [{"from": 0, "to": 24, "until": 96}]

Its last frame is the same moment as its first one, as in a loop: keys are from frame 0 up to 23,
and one at 24 must be like that at 0. Every repeat is the same motion, through the seams too;
without until it goes on to the end of the animation. Tracks of which all keys are in the stretch
repeat with it, and so do "movement" and "opacity", unless they end otherwise than they begin; and
so do "front", "visible" and "order". "attach" does where all of its changes are in the stretch:
each repeat begins as the stretch does, the last entry with "keep" leads there, and nothing jumps.
So do the keys of a choice with a cycle that all of its layers have. Keys before lead to its first
key; keys after go on from what is shown at the end, which must be one of its keys. Cycles do not
overlap.

A handle may say what is painted in front around it, from -1 (behind) to 1, and how far around, in
pixels: {"at": [120, 880], "front": 0.5, "extent": 60}; a key with "front": {"nose": 1} says it from
there on.

Parts of the drawing are stiffer or softer with

   "stiff": [{"around": [530, 800], "radius": 250, "amount": 10},
             {"from": "elbow", "to": "wrist", "amount": 30}]

The first is painted on the outline within so many pixels of a point, as far as it is seen from
there; the second is a bone, the limb between two handles without the joints at its ends. amount is
from 1/30, soft, to 100; where it is above 1 the drawing also bends and stretches less: k and the
logarithms of sigma_a and sigma_b are there at most those of the bounds over the root of amount.

DRAWING may have layers (OpenRaster .ora, or .psd where psd-tools is installed). Coordinates are
pixels of the canvas then, and a script of several layers has, instead of anchor, handles, keys,
tracks, springs, cycles and stiff:

   "layers": [{"layer": "body", "handles": {}, "keys": [{"frame": 0}]},
               {"layer": "arm", "handles": {"hand": [310, 240]},
                "keys": [{"frame": 0}, {"frame": 12, "targets": {"hand": [300, 330]}}],
                "attach": {"to": "body", "at": [200, 260], "turn": true},
                "visible": [[0, true], [40, false]]}],
   "choices": [{"name": "mouth", "layers": ["closed", "ah"], "keys": [[0, "closed"], [8, "ah"]]}]

Each may have a variant, bounds, an anchor, tracks, springs, cycles and stiff of its own. What is
attached is moved as a whole, in every frame, so that its anchor comes to where the point "at" of
its parent has come; with turn, which is true where left out, it turns with the parent there. "at"
is a point of the parent as it is drawn; where no anchor is given it is the anchor, too, and is on
both layers. Handles and targets are told as if it hung on nothing. A list lets it change hands,
each entry from its frame on: with "keep" nothing jumps then, and at may be left out; "to": null
lets go:

   "attach": [{"to": "hand A", "at": [310, 240]}, {"frame": 80, "to": "hand B", "keep": true}]

Layers that no entry names stand still. visible says from which frames on a layer is seen or
not, also one that is hidden in DRAWING. Of the layers of a choice exactly one is seen at a time,
from the frame on that its keys name; none of them is in another choice or has visible.

What moves between keys of its own:

   "camera": {"keys": [{"frame": 0, "centre": [400, 300]},
                       {"frame": 48, "centre": [520, 340], "zoom": 2, "turn": 10}]},
   "canvas": [1280, 720]

at the top lets every frame of an export show what the camera does: the point centre in the middle,
all zoom times as large (1 where left out; blended by its logarithm) and turned by so many degrees
counter-clockwise as it is seen (0). Its frame is the canvas, from the origin to its upper right
corner, which is as large as DRAWING where no canvas is given. Before its first key and after its
last one it is held; in a loop the last one leads on to the first one. A layer has

   "movement": {"keys": [{"frame": 0}, {"frame": 24, "shift": [60, 0], "turn": 90}]},
   "opacity": [[0, 1], [12, 0.2]],
   "order": [[24, {"in_front_of": "arm"}], [36, {"behind": "body"}], [48, null]]

movement shifts it as a whole from where its poses have it, and turns it around its anchor, or else
the middle of its shape, with all that hangs on it; while it hangs on another one it goes with that
one alone. opacity is a number, or fades evenly from key to key. order lays it right in front of
another layer from a frame on, or right behind it; null takes it back to its place in DRAWING. A
layer that stands still has these too, with "handles": {} and "keys": [{"frame": 0}]. Keys of the
camera and of movements have ease and passing as those of poses; where they begin and end they come
from rest and to rest, unless an ease is named.

examples:
  lissom pose giraffe.png nod.json --out nod.lissom
  lissom pose giraffe.png nod.json --out nod.lissom --triangles 20000 --detail fine
  lissom pose photo.jpg nod.json --out nod.lissom --mask mask.png
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("picture", metavar="DRAWING", type=input_file, help="the drawing")
    parser.add_argument("script", metavar="SCRIPT.json", type=input_file, help="handles and keys")
    add_out(parser, "PROJECT.lissom")
    add_meshing_options(parser)
    add_cut_out_options(parser)


def run(arguments: argparse.Namespace) -> int:
    """Solve the keys of a script and write the project."""
    from app.cli.drawings import open_drawing, save_drawing
    from app.solving import load_pose_script, pose_document
    from app.storage import check_writable

    read = arguments.picture, arguments.script, arguments.mask
    check_writable(arguments.out, sources=filter(None, read))
    script = load_pose_script(arguments.script)
    opened = open_drawing(arguments, merges_layers=False)
    with StatusLine() as status:
        document, notices = pose_document(opened.document, script, status.show)
    print_notices(notices)
    save_drawing(arguments.out, opened, document)
    posed = [layer for layer in document.layers if not layer.still]
    values = {
        "path": arguments.out,
        "layers": len(document.layers),
        "keys": sum(len(layer.keys) for layer in posed),
        "handles": sum(len(layer.handles) for layer in posed),
    }
    if len(document.layers) == 1:
        print_line(_("{path}: {keys} keys, {handles} handles").format(**values))
    else:
        print_line(_("{path}: {layers} layers, {keys} keys, {handles} handles").format(**values))
    return 0
