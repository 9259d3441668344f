"""Sends what is wrong to the sockets of `moris live`: telemetry, requests and orders.

    python3 tests/live/fuzz.py [SECONDS]

The command with telemetry and the command with the page's motorcycle get half of the time each. It must go on, keep its legs
within their limits, need no more memory, and obey afterwards.
"""

import json
import random
import socket
import sys
import time

from rig import Browser, Controller, Live, Vehicle, line

PARAMETERS = ["scale.specificForce.x", "tilt.angleLimit", "tilt.rateLimit", "splitter.x.omega1", "strategy", "actuator.maxLength", "", "../x"]
NUMBERS = [0, 1, -1, 0.3, 1e-300, 1e300, -1e9, float("nan"), float("inf"), 2**63]


def noise(most):
    return random.randbytes(random.randrange(most))


def packet(t):
    """Telemetry that is no line, or a line with something wrong."""
    text = line(t).encode()
    kind = random.randrange(6)
    if kind == 0:
        return noise(2000)
    if kind == 1:
        fields = text.split(b",")
        fields[random.randrange(len(fields))] = random.choice([b"nan", b"inf", b"-1e308", b"", b"9" * 400, b"\xff", b"1e99999"])
        return b",".join(fields)
    if kind == 2:
        return text[: random.randrange(len(text))]
    if kind == 3:
        return line(random.uniform(-1e6, 1e6)).encode()
    if kind == 4:
        place = random.randrange(len(text))
        return text[:place] + noise(8) + text[place + 1 :]
    return text * random.randrange(1, 30)


def order():
    """An order that is none, or may be one."""
    number = lambda: random.choice(NUMBERS + [random.uniform(-1.5, 1.5)])  # noqa: E731
    return random.choice(
        [
            {"event": random.choice(["start", "engage", "disengage", "park", "clear", "fault", "arrived", "", 7, None])},
            {"set": {random.choice(PARAMETERS): number() for _ in range(random.randrange(4))}},
            {"drive": {"throttle": number(), "brake": number(), "stick": number(), "is_helped": random.choice([True, False, 1])}},
            {"drive": {"throttle": random.random(), "brake": random.random() / 3, "stick": random.uniform(-1, 1), "is_helped": True}},
            "begin_again",
            random.choice([[], {}, None, 3, "x", {"set": []}, {"file": "/etc/passwd"}]),
        ]
    )


def connect(browser):
    """Bytes on a connection: some read the answer, some leave, some stay for a while."""
    host, port = browser.own.removeprefix("http://").split(":")
    stream = socket.create_connection((host, int(port)), timeout=5)
    heads = [b"", b"GET / HTTP/1.1\r\n", b"POST /ask HTTP/1.1\r\nContent-Length: ", f"GET /?token={browser.token} HTTP/1.1\r\n".encode()]
    try:
        stream.sendall(random.choice(heads) + noise(random.choice([10, 1000, 40_000])) + random.choice([b"", b"\r\n\r\n"]))
        if random.random() < 0.3:
            stream.settimeout(0.2)
            stream.recv(1000)
    except OSError:
        pass
    return stream


def fuzz(seconds, source=None):
    controller = Controller()
    live = Live(controller, "--page", "--allow-control", source=source)
    address = live.wait_for("page: ").removeprefix("page: ")
    browser = Browser(address)
    vehicle = Vehicle(live.port)
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    begin, counts, held, resident = time.monotonic(), [0, 0, 0], [], None
    while (passed := time.monotonic() - begin) < seconds:
        assert live.process.poll() is None, live.said[-20:]
        for _ in range(20):
            try:
                out.sendto(packet(passed)[:60_000], ("127.0.0.1", live.port))
                counts[0] += 1
            except OSError:
                pass
        asked = time.monotonic()
        try:
            answer = browser.ask(order())
            assert answer in (200, 400, 403, 413, 422, 503), answer
        except OSError as lost:
            # A request of more than a second is closed: on a busy computer this script may be so slow.
            closed = isinstance(getattr(lost, "reason", lost), ConnectionError)
            assert closed and time.monotonic() - asked > 1.0, lost
        counts[1] += 1
        held.append(connect(browser))
        counts[2] += 1
        if len(held) > 4:
            held.pop(0).close()
        if passed > min(60, seconds / 2) and resident is None:
            resident = live.resident()
        time.sleep(0.01)
    [stream.close() for stream in held]
    grown = live.resident() - resident
    # A state that any order leads out of: then up, and to the end.
    vehicle.ended.set()
    since = len(live.said)
    if live.state == "fault":
        live.command("clear")
    live.interrupt()
    live.wait_for(" s  off", since)
    status, printed = live.end()
    controller.ended.set()
    assert status == 0 and not controller.faults, controller.faults[:5]
    assert grown < 4096, f"{grown} kB more"
    slips = [text for text in live.said if "panicked" in text]
    assert not slips, slips
    print(f"{passed:.0f} s: {counts[0]} packets, {counts[1]} orders, {counts[2]} connections; {controller.frames} frames; {grown} kB more memory")
    print(printed, flush=True)


if __name__ == "__main__":
    duration = float(sys.argv[1]) if len(sys.argv) > 1 else 8.0
    random.seed(json.dumps(sys.argv))
    fuzz(duration / 2)
    fuzz(duration / 2, source=["--from", "ride"])
