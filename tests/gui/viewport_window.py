# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered viewport of a Blender window: waiting for it, and comparing it with final renders."""

import json
import time

import numpy as np
from blender_window import BlenderWindow, StepError, read_png

SIZE, WIDE = (320, 180), (480, 270)
"""Pixels of the viewport, about; and where two share them, or what it costs to show them is measured."""
ITERATIONS, PHOTONS = 4, 16384
"""Iterations and photons of the viewport and of final renders."""
BORDER = 8
"""Pixels at the edges of the viewport where Blender draws its rounded frame."""
IDLE_SHARE = 0.1
"""Share of moments at which the renderer process runs, below which it is at rest: it answers pings."""
REST_LOOKS, LOOK_SECONDS = 5, 0.3
"""How often in a row it is looked at, and for how long each time, until it is believed to be at rest."""


def arrange(blender: BlenderWindow, size: tuple[int, int] = SIZE) -> None:
    """A plain viewport of a size, the Properties editor on RPPM's settings, F12 without a window of its own."""
    blender.shrink("VIEW_3D", *size)
    blender.step("plain_viewport")
    blender.step("properties_tab", name="RENDER")
    blender.step("assign", path="bpy.context.preferences.view.render_display_type", value="NONE")
    blender.point_at("VIEW_3D")


def from_camera(blender: BlenderWindow, size: tuple[int, int] = SIZE) -> BlenderWindow:
    """A window whose viewport of a size is about to be rendered, from the camera."""
    arrange(blender, size)
    for name in ("samples", "preview_samples"):
        blender.step("assign", path=f"scene.rppm.{name}", value=ITERATIONS)
    for name in ("photons", "preview_photons"):
        blender.step("assign", path=f"scene.rppm.{name}", value=PHOTONS)
    blender.step("camera_view")
    return blender


def renderer_pid(blender: BlenderWindow) -> int:
    """The renderer process; raises StepError where there is not just one."""
    found = [pid for pid, command in blender.machine.processes().items() if command[-1].endswith("bootstrap.py")]
    if len(found) != 1:
        raise StepError(f"there are {len(found)} renderer processes:\n{blender.log()[-4000:]}")
    return found[0]


def wait_for_rest(blender: BlenderWindow, seconds: float = 240.0) -> None:
    """Wait until the renderer process has nothing left to do."""
    end = time.monotonic() + seconds
    pid = renderer_pid(blender)
    time.sleep(0.2)  # the change has arrived
    shares: list[float] = []
    while time.monotonic() < end:
        shares = [*shares, blender.machine.busy_share(pid, LOOK_SECONDS)][-REST_LOOKS:]
        if len(shares) == REST_LOOKS and sum(shares) / REST_LOOKS < IDLE_SHARE:
            return
    raise StepError(f"the viewport did not come to rest in {seconds:.0f} s:\n{blender.log()[-4000:]}")


def show_rendered(blender: BlenderWindow, seconds: float = 240.0) -> float:
    """Switch the viewport to Rendered and wait until it shows something new; returns how long it took, in seconds."""
    return latency(blender, "shading", seconds, kind="RENDERED")


def latency(blender: BlenderWindow, step: str, seconds: float = 60.0, /, **arguments: object) -> float:
    """Seconds from a step that changes the picture of a viewport at rest to the first new pixels on the screen."""
    for _ in range(20):
        blender.step("watch")
        blender.wait_until("drawn", 10.0)
        time.sleep(0.5)
        if blender.step("changed") is None:
            break
    else:
        raise StepError("the viewport does not come to rest")
    started = blender.step("clock")
    blender.step(step, **arguments)
    return blender.wait_until("changed", seconds) - started


def final_render(blender: BlenderWindow, name: str, seconds: float = 300.0) -> np.ndarray:
    """Press F12, and return the picture as Blender saves it."""
    before = blender.step("render_counts")["completed"]
    blender.point_at("VIEW_3D")
    blender.press("F12")
    blender.wait_until("render_counts", seconds, lambda counts: counts["completed"] > before)
    blender.step("save_result", path=f"/mnt/{name}.png")
    return read_png(blender.machine.folder / f"{name}.png")


def assert_alike(viewport: np.ndarray, final: np.ndarray) -> dict[str, float]:
    """Check that a viewport's pixels and a final render's agree: means of channels within 3 %, and what is where.

    Returns what was measured. The shapes are those of the viewport.
    """
    assert viewport.shape == final.shape
    one, other = (picture[BORDER:-BORDER, BORDER:-BORDER].astype(float) for picture in (viewport, final))
    means = np.abs(one.mean((0, 1)) / other.mean((0, 1)) - 1.0)
    correlation = np.corrcoef(blocks(one).ravel(), blocks(other).ravel())[0, 1]
    report = {"mean_difference": float(means.max()), "block_correlation": float(correlation)}
    assert means.max() < 0.03 and correlation > 0.99, report
    return report


def blocks(picture: np.ndarray, size: int = 16) -> np.ndarray:
    """Means of blocks of pixels, (rows, columns, 3); what is left at the right and below is dropped."""
    rows, columns = picture.shape[0] // size, picture.shape[1] // size
    cut = picture[: rows * size, : columns * size]
    return cut.reshape(rows, size, columns, size, 3).mean((1, 3))


def summary(values: list[float]) -> dict[str, float]:
    """Distribution of times."""
    if not values:
        return {"count": 0}
    half, most, maximum = (float(np.percentile(values, share)) for share in (50, 95, 100))
    return {"count": len(values), "p50": half, "p95": most, "max": maximum}


def distinct_pictures(seen: dict) -> int:
    """How often the watched pixels became others."""
    return sum(before != after for before, after in zip(seen["sums"], seen["sums"][1:]))


def report(blender: BlenderWindow, **measured: object) -> None:
    """Keep measurements in out/gui/TEST/measurements.json; the run prints them at its end."""
    path = blender.machine.folder / "measurements.json"
    kept = json.loads(path.read_text()) if path.exists() else {}
    path.write_text(json.dumps(kept | measured, indent=1))
