# SPDX-License-Identifier: GPL-3.0-or-later
"""The lock of set-up, .ci/requirements.txt: every Python package that it installs, with its version and hashes.

python tools/lock.py makes it anew from pyproject.toml, keeping versions that still do; --check says, without a network,
whether it has what pyproject.toml pins, a hash for each package and no place to get them from.
"""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LOCK = ROOT / ".ci/requirements.txt"
EXTRAS = ("blender", "farm", "test")
HEADER = """# SPDX-License-Identifier: GPL-3.0-or-later
# What make setup installs, by version and hash; python tools/lock.py makes it from pyproject.toml.
"""
_PIN = re.compile(r"^([A-Za-z0-9._-]+)==(\S+)(.*?)(?=^\S|\Z)", re.MULTILINE | re.DOTALL)
_HASH = re.compile(r"--hash=sha256:[0-9a-f]{64}\b")


def problems(lock: str, project: str) -> list[str]:
    """What is wrong with the text of a lock, by that of pyproject.toml; a line each."""
    table = tomllib.loads(project)["project"]
    wanted = [*table["dependencies"], *(name for extra in EXTRAS for name in table["optional-dependencies"][extra])]
    found = {_plain(name): (version, hashes) for name, version, hashes in _PIN.findall(lock)}
    wrong = []
    for requirement in wanted:
        name, _, version = requirement.partition("==")
        if found.get(_plain(name), ("nothing", ""))[0] != version:
            wrong.append(f"{requirement} is not in the lock; run python tools/lock.py")
    wrong += [f"{name} has no hash" for name, (_, hashes) in found.items() if not _HASH.search(hashes)]
    if "://" in lock or re.search(r"^-", lock, re.MULTILINE):
        wrong.append("the lock names a place to get packages from; it is the user's to choose")
    return wrong


def _plain(name: str) -> str:
    """A package's name as PyPI compares it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def main() -> int:
    """Make or check the lock; the exit status is 1 where it is wrong."""
    if "--check" not in sys.argv[1:]:
        extras = [word for extra in EXTRAS for word in ("--extra", extra)]
        options = ["--generate-hashes", "--no-emit-index-url", "--no-emit-find-links", "--no-header", "--no-annotate"]
        command = [sys.executable, "-m", "uv", "pip", "compile", "pyproject.toml", *extras, *options]
        command += ["--python-version", "3.11", "--quiet", "--output-file", str(LOCK)]
        subprocess.run(command, cwd=ROOT, check=True)
        LOCK.write_text(HEADER + LOCK.read_text(encoding="utf-8").removeprefix(HEADER), encoding="utf-8")
    wrong = problems(LOCK.read_text(encoding="utf-8"), (ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    for line in wrong:
        sys.stderr.write(f"{LOCK.relative_to(ROOT)}: {line}\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
