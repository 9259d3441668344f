"""What the page of `moris live` does, with a computed drive as its source. Run by run.py:

    live.py BROWSER PAGES PICTURES MORIS...
"""

import csv
import socket
import subprocess
import sys
import threading
from contextlib import contextmanager
from pathlib import Path

from runner import MORIS, PAGES, PHONE, PICTURES, check, picture, run_all, waiter, watched_at

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "examples"))
from vehicle import line  # noqa: E402

wait = waiter("simulationLive", "now, strips, sliders, driving, machine, latenessInWords")


def drive(port, ended):
    """The drive of examples/vehicle.py, at 60 Hz."""
    vehicle = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    k = 0
    while not ended.wait(1 / 60):
        vehicle.sendto(line(k / 60).encode(), ("127.0.0.1", port))
        k += 1


@contextmanager
def live(*options, source=None):
    """The command with its source, the drive or another one; yields the page's address."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    chosen = source or ["--from", f"udp:{port}", "--format", "csv"]
    command = [*MORIS, "live", *chosen, "--dry", "--page", *options]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    ended = threading.Event()
    try:
        address = next(said.removeprefix("page: ").strip() for said in process.stderr if said.startswith("page: "))
        threading.Thread(target=process.stderr.read, daemon=True).start()
        threading.Thread(target=drive, args=(port, ended), daemon=True).start()
        yield address
    finally:
        ended.set()
        process.stdin.write("stop\n")
        process.terminate()
        process.wait()


@contextmanager
def opened(browser, address, **options):
    """The page, running; fails if it says anything on the console or asks another place."""
    own = address.split("?")[0]
    # A command that is refused is an answer that the browser tells of.
    with watched_at(browser, address, lambda url: url.startswith(own), expected="422", **options) as page:
        wait(page, "now.view !== null")
        yield page


def value(parameter):
    """A parameter's value beside its slider, as an expression."""
    return f"sliders.values[sliders.data.parameters.findIndex(({{ name }}) => name === '{parameter}')]"


@check
def buttons_and_keys_command_and_everything_moves(browser):
    with live() as address, opened(browser, address) as page:
        assert page.locator("#state").inner_text() == "off"
        page.locator("[data-event=start]").click()
        wait(page, "now.state === 'neutral'")
        page.keyboard.press("e")
        wait(page, "now.state === 'engaging' || now.state === 'engaged'")
        before = {selector: picture(page, selector) for selector in ("#view", "#surge", "#sway")}
        page.keyboard.press("r")
        wait(page, "now.state === 'engaged'")
        wait(page, "Math.max(...strips.surge.points.map((one) => Math.abs(one[2]))) > 0.3")
        for selector, old in before.items():
            assert picture(page, selector) != old, selector
        wait(page, "document.getElementById('journal').textContent.includes('engaged')")
        assert page.locator("#late tbody tr").count() > 0
        with page.expect_download() as download:
            page.keyboard.press("r")
        file = PAGES / "live.csv"
        download.value.save_as(file)
        page.screenshot(path=PICTURES / "live-desktop.png", full_page=True)
        page.keyboard.press("p")
        wait(page, "now.state === 'parking'")
        page.keyboard.press("Escape")
        wait(page, "now.state === 'off'")
    with open(file, newline="") as recorded:
        rows = [[float(value) for value in row] for row in list(csv.reader(recorded))[1:]]
    steps = [later[0] - earlier[0] for earlier, later in zip(rows, rows[1:])]
    assert len(rows) > 100 and all(abs(step - 0.01) < 1e-6 for step in steps), max(steps)
    out = subprocess.run([*MORIS, "simulate", file, "--no-bound", "--report", PAGES], capture_output=True, text=True)
    assert out.returncode in (0, 3), out.stderr


@check
def sliders_change_parameters_and_say_what_cannot_be(browser):
    with live() as address, opened(browser, address) as page:
        field = page.locator("[id='parameter-tilt.angleLimit']")
        field.fill("0.2")
        field.press("Enter")
        wait(page, f"{value('tilt.angleLimit')} === 0.2")
        page.locator("#parameter-strategy").select_option(label="optimal")
        wait(page, "sliders.strategy === 'optimal'")
        page.locator("[data-event=start]").click()
        wait(page, "now.state === 'homing'")
        page.locator("#parameter-strategy").select_option(label="classical")
        wait(page, "sliders.message.textContent !== '' && sliders.strategy === 'optimal'")


@check
def lateness_is_said_in_words(browser):
    with live() as address, opened(browser, address) as page:
        wait(page, "document.getElementById('late-steps').textContent.length > 0")
        said = page.evaluate("""[[], [[0.05, 900], [1, 100]], [[0.05, 99990], [2, 9], [5, 1]], [[0.05, 90], [20, 10]]].map(simulationLive.latenessInWords)""")
    assert said == [
        ["No step yet.", False],
        ["On time: every step began within 1.00 ms.", False],
        ["Nearly always on time: 0.010 % of the steps began more than 1 ms late, the latest within 5.0 ms.", False],
        ["Late: 10 % of the steps began more than 1 ms late, the latest within 20.0 ms. Other programs take this computer's time.", True],
    ]


@check
def curves_have_a_time_axis(browser):
    with live() as address, opened(browser, address) as page:
        assert not page.locator("#scene").is_visible()
        wait(page, "now.view.time > 6")
        ink = """(canvas) => {
            const high = Math.round(10 * canvas.height / canvas.getBoundingClientRect().height);
            return canvas.getContext('2d').getImageData(0, canvas.height - high, canvas.width, high).data.some((value) => value > 0);
        }"""
        wait(page, "strips.sway.points.length > 100")
        assert page.locator("#surge").evaluate(ink) and page.locator("#sway").evaluate(ink)


@check
def angles_have_their_degrees(browser):
    with live() as address, opened(browser, address) as page:
        field = page.locator("[id='parameter-tilt.angleLimit']")
        field.fill("0.2")
        field.press("Enter")
        wait(page, f"{value('tilt.angleLimit')} === 0.2")
        unit = lambda name: page.locator(f"div.parameter:has([id='parameter-{name}']) .unit").inner_text()  # noqa: E731
        assert unit("tilt.angleLimit") == "rad = 11.5\u00b0" and unit("splitter.x.omega1") == "rad/s"
        assert unit("tilt.rateLimit").startswith("rad/s = ") and unit("tilt.rateLimit").endswith("\u00b0/s")


@check
def a_second_page_looks_only(browser):
    with live() as address, opened(browser, address) as first, opened(browser, address) as second:
        assert "controls" in first.locator("#role").inner_text() and "looks only" in second.locator("#role").inner_text()
        assert second.locator("[data-event=start]").is_disabled()
        second.keyboard.press("s")
        first.keyboard.press("s")
        wait(second, "now.state === 'homing'")


@check
def arrow_keys_ride_the_motorcycle(browser):
    with live("--engage", source=["--from", "ride"]) as address, opened(browser, address) as page:
        wait(page, "now.state === 'engaging'")
        assert page.locator("#driving").is_visible()
        page.keyboard.down("ArrowUp")
        before = picture(page, "#ahead")
        wait(page, "now.view.speed > 5")
        assert picture(page, "#ahead") != before and float(page.locator("#speed").inner_text()) > 10
        assert page.evaluate("simulationLive.machine.mockUp.wheels.length") == 2
        page.keyboard.up("ArrowUp")
        wait(page, "driving.held.throttle === 0")
        page.locator("#helped").uncheck()
        page.keyboard.down("ArrowUp")
        page.keyboard.down("ArrowRight")
        wait(page, "now.state === 'frozen'")
        page.screenshot(path=PICTURES / "live-ride.png", full_page=True)
        page.keyboard.up("ArrowUp")
        page.keyboard.up("ArrowRight")
        page.keyboard.press("n")
        wait(page, "now.state === 'engaged' && now.view.speed < 0.3")


@check
def everything_has_a_name_and_fits_a_phone(browser):
    with live("--engage") as address, opened(browser, address, viewport=PHONE, color_scheme="dark") as page:
        page.screenshot(path=PICTURES / "live-phone-dark.png", full_page=True)
        wide = page.evaluate("document.documentElement.scrollWidth")
        assert wide <= PHONE["width"], wide
        nameless = page.evaluate("""[...document.querySelectorAll('button, input, select, canvas')].filter((one) =>
            !(one.getAttribute('aria-label') || one.textContent.trim() || [...(one.labels || [])].some((label) => label.textContent.trim()))).map((one) => one.outerHTML)""")
        assert not nameless, nameless


if __name__ == "__main__":
    run_all("the page of moris live")
