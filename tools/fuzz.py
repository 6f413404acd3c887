# SPDX-License-Identifier: GPL-3.0-or-later
"""Gives the ways into RPPM what nobody means for so many minutes: tests/fuzz, each round with another seed.

python tools/fuzz.py MINUTES [SEED]: prints cases by way in, and the seed of a round in which something broke. What is
found becomes a test; hypothesis keeps its examples in .hypothesis and tries them first.
"""

import os
import random
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
COUNTS = ROOT / "out/fuzz/counts.txt"
EXAMPLES = 100
ROUND_SECONDS = 3600
"""A round that takes longer hangs; a case is ended long before that (tests/fuzz/counting.py)."""


def main() -> int:
    """Do it; the exit status is 1 where something broke."""
    minutes = float(sys.argv[1])
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else random.SystemRandom().randrange(1 << 30)
    COUNTS.parent.mkdir(parents=True, exist_ok=True)
    COUNTS.unlink(missing_ok=True)
    environment = os.environ | {"RPPM_FUZZ_EXAMPLES": str(EXAMPLES), "RPPM_FUZZ_COUNTS": str(COUNTS)}
    started, rounds, broken = time.monotonic(), 0, []
    while time.monotonic() - started < 60.0 * minutes:
        command = [sys.executable, "-m", "pytest", "-n", "0", "-q", "tests/fuzz", f"--hypothesis-seed={seed + rounds}"]
        try:
            status = subprocess.run(command, cwd=ROOT, env=environment, timeout=ROUND_SECONDS, check=False).returncode
        except subprocess.TimeoutExpired:
            status = -1
        if status:
            broken.append(seed + rounds)
        rounds += 1
    given, refused = Counter[str](), Counter[str]()
    for line in COUNTS.read_text(encoding="utf-8").splitlines():
        way, cases, no = line.split()
        given[way] += int(cases)
        refused[way] += int(no)
    print(f"\n{rounds} rounds of {(time.monotonic() - started) / 60.0:.1f} minutes in all, from the seed {seed} on")
    print("\n| way in | cases | refused |\n|---|---|---|")
    for way in sorted(given):
        print(f"| {way.replace('-', ' ')} | {given[way]} | {refused[way]} |")
    print(f"| all | {sum(given.values())} | {sum(refused.values())} |")
    print(f"\nbroken: {', '.join(f'seed {number}' for number in broken) or 'nothing'}")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
