"""`moris live` between an emulated vehicle, an emulated controller and an emulated browser. For the scripts beside this file."""

import json
import math
import os
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import urllib.error
import urllib.request
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "examples"))
from vehicle import line  # noqa: E402

LIVE = [os.environ["MORIS"], "live"] if "MORIS" in os.environ else ["cargo", "run", "--quiet", "--bin", "moris-live", "--"]
# The time between frames of the form csv [s].
INTERVAL = 0.01
# Linux's option for the time at which a packet arrived, however late it is read.
TIMESTAMP = 35 if sys.platform == "linux" else None

# The machine: a rig of examples/rigs.
RIG = os.environ.get("MORIS_PLUGS_RIG", "default")

# Where locks of controllers lie: those of earlier runs would say how the last session of a port has ended.
LOCKS = tempfile.TemporaryDirectory()


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


def machine(name):
    """A rig of examples/rigs, its actuators' stroke, and their largest speed [m, m/s]: arcs of the arms where it has cranks."""
    import tomllib  # of Python 3.11

    rig = tomllib.loads((ROOT / "examples" / "rigs" / f"{name}.toml").read_text())
    if "crank" not in rig:
        legs = rig["actuator"]
        return rig, (legs["minLength"], legs["maxLength"]), legs["velocityLimit"]
    crank = rig["crank"]
    ends = (crank["arm"] * math.radians(crank[f"{end}AngleDegrees"]) for end in ("min", "max"))
    return rig, tuple(ends), crank["arm"] * crank["velocityLimit"]


class Controller:
    """Receives frames of the form csv; holds what a controller may not see, and all numbers if it `keeps` them."""

    def __init__(self, keeps=False):
        _, self.stroke, speed = machine(RIG)
        # The largest speed with the steps between two frames lost, and the largest change from frame to frame [m/s, m].
        self.fastest, self.most = 1.05 * speed, 1.2 * speed * INTERVAL
        self.port = free_port()
        self.frames = 0
        self.keeps = keeps
        self.rows = []
        self.arrivals = []
        self.words = []
        self.word = "nothing"
        self.last = None
        self.step = 0.0
        self.gap = 0.0
        self.speed = 0.0
        self.faults = []
        self.is_open = True
        self.ended = threading.Event()
        threading.Thread(target=self.receive, daemon=True).start()

    def receive(self):
        while not self.ended.is_set():
            if not self.is_open:
                self.last = None
                time.sleep(0.05)
                continue
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
                # Frames wait for a script that waits for a processor: what is lost is lost by the command.
                taken.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
                taken.bind(("127.0.0.1", self.port))
                taken.settimeout(0.2)
                if TIMESTAMP:
                    taken.setsockopt(socket.SOL_SOCKET, TIMESTAMP, 1)
                while self.is_open and not self.ended.is_set():
                    try:
                        frame, stamps, _, _ = taken.recvmsg(2000, 64)
                    except TimeoutError:
                        continue
                    seconds, nanos = struct.unpack("ll", stamps[0][2]) if stamps else (time.time(), 0)
                    self.take(frame.decode(), seconds + 1e-9 * nanos)

    def take(self, frame, arrival):
        if "," not in frame:
            self.word = frame.strip()
            self.words.append(self.word)
            return
        now, *numbers = map(float, frame.split(","))
        self.word = "frame"
        legs = numbers[:6]
        self.frames += 1
        if not all(self.stroke[0] - 1e-6 <= leg <= self.stroke[1] + 1e-6 for leg in legs):
            self.faults.append(f"{now} s: a leg beyond its stroke: {legs}")
        if self.last:
            step = max(abs(leg - before) for leg, before in zip(legs, self.last[1]))
            self.step = max(self.step, step)
            self.gap = max(self.gap, arrival - self.last[2])
            self.speed = step / INTERVAL
            if step > self.most:
                self.faults.append(f"{now} s: a leg {1e3 * step:.1f} mm from the last frame")
        if self.last and now > self.last[0]:
            fastest = max(abs(leg - before) for leg, before in zip(legs, self.last[1])) / (now - self.last[0])
            if fastest > self.fastest:
                self.faults.append(f"{now} s: a leg at {fastest:.2f} m/s")
        self.last = now, legs, arrival
        if self.keeps:
            self.rows.append((now, numbers))
            self.arrivals.append(arrival)

    def last_word(self):
        """The last message, and the speed of its legs."""
        return f"{self.word}, legs at {self.speed:.3f} m/s" if self.word == "frame" else self.word


class Vehicle:
    """Sends the drive of examples/vehicle.py at 60 Hz, or what `broken` makes of a line."""

    def __init__(self, port):
        self.port = port
        self.runs = True
        self.ahead = 0.0
        self.broken = None
        self.holds = False  # lines are kept, and sent at once afterwards
        self.ended = threading.Event()
        threading.Thread(target=self.send, daemon=True).start()

    def send(self):
        out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        begin, held = time.monotonic(), []
        while not self.ended.wait(1 / 60):
            if self.runs:
                text = line(time.monotonic() - begin + self.ahead)
                held.append((self.broken(text) if self.broken else text).encode())
            while held and not self.holds:
                out.sendto(held.pop(0), ("127.0.0.1", self.port))


class Live:
    """The command. Lines that it says are in `said`."""

    def __init__(self, controller, *options, source=None, stderr=subprocess.PIPE, settled=True, locks=LOCKS.name):
        self.port = free_port()
        source = source or ["--from", f"udp:{self.port}", "--format", "csv"]
        command = [*LIVE, *source, "--rig", RIG, "--to", f"udp:127.0.0.1:{controller.port}", *["--settled"] * settled, *options]
        self.process = subprocess.Popen(
            command,
            cwd=ROOT,
            env=os.environ | {"TMPDIR": locks},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=stderr,
        )
        self.said = []
        self.state = "off"
        self.states = []
        self.news = threading.Condition()
        self.listener = threading.Thread(target=self.listen, daemon=True) if stderr == subprocess.PIPE else None
        if self.listener:
            self.listener.start()

    def listen(self):
        for text in self.process.stderr:
            text = text.decode()
            with self.news:
                self.said.append(text.strip())
                at, _, word = text.strip().rpartition(" s  ")
                if word in STATES:
                    self.state = word
                    self.states.append((float(at), word))
                self.news.notify_all()

    def wait_for(self, words, since=0, patience=60):
        """The first line from `since` on that ends with these words."""
        end = time.monotonic() + patience
        with self.news:
            while True:
                found = [text for text in self.said[since:] if words in text]
                if found:
                    return found[0]
                left = end - time.monotonic()
                assert left > 0 and self.news.wait(left), f"not said: {words}; said: {self.said[-20:]}"

    def command(self, name):
        self.write(name.encode() + b"\n")

    def write(self, text):
        self.process.stdin.write(text)
        self.process.stdin.flush()


    def interrupt(self, number=signal.SIGINT):
        self.process.send_signal(number)

    def end(self):
        """The exit status and what was printed. All that was said is in `said` then."""
        out = self.process.stdout.read().decode()
        status = self.process.wait()
        if self.listener:
            self.listener.join()
        return status, out

    def resident(self):
        """Resident memory [kB]."""
        status = Path(f"/proc/{self.process.pid}/status").read_text()
        return int(next(text for text in status.splitlines() if text.startswith("VmRSS")).split()[1])


STATES = ("off", "settled", "homing", "neutral", "engaging", "engaged", "frozen", "disengaging", "parking", "fault")


class Browser:
    """A page: reads its messages on a thread, and sends orders."""

    def __init__(self, address):
        self.own, self.token = address.split("/?token=")
        self.events = urllib.request.urlopen(f"{self.own}/events?token={self.token}", timeout=30)
        self.welcome = self.next()
        self.message = {}
        threading.Thread(target=self.read, daemon=True).start()

    def next(self):
        return json.loads(next(text for text in self.events if text.startswith(b"data: ")).removeprefix(b"data: "))

    def read(self):
        try:
            while True:
                self.message = self.next() or self.message
        except (OSError, ValueError, StopIteration, AttributeError):
            return

    def close(self):
        self.events.close()

    def ask(self, order, **headers):
        """The number of the answer."""
        body = json.dumps({"client": self.welcome["client"], "ask": order}).encode()
        request = urllib.request.Request(f"{self.own}/ask", body, {"X-Token": self.token, "Origin": self.own} | headers)
        try:
            with urllib.request.urlopen(request, timeout=10) as answer:
                return answer.status
        except urllib.error.HTTPError as refused:
            return refused.code
