"""Small files take little memory, and large ones no more than what is in them and a share."""

import json
import re
import subprocess
import sys
import tracemalloc
from dataclasses import replace
from math import inf

import numpy as np
import pytest
from animations import moving_document
from layered import blob, openraster
from messages import says
from PIL import Image
from refusals import refusal

from app.cli.commands.certify import EXITS
from app.cli.main import main
from app.document import keyframe
from app.errors import LissomError
from app.reports import Verdict
from app.storage import Preferences, load_project, save_preferences, save_project
from app.storage.pictures import parallel
from app.storage.pictures.openraster import read_openraster
from app.storage.pictures.parallel import MEMORY_OF_PICTURES
from app.storage.pictures.picture import decode_pictures
from engine.deform import MOST_HANDLES

MEGABYTE = 1_000_000
BASE = 140 * MEGABYTE  # of a process that has done nothing
# In a process of its own, which tells its largest memory. Linux is asked for that of the program
# alone: a process begins with the largest one of whoever started it, here of all tests before.
RUN = """
import re, resource, sys
from pathlib import Path
from app.cli.main import main
status = main(sys.argv[1:])
if sys.platform == "linux":
    peak = re.search(r"VmHWM:\\s*(\\d+) kB", Path("/proc/self/status").read_text())[1]
else:
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
print(1024 * int(peak))
raise SystemExit(status)
"""


@pytest.fixture
def budget(tmp_path, monkeypatch):
    """Return a function that sets how many megabytes pictures may take."""
    folder = tmp_path / "settings"
    monkeypatch.setattr(parallel, "settings_folder", lambda: folder)

    def set_to(megabytes):
        save_preferences(folder, Preferences(memory=megabytes))

    return set_to


def test_pictures_beyond_the_budget_are_refused_before_they_are_decoded(
    tmp_path, budget, capsys, monkeypatch
):
    path, out = tmp_path / "a.png", tmp_path / "out"
    Image.new("L", (900, 900), 255).save(path)
    budget(3)

    def never(_):
        raise AssertionError("it was decoded")

    with monkeypatch.context() as decoding:
        decoding.setattr("app.storage.pictures.picture._decoded", never)
        said = refusal(capsys, "domain", path, "--out", out)
        with pytest.raises(LissomError, match=says(MEMORY_OF_PICTURES, needed=6)):
            decode_pictures([(path.read_bytes(), "it")] * 2)
    assert re.search(says(MEMORY_OF_PICTURES, needed=3, budget=3), said)
    assert "preferences.json" in said
    budget(4)
    assert main(["domain", str(path), "--out", str(out)]) == 0


def test_the_layers_of_a_file_share_one_budget(tmp_path, budget):
    stack = '<layer name="a" src="data/0.png"/><layer name="b" src="data/1.png"/>'
    data = openraster((600, 600), stack, [blob(600, 600), blob(600, 600)])
    budget(2)
    with pytest.raises(LissomError, match=says(MEMORY_OF_PICTURES, needed=3)):
        read_openraster(data)
    budget(3)
    assert len(read_openraster(data).layers) == 2
    path = tmp_path / "a.lissom"
    save_project(path, moving_document())
    assert load_project(path)


def test_a_quarter_of_the_machine_is_usual(budget, monkeypatch):
    monkeypatch.setattr("os.sysconf", {"SC_PAGE_SIZE": 4096, "SC_PHYS_PAGES": 10_000}.get)
    assert parallel.memory_budget() == 10_240_000
    budget(None)
    assert parallel.memory_budget() == 10_240_000


@pytest.mark.parametrize(
    "kind",
    [
        "png",
        *(
            pytest.param(kind, marks=pytest.mark.long)
            for kind in ("ora", "jpg", "deep.png", "scene.ora")
        ),
    ],
)
def test_opening_takes_little_beyond_what_is_decoded(tmp_path, kind):
    side, count = (3_000, 3) if kind.endswith("ora") else (3_600, 1)
    drawn = Image.new("RGBA", (side, side))
    drawn.paste((200, 60, 30, 255), (side // 4, side // 4, 3 * side // 4, 3 * side // 4))
    path = tmp_path / f"a.{kind}"
    if kind == "png":
        drawn.save(path)
    elif kind == "jpg":
        drawn.convert("RGB").save(path)
    elif kind == "deep.png":
        Image.fromarray(np.asarray(drawn.getchannel("A"), dtype=np.uint16) * 257).save(path)
    else:
        stack = "".join(f'<layer name="{k}" src="data/{k}.png"/>' for k in range(count))
        path.write_bytes(openraster((side, side), stack, [drawn] * count))
    words = ["domain", path, "--out", tmp_path / "out", "--triangles", "1000"]
    words += ["--layer", "0"] if kind == "ora" else []
    if kind == "scene.ora":
        script = tmp_path / "script.json"
        keys = [{"frame": 0}]
        layer = {"layer": "0", "handles": {}, "keys": keys}
        script.write_text(json.dumps({"schema": 1, "layers": [layer]}))
        words[:2] = ["pose", path, script]
    peak = subprocess.run(
        [sys.executable, "-c", RUN, *map(str, words)], capture_output=True, text=True, check=True
    ).stdout
    decoded = 4 * side * side * count
    # While some are decoded they are there twice; masks take four bytes a pixel.
    most = {"png": 1.1, "ora": 1.1, "scene.ora": 2.6}.get(kind, 1.6)
    assert int(peak.split()[-1]) <= BASE + decoded + most * 4 * side * side


def wild_project(path, factor):
    """Write a project of which one key takes a vertex of the cage far away."""
    document = moving_document()
    (layer,) = document.layers
    key = layer.keys[1]
    phi = key.pose.phi.copy()
    phi[2] = factor * 120
    keys = (layer.keys[0], replace(key, pose=replace(key.pose, phi=phi)))
    save_project(path, replace(document, layers=(replace(layer, keys=keys),)))
    return path


@pytest.mark.parametrize("factor", [1e150, 1e12])
def test_a_map_beyond_all_pixels_is_refused(tmp_path, capsys, monkeypatch, factor):
    with monkeypatch.context() as patched:
        patched.setattr(keyframe, "LARGEST_COEFFICIENT", inf)
        path = wild_project(tmp_path / "a.lissom", factor)
    assert "The coefficients of a pose can be at most 1e+12" in refusal(capsys, "certify", path)


def test_a_map_that_goes_far_is_reported_as_over(tmp_path, capsys):
    path = wild_project(tmp_path / "a.lissom", 2e4)
    assert main(["certify", str(path)]) == EXITS[Verdict.OVER]
    assert "OVER" in capsys.readouterr().out


def test_more_handles_than_anybody_holds_are_refused(tmp_path, capsys):
    corners = np.array([0, 1, 1 + 1j, 1j])
    handles = (np.arange(MOST_HANDLES + 1) + 1) / (MOST_HANDLES + 3) * (0.9 + 0.9j)
    path = tmp_path / "a.npz"
    np.savez(
        path,
        outline=corners,
        cage=(corners - 0.5 - 0.5j) * 1.4 + 0.5 + 0.5j,
        handles=handles,
        targets=handles,
        k_max=0.6,
        sigma_a_max=3.0,
        sigma_b_min=0.3,
    )
    tracemalloc.start()
    try:
        assert "1,001 handles need too much memory" in refusal(
            capsys, "deform", path, "--out", tmp_path / "out"
        )
        assert tracemalloc.get_traced_memory()[1] < 20 * MEGABYTE
    finally:
        tracemalloc.stop()
