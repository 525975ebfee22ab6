"""The window: the session, what is drawn with OpenGL, and the loop around them."""

import io
import os
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
from imgui_bundle import glfw_utils, hello_imgui  # before glfw: it brings the library itself
from imgui_bundle import icons_fontawesome_6 as icons
from PIL import Image

import glfw  # isort: skip

from app.document import Pose
from app.editor import Action, FileDialog, Session, do, layering
