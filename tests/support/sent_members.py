# SPDX-License-Identifier: GPL-3.0-or-later
"""Record of the members of scenes that go to the renderer's process."""

import pytest

from rppm_addon.session.client.child_process import ChildProcess


def watch_sent_members(monkeypatch: pytest.MonkeyPatch) -> dict[tuple[int, int], set[str]]:
    """By session and number of a scene, the members that are sent from now on."""
    sent: dict[tuple[int, int], set[str]] = {}
    original = ChildProcess._send_part

    def watch(self, kind, session, number, part, **content):
        sent.setdefault((session, number), set()).update(part.document if kind == "members" else ())
        original(self, kind, session, number, part, **content)

    monkeypatch.setattr(ChildProcess, "_send_part", watch)
    return sent
