"""`lissom certify`: what is proven of an animation, and where it is not."""

import json
from dataclasses import replace
from math import inf
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from still_poses import posed, with_layer

from app.cli.main import main
from app.document import (
    HOLD,
    DistortionRange,
    Document,
    FrameRange,
    Meshing,
    TangentMode,
    Track,
    TrackKey,
    UnreadMotion,
    new_layer,
)
from app.reports import (
    CorrectedReport,
    Report,
    SegmentReport,
    certification,
    corrected_frames,
)
from app.storage import load_project, save_project
from engine.interpolation import Proof
from engine.maps import Certificate

SAMPLE = Path(__file__).parents[3] / "sample_images/giraffe.lissom"


@pytest.fixture(scope="module")
def giraffe(tmp_path_factory):
    """A project of the sample's first three keys, between which no handle stays."""
    path = tmp_path_factory.mktemp("giraffe") / "giraffe.lissom"
    document = load_project(SAMPLE)
    (layer,) = document.layers
    frames = FrameRange(0, layer.keys[2].frame)
    layers = (replace(layer, keys=layer.keys[:3], has_auto_pins=False),)
    save_project(path, replace(document, layers=layers, frames=frames, preview=None, loop=False))
    return path


@pytest.fixture(scope="module")
def still(tmp_path_factory):
    """A project of a blob, of which handles stay between two keys."""
    path = tmp_path_factory.mktemp("still") / "still.lissom"
    document = posed(2)
    # Which are stopped at, so that the motion has no more room than its keys take.
    keys = tuple(replace(key, tangent_mode=TangentMode.STOP) for key in document.layers[0].keys)
    save_project(path, with_layer(document, keys=keys))
    return path


def certified(capsys, *words, project=SAMPLE):
    status = main(["certify", str(project), *words])
    return status, capsys.readouterr().out


def test_in_betweens_are_proven_between_frames_too(still, capsys):
    status, said = certified(capsys, "--variant", "metric", "--json", project=still)
    assert status == 0
    content = json.loads(said)
    assert content["verdict"] == "proven"
    assert content["corrected"] is None
    limits = load_project(still).layers[0].bounds
    for interval in content["intervals"]:
        assert interval["verdict"] == "proven"
        proven = interval["proven"]
        assert proven["never_folds"]
        assert proven["unsettled_frames"] == []
        # Above what is measured, and near it.
        for name, sign, by in zip(
            ("k", "sigma_a", "sigma_b"), (1, 1, -1), proven["excess"], strict=True
        ):
            slack = 0.002 * (1 if name == "k" else interval[name])
            assert 0 <= sign * (proven[name] - interval[name]) <= slack
            # Where handles stay, the limits are the layer's.
            assert by == pytest.approx(max(sign * (proven[name] - getattr(limits, name)), 0))


def test_frames_that_fold_are_named(giraffe, capsys):
    status, said = certified(capsys, "--variant", "linear", project=giraffe)
    assert status == 1
    assert "MAY FOLD" in said
    assert "Overall: OVER." in said
    assert "may fold       frames 12, 13, 14, 15, 16, 17, 18\n" in said
    _, said = certified(capsys, "--variant", "linear", "--json", project=giraffe)
    first, second = json.loads(said)["intervals"]
    assert not first["proven"]["never_folds"]
    assert first["proven"]["unsettled_frames"] == list(range(12, 19))
    assert first["proven"]["loose_frames"] == []
    assert first["verdict"] == "over"
    assert first["sigma_b"] < 0
    assert second["proven"]["never_folds"]


def test_where_every_layer_stands_still_there_is_nothing_to_certify(tmp_path, capsys):
    (drawn,) = load_project(SAMPLE).layers
    still = replace(new_layer(drawn.picture, drawn.domain, Meshing()), still=True)
    path = tmp_path / "still.lissom"
    save_project(path, Document(layers=(still,)))
    assert main(["certify", str(path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {
        "verdict": "proven",
        "certified": True,
        "layers": {},
    }


def test_a_motion_that_is_not_known_here_is_reported(tmp_path, capsys):
    (drawn,) = load_project(SAMPLE).layers
    still = replace(new_layer(drawn.picture, drawn.domain, Meshing()), still=True)
    unread = UnreadMotion(index=0, content={"motion": "nosuch"}, reason="it is not known")
    path = tmp_path / "later.lissom"
    save_project(path, Document(layers=(replace(still, unread_motions=(unread,)),)))
    assert main(["certify", str(path)]) == 0
    assert "a motion that this version cannot show" in capsys.readouterr().err


def test_of_a_key_that_is_held_only_that_key_is_seen(giraffe, tmp_path, capsys):
    """The linear blend folds on the way, but nothing goes that way."""
    document = load_project(giraffe)
    (layer,) = document.layers
    path = tmp_path / "held.lissom"
    held = tuple(replace(key, easing=HOLD) for key in layer.keys)
    save_project(path, replace(document, layers=(replace(layer, keys=held),)))
    assert main(["certify", str(path), "--variant", "linear", "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["verdict"] == "proven"
    for own, key in zip(content["intervals"], content["keys"], strict=False):
        assert own["proven"]["never_folds"]
        assert own["k"] == pytest.approx(key["k"], abs=2e-3)
        assert own["proven"]["k"] == pytest.approx(key["k"], abs=2e-3)


def interval(k=0.5, sigma_a=2.0, sigma_b=0.5, *, reached=(0.4, 1.8, 0.6), unsettled=(), loose=()):
    return SegmentReport(
        first=0,
        last=12,
        reached=DistortionRange(*reached),
        keys=DistortionRange(0.5, 2.0, 0.5),
        correction=0.0,
        limits=DistortionRange(0.5, 2.0, 0.5),
        proof=Proof(k=k, sigma_a=sigma_a, sigma_b=sigma_b, unproven_times=(), not_tight=()),
        unsettled=unsettled,
        loose=loose,
    )


@pytest.mark.parametrize(
    ("reached", "proven", "verdict"),
    [
        ((0.5015, 2.003, 0.4993), 4, "proven"),
        ((0.5015, 2.003, 0.4993), 3, "measured"),
        ((0.503, 1.8, 0.6), 4, "over"),
    ],
)
def test_tracked_frames_are_judged_with_the_same_tolerance(reached, proven, verdict):
    limits = DistortionRange(0.5, 2.0, 0.5)
    tracked = CorrectedReport(
        frames=4,
        proven=proven,
        points=900,
        reached=DistortionRange(*reached),
        between=DistortionRange(0.4, 1.5, 0.7),
        limits=limits,
        short=(),
        looked_at=4,
        left_out=0,
        slid=0,
        curbed=0.0,
    )
    assert Report(keys=(), segments=(), corrected=tracked).corrected_verdict == verdict


@pytest.mark.parametrize(
    ("made", "verdict"),
    [
        (interval(), "proven"),
        (interval(0.5019, 2.0039, 0.4991), "proven"),
        (interval(loose=(3,)), "proven"),
        (interval(0.503), "measured"),
        (interval(sigma_a=2.005), "measured"),
        (interval(sigma_b=0.4989), "measured"),
        (interval(reached=(0.501, 1.8, 0.6), k=0.5015), "proven"),
        (interval(reached=(0.51, 1.8, 0.6), k=0.52), "over"),
        (interval(reached=(0.4, 1.8, 0.45), sigma_b=0.44), "over"),
        (interval(k=inf, sigma_a=inf, sigma_b=0.0, unsettled=(5,), loose=(3,)), "over"),
    ],
)
def test_an_interval_has_one_verdict(made, verdict, monkeypatch, capsys):
    key = Certificate(k=0.5, sigma_a=2.0, sigma_b=0.5, winding=0, is_certified=True)
    other = replace(key, is_certified=False)
    assert made.verdict == verdict
    assert Report(keys=((0, key),), segments=(interval(), made)).verdict == verdict
    assert Report(keys=((0, other),), segments=(made,)).verdict == "over"
    report = Report(keys=((0, key),), segments=(made,))
    monkeypatch.setattr("app.reports.certification.certify_clip", lambda *_: report)
    status, said = certified(capsys, "--json")
    assert status == {"proven": 0, "measured": 3, "over": 1}[verdict]
    content = json.loads(said)
    assert (content["verdict"], content["certified"]) == (verdict, verdict == "proven")
    (own,) = content["intervals"]
    # What is said of frames never contradicts what is said of the whole.
    assert bool(own["proven"]["unsettled_frames"]) == (not own["proven"]["never_folds"])
    assert own["proven"]["loose_frames"] == list(made.loose)
    for name, by, sign in zip(("k", "sigma_a", "sigma_b"), own["error"], (1, 1, -1), strict=True):
        if made.proof.k < 1:
            assert own[name] + sign * by == pytest.approx(own["proven"][name])
    assert "Overall: " in certified(capsys)[1]


def test_what_is_measured_is_the_maximum_between_the_steps_too():
    """A peak in time that no equal step meets is found."""

    class Peaked:
        def frame(self, t):
            k = 0.5 * np.exp(-(((t - 22.5 / 64) / 0.01) ** 2))
            return SimpleNamespace(fz=np.array([1.0 + 0j]), fzbar=np.array([k + 0j]))

    assert certification._measured(Peaked()).k == pytest.approx(0.5, abs=2e-3)


def test_certify_says_how_many_frames_it_looked_at(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(corrected_frames, "MOST_LOOKED_AT", 5)
    monkeypatch.setattr(corrected_frames, "SPREAD", 3)
    document = posed(1)
    keys = tuple(TrackKey(frame=frame, place=place) for frame, place in ((1, 0j), (4, 8j), (7, 0j)))
    track = Track(handles=(document.layers[0].handles[0].id,), keys=keys)
    project = tmp_path / "still.lissom"
    save_project(project, with_layer(replace(document, frames=FrameRange(0, 9)), tracks=(track,)))
    status, text = certified(capsys, project=project)
    assert status == 3
    assert "act in 7 frames; a repeat counts once. 3 of them were examined" in text
