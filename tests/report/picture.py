#!/usr/bin/env python3
"""Makes a picture of a page: a report of `cargo moris simulate` or the page of `moris live` in, an SVG with the browser's picture
in it out.

    cargo moris simulate ride.csv --report report
    python3 tests/report/run.py --install          # once: Chromium and Playwright
    target/report/venv/bin/python tests/report/picture.py report/ride.html docs/report.svg --time 34.5 --tuned

    python3 examples/vehicle.py 60 &
    cargo moris live --from udp:4444 --format csv --dry --engage --page --for 60
    target/report/venv/bin/python tests/report/picture.py "http://127.0.0.1:PORT/?token=..." docs/live-page.svg --time 30
"""

import argparse
import base64
from pathlib import Path

from playwright.sync_api import sync_playwright
from run import browser

SIZE = {"width": 1366, "height": 768}


def tune(page):
    """Opens the panel, keeps a variant, and changes the scale of surge."""
    page.locator("#tuning summary").click()
    page.locator("#parameter-strategy").select_option(label="predictive")
    page.wait_for_timeout(2000)
    page.get_by_label("Name", exact=True).fill("planned")
    page.get_by_role("button", name="Keep").click()
    field = page.locator("[id='parameter-scale.specificForce.x']")
    field.fill("0.5")
    field.press("Enter")
    page.wait_for_timeout(2000)
    page.locator("#charts section").nth(1).evaluate("section => section.scrollIntoView()")


def picture(page_file, time, is_tuned):
    """A page at a time of the ride, as a JPEG."""
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=browser())
        page = chromium.new_page(viewport=SIZE)
        if page_file.startswith("http:"):
            page.goto(page_file)
            page.wait_for_timeout(1000 * time)
            return page.screenshot(type="jpeg", quality=75)
        page.goto(Path(page_file).resolve().as_uri())
        page.wait_for_selector("#alarm[hidden], body.failed", state="attached")
        if is_tuned:
            page.wait_for_selector("#tuning:not([hidden])", state="attached")
            tune(page)
        slider = page.locator("#slider")
        slider.evaluate("(slider, time) => { slider.value = time; slider.dispatchEvent(new Event('input')); }", time)
        page.wait_for_timeout(500)
        return page.screenshot(type="jpeg", quality=75)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", help="a report, as cargo moris simulate makes it, or an address that moris live prints")
    parser.add_argument("picture", help="the SVG to write")
    parser.add_argument("--tuned", action="store_true", help="with the panel of parameters, a variant and a change")
    parser.add_argument("--time", type=float, default=0.0, help="time of the ride in seconds; with an address the time to wait")
    arguments = parser.parse_args()
    image = base64.b64encode(picture(arguments.page, arguments.time, arguments.tuned)).decode()
    width, height = SIZE["width"], SIZE["height"]
    Path(arguments.picture).write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}">\n'
        f'<image width="{width}" height="{height}" href="data:image/jpeg;base64,{image}"/>\n</svg>\n'
    )


if __name__ == "__main__":
    main()
