# SPDX-License-Identifier: GPL-3.0-or-later
"""rppm doctor: what it finds right and wrong, and what its report tells."""

from pathlib import Path

import numpy as np
import pytest

from rppm_addon.cli import main
from rppm_addon.self_test import checks, report
from rppm_addon.self_test.checks import BLOCK_TOLERANCE, MEAN_TOLERANCE, Finding, Speed, differences
from rppm_addon.self_test.ray_queries import TracedTriangles
from rppm_addon.self_test.report import SelfTest, report_text, run_self_test
from rppm_addon.session.render.renderer import Renderer

SPEED = Speed(1.0, 0.1, 0.01, 1e6, {"tracing": 2.0, "splatting": 1.0})


@pytest.mark.long
def test_rays_and_picture_are_right_here():
    assert checks.exact_rays(None).passed
    with Renderer() as renderer:
        finding = checks.picture(renderer)
    assert finding.passed, finding


def test_rays_that_hit_something_else_are_found(monkeypatch):
    trace = TracedTriangles.trace

    def almost(self, rays):
        hits = trace(self, rays)
        hits["distance"][5] = np.nextafter(hits["distance"][5], np.float32(9.0))
        return hits

    monkeypatch.setattr(TracedTriangles, "trace", almost)
    finding = checks.exact_rays(None)
    assert not finding.passed and finding.text.startswith("2 of ")


def test_a_picture_that_differs_is_found():
    reference = checks.reference()
    assert differences(reference, reference) == (0.0, 0.0)
    assert differences(1.04 * reference, reference)[0] > MEAN_TOLERANCE
    spotted = reference.copy()
    spotted[8:12, 8:12] = 0.0
    assert differences(spotted, reference)[1] > BLOCK_TOLERANCE


def test_a_device_that_is_not_there_is_told():
    found = run_self_test(lambda _fraction, _words: None, "no number")
    assert not found.passed and found.device is None
    assert "stopped: there is no device 'no number'" in report_text(found)


def test_the_report_names_no_home_and_says_what_failed(monkeypatch, context):
    monkeypatch.setattr(Path, "home", lambda: Path("/home/somebody"))
    findings = [Finding("Rays", True, "0 wrong"), Finding("Picture", False, "too dark")]
    found = SelfTest(context.information, findings, SPEED, ["warning: /home/somebody/cache cannot be written"])
    text = report_text(found)
    assert "passed    Rays: 0 wrong" in text and "FAILED    Picture: too dark" in text and "Not all is well" in text
    assert "somebody" not in text and "~/cache" in text and context.information.name in text
    assert "tracing 67%, splatting 33%" in text and "1.00 M" in text


@pytest.mark.parametrize(("passed", "status"), [(True, 0), (False, 1)])
def test_the_command_writes_it(tmp_path, monkeypatch, capsys, passed, status):
    found = SelfTest(None, [Finding("Rays", passed, "tried")], SPEED)
    monkeypatch.setattr(report, "run_self_test", lambda _on_progress, _device: found)
    assert main(["doctor", "-o", str(tmp_path / "new" / "report.txt")]) == status
    assert (tmp_path / "new" / "report.txt").read_text() in capsys.readouterr().out


@pytest.mark.long
def test_all_is_well_here():
    found = run_self_test(lambda _fraction, _words: None)
    assert found.passed and not found.problems, report_text(found)
    assert len(found.findings) == 5
