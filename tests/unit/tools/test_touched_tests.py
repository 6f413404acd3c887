# SPDX-License-Identifier: GPL-3.0-or-later
"""Which tests a change asks for."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools"))
from touched_tests import MOST_FILES, PARITY, ROOMS, bounded, touched  # noqa: E402

sys.path.remove(str(ROOT / "tools"))


@pytest.fixture
def checkout(tmp_path):
    files = {
        "tests/support/floor.py": "",
        "tests/parity/scenes.py": "from support.floor import lay",
        "tests/parity/lights/test_lights.py": "from ..scenes import light",
        "tests/parity/features/measure.py": "from ..scenes import light",
        "tests/parity/features/lighting/lamps.py": "",
        "tests/parity/features/test_features.py": "from . import measure\nfrom .lighting import lamps",
        "tests/gl/scenes.py": "",
        "tests/gl/surfaces/test_bsdf.py": "import scenes",
        "tests/gl/density_estimation/test_seeds.py": "import math",
        "tests/gl/conftest.py": "",
        "tests/cli/test_info.py": "",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


FEATURES, LIGHTS = "tests/parity/features/test_features.py", "tests/parity/lights/test_lights.py"
BSDF, SEEDS, INFO = (
    "tests/gl/surfaces/test_bsdf.py",
    "tests/gl/density_estimation/test_seeds.py",
    "tests/cli/test_info.py",
)


@pytest.mark.parametrize(
    ("changed", "expected"),
    [
        ("tests/gl/density_estimation/test_seeds.py", [SEEDS]),
        ("tests/gl/scenes.py", [BSDF]),  # not those of the module's namesake
        ("tests/support/floor.py", [FEATURES, LIGHTS]),
        ("tests/parity/features/measure.py", [FEATURES]),
        ("tests/parity/features/lighting/lamps.py", [FEATURES]),  # of a folder beside those that import it
        ("tests/gl/conftest.py", [SEEDS, BSDF]),
        ("shaders/film/passes.comp", [SEEDS, BSDF, LIGHTS]),
        ("shaders/materials/nodes/math.glsl", [FEATURES, LIGHTS]),
        ("rppm_addon/commands/info.py", [INFO]),
        ("tests/parity/references/test_lights.npz", [LIGHTS]),
        ("README.md", []),
    ],
)
def test_what_a_change_asks_for(checkout, changed, expected):
    assert touched([changed], checkout) == expected


def test_rooms_are_there():
    """Everything that the table names is in the checkout, and a room comes before the one that it is part of."""
    rooms = list(ROOMS)
    for number, room in enumerate(rooms):
        assert (ROOT / room).is_dir()
        assert not any(room.startswith(earlier) for earlier in rooms[:number])
        assert all(list(ROOT.glob(pattern)) for pattern in ROOMS[room])
    parity = {path.parent.name for path in (ROOT / "tests/parity").glob("*/__init__.py")}
    assert parity == {"features", *PARITY}


def test_more_than_ci_has_time_for_is_left_to_hand(tmp_path, capsys):
    """But for what was changed itself."""
    names = [f"test_{number}.py" for number in range(MOST_FILES + 2)]
    for name in names:
        (tmp_path / name).write_text("@pytest.mark.long" if name != names[0] else "", encoding="utf-8")
    assert bounded(names[:-1], [], tmp_path) == names[1:-1] and not capsys.readouterr().err
    for changed, kept in (([], []), (names[:3], names[1:3]), (names, [])):
        assert bounded(names, changed, tmp_path) == kept and "make test-long" in capsys.readouterr().err
