# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands of docs/farm.md: who can talk to a farm, and where it listens."""

import contextlib
import json
import re
import shlex
import socket
import subprocess

import distributed
import psutil
import pytest
from distributed.security import Security

from rppm_addon.commands.farm.cluster import is_open

from .conftest import ROOT, started, wait_for

PAGE = (ROOT / "docs/farm.md").read_text(encoding="utf-8")
SECTION = PAGE[PAGE.index("### Workers on other machines") : PAGE.index("## Farm managers")]


def commands(word):
    """The commands of the page that begin so, each as its words without assignments."""
    lines = [line for line in SECTION.splitlines() if re.match(rf"(\w+=\S+ )?{word}", line)]
    return [[part for part in shlex.split(line) if not re.match(r"[A-Z_]+=", part)] for line in lines]


def listening(process):
    """Addresses at which a process and those below it accept connections."""
    found = set()
    for one in [psutil.Process(process.pid), *psutil.Process(process.pid).children(recursive=True)]:
        with contextlib.suppress(psutil.Error):
            connections = one.net_connections("inet") if hasattr(one, "net_connections") else one.connections("inet")
            found |= {entry.laddr.ip for entry in connections if entry.status == psutil.CONN_LISTEN}
    return found


def test_what_the_page_says_listens_at_one_address():
    for program in ("dask scheduler", "dask worker"):
        (command,) = commands(program)
        assert command[command.index("--protocol") + 1] == "tls" and "--host" in command
        assert "--no-dashboard" in command
        assert command[command.index("--dashboard-address") + 1] == "127.0.0.1:0"
    assert "require-encryption: true" in SECTION


@pytest.mark.parametrize(
    ("address", "expected"),
    [
        ("tcp://10.0.0.1:8786", True), ("farm:8786", True), ("tcp://farm", True), ("tcp://127.0.0.1:8786", False),
        ("tcp://localhost:8786", False), ("tcp://[::1]:8786", False), ("tls://10.0.0.1:8786", False),
    ],
)  # fmt: skip
def test_addresses_that_need_no_key(address, expected):
    assert is_open(address) == expected


@pytest.mark.long
def test_the_recipe_for_tls(tmp_path):
    """As the page has it but for addresses and paths: who has no key gets nowhere, and nothing listens elsewhere."""
    (openssl,) = commands("openssl")
    subprocess.run(openssl, cwd=tmp_path, check=True, capture_output=True)
    (tmp_path / "dask").mkdir()
    text = re.search(r"```yaml\n(.*?)```", SECTION, re.DOTALL)[1].replace("/etc/rppm-farm", str(tmp_path))
    (tmp_path / "dask/farm.yaml").write_text(text, encoding="utf-8")

    def here(words):
        return [word.replace("10.0.0.1", "127.0.0.1").replace("10.0.0.2", "127.0.0.1") for word in words]

    (scheduler,), (worker,) = commands("dask scheduler"), commands("dask worker")
    file = tmp_path / "scheduler.json"
    variables = {"PYTHONPATH": str(ROOT), "DASK_CONFIG": str(tmp_path / "dask")}
    command = [*here(scheduler), "--port", "0", "--scheduler-file", str(file)]
    with started(command, tmp_path, **variables) as process:
        wait_for("the scheduler", lambda: file.exists() and file.read_text().endswith("}"))
        address = json.loads(file.read_text())["address"]
        assert address.startswith("tls://127.0.0.1:")
        words = [address if word.startswith("tls://") else word for word in here(worker)]
        with started(words, tmp_path, **variables) as other:
            key, certificate = str(tmp_path / "farm.key"), str(tmp_path / "farm.crt")
            security = Security(
                tls_ca_file=certificate, tls_client_cert=certificate, tls_client_key=key, require_encryption=True
            )
            with distributed.Client(address, security=security) as client:
                wait_for("the worker", lambda: len(client.scheduler_info()["workers"]) == 1)
                assert client.submit(sum, (1, 2)).result(30) == 3
            assert listening(process) == {"127.0.0.1"} and listening(other) == {"127.0.0.1"}
        for scheme in ("tcp", "tls"):
            with pytest.raises((OSError, TypeError)):  # Dask: TypeError for TLS without keys
                distributed.Client(f"{scheme}://{address.removeprefix('tls://')}", timeout=3)
        host, port = address.removeprefix("tls://").split(":")
        with socket.create_connection((host, int(port)), 5) as plain:
            plain.sendall(bytes(64))
            plain.settimeout(5)
            with contextlib.suppress(ConnectionError):
                assert plain.recv(4096)[:1] in (b"", b"\x15")  # the end, or TLS' alert
