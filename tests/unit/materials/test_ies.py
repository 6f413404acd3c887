# SPDX-License-Identifier: GPL-3.0-or-later
"""IES profiles as tables; the parity suite compares their values with Cycles'."""

import numpy as np
import pytest

from rppm_addon.materials.ies import ProfileError, profile_table

HEAD = "IESNA:LM-63-1995\r\n[LUMINAIRE] a lamp, of a kind\r\nTILT=NONE\r\n"
WATTS = 4.0 * np.pi / 177.83


def parts(text):
    """Angles in degrees and intensities in candela, (horizontal, vertical), without what is there for interpolation."""
    table = profile_table(text)
    rows, columns = int(table[0]), int(table[1])
    angles, intensity = table[2 : 2 + rows + columns], table[2 + rows + columns :].reshape(rows + 2, columns + 2)
    return np.degrees(angles[:rows]), np.degrees(angles[rows:]), intensity[1:-1, 1:-1] / WATTS


def test_factors_multiply():
    around, down, candela = parts(
        HEAD + "2 500 3.0 2 2 1 1 0 0 0\r\n0.5 0.25, 60\r\n0 180\r\n0 360\r\n100 200\r\n100 200"
    )
    np.testing.assert_allclose(around, [0, 360])
    np.testing.assert_allclose(down, [0, 180])
    np.testing.assert_allclose(candela, 3.0 * 0.5 * 0.25 * np.array([[100, 200]] * 2), rtol=1e-6)


def test_a_quarter_stands_for_all():
    around, _, candela = parts(HEAD + "1 500 1 1 3 1 1 0 0 0 1 1 60\n0\n0 30 90\n1 2 3")
    np.testing.assert_allclose(around, [0, 30, 90, 150, 180, 210, 270, 330, 360], rtol=1e-6)
    np.testing.assert_allclose(candela[:, 0], [1, 2, 3, 2, 1, 2, 3, 2, 1], rtol=1e-6)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "TILT="),
        ("IESNA:LM-63-1995\nTILT=NONE\n1 1 1 2 1 1 1 0 0 0 1 1 60\n0 90\n0\n1", "ends before"),
        ("IESNA:LM-63-1995\nTILT=NONE\n1 1 1 one 1 1 1 0 0 0 1 1 60\n0 90\n0\n1", "something else"),
        ("IESNA:LM-63-1995\nTILT=NONE\n1 1 1 1 1 7 1 0 0 0 1 1 60\n0\n0\n1", "type is 7"),
        ("IESNA:LM-63-1995\nTILT=NONE\n1 1 1 0 0 1 1 0 0 0 1 1 60\n", "no angles"),
        ("IESNA:LM-63-1995\nTILT=NONE\n1 1 1 nan 1 1 1 0 0 0 1 1 60\n", "not finite"),
        ("IESNA:LM-63-1995\nTILT=NONE\n1 1 1 99999999 99999999 1 1 0 0 0 1 1 60\n0 1", "ends before"),
    ],
)
def test_what_is_no_profile(text, reason):
    with pytest.raises(ProfileError, match=reason):
        profile_table(text)
