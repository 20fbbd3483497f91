"""Attacks on the server of `trackbed view` by the clients of tests/data/view/clients.toml."""

import http.client
import re
import socket
import subprocess
import time
import tomllib

from .outputs import good_results
from .scenes import TINY
from .verdict import ROOT, SOON

# Server memory limit [kB], as in the test suite.
MEMORY = 120_000


def memory(process):
    """Peak memory of a process [kB]; 0 if unknown."""
    try:
        text = open(f"/proc/{process}/status", encoding="utf-8").read()
    except OSError:
        return 0
    found = re.search(r"VmHWM:\s+(\d+)", text)
    return int(found.group(1)) if found else 0


def send(client, port):
    """Sends all that the server accepts."""
    stream = socket.create_connection(("127.0.0.1", port), timeout=SOON)
    reads = client.get("reads", True)
    stream.settimeout(SOON if reads else 0.2)
    head, fill, tail = (client.get(key, "").replace("{port}", str(port)).encode() for key in ("head", "fill", "tail"))
    left, once = client.get("times", 0), max(1, 65536 // max(1, len(fill)))
    try:
        stream.sendall(head)
        while left > 0:
            stream.sendall(fill * min(left, once))
            left -= once
        stream.sendall(tail)
    except OSError:
        pass
    stream.settimeout(SOON)
    return stream


def status(stream):
    """Response status; 0 if closed without one."""
    head = b""
    try:
        while len(head) < 13 and (piece := stream.recv(13 - len(head))):
            head += piece
        return int(head.split(b" ")[1])
    except (OSError, IndexError, ValueError):
        return 0


def clients(bench, rng):
    """After each client a good request must succeed, within the memory limit."""
    out = good_results(bench, [TINY[0]])[TINY[0][0]]
    all_clients = tomllib.loads((ROOT / "tests/data/view/clients.toml").read_text())["client"]
    rng.shuffle(all_clients)
    words = [bench.program, "view", str(out), "--no-open"]
    server = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        port = int(re.search(r"127\.0\.0\.1:(\d+)", server.stdout.readline()).group(1))
        for client in all_clients:
            bench.attempts += 1
            streams = [send(client, port) for _ in range(client.get("clients", 1))]
            found = {status(stream) for stream in streams} if client.get("reads", True) else set()
            begun = time.monotonic()
            try:
                good = http.client.HTTPConnection("127.0.0.1", port, timeout=SOON)
                good.request("GET", "/folders")
                response = good.getresponse().status
                good.close()
            except OSError as error:
                response = repr(error)
            bench.longest = max(bench.longest, time.monotonic() - begun)
            wrong = [f"statuses {found}"] if not found <= set(client.get("status", [])) else []
            wrong += [f"a good request gets {response}"] if response != 200 else []
            wrong += [f"{memory(server.pid)} kB"] if memory(server.pid) > MEMORY else []
            wrong += [f"exit code {server.poll()}"] if server.poll() is not None else []
            if wrong:
                bench.fault(words, f"client {client['name']!r}: {', '.join(wrong)}")
            for stream in streams:
                stream.close()
            yield
    finally:
        server.kill()
        server.communicate()
