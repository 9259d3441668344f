//! The functions of the WebAssembly: the page's script writes numbers, calls, and reads numbers or
//! text.

use std::cell::RefCell;

use moris_pages::memory::{group, respond, write};
use serde_json::json;

use moris_pages::ride::{Ride, RiderCommand};

thread_local! {
    static RIDE: RefCell<Option<Ride>> = RefCell::default();
}

/// Calls with the ride; does nothing without one.
fn with_ride<T: Default>(act: impl FnOnce(&mut Ride) -> T) -> T {
    RIDE.with_borrow_mut(|ride| ride.as_mut().map(act).unwrap_or_default())
}

/// Begins with the parameters that the numbers hold. True if the text has the names of what
/// [`view`] gives; false if it is the reason why the parameters cannot be used.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn create() -> bool {
    respond(Ride::new(&group()).map(|mut ride| {
        let names: Vec<&str> = ride.view().into_iter().map(|(name, _)| name).collect();
        RIDE.set(Some(ride));
        json!(names).to_string()
    }))
}

/// Takes the parameters that the numbers hold. False if the text is the reason why it cannot.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn retune() -> bool {
    with_ride(|ride| respond(ride.retune(&group()).map(|_| String::new())))
}

/// Sets the friction of the road; false if it is out of range.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn set_friction(friction: f64) -> bool {
    with_ride(|ride| ride.set_friction(friction).is_ok())
}

/// Rides so many milliseconds.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn advance(milliseconds: u32, throttle: f64, brake: f64, stick: f64, is_helped: bool) {
    let command = RiderCommand { throttle, brake, stick, is_helped };
    with_ride(|ride| (0..milliseconds).for_each(|_| ride.step(&command)));
}

/// Gives the washout the preview by earlier laps from now on, or none.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn learn(is_on: bool) {
    with_ride(|ride| ride.learn(is_on));
}

/// Ends the ride for the next one.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn restart() -> bool {
    with_ride(|ride| ride.restart().is_ok())
}

/// Writes what the page shows to the numbers, and returns their address.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn view() -> *const f64 {
    write(with_ride(|ride| ride.view().into_iter().map(|(_, value)| value).collect::<Vec<f64>>()).into_iter())
}

/// Writes the road to the numbers: x, y, heading and advised speed of each point. Returns their
/// address.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn road() -> *const f64 {
    write(with_ride(|ride| road_points(ride)).into_iter())
}

/// Number of the road's points.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn road_length() -> usize {
    with_ride(|ride| road_points(ride).len() / 4)
}

fn road_points(ride: &Ride) -> Vec<f64> {
    ride.course().points().flat_map(|(place, advised)| [place.x, place.y, place.yaw, advised]).collect()
}

/// Makes a text of a lap's time and measures; false without such a lap.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn lap(number: usize) -> bool {
    with_ride(|ride| {
        let lap = ride.laps().get(number).ok_or("no such lap");
        respond(lap.map(|lap| {
            let ratings = ride.ratings(lap);
            json!({ "time": lap.time, "is_mixed": lap.is_mixed, "ratings": ratings }).to_string()
        }))
    })
}

/// Makes a text of the recording as a CSV file; false without a ride.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn csv() -> bool {
    with_ride(|ride| respond(Ok::<_, &str>(ride.recording().csv())) && ride.recording().samples() > 1)
}
