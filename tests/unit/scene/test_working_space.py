# SPDX-License-Identifier: GPL-3.0-or-later
"""Working spaces against the matrices that their standards and OpenColorIO's configs print."""

import numpy as np
import pytest

from rppm_addon.scene.common.working_space import ACESCG, REC709, REC2020, WORKING_SPACES, space_of

PRINTED = {
    "ACEScg": [(0.6130974, 0.3395231, 0.0473795), (0.0701937, 0.9163539, 0.0134524), (0.0206156, 0.1095698, 0.8698147)],
    "Linear Rec.2020": [
        (0.6274039, 0.3292830, 0.0433131), (0.0690973, 0.9195404, 0.0113623), (0.0163914, 0.0880133, 0.8955953),
    ],
}  # fmt: skip


@pytest.mark.parametrize("name", list(PRINTED))
def test_colors_of_rec709_are_those_of_printed_matrices(name):
    space = WORKING_SPACES[name]
    assert pytest.approx(np.array(PRINTED[name]), abs=1e-6) == space.from_rec709(np.eye(3)).T
    assert space.to_rec709(space.from_rec709(np.eye(3))) == pytest.approx(np.eye(3), abs=1e-9)
    assert space.from_rec709(np.ones(3, np.float32)).dtype == np.float32


def test_white_is_white_and_luminance_is_that_of_xyz():
    for space in (REC709, REC2020, ACESCG):
        assert space.luminance.sum() == pytest.approx(1.0)
        assert space.from_rec709(np.ones(3)) == pytest.approx(np.ones(3))
        assert space.luminance @ space.from_rec709(np.array([0.2, 0.5, 0.1])) == pytest.approx(
            REC709.luminance @ [0.2, 0.5, 0.1]
        )


def test_rec709_converts_nothing_and_other_spaces_define_how():
    colors = np.array([[0.25, 0.5, 0.75]])
    assert REC709.from_rec709(colors) is colors and REC709.to_rec709(colors) is colors
    assert REC709.defines == {}
    assert ACESCG.defines["WORKING_LUMINANCE"] == "vec3(0.26767218, 0.67433999, 0.05798783)"
    assert str(ACESCG.defines["REC709_TO_WORKING"]).startswith("mat3(0.61309740, 0.07019372, 0.02061559,")


def test_files_name_their_space():
    assert [space_of(space.interop_id) for space in WORKING_SPACES.values()] == list(WORKING_SPACES.values())
    assert space_of("of another program") is REC709
