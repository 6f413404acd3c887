# SPDX-License-Identifier: GPL-3.0-or-later
"""Packages are installed as they are locked, whatever an index offers beside them."""

import hashlib
import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

INSTALLER = Path(__file__).resolve().parents[3] / ".ci" / "install_locked.py"


def make_wheel(folder, name, version, *requires, extras=()):
    """A wheel with an empty module; the line that locks it."""
    lines = [f"Name: {name}", f"Version: {version}", *(f"Provides-Extra: {extra}" for extra in extras)]
    lines += [f"Requires-Dist: {requirement}" for requirement in requires]
    file, info = folder / f"{name}-{version}-py3-none-any.whl", f"{name}-{version}.dist-info"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr(f"{name}.py", f"VERSION = {version!r}\n")
        archive.writestr(f"{info}/METADATA", "\n".join(["Metadata-Version: 2.1", *lines, ""]))
        archive.writestr(f"{info}/WHEEL", "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n")
        archive.writestr(f"{info}/RECORD", "")
    return f"{name}=={version} --hash=sha256:{hashlib.sha256(file.read_bytes()).hexdigest()}\n"


@pytest.fixture(scope="module")
def index(tmp_path_factory):
    """Folder of wheels in two versions, in which the extra of b that a asks for needs c, and lines that lock them."""
    folder = tmp_path_factory.mktemp("index")
    lines = {}
    for version in ("1.0", "2.0"):
        lines["rppm_a", version] = make_wheel(folder, "rppm_a", version, "rppm_b[more]>=1.0")
        lines["rppm_b", version] = make_wheel(folder, "rppm_b", version, 'rppm_c; extra == "more"', extras=("more",))
        lines["rppm_c", version] = make_wheel(folder, "rppm_c", version, 'rppm_d; python_version < "3"')
    return folder, lines


@pytest.fixture(scope="module")
def python(tmp_path_factory):
    folder = tmp_path_factory.mktemp("environment")
    subprocess.run([sys.executable, "-m", "venv", folder], check=True, timeout=120)
    return folder / "bin" / "python"


def install(python, index, lock):
    """Installs a lock where the index alone can be reached; the finished process."""
    code = (
        f"import sys; sys.path.insert(0, {str(INSTALLER.parent)!r}); from pathlib import Path; import install_locked\n"
        f"try:\n    install_locked.install(Path({str(lock)!r}))\n"
        "except install_locked.LockError as error:\n    sys.exit(str(error))\n"
    )
    variables = os.environ | {"PIP_NO_INDEX": "1", "PIP_FIND_LINKS": str(index), "PIP_CONFIG_FILE": os.devnull}
    return subprocess.run([python, "-c", code], env=variables, capture_output=True, text=True, timeout=120)


def installed(python):
    listed = subprocess.run([python, "-m", "pip", "list", "--format=json"], capture_output=True, text=True, check=True)
    return {row["name"].replace("-", "_"): row["version"] for row in json.loads(listed.stdout)}


def test_an_index_with_newer_versions_changes_nothing(python, index, tmp_path):
    folder, lines = index
    (tmp_path / "lock.txt").write_text("".join(lines[name, "1.0"] for name in ("rppm_a", "rppm_b", "rppm_c")))
    run = install(python, folder, tmp_path / "lock.txt")
    assert run.returncode == 0, run.stderr
    found = installed(python)
    assert [found.get(name) for name in ("rppm_a", "rppm_b", "rppm_c", "rppm_d")] == ["1.0", "1.0", "1.0", None]


def test_a_lock_without_what_an_extra_needs_is_refused(python, index, tmp_path):
    folder, lines = index
    (tmp_path / "lock.txt").write_text(lines["rppm_a", "1.0"] + lines["rppm_b", "1.0"])
    run = install(python, folder, tmp_path / "lock.txt")
    assert run.returncode == 1
    assert "rppm-b needs rppm_c" in run.stderr and "run make lock" in run.stderr


def test_another_file_of_the_version_is_refused(python, index, tmp_path):
    folder, lines = index
    (tmp_path / "lock.txt").write_text(lines["rppm_a", "1.0"].replace("1.0", "2.0"))
    run = install(python, folder, tmp_path / "lock.txt")
    assert run.returncode == 1 and run.stderr.count("\n") == 1
    assert "pip could not install lock.txt" in run.stderr


def test_the_lock_of_set_up_has_all_that_its_packages_need():
    sys.path.insert(0, str(INSTALLER.parent))
    try:
        import install_locked
    finally:
        sys.path.remove(str(INSTALLER.parent))
    assert install_locked.unmet_requirements((INSTALLER.parent / "locks" / "setup.txt").read_text()) == []
