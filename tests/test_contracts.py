"""The layers of the project, as contracts on its imports."""

from importlinter.cli import lint_imports


def test_the_layers_keep_their_direction():
    assert lint_imports(config_filename="pyproject.toml", is_debug_mode=False) == 0
