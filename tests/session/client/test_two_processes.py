# SPDX-License-Identifier: GPL-3.0-or-later
"""Two Blenders at once, each with its renderer's process; they share programs' folder, log and user."""

import os
import signal
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from session.conftest import children, rendered, scene_of

from rppm_addon.session.client.remote_rendering import RemoteRenderer
from rppm_addon.session.render.render_job import RenderJob
from rppm_addon.session.transport.sessions import SessionKind


class KillsAnother(RenderJob):
    """Ends another process when it has come to its second sample."""

    def __init__(self, victim):
        self.victim = victim

    def on_progress(self, progress):
        if progress.iteration == 2 and self.victim is not None:
            os.kill(self.victim, signal.SIGKILL)
            self.victim = None
        return False


def test_neither_disturbs_the_other(start):
    scene = scene_of(3)
    expected = rendered(scene).combined
    first, second = (RemoteRenderer(start(), SessionKind.FINAL) for _ in range(2))
    first.render(scene, RenderJob())
    (pid,) = children()
    with ThreadPoolExecutor(2) as pool:
        for result in pool.map(lambda remote: remote.render(scene, RenderJob()), (first, second)):
            np.testing.assert_array_equal(result.frame.combined, expected)
    assert first.process.log_path == second.process.log_path and len(children()) == 2
    job = KillsAnother(pid)
    np.testing.assert_array_equal(second.render(scene, job).frame.combined, expected)
    assert job.victim is None and second.process.restarts == 0
