"""What goes into the bundle beside what PyInstaller sees by itself, and what stays out of it."""

import sys
from typing import Final

# Packages all of whose modules are taken: Lissom finds its commands by their names, and ModernGL
# finds glcontext, which finds its backends, when a context is made.
WHOLE: Final = ("app", "engine", "glcontext", "zlib_ng")
# Imported within functions only, or by libraries out of sight.
HIDDEN: Final = (
    *("av", "psd_tools", "matplotlib.figure", "matplotlib.backends.backend_agg"),
    *("imgui_bundle.glfw_utils", "_miniaudio", "_cffi_backend"),
)
# Whose names, versions and licences the program or its user may ask for.
DISTRIBUTIONS: Final = (
    *("lissom", "numpy", "scipy", "pillow", "shapely", "contourpy", "zlib-ng", "threadpoolctl"),
    "miniaudio",
    *("moderngl", "glcontext", "glfw", "imgui-bundle", "av", "psd-tools", "matplotlib"),
    *("attrs", "cycler", "fonttools", "kiwisolver", "packaging", "pyparsing", "python-dateutil"),
)
# Of the assets of Dear ImGui Bundle, what the window asks for, with the licences.
FONTS: Final = (
    "assets/fonts/Roboto/*",
    "assets/fonts/Inconsolata*",
    "assets/fonts/Font_Awesome_6_Free-Solid-900.otf",
)
# What libraries do without, and Lissom never asks them for: parts of SciPy that none of its modules
# loads, windows of others, what develops and tests, and what reaches a network.
UNWANTED: Final = (
    *("scipy.stats", "scipy.signal", "scipy.io", "scipy.integrate", "scipy.cluster", "scipy.odr"),
    *("scipy.datasets", "scipy.misc", "scipy.fftpack", "scipy.differentiate", "numpy.distutils"),
    *("matplotlib.tests", "matplotlib.testing", "imgui_bundle.demos_python"),
    *("PIL.ImageTk", "PIL.ImageQt", "tkinter", "_tkinter", "PyQt5", "PyQt6", "PySide2", "PySide6"),
    *("gi", "wx", "IPython", "jupyter", "pytest", "hypothesis", "setuptools", "pip", "tornado"),
    *("pandas", "skimage", "aggdraw", "curses", "readline", "sqlite3", "ssl", "_ssl"),
)
# Files that would be taken with a package: samples and styles of its own, and GLFW a second time.
SPARED: Final = (
    *("imgui_bundle/demos_assets", "imgui_bundle/demos_cpp", "imgui_bundle/demos_python"),
    *("imgui_bundle/assets/images", "imgui_bundle/assets/app_settings"),
    *("imgui_bundle/assets/fonts/latex", "glfw/x11", "glfw/wayland"),
    *("matplotlib/mpl-data/sample_data", "matplotlib/mpl-data/images"),
)
# Libraries of the system that graphics drivers load as well. An older one in the bundle would come
# first and keep a newer driver from loading, so that the system's own is used.
SYSTEMS: Final = (
    ("libstdc++", "libgcc_s", "libmvec", "libz.", "libexpat", "libX", "libxcb", "libbsd", "libmd.")
    if sys.platform == "linux"
    else ()
)
