"""What a report's page shows, held against the data it was made of. Run by run.py."""

import base64
import hashlib
import json
import math
import re
import statistics
import subprocess
from contextlib import contextmanager

from runner import IS_FIREFOX, MORIS, PAGES, PHONE, PICTURES, check, check_everywhere, run_all, watched

# Half of what an eye can tell on the screen, and what 32-bit numbers leave of lengths [m].
PIXEL, ROUNDING = 0.5, 1e-6


def with_hashes(text):
    """The page with a policy that permits its scripts as they are."""
    scripts = [base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in re.findall("<script>(.*?)</script>", text, re.DOTALL)]
    return re.sub("script-src ('sha256-[^']*' )+", "script-src " + "".join(f"'sha256-{script}' " for script in scripts), text, count=1)


def opened(browser, name, *, text=None, **options):
    """The page of this name, or another text in its place."""
    file = PAGES / f"{name}.html"
    if text is not None:
        file = PAGES / f"{name}-changed.html"
        file.write_text(with_hashes(text))
    return watched(browser, file, **options)


def plain(name):
    return json.loads((PAGES / f"{name}.json").read_text())


def set_slider(page, time):
    script = "(slider, time) => { slider.value = time; slider.dispatchEvent(new Event('input')); }"
    page.locator("#slider").evaluate(script, time)


def choose(page, run):
    page.locator("#runs").get_by_role("button", name=run, exact=True).click()


def near(found, expected, tolerance, what):
    assert abs(found - expected) <= tolerance, f"{what}: {found} is not {expected} (to {tolerance})"


def rotation(roll, pitch, yaw):
    """Rz(yaw) Ry(pitch) Rx(roll), multiplied out step by step."""
    def product(a, b):
        return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]

    (cr, sr), (cp, sp), (cy, sy) = [(math.cos(angle), math.sin(angle)) for angle in (roll, pitch, yaw)]
    about_x, about_y, about_z = [[1, 0, 0], [0, cr, -sr], [0, sr, cr]], [[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]], [[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]]
    return product(about_z, product(about_y, about_x))


def leg_ends(data, run, k):
    """Base and platform joint of each leg at sample k."""
    turn = rotation(*(angle[k] for angle in run["orientation"]))
    place = [axis[k] for axis in run["position"]]
    tops = [[place[i] + sum(turn[i][j] * joint[j] for j in range(3)) for i in range(3)] for joint in data["rig"]["platform"]]
    return list(zip(data["rig"]["base"], tops))


def projected(page, point):
    """Where a point must be in the picture, from nothing but where the camera stands and the focal length."""
    camera = page.evaluate("(({azimuth, elevation, eye, focal, middle}) => ({azimuth, elevation, eye, focal, middle}))(simulationReport.view.camera)")
    a, e = camera["azimuth"], camera["elevation"]
    ahead = [-math.cos(e) * math.cos(a), -math.cos(e) * math.sin(a), -math.sin(e)]
    right = [-math.sin(a), math.cos(a), 0.0]
    up = [right[1] * ahead[2] - right[2] * ahead[1], right[2] * ahead[0] - right[0] * ahead[2], right[0] * ahead[1] - right[1] * ahead[0]]
    seen = [p - q for p, q in zip(point, camera["eye"])]
    x, y, depth = (sum(u * v for u, v in zip(axis, seen)) for axis in (right, up, ahead))
    return camera["middle"][0] + camera["focal"] * x / depth, camera["middle"][1] - camera["focal"] * y / depth


def assert_legs_are_drawn(page, data, run, k, what):
    drawn = page.evaluate("simulationReport.view.drawnLegs")
    for leg, (ends, pictures) in enumerate(zip(leg_ends(data, run, k), drawn, strict=True)):
        near(math.dist(*ends), run["legs"][leg][k], ROUNDING, f"{what}, length of leg {leg + 1}")
        for end, picture in zip(ends, pictures):
            near(math.dist(projected(page, end), picture), 0.0, PIXEL, f"{what}, end of leg {leg + 1}")


@check_everywhere
def pages_are_quiet_and_ask_for_nothing(browser):
    """No message, no error, no dialog, no request, in light and dark, and the alarm is gone."""
    for name in ("two-runs", "hostile", "long"):
        # Playwright does not set the scheme in Firefox.
        for scheme in ("light",) if IS_FIREFOX else ("light", "dark"):
            with opened(browser, name, color_scheme=scheme) as page:
                assert not page.locator("#alarm").is_visible()
                page.evaluate("simulationReport.seek(3.7)")
                page.screenshot(path=PICTURES / f"{name}-{scheme}.png")


@check_everywhere
def the_slider_moves_the_legs(browser):
    """After the slider, each leg is drawn between its joints, and the gauges say its length."""
    data = plain("two-runs")
    run = data["runs"][0]
    with opened(browser, "two-runs") as page:
        for k in (0, 512, 2100, 3990, 4100, 5999):
            set_slider(page, run["times"][k])
            assert_legs_are_drawn(page, data, run, k, f"sample {k}")
            texts = page.locator(".gauge .value").all_text_contents()
            assert texts == [f"{leg[k]:.3f} m" for leg in run["legs"]], texts


@check
def the_head_leans_with_the_rider(browser):
    """The head is drawn where eq. (4) as corrected has it: (0, -b sin(lean), h - b + b cos(lean)) on the platform."""
    data = plain("two-runs")
    run, rig = data["runs"][0], data["rig"]
    with opened(browser, "two-runs") as page:
        for k in (0, 1800, 2600):
            lean, torso = run["lean"][k], rig["torso_length"]
            head = [0, -torso * math.sin(lean), rig["head_height"] - torso + torso * math.cos(lean)]
            turn = rotation(*(angle[k] for angle in run["orientation"]))
            place = [axis[k] + sum(turn[i][j] * head[j] for j in range(3)) for i, axis in enumerate(run["position"])]
            set_slider(page, run["times"][k])
            near(math.dist(projected(page, place), page.evaluate("simulationReport.view.drawnHead")), 0.0, PIXEL, f"head at sample {k}")
        assert max(abs(run["lean"][k]) for k in (1800, 2600)) > 0.1, "nobody leans at the samples looked at"


@check
def the_mouse_turns_the_view(browser):
    data = plain("two-runs")
    with opened(browser, "two-runs") as page:
        before = page.evaluate("simulationReport.view.drawnLegs")
        box = page.locator("#view").bounding_box()
        page.mouse.move(box["x"] + 200, box["y"] + 300)
        page.mouse.down()
        page.mouse.move(box["x"] + 320, box["y"] + 340, steps=5)
        page.mouse.up()
        assert math.dist(before[0][1], page.evaluate("simulationReport.view.drawnLegs")[0][1]) > 20
        assert_legs_are_drawn(page, data, data["runs"][0], 0, "turned")
        for name in ("side", "front", "above", "oblique"):
            page.get_by_role("button", name=name).click()
            assert_legs_are_drawn(page, data, data["runs"][0], 0, name)


@check
def the_picture_has_the_legs_colours(browser):
    """Where a leg's lower part must be, its pixels are of the colour of its stroke, unless something stands before it.

    Chromium advises against reading a canvas often; that is the only message.
    """
    data = plain("two-runs")
    run = data["runs"][0]
    with opened(browser, "two-runs", quiet=False) as page:
        for k in (0, 3900):
            set_slider(page, run["times"][k])
            seen = 0
            for leg, (foot, top) in enumerate(leg_ends(data, run, k)):
                x, y = projected(page, [f + 0.25 * (t - f) for f, t in zip(foot, top)])
                pixel = page.evaluate("([x, y]) => [...document.getElementById('view').getContext('2d').getImageData(x, y, 1, 1).data]", [x, y])
                seen += max(abs(a - b) for a, b in zip(pixel, stroke_colour(page, data, run["legs"][leg][k]))) <= 2
            assert seen >= 4, f"only {seen} legs have their colour at sample {k}"


def stroke_colour(page, data, length):
    """The colour by the fraction of the half stroke that is left, from the style sheet's four colours."""
    shortest, longest = data["rig"]["stroke"]
    left = min(length - shortest, longest - length) / ((longest - shortest) / 2)
    names = ["--leg-end", "--leg-near", "--leg-some", "--leg-easy"]
    texts = page.evaluate("names => names.map((name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim())", names)
    colours = [[int(text[i:i + 2], 16) for i in (1, 3, 5)] for text in texts]
    place = min(max(left / 0.2, 0.0), 3.0)
    low = min(int(place), 2)
    return [a + (place - low) * (b - a) for a, b in zip(colours[low], colours[low + 1])]


@check
def the_charts_follow(browser):
    """The cursor stands at its time in every chart, and the legend gives the values there."""
    run = plain("two-runs")["runs"][0]
    with opened(browser, "two-runs") as page:
        set_slider(page, 37.5)
        for plot in page.locator(".plot").all():
            box, cursor = plot.bounding_box(), plot.locator(".cursor").bounding_box()
            inside = (box["width"] - 52 - 10) * 37.5 / 60
            near(cursor["x"] - box["x"], 52 + inside, 1.5, "cursor")
        surge = page.locator('.chart[data-title="Surge, x"] .legend li', has_text="default")
        assert surge.inner_text().endswith(f"{run['felt'][0][3750]:.2f}".replace("-", "\u2212")), surge.inner_text()


@check
def charts_are_zoomed_and_clicked(browser):
    with opened(browser, "two-runs") as page:
        box = page.locator(".plot").first.bounding_box()
        x_of = lambda time: box["x"] + 52 + (box["width"] - 62) * time / 60
        y = box["y"] + 20
        page.mouse.click(x_of(30), y)
        near(page.evaluate("simulationReport.now.time"), 30, 0.1, "clicked time")
        page.mouse.move(x_of(20), y)
        page.mouse.down()
        page.mouse.move(x_of(45), y, steps=4)
        page.mouse.up()
        for found, expected in zip(page.evaluate("simulationReport.now.shown"), (20, 45)):
            near(found, expected, 0.1, "shown time")
        page.screenshot(path=PICTURES / "zoomed.png")
        page.get_by_role("button", name="Whole recording").click()
        assert page.evaluate("simulationReport.now.shown") == [0, 60]


@check
def the_roughest_second_is_shown(browser):
    """By button and by key: the second of which the standard deviation of the error is largest, each second tried."""
    with opened(browser, "ride") as page:
        run = page.evaluate(
            "(({ times, desired, felt }) => [times, ...[0, 1].flatMap((axis) => [desired, felt]"
            ".map((cues) => cues.specific_force[axis]))].map((values) => [...values]))(simulationReport.now.run)"
        )
        times, *forces = run
        errors = [[b - a for a, b in zip(*forces[:2])], [b - a for a, b in zip(*forces[2:])]]
        count = 100  # at 100 Hz
        roughness = {times[k]: max(statistics.pstdev(error[k : k + count + 1]) for error in errors) for k in range(len(times) - count)}
        for act in (lambda: page.get_by_role("button", name="Roughest second").click(), lambda: page.keyboard.press("r")):
            page.evaluate("document.activeElement.blur(), simulationReport.show(null)")
            act()
            begin, end = page.evaluate("simulationReport.now.shown")
            near(end - begin, 1, 1e-9, "a second")
            shown = roughness[min(roughness, key=lambda time: abs(time - begin))]
            near(shown, max(roughness.values()), 1e-4, f"roughness from {begin} s")
            near(page.evaluate("simulationReport.now.time"), begin + 0.5, 1e-9, "middle")
        page.screenshot(path=PICTURES / "roughest.png")


@check
def the_wheel_zooms_and_moves(browser):
    """Control and the wheel zoom about the pointer, shift and a drag move, and neither leaves the ride."""
    with opened(browser, "two-runs") as page:
        box = page.locator(".plot").first.bounding_box()
        x_of = lambda share: box["x"] + 52 + (box["width"] - 62) * share
        y = box["y"] + 20
        shown = lambda: page.evaluate("simulationReport.now.shown")
        page.mouse.move(x_of(0.5), y)
        page.keyboard.down("Control")
        page.mouse.wheel(0, -400)
        page.keyboard.up("Control")
        page.wait_for_function("simulationReport.now.shown[1] < 60")
        zoomed = shown()
        near(sum(zoomed) / 2, 30, 0.2, "middle of the zoom")
        page.keyboard.down("Shift")
        page.mouse.down()
        page.mouse.move(x_of(0.3), y, steps=3)
        page.mouse.up()
        moved = shown()
        near(moved[0] - zoomed[0], 0.2 * (zoomed[1] - zoomed[0]), 0.3, "distance moved")
        near(moved[1] - moved[0], zoomed[1] - zoomed[0], 1e-6, "span while moving")
        page.mouse.down()
        page.mouse.move(x_of(0.3) - 5000, y, steps=3)
        page.mouse.up()
        page.keyboard.up("Shift")
        near(shown()[1], 60, 1e-9, "end of the ride")


@check
def the_pointer_reads_every_curve(browser):
    """Under the pointer, the legends of all charts give its time's values; off the charts, the cursor's again."""
    run = plain("two-runs")["runs"][0]
    with opened(browser, "two-runs") as page:
        set_slider(page, 10.0)
        legend = page.locator('.chart[data-title="Surge, x"] .legend li', has_text="default")
        written = lambda k: f"{run['felt'][0][k]:.2f}".replace("-", "\u2212")
        assert legend.inner_text().endswith(written(1000))
        box = page.locator('.chart[data-title="Surge, x"] .plot').bounding_box()
        page.mouse.move(box["x"] + 52 + (box["width"] - 62) * 37.5 / 60, box["y"] + 40)
        shown = float(legend.inner_text().split()[-1].replace("\u2212", "-"))
        values = run["felt"][0][3742:3759]
        assert min(values) - 0.01 <= shown <= max(values) + 0.01, f"{shown} is not among {values}"
        page.mouse.move(2, 2)
        assert legend.inner_text().endswith(written(1000))


@check
def curves_differ_without_colour_and_in_words(browser):
    """Each curve of a chart has dashes of its own, and each chart a description for readers of screens."""
    with opened(browser, "two-runs") as page:
        for chart in page.locator(".chart").all():
            dashes = chart.locator(".legend li svg line").evaluate_all(
                "lines => lines.map((line) => [line.getAttribute('stroke-dasharray'), line.getAttribute('stroke-width')].join('/'))")
            assert len(set(dashes)) == len(dashes), f"{chart.get_attribute('data-title')}: {dashes}"
            label = chart.locator("canvas").get_attribute("aria-label")
            assert chart.get_attribute("data-title") in label and " from " in label, label


@check
def findings_and_axes_are_those_of_all_runs(browser):
    """Findings follow the run that is shown; the vertical axis does not change with it."""
    with opened(browser, "two-runs") as page:
        ranges = lambda: page.evaluate("simulationReport.ranges()")
        before = ranges()
        for name, text in (("soft", "four seconds less"), ("small-motions", "hold the platform back"), ("default", "No leg comes")):
            choose(page, name)
            found = page.locator("#findings li").all_inner_texts()
            assert text in found[0] and "computed" in found[1] and len(found) == 2, found
            # The runs' limits of the tilt's rate differ in the seventh digit.
            apart = [abs(x - y) for now, then in zip(ranges(), before) for x, y in zip(now, then)]
            assert max(apart) < 1e-6, (name, apart)


@check
def chosen_channels_share_a_chart(browser):
    with opened(browser, "two-runs") as page:
        page.get_by_text("Overlay channels in one chart").click()
        for name in ("Surge, felt", "Leg 3"):
            page.get_by_label(name, exact=True).check()
        chart = page.locator('.chart[data-title="Overlay"]')
        assert len(chart.locator(".legend li").all()) == 2
        chart.scroll_into_view_if_needed()
        page.screenshot(path=PICTURES / "overlay.png")
        page.get_by_label("Leg 3", exact=True).uncheck()
        assert len(chart.locator(".legend li").all()) == 1


@check
def the_machine_is_in_sight_where_it_plays(browser):
    """On a phone, too, wherever the page is scrolled to."""
    with opened(browser, "two-runs", viewport=PHONE) as page:
        box, play = (page.locator(name).bounding_box() for name in ("#view", "#play"))
        assert 0 <= box["y"] and box["y"] + box["height"] <= play["y"], (box, play)
        page.get_by_role("button", name="Play").click()
        box = page.locator("#view").bounding_box()
        assert 0 <= box["y"] and box["y"] + box["height"] <= 844 and box["height"] > 120, box
        page.screenshot(path=PICTURES / "phone.png")
        page.get_by_role("button", name="Pause").click()
        assert page.evaluate("document.documentElement.scrollWidth") <= 390


@check
def a_print_has_the_definitions_on_request(browser):
    """The control bar and what is only for a screen are left out."""
    with opened(browser, "two-runs") as page:
        first = page.locator("#measures details tbody tr").first
        for wanted in (False, True):
            page.get_by_label("print with the definitions").set_checked(wanted)
            page.evaluate("dispatchEvent(new Event('beforeprint'))")
            page.emulate_media(media="print")
            assert not page.locator("#player").is_visible() and not page.locator("#overlay").is_visible()
            assert first.is_visible() == wanted and page.locator("#measures details").is_visible() == wanted
            page.screenshot(path=PICTURES / "print.png", full_page=True)
            page.evaluate("dispatchEvent(new Event('afterprint'))")
            page.emulate_media(media="screen")
            assert not first.is_visible()
        rows = page.locator("#measures details tbody tr").all_text_contents()
        assert rows and len(rows) == len(set(rows))


@check
def a_print_is_light_and_undistorted(browser):
    """From a dark screen, too: the canvases are drawn anew, for the paper's width and in its colours."""
    canvases = """[...document.querySelectorAll('canvas')].map((canvas) => {
        const { width, height } = canvas.getBoundingClientRect();
        return [canvas.width / canvas.height, width / height];
    })"""
    # Lightness of the darkest pixel that is drawn in a chart: a line of the grid on a dark screen, a curve on paper.
    darkest = """(() => {
        const chart = document.querySelector('.chart canvas');
        const copy = Object.assign(document.createElement('canvas'), { width: chart.width, height: chart.height });
        const context = copy.getContext('2d', { willReadFrequently: true });
        context.drawImage(chart, 0, 0);
        const { data } = context.getImageData(0, 0, copy.width, copy.height);
        let least = 765;
        for (let i = 0; i < data.length; i += 4) if (data[i + 3] === 255) least = Math.min(least, data[i] + data[i + 1] + data[i + 2]);
        return least / 3;
    })()"""
    with opened(browser, "two-runs", color_scheme="dark") as page:
        colours = lambda: page.evaluate("[getComputedStyle(document.documentElement).getPropertyValue('--card').trim(), getComputedStyle(document.documentElement).getPropertyValue('--ink').trim()]")
        dark, on_dark = colours(), page.evaluate(darkest)
        page.evaluate("dispatchEvent(new Event('beforeprint'))")
        page.emulate_media(media="print", color_scheme="dark")
        light, on_light = colours(), page.evaluate(darkest)
        assert light == ["#ffffff", "#1e2530"] != dark, (light, dark)
        assert on_dark < 70 and on_light > 80, (on_dark, on_light)
        for drawn, shown in page.evaluate(canvases):
            assert abs(drawn - shown) < 0.02 * shown, (drawn, shown)
        page.evaluate("dispatchEvent(new Event('afterprint'))")
        page.emulate_media(media="screen", color_scheme="dark")
        assert colours() == dark


@check
def it_plays_at_real_speed(browser):
    """On a clock that the test turns: a second of it is a second of the ride, or five at speed 5; it stops at the end."""
    with opened(browser, "two-runs") as page:
        page.clock.install(time=0)
        page.clock.pause_at(3_600_000)
        page.get_by_role("button", name="Play").click()
        page.clock.run_for(2000)
        near(page.evaluate("simulationReport.now.time"), 2.0, 0.05, "time after two seconds")
        page.locator("#speed").select_option("5")
        page.clock.run_for(2000)
        near(page.evaluate("simulationReport.now.time"), 12.0, 0.2, "time after two more, five times as fast")
        page.clock.run_for(12000)
        assert page.evaluate("[simulationReport.now.time, simulationReport.now.playing]") == [60, False]
        assert page.locator("#play").inner_text() == "Play"


@check
def another_run_can_be_chosen(browser):
    data = plain("two-runs")
    with opened(browser, "two-runs") as page:
        set_slider(page, 38.0)
        choose(page, "soft")
        assert_legs_are_drawn(page, data, data["runs"][1], 3800, "soft")
        assert shown_run(page) == "soft"
        choose(page, "small-motions")
        assert page.locator(".events tr", has_text="safety unit").count() > 0
        page.screenshot(path=PICTURES / "small-motions.png")


LANES = {"tilt": "tilt limited", "soft": "soft limits", "safety": "safety unit", "actuator": "actuator guard"}


def assert_lanes(page, limited, times, what):
    """Each lane has its colour where its flags are up and nowhere else, and the list has its rows; returns how often."""
    rows = page.locator(".events td:nth-child(2)").all_text_contents()
    seen = {}
    for lane, (kind, name) in enumerate(LANES.items()):
        flags = limited[kind]
        assert (name in rows) == any(flags), (what, kind)
        # Not within 0.2 s of an edge: stretches closer than 0.1 s are one, and a pixel has up to 0.1 s.
        inside = [k for k in range(20, len(flags) - 20, 7) if len(set(flags[k - 20:k + 21])) == 1]
        painted = page.evaluate("""([kind, lane, shares]) => {
            const canvas = document.querySelector("#charts canvas");
            const [ratio, width] = [canvas.width / canvas.clientWidth, canvas.clientWidth];
            const text = getComputedStyle(document.documentElement).getPropertyValue(`--${kind}`).trim();
            const wanted = [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16));
            return shares.map((share) => {
                const at = [52 + (width - 62) * share, 8 + 20 * lane + 10].map((place) => Math.floor(place * ratio));
                // Two stretches may meet in one of the pixels.
                const { data } = canvas.getContext("2d").getImageData(at[0] - 1, at[1], 3, 1);
                return [0, 4, 8].some((from) => wanted.every((part, i) => Math.abs(part - data[from + i]) < 4));
            });
        }""", [kind, lane, [times[k] / times[-1] for k in inside]])
        wrong = [k for k, paint in zip(inside, painted) if paint != bool(flags[k])]
        assert not wrong, (what, kind, wrong[:5])
        seen[kind] = sum(painted)
    return seen


@check
def every_limit_has_its_lane(browser):
    """Chromium advises against reading a canvas often; that is the only message."""
    data = plain("two-runs")
    with opened(browser, "two-runs", quiet=False) as page:
        for run in data["runs"]:
            choose(page, run["name"])
            seen = assert_lanes(page, run["limited"], run["times"], run["name"])
        assert all(seen[kind] > 5 for kind in ("tilt", "safety", "actuator")), seen
    with tuned(browser, quiet=False) as page:
        # A short stroke, and a strategy that does not plan for it.
        control(page, "strategy").select_option(label="classical")
        move(page, "actuator.maxLength", 60)
        page.wait_for_timeout(400)
        limited = page.evaluate("Object.fromEntries(Object.entries(simulationReport.now.run.limited).map(([kind, flags]) => [kind, [...flags]]))")
        seen = assert_lanes(page, limited, [0.01 * k for k in range(2001)], "by hand")
        page.screenshot(path=PICTURES / "lanes.png")
        assert seen["soft"] > 5, seen


@check
def the_table_holds_the_measures(browser):
    data = plain("two-runs")
    with opened(browser, "two-runs") as page:
        shown = {}
        rows = "rows => rows.map((row) => [row.dataset.group, ...[...row.children].map((cell) => cell.textContent)])"
        for group, name, *cells in page.locator("#measures .channel tbody tr").evaluate_all(rows):
            for run, cell in zip(data["runs"], cells, strict=True):
                shown[group, name, run["name"]] = cell
        for run in data["runs"]:
            for measure in run["measures"]:
                cell = shown[measure["group"], f"{measure['name']} {measure['unit']}", run["name"]]
                near(float(cell.replace("\u2212", "-")), measure["value"], 0.006 * abs(measure["value"]), str(measure))
        page.get_by_text("Definitions and sources").click()
        defined = page.locator("#measures details tbody tr").all_inner_texts()
        for measure in data["runs"][0]["measures"]:
            assert any(measure["definition"] in row and measure["source"] in row for row in defined), measure
        page.locator("#measures").scroll_into_view_if_needed()
        page.screenshot(path=PICTURES / "measures.png", full_page=True)


@check
def no_peak_is_lost(browser):
    """In two minutes at 1 kHz, a bump of 50 ms, less than half a pixel wide, is drawn to its full height."""
    with opened(browser, "long") as page:
        found = page.evaluate("""() => {
            const canvas = document.querySelector('.chart[data-title="Heave, z"] canvas');
            const [ratio, box] = [canvas.width / canvas.clientWidth, canvas.getBoundingClientRect()];
            const x = Math.round((52 + (box.width - 62) * 35.025 / 120) * ratio);
            const data = canvas.getContext("2d").getImageData(x - 3, 0, 7, canvas.height).data;
            const wanted = [1, 3, 5].map((at) => parseInt(getComputedStyle(document.documentElement)
                .getPropertyValue("--desired").trim().slice(at, at + 2), 16));
            const rows = new Set();
            for (let i = 0; i < data.length; i += 4) {
                if (wanted.every((part, k) => Math.abs(part - data[i + k]) < 12)) rows.add(Math.floor(i / 28) / ratio);
            }
            return [Math.min(...rows), Math.max(...rows), rows.size];
        }""")
        top, bottom, rows = found
        assert top < 20 and bottom > 90 and rows > 60, f"the bump is drawn from {top} to {bottom} px, in {rows} rows"


@check
def hostile_text_stays_text(browser):
    data = plain("hostile")
    with opened(browser, "hostile") as page:
        assert page.locator("h1").inner_text().split() == data["title"].split()
        assert page.title().split() == data["title"].split()
        counts = page.evaluate("['img', 'script', 'iframe', 'object'].map((tag) => document.getElementsByTagName(tag).length)")
        assert counts == [0, 3, 0, 0], counts
        assert page.locator("#runs button").first.inner_text().split() == data["runs"][0]["name"].split()


@check
def a_failing_script_is_not_silent(browser):
    """A script that fails, data that are cut off, and no scripts at all: the page says so."""
    text = (PAGES / "hostile.html").read_text()
    broken = text.replace("const report = {", "const report = nothing + {", 1)
    cut = text.replace('"deflated":"', '"deflated":"!', 1)
    assert text not in (broken, cut)
    for changed in (broken, cut):
        with opened(browser, "hostile", quiet=False, text=changed) as page:
            assert "could not be drawn" in page.locator("#alarm").inner_text()
            assert page.locator("#alarm").is_visible()
    with opened(browser, "hostile", java_script_enabled=False) as page:
        assert page.locator("#alarm").is_visible()


@check
def a_narrow_screen_is_enough(browser):
    with opened(browser, "two-runs", viewport={"width": 700, "height": 900}) as page:
        page.screenshot(path=PICTURES / "narrow.png")
        assert page.evaluate("document.documentElement.scrollWidth") <= 700


def of_command(*options):
    """Measures and findings of the ride, as the command prints them."""
    command = [*MORIS, "simulate", PAGES / "ride.csv", "--report", PAGES / "of-command", "--json", *options]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode in (0, 3), done.stderr
    return json.loads(done.stdout)[0]["results"][0]


def settled(page):
    page.evaluate("(async () => { while (simulationReport.tuning.isBusy) await new Promise((next) => setTimeout(next, 5)); })()")


@contextmanager
def tuned(browser, **options):
    """The ride's page with its panel open."""
    with opened(browser, "ride", **options) as page:
        page.locator("#tuning:not([hidden])").wait_for(state="attached")
        page.locator("#tuning summary").click()
        assert page.evaluate("Boolean(simulationReport.tuning)"), page.locator("#tuning").inner_text()
        yield page


def control(page, name):
    """The field of a parameter."""
    return page.locator(f"[id='parameter-{name}']")


def slider_of(page, name):
    return page.locator(f".parameter:has([id='parameter-{name}']) input[type=range]")


def move(page, name, place):
    """Moves a slider to a place and lets it go."""
    slider = slider_of(page, name)
    slider.evaluate("(slider, place) => ['input', 'change'].forEach((kind) => { slider.value = place; slider.dispatchEvent(new Event(kind)); })", place)
    settled(page)


def download(page, button, name, text):
    """The file that a button saves; `text`: its text in the page."""
    file = PAGES / f"saved-{name}"
    if IS_FIREFOX:
        # The protocol does not tell of files from a page's memory.
        file.write_text(page.evaluate(text))
        return file
    with page.expect_download() as found:
        page.get_by_role("button", name=button).click()
    found.value.save_as(file)
    assert found.value.suggested_filename == name, found.value.suggested_filename
    assert file.read_text() == page.evaluate(text)
    return file


def saved(page, name="ride.toml"):
    """The parameter file that the page saves."""
    return download(page, "Save parameters", name, "simulationReport.tuning.file()")


ALTERNATIVES = "Simulated and better: "


def assert_same(page, command, what):
    """Of the shown run: measures to the last digits but one of a double, cells to their digits, findings to the letter.

    The command alone simulates alternatives; the page's findings lack them.
    """
    run = page.evaluate("(({ measures, findings }) => ({ measures, findings: findings.map(({ text }) => text) }))(simulationReport.now.run)")
    shown = {(measure["group"].lower(), measure["name"]): measure["value"] for measure in run["measures"]}
    assert len(command["measures"]) > 40
    for measure in command["measures"]:
        found, expected = shown[measure["subject"].lower(), measure["name"]], measure["value"]
        if expected is None:
            assert found is None, (what, measure, found)
        else:
            near(found, expected, 1e-9 * max(1.0, abs(expected)), f"{what}, {measure['subject']}, {measure['name']}")
        cells = page.evaluate("([a, b]) => [a, b].map((value) => simulationReport.cellText(value))", [found, expected])
        assert cells[0] == cells[1], (what, measure, cells)
    findings = [finding for finding in command["findings"] if not finding.startswith(ALTERNATIVES)]
    assert run["findings"] == findings, (what, run["findings"], findings)


@check_everywhere
def the_page_simulates_as_the_command(browser):
    """With a scale, with another strategy and with a weight of its: measures and findings are the command's with the saved file."""
    with tuned(browser) as page:
        move(page, "scale.specificForce.x", 300)
        assert_same(page, of_command("--parameters", saved(page)), "a scale")
        control(page, "strategy").select_option(label="optimal")
        move(page, "optimal.weightPosition", 260)
        file = saved(page)
        assert 'strategy = "optimal"' in file.read_text().replace('"strategy"', "strategy"), file.read_text()
        assert_same(page, of_command("--parameters", file), "optimal")
        # The bound belongs to the limits that the page started with.
        move(page, "tilt.rateLimit", 100)
        assert_same(page, of_command("--no-bound", "--parameters", saved(page)), "another limit")


# Notes the worker's messages, beside each what the page shows then. `inPart` are acts, each at the first part of a run.
NOTED = """() => {
    const { tuning } = simulationReport;
    const shown = () => [document.querySelector('.chart canvas').toDataURL(), ...['measures', 'findings'].map((id) => document.getElementById(id).textContent)];
    Object.assign(window, { noted: [{ kind: "before", shown: shown() }], inPart: [], change: (name, value) => {
        // As if the first change had just come: then a run is given up at once.
        tuning.unfinishedSince = null;
        tuning.change(tuning.values.with(tuning.slots.get(name), value));
    } });
    tuning.simulator.worker.addEventListener("message", ({ data }) => {
        const kind = data.part ? "part" : Object.keys(data).find((key) => ["measures", "isAbandoned", "reason"].includes(key));
        noted.push({ kind, from: data.part?.from, to: data.part?.to, shown: shown() });
        if (data.part?.from === 0 && inPart.length > 0) inPart.shift()();
    });
}"""


@contextmanager
def noted(browser):
    """The ride's page with the predictive strategy, and its worker's messages noted from now on."""
    with tuned(browser) as page:
        control(page, "strategy").select_option(label="predictive")
        settled(page)
        page.locator(".chart").first.scroll_into_view_if_needed()
        # What waits while a slider moves comes after 250 ms.
        page.evaluate("new Promise((next) => setTimeout(next, 300))")
        page.evaluate(NOTED)
        yield page


@check_everywhere
def curves_come_before_measures(browser):
    """The first samples are drawn while others are simulated, all of them before the measures; none is missing."""
    with noted(browser) as page:
        page.evaluate("change('scale.specificForce.x', 0.9)")
        settled(page)
        before, *parts, last = page.evaluate("noted")
        assert last["kind"] == "measures" and len(parts) > 1, parts
        ends = [0, *(part["to"] for part in parts)]
        assert [part["from"] for part in parts] == ends[:-1] and ends[-1] == 2001, ends
        drawn, measures, findings = zip(*(one["shown"] for one in [before, *parts, last]))
        assert len(set(drawn)) == len(parts) + 1 and drawn[-1] == drawn[-2], [drawn.index(one) for one in drawn]
        assert len(set(findings[:-1])) == 1 and findings[-1] != findings[0], findings
        assert len(set(measures)) == 1, "the table out of sight waits"
        page.wait_for_function("text => document.getElementById('measures').textContent !== text", arg=measures[0])


@check_everywhere
def a_change_ends_the_run_under_way(browser):
    """The last of several changes is simulated to its end, and if it cannot be used, the curves are again the last whole ones."""
    with noted(browser) as page:
        # Five times the steps: no run is at its end before its first part is drawn.
        page.evaluate("change('solver.maxStep', 0.0002)")
        settled(page)
        page.evaluate("noted.length = 0")
        page.evaluate("inPart.push(() => change('scale.specificForce.x', 0.4), () => change('scale.specificForce.x', 0.8))")
        page.evaluate("change('scale.specificForce.x', 0.9)")
        settled(page)
        ends = [one["kind"] for one in page.evaluate("noted") if one["kind"] not in ("before", "part")]
        assert ends == ["isAbandoned", "isAbandoned", "measures"], ends
        file = saved(page)
        assert "0.8" in file.read_text()
        assert_same(page, of_command("--parameters", file), "the last change")
        curves = "(({ felt, legs }) => [...felt.specific_force, ...legs].map((values) => [...values]))(simulationReport.now.run)"
        whole = page.evaluate(curves)
        page.evaluate("inPart.push(() => { window.begun = simulationReport.now.run.felt.specific_force[0].slice(); change('head.torsoLength', 9); })")
        page.evaluate("change('scale.specificForce.x', 0.5)")
        settled(page)
        assert page.evaluate("noted.at(-1).kind") == "reason", page.evaluate("noted.map(({kind, from}) => [kind, from])")
        assert page.evaluate("[...begun]") != whole[0] and page.evaluate(curves) == whole
        assert_same(page, of_command("--parameters", file), "the last that could be used")


@check
def the_rig_is_judged_as_by_the_command(browser):
    """Rig sliders: the verdict is that of `rig check` with the saved rig, the run that of `simulate` with it."""
    with tuned(browser) as page:
        verdict = page.locator("#verdict")
        for name, place in (("actuator.maxLength", 150), ("actuator.velocityLimit", 100), ("safety.x.positionLimit", 60)):
            move(page, name, place)
        rig = download(page, "Save rig", "ride.rig.toml", "simulationReport.tuning.rigFile()")
        done = subprocess.run([*MORIS, "rig", "check", rig, "--samples", "1000", "--report", PAGES], capture_output=True, text=True)
        assert done.returncode == 0 and "m³" in done.stdout, done.stderr
        said = [" ".join(line.split()) for line in done.stdout.splitlines()]
        rows = verdict.locator("tr").evaluate_all("rows => rows.map((row) => [...row.children].map((cell) => cell.textContent).join(' '))")
        texts = verdict.locator("p").evaluate_all("texts => texts.map((one) => one.textContent)")
        lines = rows + [" ".join(line.split()) for text in texts for line in text.splitlines()]
        assert len(rows) == 7 and len(lines) >= 13, lines
        missing = [line for line in lines if line not in said]
        assert not missing, (missing, said)
        assert page.get_by_text("The rig is sound.").is_visible()
        assert_same(page, of_command("--no-bound", "--rig", rig, "--parameters", saved(page)), "another rig")
        assert_same(page, of_command("--no-bound", "--rig", rig), "the rig's file alone")
        longest = page.evaluate("simulationReport.now.run.rig.stroke[1]")
        assert 1.3 < longest < 1.6 and f"{longest:.3f} m" in texts[0], (longest, texts)
        page.locator("#tuning").get_by_text("free of singularities").scroll_into_view_if_needed()
        page.screenshot(path=PICTURES / "rig.png")
        # Legs that do not reach neutral.
        field = control(page, "rig.neutralHeight")
        field.fill("2")
        field.press("Enter")
        settled(page)
        assert page.get_by_text("This rig cannot be used: ").is_visible() and verdict.inner_text() == ""


@check
def the_start_is_the_original(browser):
    """With the start values, every curve and measure is that of the page's own run."""
    with tuned(browser) as page:
        move(page, "tilt.rateLimit", 60)
        page.get_by_role("button", name="Start values").click()
        settled(page)
        apart = page.evaluate("""() => {
            const [own, again] = simulationReport.runs();
            const all = (run) => [...run.desired.specific_force, ...run.desired.angular_velocity, ...run.felt.specific_force,
                ...run.felt.angular_velocity, ...run.position, ...run.orientation, ...run.legs, ...run.tilt, ...run.tilt_rate,
                run.limited.tilt, run.limited.soft, run.limited.safety, run.limited.actuator];
            const [before, after] = [all(own), all(again)];
            return before.map((series, i) => series.length !== after[i].length ? Infinity
                : series.reduce((most, value, k) => Math.max(most, Math.abs(value - after[i][k])), 0));
        }""")
        assert len(apart) == 32 and max(apart) < 1e-5, apart
        own, again = page.evaluate("simulationReport.runs().map(({ measures }) => measures.map(({ value }) => value === null ? null : simulationReport.cellText(value)))")
        assert own == again and len(own) > 40
        # Of two equal curves one is drawn, and the legend names it.
        assert page.locator(".chart .legend li", has_text="(as felt").count() > 0


@check
def the_fitting_scale_is_marked(browser):
    """At the scales of surge, sway and rates, where the command's findings have it; not with another strategy."""
    fitting = float(re.search(r"(?:; |: )scale force and rates by ([\d.]+)", " ".join(of_command()["findings"]))[1])
    mark = ".parameter:has([id='parameter-{}']) .fitting"
    with tuned(browser) as page:
        shown = page.evaluate("document.querySelectorAll('.fitting:not([hidden])').length")
        assert shown == 5, shown
        for name in ("scale.specificForce.x", "scale.angularVelocity.z"):
            found = page.locator(mark.format(name)).get_attribute("title").split()[-1]
            start = page.evaluate("(name) => simulationReport.tuning.parameters.find((one) => one.name === name).start", name)
            near(float(found), fitting * start, 0.005, name)
        move(page, "scale.specificForce.x", 100)
        assert page.locator(mark.format("scale.specificForce.x")).is_visible()
        control(page, "strategy").select_option(label="optimal")
        settled(page)
        assert not page.locator(mark.format("scale.specificForce.x")).is_visible()


@check
def changes_are_undone_and_compared(browser):
    """By keyboard: a slider, undo, the original beside the changed run."""
    with tuned(browser) as page:
        slider = slider_of(page, "scale.specificForce.x")
        field = control(page, "scale.specificForce.x")
        slider.focus()
        start = field.input_value()
        page.keyboard.press("ArrowLeft")
        settled(page)
        changed = field.input_value()
        assert float(changed) < float(start), (start, changed)
        page.keyboard.press("ArrowLeft")
        settled(page)
        assert float(field.input_value()) < float(changed), "the slider lost the focus"
        twice = field.input_value()
        for key, expected in (("Control+z", changed), ("Control+Shift+z", twice), ("Control+z", changed)):
            page.keyboard.press(key)
            settled(page)
            assert field.input_value() == expected, (key, field.input_value())
        assert shown_run(page) == "by hand"
        compare = page.get_by_role("button", name="Compare")
        for expected in ("default", "by hand"):
            compare.click()
            assert shown_run(page) == expected
        slider.focus()
        page.keyboard.press("Control+z")
        settled(page)
        assert field.input_value() == start and page.get_by_role("button", name="Undo").is_disabled()
        field.fill("0.5")
        field.press("Enter")
        settled(page)
        assert page.evaluate("simulationReport.tuning.values[simulationReport.tuning.slots.get('scale.specificForce.x')]") == 0.5
        page.get_by_label("Find a parameter").fill("damping splitter.x")
        assert slider_of(page, "splitter.x.zeta1").is_visible()
        page.screenshot(path=PICTURES / "panel.png")


@check
def parameters_are_named_and_found_in_plain_words(browser):
    """Words for what one wants find parameters; those without effect are grey and say why; numbers have four digits at most."""
    with tuned(browser) as page:
        visible = "() => [...document.querySelectorAll('#tuning .parameter')].filter((one) => one.checkVisibility()).map((one) => one.querySelector('.variable')?.textContent)"
        for word, expected in (("smooth", "input.cutoff"), ("gentle", "softLimit.pace"), ("surge", "scale.specificForce.x"), ("gentle", "tilt.rateLimit")):
            page.get_by_label("Find a parameter").fill(word)
            assert expected in page.evaluate(visible), (word, page.evaluate(visible))
        assert "scale.specificForce.x" not in page.evaluate(visible)
        page.get_by_label("Find a parameter").fill("nothing has this")
        assert page.get_by_text("No parameter has this").is_visible() and not page.evaluate(visible)
        page.get_by_label("Find a parameter").fill("")
        label = page.locator("label[for='parameter-scale.specificForce.x']")
        assert label.inner_text() == "Size of surge"
        control(page, "strategy").select_option(label="predictive")
        settled(page)
        idle = page.locator(".parameter.idle:has([id='parameter-splitter.x.omega1'])")
        assert "no effect with strategy predictive" in idle.inner_text()
        page.get_by_label("Find a parameter").fill("automaticScale.error")
        idle = page.locator(".parameter.idle:has([id='parameter-automaticScale.error'])")
        assert "no effect unless scale.automatic is on" in idle.inner_text()
        page.get_by_label("Find a parameter").fill("")
        long = page.evaluate("[...document.querySelectorAll('#tuning .parameter input[type=number], #tuning .end')].map((one) => one.value ?? one.textContent)")
        too_long = [text for text in long if sum(c.isdigit() for c in text.lstrip("0.-\u2212").split("e")[0]) > 4]
        assert not too_long, too_long


@check
def the_machine_keeps_its_proportions_when_the_panel_opens(browser):
    with tuned(browser) as page:
        page.evaluate("new Promise((next) => requestAnimationFrame(() => requestAnimationFrame(next)))")
        picture, box = page.evaluate("(() => { const v = document.getElementById('view'), b = v.getBoundingClientRect(); return [v.width / v.height, b.width / b.height]; })()")
        near(picture, box, 0.02, "width over height")


def shown_run(page):
    return page.locator("#runs button[aria-pressed=true]").inner_text()


@check_everywhere
def variants_are_kept_by_name(browser):
    """Kept, chosen, compared, renamed and deleted; the panel and the saved file are the shown one's."""
    with tuned(browser) as page:
        field = control(page, "scale.specificForce.x")
        name, runs = page.get_by_label("Name", exact=True), page.locator("#runs button")
        values = {}
        for kept, place in (("strong one", 300), ("weak", 100)):
            move(page, "scale.specificForce.x", place)
            values[kept] = field.input_value()
            name.fill(kept)
            name.press("Enter")
        assert runs.all_inner_texts() == ["default", "by hand", "strong one", "weak"]
        assert values["strong one"] != values["weak"] and shown_run(page) == "weak"
        name.fill("weak")
        page.get_by_role("button", name="Keep").click()
        assert "already" in page.locator("#tuning .panel > [role=status]").inner_text() and runs.count() == 4
        choose(page, "strong one")
        assert field.input_value() == values["strong one"]
        assert_same(page, of_command("--parameters", saved(page, "ride-strong-one.toml")), "a kept variant")
        assert page.evaluate("simulationReport.tuning.command()").endswith(" ride-strong-one.toml")
        page.get_by_label("Compare with").select_option("weak")
        for expected in ("weak", "strong one"):
            page.get_by_role("button", name="Compare").click()
            assert shown_run(page) == expected and field.input_value() == values[expected]
        # A change goes to the run by hand; what is kept stays.
        move(page, "scale.specificForce.x", 200)
        assert shown_run(page) == "by hand"
        choose(page, "strong one")
        assert field.input_value() == values["strong one"]
        name.fill("first")
        page.get_by_role("button", name="Rename").click()
        assert runs.all_inner_texts() == ["default", "by hand", "first", "weak"] and shown_run(page) == "first"
        page.locator("#charts .chart").first.scroll_into_view_if_needed()
        page.screenshot(path=PICTURES / "variants.png")
        page.get_by_role("button", name="Delete").click()
        assert runs.all_inner_texts() == ["default", "by hand", "weak"] and shown_run(page) == "by hand"
        heads = page.locator("#measures .channel").first.locator("thead th").all_inner_texts()
        assert heads == ["default", "by hand", "weak"], heads
        assert page.get_by_role("button", name="Delete").is_disabled() and page.get_by_role("button", name="Rename").is_disabled()


@check
def parameters_that_cannot_be_used_are_said_to_be(browser):
    """The curves stay those of the last parameters that could be used."""
    with tuned(browser) as page:
        move(page, "scale.specificForce.x", 200)
        before = page.evaluate("simulationReport.runs()[1].measures")
        page.get_by_label("Find a parameter").fill("head.torsoLength")
        field = control(page, "head.torsoLength")
        field.fill("9")
        field.press("Enter")
        settled(page)
        said = page.locator("#tuning .panel > [role=status]")
        assert "cannot be used: head.torsoLength" in said.inner_text()
        assert said.evaluate("(one) => getComputedStyle(one).fontSize") == "18px"
        assert page.evaluate("simulationReport.runs()[1].measures") == before


@check_everywhere
def the_panel_fits_a_phone(browser):
    """Every control has a label, and the page is not wider than the phone."""
    for scheme in ("light",) if IS_FIREFOX else ("light", "dark"):
        with tuned(browser, viewport=PHONE, color_scheme=scheme, reduced_motion="reduce") as page:
            move(page, "scale.specificForce.y", 100)
            assert page.evaluate("document.documentElement.scrollWidth") <= 390
            box = page.locator("#tuning").bounding_box()
            assert 0 < box["y"] and box["y"] + box["height"] <= 844 and box["height"] > 200, box
            unnamed = page.evaluate("""() => [...document.querySelectorAll("#tuning :is(input, select, button)")]
                .filter((one) => !one.labels?.length && !one.ariaLabel && !one.textContent).length""")
            assert unnamed == 0
            page.screenshot(path=PICTURES / f"panel-phone-{scheme}.png")


@check
def the_keyboard_is_enough(browser):
    """Tab reaches every control, each with a name and in sight of its focus; keys play, seek, tune, keep and choose."""
    with tuned(browser, reduced_motion="reduce") as page:
        reached = page.evaluate_handle("new Set()")
        controls = """[...document.querySelectorAll("button, input, select, summary, [tabindex='0']")]
            .filter((one) => one.checkVisibility() && !one.disabled && !one.closest("details:not([open]) > :not(summary)"))"""
        page.evaluate("document.activeElement.blur()")
        for _ in range(page.evaluate(f"{controls}.length") + 30):
            page.keyboard.press("Tab")
            page.evaluate("""(reached) => {
                const one = document.activeElement;
                const style = getComputedStyle(one);
                if (one !== document.body) reached.add(style.outlineStyle === "none" ? null : one);
            }""", reached)
        missed = page.evaluate(f"(reached) => {controls}.filter((one) => !reached.has(one)).map((one) => one.outerHTML)", reached)
        assert not missed, missed[:3]
        nameless = page.evaluate(f"""{controls}.filter((one) => !(one.ariaLabel || one.textContent.trim()
            || [...(one.labels || [])].some((label) => label.textContent.trim()))).map((one) => one.outerHTML)""")
        assert not nameless, nameless[:3]
        assert not page.evaluate("simulationReport.now.playing")
        page.evaluate("document.activeElement.blur()")
        page.keyboard.press("Space")
        assert page.evaluate("simulationReport.now.playing")
        page.keyboard.press("Space")
        row = page.locator(".events button").nth(1)
        row.focus()
        page.keyboard.press("Enter")
        near(page.evaluate("simulationReport.now.time"), float(row.inner_text().split()[0]), 0.01, "time of the second row")
        slider_of(page, "scale.specificForce.x").focus()
        page.keyboard.press("ArrowLeft")
        settled(page)
        page.get_by_label("Name", exact=True).focus()
        page.keyboard.type("kept")
        page.keyboard.press("Enter")
        assert shown_run(page) == "kept"
        page.locator("#runs button").first.focus()
        page.keyboard.press("Enter")
        assert shown_run(page) == "default"


@check
def text_stands_out(browser):
    """Contrast of 4.5 for text on its ground, in light and dark (WCAG 2, 1.4.3)."""
    def luminance(colour):
        parts = [int(colour[at:at + 2], 16) / 255 for at in (1, 3, 5)]
        linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
        return sum(weight * part for weight, part in zip((0.2126, 0.7152, 0.0722), linear))

    for scheme in ("light", "dark"):
        with opened(browser, "two-runs", color_scheme=scheme) as page:
            names = ["--ink", "--muted", "--accent", "--limit", "--card", "--paper"]
            values = page.evaluate("names => names.map((name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim())", names)
            of = {name: luminance(value) for name, value in zip(names, values, strict=True)}
            for text in names[:4]:
                for ground in names[4:]:
                    low, high = sorted((of[text], of[ground]))
                    assert (high + 0.05) / (low + 0.05) >= 4.5, (scheme, text, ground, (high + 0.05) / (low + 0.05))


@check
def without_webassembly_the_page_still_shows(browser):
    """A panel that cannot simulate says so, and everything else is drawn."""
    text = (PAGES / "ride.html").read_text().replace("(async () => {", "delete window.Worker;\n(async () => {", 1)
    with opened(browser, "ride", text=text) as page:
        page.locator("#tuning:not([hidden])").wait_for(state="attached")
        page.locator("#tuning summary").click()
        assert "cannot simulate" in page.locator("#tuning").inner_text()
        assert page.locator(".chart").count() > 5 and not page.locator("#alarm").is_visible()


if __name__ == "__main__":
    run_all("the report")
