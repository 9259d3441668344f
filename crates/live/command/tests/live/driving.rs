//! The motorcycle that is ridden with the page's controls.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use serde_json::Value;

use crate::page::{Page, end};
use crate::rig::Live;

/// Full throttle, straight on and off the road.
const FULL: &str = "{\"drive\":{\"throttle\":1,\"brake\":0,\"stick\":0,\"is_helped\":false}}";
const AWAY: &str = "{\"drive\":{\"throttle\":1,\"brake\":0,\"stick\":1,\"is_helped\":false}}";

/// The number with this name in the last row of a message; none before the first row.
fn number(names: &Value, message: &Value, name: &str) -> Option<f64> {
    let place = names.as_array()?.iter().position(|known| known == name)?;
    message["rows"].as_array()?.last()?.get(place)?.as_f64()
}

/// Holds the controls, as a page does, until something has been done.
fn hold(page: &Page, client: &str, controls: &str, act: impl FnOnce()) {
    let is_done = AtomicBool::new(false);
    thread::scope(|scope| {
        scope.spawn(|| {
            while !is_done.load(Ordering::Relaxed) {
                assert_eq!(page.ask(client, controls), 200);
                thread::sleep(Duration::from_millis(40));
            }
        });
        act();
        is_done.store(true, Ordering::Relaxed);
    });
}

#[test]
fn the_first_page_rides_and_its_silence_closes_the_throttle() {
    let directory = tempfile::tempdir().unwrap();
    let mut live = Live::start(directory.path(), "ride", &["--page", "--engage"]);
    let page = Page::of(&mut live);
    let mut first = page.events();
    let welcome = first.next();
    assert_eq!(welcome["drives"], true);
    let (one, names) = (welcome["client"].as_str().unwrap(), welcome["names"].clone());
    let (two, _) = page.events().welcome();
    assert_eq!(page.ask(&two, FULL), 403);
    assert_eq!(page.ask(&two, "\"begin_again\""), 403);
    for garbage in [
        "{\"drive\":{\"throttle\":2,\"brake\":0,\"stick\":0,\"is_helped\":true}}",
        "{\"drive\":{\"throttle\":0,\"brake\":0,\"stick\":-1.5,\"is_helped\":true}}",
        "{\"drive\":{\"throttle\":1e999,\"brake\":0,\"stick\":0,\"is_helped\":true}}",
        "{\"drive\":{\"throttle\":null,\"brake\":0,\"stick\":0,\"is_helped\":true}}",
        "{\"drive\":{\"throttle\":1}}",
        "{\"drive\":[]}",
        "\"drive\"",
    ] {
        assert!([400, 422].contains(&page.ask(one, garbage)), "{garbage}");
    }
    live.wait_for("engaging");
    let speed = |message: &Value| number(&names, message, "speed").unwrap_or_default();
    // Nobody has held anything: it stands.
    first.wait_for(|message| message["state"] == "engaging" && speed(message) == 0.0);
    hold(&page, one, FULL, || first.wait_for(|message| speed(message) > 8.0));
    // Silence: it gets no faster than the lag of the throttle has it.
    let mut fastest = 0.0_f64;
    first.wait_for(|message| {
        fastest = fastest.max(speed(message));
        speed(message) > 0.0 && speed(message) < fastest - 0.1
    });
    assert!(fastest < 30.0, "{fastest} m/s");
    // Past the end of the road the cue goes to rest, and a new ride brings it back.
    hold(&page, one, AWAY, || first.wait_for(|message| message["state"] == "frozen"));
    first.wait_for(|message| message["lines"].to_string().contains("telemetry: paused"));
    assert_eq!(page.ask(one, "\"begin_again\""), 200);
    // The speed glides to the new ride's, and at its end the platform is engaged.
    let is_back = |state: &Value| state == "engaging" || state == "engaged";
    first.wait_for(|message| is_back(&message["state"]) && speed(message) == 0.0);
    end(live);
}

#[test]
fn other_vehicles_have_no_controls() {
    let directory = tempfile::tempdir().unwrap();
    let from = format!("udp:{}", crate::rig::free_port());
    let mut live = Live::start(directory.path(), &from, &["--format", "csv", "--page"]);
    let page = Page::of(&mut live);
    let mut events = page.events();
    let welcome = events.next();
    assert_eq!(welcome["drives"], false);
    let client = welcome["client"].as_str().unwrap();
    assert_eq!(page.ask(client, FULL), 422);
    assert_eq!(page.ask(client, "{\"event\":\"start\"}"), 200);
    live.wait_for("homing");
    end(live);
}
