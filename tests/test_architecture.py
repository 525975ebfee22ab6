"""The rooms of the project: their layers, their size, and the faces by which they are entered."""

import ast
import re
import tomllib
from functools import cache
from itertools import chain
from pathlib import Path

import pytest
from importlinter.cli import lint_imports

from app.cli.main import COMMANDS

ROOT = Path(__file__).parents[1]
ROOTS = ("app", "engine")
MOST_IN_A_ROOM = 12  # modules and sub-packages together
MOST_LOOSE = 5  # modules beside the packages of app and engine
# Rooms whose modules are found by their names, and that nothing else imports from.
BY_NAME = {"app.cli", "app.cli.commands", "app.cli.usage"}

# Modules whose functions are only called by the module's name: the verbs of actions and commands,
# and the ways in to panels and to the parts of the command line.
VERBS = (
    "app.editor.actions.",
    "app.editor.layering.",
    "app.editor.tools.",
    "app.document.commands.",
    "app.cli.",
    "app.ui.",
)

# Calls that say what a thing is, and compute nothing.
# That BLAS keeps to one thread is said once for all that the engine does.
DECLARATIONS = {"RigidMotion", "TypeVar", "field", "get_args", "threadpool_limits"}
# Ready motions are data, of these kinds of values.
DECLARATIONS |= {"BodyKind", "Curve", "Gait", "Leap", "Limbs", "Motion", "Swell", "Wave", "even"}
DECLARATIONS |= {"MappingProxyType"}


def module_files() -> dict[str, Path]:
    """Return the file of every module and package, by its dotted name."""
    files = {}
    for path in chain.from_iterable((ROOT / root).rglob("*.py") for root in ROOTS):
        parts = path.relative_to(ROOT).with_suffix("").parts
        files[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return files


FILES = module_files()
PACKAGES = sorted(name for name, path in FILES.items() if path.name == "__init__.py")


@cache
def parsed(name: str) -> ast.Module:
    return ast.parse(FILES[name].read_text(encoding="utf-8"))


def test_the_layers_keep_their_direction():
    assert lint_imports(config_filename="pyproject.toml", is_debug_mode=False) == 0


def test_the_readmes_have_the_levels_of_the_contracts():
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    layers = {
        tuple(contract["containers"]): contract["layers"]
        for contract in settings["tool"]["importlinter"]["contracts"]
        if contract["type"] == "layers"
    }
    numbers: list[int] = []
    for root in ("engine", "app"):
        levels = [
            [f"{root}.{name.strip()}" for name in re.split(r"[|:]", layer)]
            for layer in reversed(layers[root,])
        ]
        readme = (ROOT / root / "README.md").read_text(encoding="utf-8")
        rows = re.findall(r"^\| (\d+) \| ((?:`[\w.]+`(?:, )?)+) \|", readme, flags=re.MULTILINE)
        assert [re.findall(r"`([\w.]+)`", rooms) for _, rooms in rows] == levels
        numbers += [int(number) for number, _ in rows]
    # The program's levels go on where the engine's end.
    assert numbers == list(range(1, len(numbers) + 1))


@pytest.mark.parametrize("package", PACKAGES)
def test_a_room_can_be_seen_at_a_glance(package):
    folder = FILES[package].parent
    modules = {path.stem for path in folder.glob("*.py")} - {"__init__", "__main__"}
    rooms = {path.parent.name for path in folder.glob("*/__init__.py")}
    # Commands are seen at a glance in their table, which has a module for each.
    most = len(COMMANDS) if package in {"app.cli.commands", "app.cli.usage"} else MOST_IN_A_ROOM
    assert len(modules | rooms) <= most
    if package in ROOTS:
        assert len(modules) <= MOST_LOOSE


@pytest.mark.parametrize("package", PACKAGES)
def test_a_room_says_what_goes_in_what_comes_out_and_what_it_imports(package):
    text = ast.get_docstring(parsed(package)) or ""
    for what in ("In: ", "Out: ", "Imports: "):
        assert f"\n{what}" in text, f"{package} does not say {what!r}"


@pytest.mark.parametrize("package", PACKAGES)
def test_a_face_has_nothing_but_public_names(package):
    docstring, *statements = parsed(package).body
    assert isinstance(docstring, ast.Expr)
    for statement in statements:
        assert isinstance(statement, (ast.ImportFrom, ast.Assign))


@pytest.mark.parametrize("name", sorted(FILES))
def test_a_room_is_entered_by_its_face(name):
    for node in ast.walk(parsed(name)):
        if not isinstance(node, ast.ImportFrom) or (node.module or "").split(".")[0] not in ROOTS:
            continue
        module = node.module or ""
        package = module if module in PACKAGES else module.rpartition(".")[0]
        is_inside = name == package or name.startswith(f"{package}.")
        if is_inside or package in ROOTS or package in BY_NAME:
            continue
        assert module == package, f"{name} imports from {module}, not from {package}"
        for alias in node.names:
            is_room = f"{module}.{alias.name}" in PACKAGES
            assert is_room or alias.name in public_names(package), (
                f"{name} takes {alias.name} from {package}, whose face does not have it"
            )


@pytest.mark.parametrize("name", sorted(name for name in FILES if name.startswith("engine")))
def test_the_engine_computes_nothing_when_it_is_loaded(name):
    for statement in parsed(name).body:
        if isinstance(statement, ast.FunctionDef):
            continue
        inside = statement.body if isinstance(statement, ast.ClassDef) else [statement]
        calls = [
            ast.unparse(node.func)
            for part in inside
            if not isinstance(part, ast.FunctionDef)
            for node in ast.walk(part)
            if isinstance(node, ast.Call)
        ]
        assert set(calls) <= DECLARATIONS


@cache
def public_names(package: str) -> set[str]:
    """Return what a face shows: what it imports by its own name, and its tables."""
    body = parsed(package).body
    imports = (alias for node in body if isinstance(node, ast.ImportFrom) for alias in node.names)
    tables = (ast.unparse(node.targets[0]) for node in body if isinstance(node, ast.Assign))
    return {alias.asname for alias in imports if alias.asname is not None} | set(tables)


def defined_names(name: str) -> tuple[set[str], set[str]]:
    """Return the public classes and type aliases of a module, and its public functions."""
    types, functions = set(), set()
    for node in parsed(name).body:
        if isinstance(node, ast.ClassDef):
            types.add(node.name)
        elif isinstance(node, ast.FunctionDef):
            functions.add(node.name)
        elif isinstance(node, (ast.Assign, ast.AnnAssign)) and not (
            node.value is None or isinstance(node.value, ast.Call)
        ):
            target = ast.unparse(node.targets[0] if isinstance(node, ast.Assign) else node.target)
            is_alias = target[0].isupper() and not target.isupper()
            # An abbreviation of a library's own name is no other name.
            if is_alias and not ast.unparse(node.value).endswith(f".{target}"):
                types.add(target)
    return ({n for n in types if n[0] != "_"}, {n for n in functions if n[0] != "_"})


def test_a_type_has_a_name_of_its_own():
    seen: dict[str, str] = {}
    for name in FILES:
        for defined in defined_names(name)[0]:
            assert seen.setdefault(defined, name) == name, f"{defined} in {seen[defined]}, {name}"


def test_a_function_that_a_face_shows_has_a_name_of_its_own():
    seen: dict[str, str] = {}
    for name in FILES:
        if name.startswith(VERBS):
            continue
        package = name if name in PACKAGES else name.rpartition(".")[0]
        for function in defined_names(name)[1] & public_names(package):
            where = seen.setdefault(function, name)
            assert where == name, f"{function} in {where}, {name}"


def test_the_engine_is_tested_without_the_program():
    support = {path.stem: path for path in (ROOT / "tests" / "support").glob("*.py")}
    waiting = list((ROOT / "tests" / "engine").rglob("*.py"))
    seen = set()
    while waiting:
        path = waiting.pop()
        seen.add(path)
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            for name in names:
                assert name.split(".")[0] != "app", f"{path} imports {name}"
                if name in support and support[name] not in seen:
                    waiting.append(support[name])
