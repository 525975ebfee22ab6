"""Lissom in the menu of applications, as the freedesktop conventions have it."""

import configparser
import io
import os
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from documents import disc_document
from PIL import Image

from app.cli.commands import desktop
from app.cli.main import main
from app.errors import REINSTALL
from app.storage import draw_thumbnail, read_thumbnail, sample_images, save_project

PROGRAM = Path(sysconfig.get_path("scripts")) / "lissom"
SPACE = {"mime": "http://www.freedesktop.org/standards/shared-mime-info"}

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="other desktops are refused")


@pytest.fixture
def home(tmp_path, monkeypatch):
    """A person's folder of data, with things of theirs, and no programs that refresh caches."""
    path = tmp_path / "data"
    for name in ("applications/other.desktop", "icons/hicolor/48x48/apps/other.png"):
        (path / name).parent.mkdir(parents=True)
        (path / name).write_bytes(b"theirs")
    monkeypatch.setenv("XDG_DATA_HOME", str(path))
    monkeypatch.setattr(desktop.shutil, "which", lambda _: None)
    return path


def entry(path, section):
    parser = configparser.RawConfigParser()
    parser.optionxform = str
    parser.read(path, encoding="utf-8")
    assert parser.sections() == [section]
    return dict(parser[section])


def everything(folder):
    return {path: path.is_file() and path.read_bytes() for path in folder.rglob("*")}


def test_the_menu_has_lissom_and_opens_projects_with_it(home, capsys):
    assert main(["desktop", "--install"]) == 0
    assert str(home) in capsys.readouterr().out
    said = entry(home / "applications/lissom.desktop", "Desktop Entry")
    assert said["Type"] == "Application"
    assert said["Name"] == "Lissom"
    assert said["Icon"] == "lissom"
    assert said["MimeType"] == "application/x-lissom;"
    assert said["Categories"].split(";")[0] == "Graphics"
    assert said["TryExec"] == str(PROGRAM)
    assert shlex.split(said["Exec"]) == [str(PROGRAM), "%f"]


def test_menu_and_kind_of_file_have_their_names_in_all_languages(home):
    assert main(["desktop", "--install"]) == 0
    said = (home / desktop.ENTRY_AT).read_text(encoding="utf-8")
    assert "GenericName=2D animation\nComment=Pose" in said
    assert "Comment[de]=Eine Zeichnung" in said
    kind = (home / desktop.MIME_TYPE_AT).read_text(encoding="utf-8")
    assert '<comment xml:lang="de">Lissom-Projekt</comment>' in kind


def test_a_bundle_enters_itself(home, tmp_path, monkeypatch):
    program = str(tmp_path / "lissom" / "lissom")
    monkeypatch.setattr(sys, "frozen", True, raising=False)
    monkeypatch.setattr(sys, "executable", program)
    assert main(["desktop", "--install"]) == 0
    said = entry(home / "applications/lissom.desktop", "Desktop Entry")
    assert said["TryExec"] == shlex.split(said["Exec"])[0] == program


def test_icons_of_every_size_lie_in_the_theme_that_all_fall_back_to(home):
    main(["desktop", "--install"])
    for path in home.glob("icons/hicolor/*/apps/lissom.png"):
        with Image.open(path) as icon:
            assert path.parts[-3] == f"{icon.width}x{icon.height}"
            assert icon.mode == "RGBA"
            assert icon.getpixel((0, 0))[3] == 0
            assert icon.getpixel((icon.width // 2, icon.height // 2))[3] == 255
    assert len(list(home.glob("icons/hicolor/*/apps/lissom.png"))) == 8
    assert (home / "icons/hicolor/48x48/apps/lissom.png").is_file()


def test_projects_are_known_by_their_name_and_by_how_they_begin(home, tmp_path):
    main(["desktop", "--install"])
    packages = ET.parse(home / "mime/packages/lissom.xml").getroot()  # noqa: S314 - our own
    kind = packages.find("mime:mime-type", SPACE)
    assert kind.get("type") == "application/x-lissom"
    assert kind.find("mime:glob", SPACE).get("pattern") == "*.lissom"
    assert kind.find("mime:icon", SPACE).get("name") == "lissom"
    save_project(tmp_path / "a.lissom", disc_document())
    for content in (tmp_path / "a.lissom", sample_images() / "giraffe.lissom"):
        start = content.read_bytes()[:100]
        for match in kind.iterfind("mime:magic//mime:match", SPACE):
            assert match.get("type") == "string"
            value = match.get("value").encode().decode("unicode_escape").encode()
            assert start[int(match.get("offset")) :].startswith(value)


def test_the_thumbnailer_makes_a_thumbnail(home, tmp_path):
    main(["desktop", "--install"])
    said = entry(home / "thumbnailers/lissom.thumbnailer", "Thumbnailer Entry")
    assert said["MimeType"] == "application/x-lissom;"
    assert said["TryExec"] == str(PROGRAM)
    project, out = tmp_path / "a b.lissom", tmp_path / "out"
    picture = read_thumbnail(sample_images() / "giraffe.lissom")
    save_project(project, disc_document(), thumbnail=draw_thumbnail(picture))
    meant = {"%i": str(project), "%o": str(out), "%s": "64"}
    program, *words = (meant.get(word, word) for word in shlex.split(said["Exec"]))
    assert program == str(PROGRAM)
    assert main(words) == 0
    with Image.open(io.BytesIO(out.read_bytes())) as image:
        assert max(image.size) == 64


def test_removal_leaves_what_was_there_before(home):
    before = everything(home)
    for _ in range(2):  # again, after Lissom has moved
        assert main(["desktop", "--install"]) == 0
    assert len(everything(home)) > len(before)
    for _ in range(2):
        assert main(["desktop", "--remove"]) == 0
        assert everything(home) == before


def test_caches_are_refreshed_where_the_programs_for_it_are(home, monkeypatch):
    calls = []

    def refresh(words, **settings):
        calls.append(words)
        if settings["timeout"] and len(calls) == 2:
            raise subprocess.TimeoutExpired(words, 1)
        raise FileNotFoundError(words[0])

    monkeypatch.setattr(desktop.shutil, "which", lambda name: f"/bin/{name}")
    monkeypatch.setattr(desktop.subprocess, "run", refresh)
    assert main(["desktop", "--install"]) == 0
    wanted = [
        ["/bin/update-desktop-database", home / "applications"],
        ["/bin/update-mime-database", home / "mime"],
    ]
    assert calls == wanted
    assert main(["desktop", "--remove"]) == 0
    assert calls == 2 * wanted


@pytest.mark.skipif(
    shutil.which("update-mime-database") is None, reason="update-mime-database is not installed"
)
@pytest.mark.parametrize("has_others", [False, True])
def test_the_systems_own_program_understands_it_and_nothing_is_left(home, monkeypatch, has_others):
    monkeypatch.undo()
    monkeypatch.setenv("XDG_DATA_HOME", str(home))
    other = home / "mime/packages/other.xml"
    if has_others:
        other.parent.mkdir(parents=True)
        other.write_text(
            desktop.MIME_TYPE.replace("lissom", "other").replace("{comments}", ""), encoding="utf-8"
        )
        subprocess.run(["update-mime-database", home / "mime"], check=True)
    before = everything(home)
    main(["desktop", "--install"])
    globs = (home / "mime/globs2").read_text(encoding="utf-8")
    assert "50:application/x-lissom:*.lissom" in globs
    assert (home / "mime/application/x-lissom.xml").is_file()
    main(["desktop", "--remove"])
    (home / "applications/mimeinfo.cache").unlink(missing_ok=True)  # for what others have there
    assert everything(home) == before


def test_a_folder_that_cannot_be_written_is_reported(home, capsys):
    (home / "thumbnailers").write_bytes(b"")
    with pytest.raises(SystemExit) as leaving:
        main(["desktop", "--install"])
    assert leaving.value.code == 2
    assert str(home / "thumbnailers") in capsys.readouterr().err


@pytest.mark.parametrize("data", ["", "relative", None])
def test_without_a_folder_of_data_it_is_the_usual_one(home, monkeypatch, data):
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.delenv("XDG_DATA_HOME")
    if data is not None:
        monkeypatch.setenv("XDG_DATA_HOME", data)
    main(["desktop", "--install"])
    assert (home / ".local/share/applications/lissom.desktop").is_file()


def test_a_program_in_a_strange_folder_is_quoted(home, monkeypatch, tmp_path):
    scripts = tmp_path / 'my "own" $programs`\\ 100%'
    scripts.mkdir()
    (scripts / "lissom").touch()
    monkeypatch.setattr(desktop.sysconfig, "get_path", lambda _: str(scripts))
    main(["desktop", "--install"])
    said = entry(home / "applications/lissom.desktop", "Desktop Entry")
    assert said["TryExec"].replace("\\\\", "\\") == str(scripts / "lissom")
    line = said["Exec"].replace("\\\\", "\\")
    quoted = re.fullmatch(r'"((?:[^"`$\\]|\\["`$\\])*)" %f', line)
    assert re.sub(r"\\(.)", r"\1", quoted[1]) == str(scripts / "lissom").replace("%", "%%")


def test_a_program_in_a_folder_of_several_lines_stays_on_one(home, monkeypatch, tmp_path):
    scripts = tmp_path / "my\nExec=evil\r\tprograms\udcff"
    scripts.mkdir()
    (scripts / "lissom").touch()
    monkeypatch.setattr(desktop.sysconfig, "get_path", lambda _: str(scripts))
    main(["desktop", "--install"])
    for place in ("applications/lissom.desktop", "thumbnailers/lissom.thumbnailer"):
        lines = os.fsdecode((home / place).read_bytes()).split("\n")
        (line,) = (line for line in lines if line.startswith("Exec="))
        assert r"my\nExec=evil\r\tprograms" in line
        assert not any("evil" in line for line in lines if not line.startswith(("Exec", "TryExec")))


def test_an_installation_without_the_program_says_so(home, monkeypatch, tmp_path, capsys):
    before = everything(home)
    monkeypatch.setattr(desktop.sysconfig, "get_path", lambda _: str(tmp_path / "nowhere"))
    with pytest.raises(SystemExit):
        main(["desktop", "--install"])
    assert REINSTALL in capsys.readouterr().err
    assert everything(home) == before


@pytest.mark.parametrize("system", ["win32", "darwin"])
@pytest.mark.parametrize("option", ["--install", "--remove"])
def test_other_systems_are_refused_with_a_remedy(home, monkeypatch, capsys, system, option):
    before = everything(home)
    monkeypatch.setattr("app.cli.commands.desktop.sys.platform", system)
    with pytest.raises(SystemExit) as leaving:
        main(["desktop", option])
    assert leaving.value.code == 2
    assert desktop.OTHER_SYSTEM in capsys.readouterr().err
    assert everything(home) == before
