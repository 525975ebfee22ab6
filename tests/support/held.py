"""What this process holds that must be given back: files, threads, OpenGL objects, caches."""

import ctypes
import functools
import gc
import os
import sys
import threading
from pathlib import Path
from typing import NamedTuple

import moderngl

# OpenGL's names of them, in the singular and the plural; programs and shaders share their numbers.
GENERATED = {
    "Buffer": "Buffers",
    "Framebuffer": "Framebuffers",
    "Renderbuffer": "Renderbuffers",
    "Sampler": "Samplers",
    "Texture": "Textures",
    "VertexArray": "VertexArrays",
}
VERTEX_SHADER = 0x8B31
PAGE = os.sysconf("SC_PAGE_SIZE")
OURS = ("app.", "engine.")


class Held(NamedTuple):
    """How much of each is held."""

    files: int
    threads: int
    opengl: int
    cached: int  # entries of all caches of functions


def held(gl: moderngl.Context) -> Held:
    """Return what is held now; garbage is collected before."""
    gc.collect()
    return Held(
        files=len(os.listdir("/dev/fd")),  # noqa: PTH208 - their number alone
        threads=threading.active_count(),
        opengl=count_opengl(gl),
        cached=sum(cache.cache_info().currsize for cache in caches()),
    )


def caches() -> set["functools._lru_cache_wrapper[object]"]:
    """Return the caches of all functions and methods of the program that are loaded."""
    modules = [vars(module) for name, module in sys.modules.items() if name.startswith(OURS)]
    classes = [vars(each) for names in modules for each in names.values() if isinstance(each, type)]
    values = (value for names in (*modules, *classes) for value in names.values())
    return {value for value in values if isinstance(value, functools._lru_cache_wrapper)}


def count_opengl(gl: moderngl.Context) -> int:
    """Return how many objects there are in a context, whoever has lost sight of them."""
    with gl:
        load = gl.mglo._context.load_opengl_function
        pointer = ctypes.POINTER(ctypes.c_uint)
        count = 0
        for singular, plural in GENERATED.items():
            name = ctypes.c_uint()
            make = ctypes.CFUNCTYPE(None, ctypes.c_int, pointer)
            make(load(f"glGen{plural}"))(1, name)
            count += _count_named(load(f"glIs{singular}"), name.value)
            make(load(f"glDelete{plural}"))(1, name)
        last = ctypes.CFUNCTYPE(ctypes.c_uint, ctypes.c_uint)(load("glCreateShader"))(VERTEX_SHADER)
        count += sum(_count_named(load(f"glIs{kind}"), last) for kind in ("Program", "Shader"))
        ctypes.CFUNCTYPE(None, ctypes.c_uint)(load("glDeleteShader"))(last)
    return count


def _count_named(is_one: int, last: int) -> int:
    """Return how many numbers below the last one given name an object."""
    tell = ctypes.CFUNCTYPE(ctypes.c_ubyte, ctypes.c_uint)(is_one)
    return sum(map(tell, range(1, last)))


def resident() -> float:
    """Return the memory of this process, in MB."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * PAGE / 1e6


class _Mallinfo(ctypes.Structure):
    """Of glibc's `mallinfo2`, over all arenas."""

    _fields_ = tuple(
        (name, ctypes.c_size_t)
        for name in (
            *("arena", "ordblks", "smblks", "hblks", "hblkhd"),
            *("usmblks", "fsmblks", "uordblks", "fordblks", "keepcost"),
        )
    )


def in_use() -> float:
    """Return the memory that was asked for and not given back, in MB, without Python's objects.

    What a process takes besides is what its allocator keeps for later.
    """
    tell = ctypes.CDLL(None).mallinfo2
    tell.restype = _Mallinfo
    info = tell()
    return (info.uordblks + info.hblkhd) / 1e6
