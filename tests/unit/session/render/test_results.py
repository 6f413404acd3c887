# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of renders, as the command line writes them and as processes exchange them."""

import dataclasses

import pytest

from rppm_addon.gl.context.context import DeviceInformation
from rppm_addon.gl.context.devices import Device
from rppm_addon.session.render.results import PhotonStatistics, Progress, RenderStatistics
from rppm_addon.session.transport.protocol import ProtocolError
from rppm_addon.session.transport.received import received
from rppm_addon.session.transport.sessions import SessionStatus

PHOTONS = PhotonStatistics(0.25, "GRID", "TRACED", {"Lamp": 5.0}, {"Lamp": 64})


def test_the_figures_of_photons_are_beside_the_others_in_json():
    statistics = RenderStatistics(1, 64, 3.0, 2.0, "a device", 5, PHOTONS, warnings=["w"])
    assert statistics.as_dict() == {
        "iterations": 1, "photons": 64, "seconds": 3.0, "build_seconds": 2.0, "device": "a device", "triangles": 5,
        "radius_meters": 0.25, "density_estimation": "GRID", "first_photon_hits": "TRACED", "noise": 0.0,
        "stage_seconds": {}, "memory_bytes": {}, "flux_watts": {}, "source_watts": {"Lamp": 5.0},
        "source_photons": {"Lamp": 64}, "warnings": ["w"],
    }  # fmt: skip


@pytest.mark.parametrize(
    "record",
    [
        SessionStatus(3, progress=Progress(1, 2, 3.0, 4), photon_statistics=PHOTONS, warnings=["w"]),
        SessionStatus(),
        RenderStatistics(1, 64, 3.0, 2.0, "a device", 5, PHOTONS),
        DeviceInformation("a device", "Mesa", "4.6", {"GL_MAX": 5}, number=0, devices=[Device(0, "software", "", "a")]),
    ],
)
def test_records_come_through_a_pipe_as_they_are(record):
    assert received(type(record), dataclasses.asdict(record)) == record


@pytest.mark.parametrize(
    ("status", "field"),
    [
        ({"mood": 1}, "mood"),
        ({"progress": 5}, ""),
        ({"progress": {}}, "Progress"),
        ({"progress": dataclasses.asdict(Progress("many", 2, 1.0, 5))}, "iteration"),
        ({"progress": dataclasses.asdict(Progress(1, 2, 1.0, 5, noise=None))}, "noise"),
        ({"photon_statistics": {"radius_meters": "wide"}}, "radius_meters"),
        ({"photon_statistics": {"radius_meters": 0.1, "source_watts": {"a": "b"}}}, "source_watts"),
        ({"warnings": [5]}, "warnings"),
    ],
)
def test_other_values_are_refused(status, field):
    with pytest.raises(ProtocolError, match=f"no SessionStatus came .*{field}"):
        received(SessionStatus, status)


def test_rates_are_those_while_rendering():
    progress = Progress(4, 8, 6.0, 4000, build_seconds=2.0)
    assert progress.rendering_seconds == 4.0 and progress.photons_per_iteration == 1000
    assert progress.iterations_per_second == 1.0 and progress.photons_per_second == 1000.0
    assert Progress(0, 8, 6.0, 0).photons_per_second == 0.0
