"""Few keys for a recorded drag: equal moves of the slider divide their number by equal factors."""

from app.editor.work.track_keys import Recording
from app.rigging import FittedKeys, fit_keys

# Largest distance of the fitted motion from the recorded one without smoothing, in pixels of the
# screen like tremor. Each step multiplies it.
CLOSEST, STEP, STEPS = 0.3, 1.35, 24
FEWEST, LEAST = 0.07, 4.0  # keys with full smoothing: of a recorded frame, of a short recording


def fit_recording(
    take: Recording, values: list[complex], seam: int
) -> list[tuple[int, complex, complex]]:
    """Fit the recorded values by few keys; return their frames, places and velocities.

    Frames count on over the end of a loop. One key is at the end, `seam`, since the last frame of a
    loop is its first frame again. Without smoothing the motion is within `CLOSEST` of the hand's.
    """
    times = [sample.time for sample in take.samples]
    take.keep_fits_of((take.scale, values))

    def fit(step: int) -> FittedKeys:
        if step not in take.fits:
            tolerance = CLOSEST * STEP**step / take.scale
            take.fits[step] = fit_keys(times, values, tolerance, required=(seam,))
        return take.fits[step]

    most = len(fit(0).frames)
    fewest = min(max(FEWEST * (times[-1] - times[0]), LEAST), most)
    wanted = most * (fewest / most) ** take.smoothing
    low, high = 0, STEPS
    while low < high:
        middle = (low + high) // 2
        if len(fit(middle).frames) <= wanted + 0.5:
            high = middle
        else:
            low = middle + 1
    return list(zip(*(each.tolist() for each in fit(low)), strict=True))
