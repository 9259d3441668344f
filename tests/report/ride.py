"""What the page of `moris ride` does. Run by run.py."""

import json
import subprocess
from contextlib import contextmanager

from runner import LAPTOP, MORIS, PAGES, PHONE, PICTURES, check, check_everywhere, picture, run_all, waiter, watched

PAGE = PAGES / "by-hand.html"

wait = waiter("simulationRide", "now")

# A player who keeps nine tenths of the advised speed until a condition holds, in steps of 20 ms; pictures are drawn at its
# end, and now and then. The page's own clock is held.
PLAYER = """
window.ride = (isDone, stick, most) => {
  const { now, engine, frame } = simulationRide;
  const isHelped = document.getElementById("helped").checked;
  const commands = () => {
    const missing = Math.max(3, Math.min(most, 0.9 * now.view.advised)) - now.view.speed;
    return { throttle: Math.max(0, Math.min(0.3, 0.1 * missing)), brake: Math.max(0, Math.min(0.5, -0.1 * missing)), stick, isHelped };
  };
  now.isHeld = true;
  for (let k = 0; k < 15000 && !isDone(now.view); k += 1) {
    engine.advance(0.02, commands());
    now.view = engine.view();
    if (k % 100 === 0) frame(0.02, commands());
  }
  for (let k = 0; k < 2; k += 1) frame(0.001, commands());
  return isDone(now.view);
}
"""


@contextmanager
def opened(browser, **options):
    """The page, running, with the player."""
    with watched(browser, PAGE, **options) as page:
        page.evaluate(f"{PLAYER}; null")
        yield page


def view(page, name):
    return page.evaluate(f"simulationRide.now.view.{name}")


def ride(page, until, stick=0, most=30):
    assert page.evaluate(f"ride((view) => {until}, {stick}, {most})"), until


@check
def the_page_is_one_small_file(_):
    assert PAGE.stat().st_size < 4_000_000, PAGE.stat().st_size


@check_everywhere
def keys_open_the_throttle_lean_and_brake(browser):
    """In the browser's own time: the motorcycle goes, leans to the side of the key, slows down."""
    with opened(browser) as page:
        wait(page, "document.getElementById('message').textContent.startsWith('Ready')")
        page.keyboard.down("ArrowUp")
        wait(page, "now.view.speed > 8")
        page.keyboard.up("ArrowUp")
        page.locator("#helped").uncheck()
        for key, sign in (("d", 1), ("ArrowLeft", -1)):
            page.keyboard.down(key)
            wait(page, f"{sign} * now.view.roll > 0.05")
            page.keyboard.up(key)
        fastest = view(page, "speed")
        page.keyboard.down("s")
        wait(page, f"now.view.speed < {fastest - 3}")
        page.keyboard.up("s")
        page.keyboard.press("p")
        wait(page, "document.getElementById('message').textContent === 'Paused'")


@check
def a_held_throttle_stays_on_the_road_and_the_first_bend_is_announced(browser):
    with opened(browser) as page:
        said = page.evaluate("""() => {
            const { now, engine, frame } = simulationRide;
            const said = new Set();
            now.isHeld = true;
            for (let k = 0; k < 6000; k += 1) {
                const commands = { throttle: 1, brake: 0, stick: 0, isHelped: true };
                if (k % 25 === 0) {
                    frame(0.02, commands);
                    said.add(document.getElementById("message").textContent);
                } else engine.advance(0.02, commands);
            }
            return [...said];
        }""")
        assert any(text.startswith("Bend to the ") and text.endswith("km/h") for text in said), said
        assert view(page, "stage") == "riding", view(page, "stage")


@check_everywhere
def a_gamepad_rides(browser):
    """A pad that the test moves: triggers, stick and start."""
    with opened(browser) as page:
        page.evaluate("""() => {
            window.pad = { connected: true, axes: [0], buttons: Array.from({ length: 10 }, () => ({ value: 0, pressed: false })) };
            navigator.getGamepads = () => [null, window.pad];
        }""")
        page.locator("#helped").uncheck()
        page.evaluate("pad.buttons[7].value = 0.4")
        wait(page, "now.view.speed > 6")
        page.evaluate("pad.axes[0] = 0.5")
        assert page.evaluate("simulationRide.controls.after(0.02)") == {"throttle": 0.4, "brake": 0, "stick": 0.5}
        wait(page, "now.view.roll > 0.05")
        fastest = view(page, "speed")
        page.evaluate("Object.assign(pad.buttons[7], { value: 0 }); Object.assign(pad.buttons[6], { value: 0.5 }); pad.axes[0] = 0.05; null")
        assert page.evaluate("simulationRide.controls.after(0.02).stick") == 0, "the dead zone"
        wait(page, f"now.view.speed < {fastest - 2}")
        page.evaluate("pad.buttons[9].pressed = true")
        wait(page, "now.view.stage === 'returning'")


@check
def a_phone_rides_by_touch_and_tilt(browser):
    """Two fingers hold two buttons; then a tilt of the device leans, upright and on its side."""
    with opened(browser, viewport=PHONE, has_touch=True, is_mobile=True, device_scale_factor=3) as page:
        assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]
        session = page.context.new_cdp_session(page)

        def touch(*names):
            boxes = [page.locator(name).bounding_box() for name in names]
            points = [{"x": box["x"] + box["width"] / 2, "y": box["y"] + box["height"] / 2, "id": k} for k, box in enumerate(boxes)]
            session.send("Input.dispatchTouchEvent", {"type": "touchStart" if points else "touchEnd", "touchPoints": points})

        def tilt(beta, gamma):
            page.evaluate("([beta, gamma]) => dispatchEvent(new DeviceOrientationEvent('deviceorientation', { beta, gamma }))", [beta, gamma])

        page.locator("#helped").uncheck()
        page.locator("#pedals").scroll_into_view_if_needed()
        page.screenshot(path=PICTURES / "ride-touch.png")
        touch("#hold-throttle")
        wait(page, "now.view.speed > 6")
        touch("#hold-throttle", "#hold-left")
        wait(page, "now.view.roll < -0.05")
        touch()
        wait(page, "simulationRide.controls.held.size === 0")
        page.locator("#tilt").tap()
        wait(page, "document.getElementById('tilt').textContent === 'Lean: tilt the device'")
        tilt(40, 15)
        wait(page, "simulationRide.controls.tilt === 0.5")
        wait(page, "now.view.roll > 0.05")
        size = {"width": PHONE["height"], "height": PHONE["width"], "deviceScaleFactor": 3, "mobile": True}
        session.send("Emulation.setDeviceMetricsOverride", size | {"screenOrientation": {"type": "landscapePrimary", "angle": 90}})
        wait(page, "screen.orientation.angle === 90")
        tilt(-60, 15)
        wait(page, "simulationRide.controls.tilt === -1")


@check_everywhere
def curves_road_and_platform_move(browser):
    with opened(browser) as page:
        ride(page, "view.distance > 20")
        canvases = ["#road", "#view", "#surge", "#sway"]
        before = {selector: picture(page, selector) for selector in canvases}
        ride(page, "view.distance > 300")
        for selector in canvases:
            assert picture(page, selector) != before[selector], selector
        desired, felt = page.evaluate("[0, 1].map((k) => { const p = simulationRide.strips.sway.points; return Math.max(...p.map((one) => Math.abs(one[1 + k]))); })")
        assert desired > 0.3 and felt > 0.1, (desired, felt)


@check
def a_lap_has_its_time_and_its_recording_is_read_by_the_workbench(browser):
    """The measures of the page are those of `moris simulate` on the saved file."""
    with opened(browser) as page:
        ride(page, "view.laps === 1")
        cells = page.locator("#lap-rows tr").first.locator("th, td").all_inner_texts()
        minutes, seconds = cells[1].split(":")
        assert 90 < 60 * int(minutes) + float(seconds) < 200, cells
        with page.expect_download() as download:
            page.locator("#save").click()
        file = PAGES / "ridden.csv"
        download.value.save_as(file)
    automatic = PAGES / "automatic.toml"
    automatic.write_text('"scale.automatic" = "on"\n')  # As in the page.
    options = ["--parameters", automatic, "--no-bound", "--json", "--fade-in", "0", "--report", PAGES]
    out = subprocess.run([*MORIS, "simulate", file, *options], capture_output=True, text=True)
    assert out.returncode in (0, 3), out.stderr
    [result] = json.loads(out.stdout)
    rows = {(row["subject"], row["name"]): row["value"] for row in result["results"][0]["measures"]}
    expected = [rows[f"specific force {axis}", name] for axis in "xy" for name in ("RMS error", "shake", "jolt", "peak")]
    for shown, measured in zip(map(float, cells[3:]), expected, strict=True):
        # Two digits are shown, and the file has one sample of ten.
        assert abs(shown - measured) < 0.006 + 0.02 * measured, (cells, expected)
    assert (PAGES / "ridden.html").exists()


@check
def the_second_lap_is_known_and_the_track_is_drawn(browser):
    """The preview is trusted in the second lap, until it is switched off."""
    coast = "for (let k = 0; k < 6; k += 1) simulationRide.frame(0.02, { throttle: 0.2, brake: 0, stick: 0 })"
    with opened(browser) as page:
        ride(page, "view.distance > 300")
        page.evaluate(coast)
        assert page.locator("#road-state").inner_text() == "This stretch is new."
        drawn = picture(page, "#track canvas")
        ride(page, "view.laps === 1 && view.distance > 2000")
        page.evaluate(coast)
        assert view(page, "passes") == 1 and view(page, "trust") > 0.5, (view(page, "passes"), view(page, "trust"))
        assert page.locator("#road-state").inner_text().startswith("Earlier passes here: 1; trust in the preview: ")
        assert picture(page, "#track canvas") != drawn
        assert page.evaluate("simulationRide.track.points.some((point) => point && point[2] > 0.5)")
        page.screenshot(path=PICTURES / "ride-track.png", full_page=True)
        ride(page, "view.laps === 2")
        first, second = (float(error) for error in page.locator("#lap-rows td:nth-child(4)").all_inner_texts())
        assert second < 0.9 * first, (first, second)
        page.locator("#learns").uncheck()
        ride(page, "view.distance > 3400")
        assert view(page, "trust") == 0
        page.locator("#learns").check()
        page.locator("#parameter-strategy").select_option(label="classical")
        page.evaluate(coast)
        assert page.locator("#road-use").inner_text() == "The strategy predictive alone uses the preview."


@check
def leaving_the_road_says_so_and_a_key_restarts(browser):
    with opened(browser) as page:
        ride(page, "view.distance > 60")
        page.locator("#helped").uncheck()
        ride(page, "view.stage === 'off_road'", stick=1)
        assert page.locator("#message").inner_text().startswith("Off the road")
        page.keyboard.press("r")
        ride(page, "view.stage === 'returning'")
        assert "neutral" in page.locator("#message").inner_text()
        for _ in range(20):
            page.evaluate("for (let k = 0; k < 10; k += 1) simulationRide.frame(0.1, { throttle: 0, brake: 0, stick: 0 })")
        assert view(page, "stage") == "ready" and view(page, "distance") == 0


@check
def strategy_and_sliders_change_in_flight(browser):
    with opened(browser) as page:
        ride(page, "view.distance > 30")
        page.locator("[id='parameter-scale.specificForce.x']").fill("0.5")
        page.locator("[id='parameter-scale.specificForce.x']").press("Enter")
        assert view(page, "is_exchanging") == 0
        page.locator("#parameter-strategy").select_option(label="optimal")
        ride(page, "view.is_exchanging === 1", most=8)
        ride(page, "view.is_exchanging === 0 && view.stage === 'riding'", most=8)
        page.locator("[id='parameter-friction of the road']").fill("0.25")
        page.locator("[id='parameter-friction of the road']").press("Enter")
        # On a slippery road a bend that is too fast ends the ride.
        page.evaluate("""() => { const { now, engine, frame } = simulationRide;
            for (let k = 0; k < 3000 && now.view.stage === 'riding'; k += 1) {
              engine.advance(0.02, { throttle: 0.3, brake: 0, stick: 0, isHelped: false });
              now.view = engine.view();
            }
            frame(0.02, { throttle: 0, brake: 0, stick: 0 }); }""")
        assert view(page, "stage") in ("fallen", "off_road")
        assert page.locator("#message").inner_text().startswith(("Fallen", "Off the road"))


@check
def everything_has_a_name_and_fits_a_phone(browser):
    """Controls and pictures have labels; nothing is wider than the screen; reduced motion begins with the map."""
    for scheme in ("light", "dark"):
        for name, viewport in (("desktop", LAPTOP), ("phone", PHONE)):
            with opened(browser, viewport=viewport, color_scheme=scheme) as page:
                ride(page, "view.distance > 290")
                page.screenshot(path=PICTURES / f"ride-{name}-{scheme}.png", full_page=True)
                wide = page.evaluate("document.documentElement.scrollWidth")
                assert wide <= viewport["width"], wide
                nameless = page.evaluate("""[...document.querySelectorAll('button, input, select, canvas')].filter((one) =>
                    !(one.getAttribute('aria-label') || one.textContent.trim() || [...(one.labels || [])].some((label) => label.textContent.trim()))).map((one) => one.outerHTML)""")
                assert not nameless, nameless
    with opened(browser, reduced_motion="reduce") as page:
        assert page.locator("#map").is_checked()


if __name__ == "__main__":
    subprocess.run([*MORIS, "ride", "--output", PAGE], check=True)
    run_all("the ride")
