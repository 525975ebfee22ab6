"""Arguments of `lissom move`."""

import argparse

from app.cli.options import (
    add_cut_out_options,
    add_meshing_options,
    input_file,
    output_file,
)

EPILOG = """\
A ready motion moves the joints of a drawing. What kind of body the drawing is, and where its joints
are, is guessed, and printed, unless it is told:

  {"schema": 1, "kind": "biped-side",
   "joints": {"hips": [225, 250], "chest": [230, 365], "head": [235, 490],
              "knee.L": [300, 160], "foot.L": [330, 55], "knee.R": [190, 150],
              "foot.R": [125, 55]}}

Places are pixels of the drawing from its lower left corner, x to the right and y up, as in
`lissom pose`. The kinds and their joints, of which any may be left out that is not in the drawing:

  biped-front, biped-side, four-legs
    hips, chest, neck, head, tail, and of each side, as in knee.L and knee.R,
    shoulder, elbow, hand, hip, knee, foot; the hands of four legs are its front feet, and from
    the side L and R are the two limbs of a pair, whichever is nearer
  chain
    joint.1, joint.2 and so on to joint.16, from the end that leads, or is held, to the other one
  anything
    none: it moves as a whole

The project has a handle at each joint, and keys of the motion, which can be edited as any others.
It loops, unless the motion travels. Joints that the limits of distortion hold back are told, with
the largest --size at which none is. A drawing on layers is merged into one picture first.

examples:
  lissom move --list
  lissom move horse.png --motion walk --out horse.lissom
  lissom move person.png --motion wave --mirrored --size 0.8 --out hello.lissom
  lissom move bird.png --motion walk --joints bird.json --travel --out bird.lissom
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "picture", metavar="DRAWING", type=input_file, nargs="?", help="the drawing"
    )
    parser.add_argument(
        "--list", action="store_true", help="name the motions, with the kinds that they fit"
    )
    parser.add_argument("--motion", metavar="NAME", help="which motion it is given")
    parser.add_argument("--out", metavar="PROJECT.lissom", type=output_file, help="where to write")
    parser.add_argument("--kind", metavar="KIND", help="what kind of body it is")
    parser.add_argument(
        "--joints", metavar="JOINTS.json", type=input_file, help="where its joints are"
    )
    parser.add_argument(
        "--facing", choices=("left", "right"), help="where it looks (default: guessed)"
    )
    parser.add_argument(
        "--speed", metavar="X", type=float, default=1.0, help="times as fast as usual, 0.1 to 4"
    )
    parser.add_argument(
        "--size",
        metavar="X",
        type=float,
        default=1.0,
        help="how far limbs and steps go, over what is usual, 0.05 to 2",
    )
    parser.add_argument(
        "--energy",
        metavar="X",
        type=float,
        default=1.0,
        help="how much the body bounces and sways meanwhile, 0 to 2",
    )
    parser.add_argument(
        "--mirrored", action="store_true", help="the other side begins, or does what one alone does"
    )
    parser.add_argument(
        "--start",
        metavar="X",
        type=float,
        default=0.0,
        help="the share of its cycle at which it begins, from 0 to below 1",
    )
    parser.add_argument(
        "--travel",
        action="store_true",
        help="get on by one stride, with feet planted in the picture; it does not loop",
    )
    parser.add_argument(
        "--bones", action="store_true", help="let each limb have a bone, which keeps it stiff"
    )
    add_meshing_options(parser)
    add_cut_out_options(parser)
