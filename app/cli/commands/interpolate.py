"""`lissom interpolate`: in-betweens of harmonic maps at points, from file to file."""

import argparse
from pathlib import Path

import numpy as np

from app.errors import LissomError
from app.storage import check_writable, read_arrays, write_arrays

EPILOG = """\
MAPS.npz holds
  outline    (p,)    complex  the domain's boundary, simple, counter-clockwise
  cage       (n,)    complex  the polygon of the Cauchy coordinates around it, counter-clockwise
  phi, psi   (q, n)  complex  coefficients of the keyframes f = Phi + conj(Psi), q >= 2
  points     (m,)    complex  where the in-betweens are wanted, in the closed domain
  anchor     ()      complex  optional: the point whose position and arg f_z are linear in time;
                              by default the centre of the largest disc in the domain
  triangles  (t, 3)  int      optional: triangles of the points; integration follows their edges

Keyframe i is at time i. OUT.npz gets times (s,), anchor, and one row for each time of
  positions, fz, fzbar  (s, m)  complex128  f, f_z and the derivative of f by conj(z) at the points
  rho                   (s,)    float64     with scaled-eta: the scaling of eta, 1 at keyframes

examples:
  lissom interpolate maps.npz --variant metric --times 0,0.25,0.5,0.75,1 --out frames.npz
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `lissom interpolate`."""
    parser.epilog = EPILOG
    parser.add_argument("maps", metavar="MAPS.npz", type=Path, help="domain, keyframes and points")
    parser.add_argument(
        "--variant",
        required=True,
        choices=("nu", "eta", "scaled-eta", "metric", "linear"),
        help="how the keyframes are blended",
    )
    parser.add_argument(
        "--times",
        required=True,
        metavar="T,T,...",
        type=_times,
        help="in [0, q - 1], in any order, separated by commas",
    )
    parser.add_argument("--out", metavar="OUT.npz", type=Path, required=True, help="where to write")


def run(arguments: argparse.Namespace) -> int:
    """Read maps, interpolate them and write the in-betweens."""
    from engine.interpolation import prepare  # noqa: PLC0415 - `--help` need not load it
    from engine.maps import HarmonicMap  # noqa: PLC0415

    check_writable(arguments.out)
    data = read_arrays(
        arguments.maps,
        required=("outline", "cage", "phi", "psi", "points"),
        optional=("anchor", "triangles"),
    )
    phi, psi = data["phi"], data["psi"]
    if phi.ndim != 2 or phi.shape != psi.shape or phi.shape[1:] != data["cage"].shape:
        raise LissomError(
            "phi and psi must both be of shape (keyframes, cage vertices); they are of shape "
            f"{phi.shape} and {psi.shape}, with a cage of shape {data['cage'].shape}"
        )
    _require_in_range(arguments.times, len(phi))
    prepared = prepare(
        [HarmonicMap(cage=data["cage"], phi=a, psi=b) for a, b in zip(phi, psi, strict=True)],
        data["points"],
        outline=data["outline"],
        variant=arguments.variant,
        triangles=data.get("triangles"),
        anchor=data.get("anchor"),
    )
    frames = [prepared.frame(time) for time in arguments.times]
    results = {
        "times": np.array(arguments.times),
        "anchor": np.array(prepared.sites.anchor),
        "positions": np.array([frame.positions for frame in frames]),
        "fz": np.array([frame.fz for frame in frames]),
        "fzbar": np.array([frame.fzbar for frame in frames]),
    }
    if arguments.variant == "scaled-eta":
        results["rho"] = np.array([frame.rho for frame in frames])
    write_arrays(arguments.out, results)
    return 0


def _times(text: str) -> tuple[float, ...]:
    try:
        return tuple(float(word) for word in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a list of numbers separated by commas"
        ) from None


def _require_in_range(times: tuple[float, ...], keyframes: int) -> None:
    """Refuse times before any long computation."""
    for time in times:
        if keyframes >= 2 and not 0 <= time <= keyframes - 1:
            raise LissomError(
                f"time {time:g} is out of range: {keyframes} keyframes span the times from 0 to "
                f"{keyframes - 1}"
            )
