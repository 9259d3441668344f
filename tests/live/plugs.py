"""Pulls each plug of a rig once: vehicle -> `moris live` -> controller, with emulators of both and of a browser.

    python3 tests/live/plugs.py [SECONDS] [--picture FILE]
    MORIS_PLUGS_RIG=crank-person python3 tests/live/plugs.py

Without a time the plugs follow each other at once; with one they are spread over it, as in a ride. Says what happened, and draws
it. Fails if a leg leaves its stroke or its speed, if the frames let a rider feel a jolt, or if an event has not the effect that
docs/live-reference.md names. The picture there is that of 150 s.

Vehicle, command and controller need a machine that keeps real time. Where a process wakes too late, a failure says nothing of the
command: the exit status is then 77, and the last line says so.
"""

import argparse
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import traceback
from collections import Counter
from pathlib import Path

from drawing import draw
from felt import jolts
from rig import INTERVAL, LOCKS, Browser, Controller, Live, Vehicle

from fuzz import packet

SHORT = 0.3  # s between the plugs without a time
MOST = 1.0  # largest change of the felt force within 20 ms; the vehicle's own force changes by less than 0.1 [m/s2]

MAX_LATENESS = 0.05  # s by which a process may wake too late: less than the silence that freezes the platform
NO_REAL_TIME = 77  # exit status, as of other programs for a test that cannot be run
LATENESS_PROBE = """
import sys, threading, time
ended, latest, last = threading.Event(), 0.0, time.monotonic()
threading.Thread(target=lambda: (sys.stdin.read(), ended.set()), daemon=True).start()
while not ended.is_set():
    time.sleep(0.005)
    now = time.monotonic()
    latest, last = max(latest, now - last - 0.005), now
print(latest)
"""
"""A process of its own that wakes every 5 ms, until its input ends, and prints by how much it was late at most [s]."""


class Ride:
    def __init__(self, seconds, directory):
        self.hold = seconds / 19 if seconds else SHORT
        self.pipe = directory / "recording"
        os.mkfifo(self.pipe)
        self.disk = threading.Event()
        threading.Thread(target=self.take_recording, daemon=True).start()
        self.controller = Controller(keeps=True)
        options = ["--engage", "--page", "--allow-control", "--record", str(self.pipe)]
        self.live = Live(self.controller, *options)
        self.address = self.live.wait_for("page: ").removeprefix("page: ")
        self.browser = Browser(self.address)
        self.vehicle = Vehicle(self.live.port)
        self.plugs = []
        self.begin = time.monotonic()

    def take_recording(self):
        with open(self.pipe, "rb") as recording:
            while not self.disk.is_set():
                recording.read1(65536)

    def mark(self, name):
        self.plugs.append((self.controller.rows[-1][0], name))

    def judge(self):
        """The largest jolt after each plug, from the frames alone."""
        rows, arrivals = list(self.controller.rows), list(self.controller.arrivals)
        found = jolts([at for at, _ in rows], [numbers for _, numbers in rows], arrivals, INTERVAL)
        marks = [(0.0, "the way up"), *self.plugs, (float("inf"), "")]
        for (begin, name), (end, _) in zip(marks, marks[1:]):
            jolt, at = max(((jolt, at) for jolt, at in found if begin < at <= end), default=(0.0, begin))
            times = [arrival for (time_, _), arrival in zip(rows, arrivals) if begin <= time_ <= end]
            gap = max((later - one for one, later in zip(times, times[1:])), default=0.0)
            print(f"  felt jolt {jolt:.2f} m/s2 at {at:.2f} s, at most {1e3 * gap:.0f} ms between frames: {name}")
        jolt, at = max(found)
        assert jolt <= MOST, f"the felt force changes by {jolt:.2f} m/s2 within 20 ms at {at:.2f} s"

    def runs_again(self, since):
        """Waits for the cue; in a long ride until it is whole."""
        self.live.wait_for(" s  engaging", since)
        if self.hold > SHORT:
            self.live.wait_for(" s  engaged", since)

    def pull(self, name, act, *effects):
        """Does something, waits for what it is said to cause, and holds until the next."""
        since, frames = len(self.live.said), self.controller.frames
        at = time.monotonic() - self.begin
        self.mark(name)
        act()
        for effect in effects:
            self.live.wait_for(effect, since)
        time.sleep(self.hold)
        said = Counter(text.split(" s  ", 1)[-1] for text in self.live.said[since:])
        said = "; ".join(text + (f" ({count} times)" if count > 1 else "") for text, count in said.items()) or "nothing is said"
        seen = f"{self.controller.frames - frames} frames; last {self.controller.last_word()}"
        print(f"{at:6.1f} s  {name:42} {said}; {seen}", flush=True)
        assert not self.controller.faults, self.controller.faults[:5]
        assert self.live.process.poll() is None

    def broken(self, spoil, seconds):
        """The vehicle sends what `spoil` makes of its lines for a while."""

        def act():
            self.vehicle.broken = spoil
            time.sleep(seconds)
            self.vehicle.broken = None

        return act

    def repeated(self, seconds):
        """The vehicle sends its last line on and on."""
        last = []

        def spoil(text):
            last.append(text)
            return last[0]

        return self.broken(spoil, seconds)

    def silent(self, seconds):
        def act():
            self.vehicle.runs = False
            time.sleep(seconds)
            self.vehicle.runs = True

        return act

    def without_controller(self):
        self.controller.is_open = False
        time.sleep(1.0)
        self.controller.is_open = True

    def second_vehicle(self):
        second = Vehicle(self.live.port)
        second.ahead = 1.7
        time.sleep(0.5)
        second.ended.set()

    def idle_connections(self):
        host, port = self.browser.own.removeprefix("http://").split(":")
        idle = [socket.create_connection((host, int(port))) for _ in range(30)]
        begin = time.monotonic()
        answer = self.browser.ask({"event": "start"})
        taken = time.monotonic() - begin
        assert answer == 200 and taken < 0.5, f"an order was answered with {answer} after {taken:.2f} s"
        [connection.close() for connection in idle]

    def burst(self, seconds):
        def act():
            self.vehicle.holds = True
            time.sleep(seconds)
            self.vehicle.holds = False
            time.sleep(1.0)

        return act

    def stopped(self, seconds):
        def act():
            self.live.interrupt(signal.SIGSTOP)
            time.sleep(seconds)
            self.live.interrupt(signal.SIGCONT)
            time.sleep(1.0)

        return act

    def without_page(self):
        self.browser.close()
        time.sleep(0.2)
        self.browser = Browser(self.address)

    def garbage(self):
        out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        for k in range(500):
            out.sendto(packet(k)[:60_000], ("127.0.0.1", self.live.port))
            time.sleep(0.002)

    def full_disk(self):
        self.disk.set()
        # Refused commands are recorded, too, and a block is written when it is full.
        for _ in range(1000):
            if any("the recording has ended" in text for text in self.live.said):
                break
            self.live.command("start")
            time.sleep(0.002)


def fields(place, value):
    """Replaces a field of a line."""

    def spoil(text):
        parts = text.split(",")
        parts[place:place + 1] = [value]
        return ",".join(parts)

    return spoil


def ride(seconds, picture):
    with tempfile.TemporaryDirectory() as directory:
        one = Ride(seconds, Path(directory))
        one.runs_again(0)
        if seconds:
            time.sleep(one.hold)
        one.pull("the vehicle is paused", one.broken(lambda text: text + ",1", 0.5), "telemetry: paused", " s  frozen", "telemetry: running")
        one.pull("the source repeats its last packet", one.repeated(1.0), "telemetry: paused", " s  frozen", "telemetry: running")
        one.pull("the source falls silent for 1 s", one.silent(1.0), "telemetry: silent", " s  frozen", " s  engaging")
        one.pull("NaN for 0.7 s", one.broken(fields(1, "nan"), 0.7), "telemetry: silent", " s  frozen", " s  engaging")
        one.pull("the source's clock stands for 0.7 s", one.broken(fields(0, "1"), 0.7), " s  engaging")

        def jump():
            one.vehicle.ahead += 1000.0

        # A glide is said where the cue was whole before.
        glide = [" s  engaging"] if seconds else []
        one.pull("the source's clock leaps by 1000 s", jump, *glide)
        one.pull("a teleport: the roll jumps by 1 rad", one.broken(fields(7, "1"), 0.5), *glide)
        one.pull("garbage on the source's port", one.garbage, "dropped: ")
        one.pull("the program is stopped for 0.5 s", one.stopped(0.5), "the computer was late by")
        one.pull("a line of commands that is no UTF-8", lambda: one.live.write(b"\xff\xfe\n"), "commands: ")
        one.pull("a second vehicle on the same port", one.second_vehicle, "telemetry comes from")
        one.pull("30 idle connections to the page", one.idle_connections)
        one.pull("packets are held up for 0.4 s", one.burst(0.4))
        one.pull("the controller is away for 1 s", one.without_controller, "CONTROLLER LOST", " s  fault")
        before = one.controller.frames
        one.pull("a person clears the fault", lambda: one.live.command("clear"), "legs: a slow start", " s  homing", " s  neutral")
        assert one.controller.frames > before + 100, "no frames after the fault was cleared"
        one.pull("a person engages again", lambda: one.live.command("engage"), " s  engaging")
        one.pull("the page is closed, and opened again", one.without_page)
        one.pull("the recording's disk is full", one.full_disk, "the recording has ended")
        one.pull("the source is away for 2 s", one.silent(2.0), " s  frozen", "telemetry: stale", " s  disengaging")
        since = len(one.live.said)
        one.mark("Ctrl-C")
        one.live.interrupt()
        one.live.wait_for(" s  parking", since)
        if not seconds:
            time.sleep(0.6)
            one.live.interrupt()
        one.live.wait_for(" s  off", since)
        status, printed = one.live.end()
        words = ["park", "stop"] if seconds else ["stop"]
        time.sleep(0.3)
        assert status != 0 and one.controller.words[-len(words):] == words, (status, one.controller.words)
        assert "panicked" not in "".join(one.live.said)
        one.vehicle.ended.set()
        one.controller.ended.set()
        said = (word + f" ({count} times)" * (count > 1) for word, count in Counter(one.controller.words).items())
        print(f"Ctrl-C: {', '.join(said)}; the recording's error is the exit status\n{printed}")
        one.judge()
        print(f"{one.controller.frames} frames, of which legs change by at most {one.controller.step / one.controller.most:.2f} of what is allowed")
        if picture:
            Path(picture).write_text(draw(one.controller.rows, one.live.states, one.plugs))


def ended_by(number):
    """A signal parks the platform, and the second one of a supervisor does not change that."""
    controller = Controller()
    live = Live(controller)
    live.command("start")
    live.wait_for(" s  neutral")
    live.interrupt(number)
    time.sleep(0.05)
    live.interrupt(number)
    time.sleep(0.6)
    if number != signal.SIGINT:
        live.interrupt(number)
    forecast = live.wait_for("parking takes")
    live.wait_for(" s  off")
    status, _ = live.end()
    controller.ended.set()
    assert status == 0 and controller.words[-2:] == ["park", "stop"], (status, controller.words)
    assert not controller.faults, controller.faults[:5]
    print(f"{signal.Signals(number).name}, three times: {forecast}; {', '.join(controller.words)}")


def deaf():
    """The readers of standard error and output are gone: orders are obeyed all the same."""
    controller = Controller()
    reader, writer = os.pipe()
    # A disk that takes nothing either.
    hangs = Path(LOCKS.name) / "hangs"
    os.mkfifo(hangs)
    disk = os.open(hangs, os.O_RDWR)
    live = Live(controller, "--engage", "--record", str(hangs), stderr=writer)
    os.close(writer)
    vehicle = Vehicle(live.port)
    time.sleep(0.5)
    os.close(reader)
    live.process.stdout.close()
    time.sleep(1.5)
    live.write(b"nonsense\n\xff\n")
    time.sleep(0.3)
    live.command("stop")
    time.sleep(0.3)
    frames = controller.frames
    time.sleep(0.3)
    live.interrupt()
    status = live.process.wait(30)
    os.close(disk)
    vehicle.ended.set()
    controller.ended.set()
    assert "stop" in controller.words and controller.frames == frames, controller.words
    print(f"no readers: {frames} frames, stop obeyed, exit status {status}")


def alone():
    """Nobody is at the controller's address: a fault within 0.5 s, and an exit status."""
    controller = Controller()
    controller.is_open = False
    time.sleep(0.5)
    live = Live(controller, "--page")
    browser = Browser(live.wait_for("page: ").removeprefix("page: "))
    begin = time.monotonic()
    live.command("start")
    live.wait_for("CONTROLLER LOST")
    taken = time.monotonic() - begin
    live.wait_for(" s  fault")
    time.sleep(0.2)
    assert browser.message["state"] == "fault" and browser.message["is_lost"], browser.message["state"]
    live.interrupt()
    status, _ = live.end()
    controller.ended.set()
    assert taken < 0.5 and status != 0, (taken, status)
    print(f"nobody at the controller: a fault after {taken:.2f} s, exit status {status}")


def two_sessions():
    """A second session with the same controller is refused."""
    controller = Controller()
    live = Live(controller)
    live.wait_for("commands: ")
    with tempfile.TemporaryDirectory() as other:
        # Of another user, or of a service with a folder of its own.
        for locks in (LOCKS.name, other):
            second = Live(controller, locks=locks)
            status, _ = second.end()
            assert status != 0 and any("another session" in text for text in second.said), second.said
    live.interrupt()
    live.end()
    controller.ended.set()
    print("a second session with the same controller: refused")


def killed():
    """After kill -9 there are no more frames: a controller must have its own time-out. A new session asks where the legs are."""
    controller = Controller()
    live = Live(controller)
    live.command("start")
    live.wait_for(" s  homing")
    time.sleep(0.3)
    live.process.kill()
    live.process.wait()
    time.sleep(0.2)
    frames = controller.frames
    time.sleep(0.3)
    left = controller.last_word()
    assert frames > 0 and controller.frames == frames and "stop" not in controller.words
    again = Live(controller)
    again.wait_for("--settled is not believed")
    again.wait_for("the legs' place is unknown")
    time.sleep(0.5)
    assert controller.frames == frames and "legs?" in controller.words, controller.words
    controller.last = None
    again.command("start")
    again.wait_for("legs: a slow start")
    again.wait_for(" s  neutral")
    again.interrupt()
    status, _ = again.end()
    controller.ended.set()
    assert status == 0 and not controller.faults, (status, controller.faults[:5])
    print(f"kill -9: {frames} frames, and no more, the last {left}; the next session asks where the legs are, and starts slowly")


def run_all(seconds, picture):
    ride(seconds, picture)
    of_linux = [signal.SIGPWR, signal.SIGRTMIN] if hasattr(signal, "SIGPWR") else []
    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGTRAP, *of_linux):
        ended_by(number)
    deaf()
    alone()
    two_sessions()
    killed()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("seconds", nargs="?", type=float, default=0.0, help="time over which the plugs are spread")
    parser.add_argument("--picture", help="SVG to draw")
    arguments = parser.parse_args()
    probe = subprocess.Popen([sys.executable, "-c", LATENESS_PROBE], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    try:
        run_all(arguments.seconds, arguments.picture)
    except Exception:
        lateness = float(probe.communicate()[0])
        if lateness <= MAX_LATENESS:
            raise
        traceback.print_exc()
        print(f"needs real time, but a process woke {1e3 * lateness:.0f} ms too late: python3 tests/live/plugs.py on an idle machine")
        sys.exit(NO_REAL_TIME)
    probe.communicate()
