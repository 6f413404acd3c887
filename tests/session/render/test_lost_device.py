# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders that go on where the device is lost, or the process that renders them."""

import dataclasses
import os
import signal

import numpy as np
import pytest
from session.conftest import children, open_viewport, rendered, scene_of, wait_until

from rppm_addon.gl.context.driver_errors import OUT_OF_MEMORY, DriverErrors
from rppm_addon.gl.context.losses import LossWatch
from rppm_addon.scene.errors import DeviceLostError
from rppm_addon.session.checkpoints import checkpoint_schedule
from rppm_addon.session.checkpoints.continuation import MOST_LOSSES
from rppm_addon.session.client.client import ProcessState
from rppm_addon.session.client.remote_rendering import RemoteRenderer
from rppm_addon.session.render.render_job import RenderJob
from rppm_addon.session.render.renderer import Renderer
from rppm_addon.session.transport.sessions import SessionKind

SAMPLES = 6


class Losses:
    """Has the next look at the device find it lost, once ``due`` is set."""

    def __init__(self, monkeypatch):
        self.due = False
        monkeypatch.setattr(LossWatch, "check", self._check)
        monkeypatch.setattr(checkpoint_schedule, "FIRST_SAFEGUARD_SECONDS", 0.0)
        monkeypatch.setattr(checkpoint_schedule, "SAFEGUARD_SECONDS", 0.0)
        monkeypatch.setattr(checkpoint_schedule, "SAFEGUARD_MOST_TIME", 1e6)

    def _check(self):
        if self.due:
            self.due = False
            raise DeviceLostError("the driver has reset the graphics device")


def driver(status=0, error=0, version=430, extensions=()):
    functions = {"glGetGraphicsResetStatus": lambda: status, "glGetError": lambda: error}

    def function(name, *_):
        return functions.get(name)

    return LossWatch(function, DriverErrors(function), version, set(extensions))


@pytest.mark.parametrize(
    "lost",
    [
        driver(status=0x8253, version=450),
        driver(status=0x8254, extensions=["GL_KHR_robustness"]),
        driver(error=0x0507),  # where the driver has no word for it
    ],
)
def test_a_lost_context_is_found(lost):
    with pytest.raises(DeviceLostError, match="reset"):
        lost.check()


def test_other_errors_are_no_loss():
    driver(version=450).check()
    driver(error=0x0502).check()


def test_who_asks_for_one_error_leaves_the_others():
    kept = [OUT_OF_MEMORY, 0x0502]
    errors = DriverErrors(lambda *_: lambda: kept.pop() if kept else 0)
    LossWatch(lambda *_: None, errors, 430, set()).check()
    assert not kept and errors.take(OUT_OF_MEMORY) and not errors.take(OUT_OF_MEMORY)
    kept += [OUT_OF_MEMORY, 0x0502]  # the other again, which nobody asks for
    assert errors.take(OUT_OF_MEMORY) and not kept


def test_a_render_goes_on_in_another_context(monkeypatch):
    scene, seen, handed_out = scene_of(SAMPLES), [], []
    losses, whole = Losses(monkeypatch), rendered(scene).combined

    def lose_after_three(progress, _):
        seen.append(progress.iteration)
        losses.due = seen == [0, 1, 2, 3]

    with Renderer() as renderer:
        take = {"snapshots": (0.0, 1e6), "on_snapshot": lambda mark, _: handed_out.append(mark)}
        result = renderer.render(scene, lose_after_three, **take)
    assert seen == [0, 1, 2, 3, 2, 3, 4, 5, 6] or seen == [0, 1, 2, 3, 3, 4, 5, 6]
    np.testing.assert_array_equal(result.frame.combined, whole)
    assert any("reset" in text and "after sample" in text for text in result.statistics.warnings)
    assert handed_out == [0.0]  # once


def test_a_device_that_is_lost_again_and_again_ends_the_render(monkeypatch):
    losses, began = Losses(monkeypatch), []

    def lose(*_):
        began.append(1)
        losses.due = True

    with Renderer() as renderer, pytest.raises(DeviceLostError):
        renderer.render(scene_of(SAMPLES), lose)
    assert len(began) == MOST_LOSSES + 1


class KillingJob(RenderJob):
    """Kills the process once it has handed over what another one needs, if ``process`` is given.

    A process hands its state over after the first iteration that ends after FIRST_SAFEGUARD_SECONDS: the state is there
    with the progress of the next one.
    """

    def __init__(self, process=None):
        self.process, self.iterations, self.late = process, [], 0

    def on_progress(self, progress):
        self.iterations.append(progress.iteration)
        self.late += progress.elapsed_seconds > checkpoint_schedule.FIRST_SAFEGUARD_SECONDS
        if self.process is not None and self.late > 1:
            self.process = None
            os.kill(children().pop(), signal.SIGKILL)
        return False


def test_another_process_goes_on_with_a_render(process):
    scene = scene_of(200)
    remote = RemoteRenderer(process, SessionKind.FINAL)
    whole = remote.render(scene, RenderJob())
    killing = KillingJob(process)
    again = remote.render(dataclasses.replace(scene, warnings=[]), killing)
    assert process.restarts == 1 and process.state is ProcessState.RUNNING
    begun = [
        later for earlier, later in zip(killing.iterations, killing.iterations[1:], strict=False) if later <= earlier
    ]
    assert len(begun) == 1 and begun[0] > 0
    np.testing.assert_array_equal(again.frame.combined, whole.frame.combined)
    assert any(f"after sample {begun[0]} in another process" in text for text in again.statistics.warnings)


def test_a_process_that_loses_the_device_says_so(start):
    process = start("loses_the_device")
    open_viewport(process)
    wait_until(lambda: process.state is ProcessState.FAILED)
    assert "reset the graphics device" in process.error
