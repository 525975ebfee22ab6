"""What cannot be a body, a motion or a recording is refused, with an error that names it."""

import numpy as np
import pytest

from app.rigging import (
    MOTIONS,
    Body,
    Parameters,
    find_kind,
    fit_keys,
    guess_facing,
    simulate_spring,
)
from app.rigging.kinematics.recordings import MOST_FRAMES
from engine.errors import EngineError

NAN = float("nan")
STANDING = {
    "hips": 50 + 100j,
    "chest": 50 + 150j,
    "head": 50 + 190j,
    "knee.L": 55 + 50j,
    "foot.L": 50 + 0j,
}


def body(box=(0j, 100 + 200j), **joints):
    return Body(kind=find_kind("biped-side"), joints=STANDING | joints, box=box)


REFUSED = {
    "a knee on the hips": lambda: body(**{"knee.L": STANDING["hips"]}),
    "a foot nowhere": lambda: body(**{"foot.L": complex(NAN, NAN)}),
    "a flat box": lambda: Body(kind=find_kind("anything"), joints={}, box=(0j, 100 + 0j)),
    "a limb that is not there": lambda: body().limb_joints("hand.L"),
    "a length that is not there": lambda: body().path_length(["hips", "nose"]),
    "a phase that is no number": lambda: MOTIONS["walk"].perform(body(), Parameters()).pose_at(NAN),
    "no frames a second": lambda: MOTIONS["walk"].frames(Parameters(), NAN),
    "no outline": lambda: guess_facing(find_kind("biped-side"), STANDING, np.empty(0, complex)),
    "places too far for a spring": lambda: simulate_spring(
        [0j, 1e308, 0], 24, frequency=2, damping=0.2
    ),
    "a speed as text": lambda: simulate_spring([0j, 1], "x", frequency=2, damping=0.2),
    "places too far to record": lambda: fit_keys([0, 1, 2], [0j, 1e308, 0], 1),
    "a recording that is too long": lambda: fit_keys([0, MOST_FRAMES + 1], [0j, 1], 1),
    "a recording that is too late": lambda: fit_keys([1e18, 1e18 + 1000], [0j, 1], 1),
    "a recording as text": lambda: fit_keys(["a"], [0j], 1),
    "half a frame with a key": lambda: fit_keys([0, 4], [0j, 1], 1, required=[1.5]),
}


@pytest.mark.parametrize("case", REFUSED)
def test_input_of_rigging_is_refused_when_it_is_no_input(case):
    with pytest.raises(EngineError):
        REFUSED[case]()
