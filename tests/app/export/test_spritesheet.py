"""Sprite sheets as an engine reads them: by the JSON beside the PNG."""

import errno
import json
import os
from pathlib import Path

import numpy as np
import pytest
from exports import FRAMES, SIZE, draw, plan_for, run
from numpy.testing import assert_array_equal
from PIL import Image

from app.errors import LissomError
from app.export import data_file
from app.export.plan import FrameTag
from app.export.writers import spritesheet
from app.export_formats import SpriteSheetOptions
from engine.arrays import Bytes


def exported(folder, drawing=draw, *, tags=None, **layout):
    """Export a sheet; return its pixels and its data."""
    changes = {"sheet": SpriteSheetOptions(**layout), "fps": 23.976}
    changes |= {} if tags is None else {"tags": tags}
    plan = plan_for(folder / "walk.png", "spritesheet", **changes)
    run(plan, drawing)
    with Image.open(plan.out) as image:
        sheet = np.asarray(image)
    return sheet, json.loads(data_file(plan.out, "spritesheet").read_text())


def placed(sheet: Bytes, entry) -> Bytes:
    """A frame as an engine puts it together again."""
    at, source = entry["frame"], entry["spriteSourceSize"]
    assert (at["w"], at["h"]) == (source["w"], source["h"])
    whole = np.zeros((entry["sourceSize"]["h"], entry["sourceSize"]["w"], 4), dtype=np.uint8)
    part = sheet[at["y"] : at["y"] + at["h"], at["x"] : at["x"] + at["w"]]
    whole[source["y"] : source["y"] + source["h"], source["x"] : source["x"] + source["w"]] = part
    return whole


@pytest.mark.parametrize("trimmed", [True, False])
@pytest.mark.parametrize("power_of_two", [True, False])
@pytest.mark.parametrize("padding", [0, 3])
def test_every_frame_comes_back_exactly(tmp_path, trimmed, power_of_two, padding):
    sheet, data = exported(tmp_path, trimmed=trimmed, power_of_two=power_of_two, padding=padding)
    assert list(data["frames"]) == [f"frame_000{index}.png" for index in range(FRAMES)]
    used = np.zeros(sheet.shape[:2], dtype=int)
    for index, entry in enumerate(data["frames"].values()):
        assert_array_equal(placed(sheet, entry), draw(index))
        assert entry["trimmed"] == trimmed
        assert not entry["rotated"]
        assert entry["sourceSize"] == {"w": SIZE[0], "h": SIZE[1]}
        at = entry["frame"]
        assert min(at["x"], at["y"]) >= padding
        around = np.s_[at["y"] - padding : at["y"] + at["h"], at["x"] - padding : at["x"] + at["w"]]
        used[around] += 1
    assert used.max() == 1  # no frame lies over another, or in its padding
    meta = data["meta"]
    assert meta["size"] == {"w": sheet.shape[1], "h": sheet.shape[0]}
    assert (meta["image"], meta["format"], meta["scale"]) == ("walk.png", "RGBA8888", "1")
    assert all(side & (side - 1) == 0 for side in sheet.shape[:2]) or not power_of_two
    if padding:
        assert not sheet[-padding:].any()
        assert not sheet[:, -padding:].any()


def test_trimmed_sheets_are_smaller_and_same_frames_are_there_once(tmp_path):
    whole, _ = exported(tmp_path, trimmed=False, padding=0)
    small, _ = exported(tmp_path, trimmed=True, padding=0)
    assert small.size < 0.8 * whole.size
    sheet, data = exported(tmp_path, lambda time: draw(time // 4), trimmed=True, padding=0)
    assert sheet.size < 0.5 * small.size
    corners = [(entry["frame"]["x"], entry["frame"]["y"]) for entry in data["frames"].values()]
    assert len(set(corners)) == 2
    for index, entry in enumerate(data["frames"].values()):
        assert_array_equal(placed(sheet, entry), draw(index // 4))


def test_frames_of_which_nothing_is_seen_have_a_pixel(tmp_path):
    sheet, data = exported(tmp_path, lambda time: draw(time) * (time < 2), trimmed=True)
    entry = data["frames"]["frame_0004.png"]
    assert (entry["frame"]["w"], entry["frame"]["h"]) == (1, 1)
    assert not placed(sheet, entry).any()


def test_durations_add_up_and_tags_are_those_of_the_timeline(tmp_path):
    tags = (FrameTag("rise", 0, 2), FrameTag("fall", 3, 6))
    _, data = exported(tmp_path, tags=tags)
    durations = [entry["duration"] for entry in data["frames"].values()]
    assert sum(durations) == round(1000 * FRAMES / 23.976)
    assert set(durations) <= {41, 42}
    assert data["meta"]["frameTags"] == [
        {"name": "rise", "from": 0, "to": 2, "direction": "forward"},
        {"name": "fall", "from": 3, "to": 6, "direction": "forward"},
    ]


def test_what_does_not_fit_on_a_sheet_is_refused_and_leaves_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr(spritesheet, "LARGEST", 48)
    for trimmed in (True, False):
        with pytest.raises(LissomError, match="do not fit on a sheet"):
            exported(tmp_path, trimmed=trimmed)
        assert list(tmp_path.iterdir()) == []


def test_data_lie_beside_their_sheet(tmp_path):
    assert data_file(tmp_path / "a.png", "spritesheet") == tmp_path / "a.json"
    assert data_file(tmp_path / "v1.2", "spritesheet") == tmp_path / "v1.2.json"


@pytest.mark.parametrize("calls", [1, 2, 3])
def test_a_sheet_that_is_replaced_half_way_never_has_the_data_of_another(
    tmp_path, monkeypatch, calls
):
    exported(tmp_path)
    before = contents(tmp_path)
    replace, left = Path.replace, [calls]

    def stopped(self, target):
        left[0] -= 1
        if not left[0]:
            raise OSError(5, "Input/output error")
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", stopped)
    with pytest.raises(LissomError, match="Input/output"):
        exported(tmp_path, padding=9)
    if calls < 3:
        assert contents(tmp_path) == before
    else:  # nothing comes after it but the data
        assert not (tmp_path / "walk.json").exists()


@pytest.mark.parametrize("calls", [1, 2])
def test_a_sheet_for_which_there_is_no_room_leaves_both_files_as_they_were(
    tmp_path, monkeypatch, calls
):
    exported(tmp_path)
    before, left = contents(tmp_path), [calls]

    def full(_):
        left[0] -= 1
        if not left[0]:
            raise OSError(errno.EFBIG, "File too large")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(LissomError, match=r"File too large.* free some space"):
        exported(tmp_path, padding=9)
    assert contents(tmp_path) == before


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}
