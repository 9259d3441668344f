//! The functions of the WebAssembly: the page's script writes numbers, calls, and reads numbers or
//! text.

use std::cell::RefCell;

use moris_interface::{Group, Reader};
use moris_washout::Parameters;
use serde_json::json;

use crate::ride::{Command, Ride};

/// Memory that the page reads and writes, and the ride.
#[derive(Default)]
struct Exchange {
    numbers: Vec<f64>,
    text: String,
    ride: Option<Ride>,
}

thread_local! {
    static EXCHANGE: RefCell<Exchange> = RefCell::default();
}

impl Exchange {
    /// Puts a text for the page; true for a good one.
    fn say(&mut self, text: Result<String, impl ToString>) -> bool {
        let is_good = text.is_ok();
        self.text = text.unwrap_or_else(|reason| reason.to_string());
        is_good
    }
}

/// Calls with the ride; does nothing without one.
fn with_ride<T: Default>(act: impl FnOnce(&mut Ride, &mut Vec<f64>) -> T) -> T {
    EXCHANGE.with_borrow_mut(|Exchange { ride, numbers, .. }| match ride {
        Some(ride) => act(ride, numbers),
        None => T::default(),
    })
}

/// Memory for so many numbers, which the page writes.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn numbers(count: usize) -> *mut f64 {
    EXCHANGE.with_borrow_mut(|exchange| {
        exchange.numbers.clear();
        exchange.numbers.resize(count, 0.0);
        exchange.numbers.as_mut_ptr()
    })
}

/// Begins with the parameters that the numbers hold. True if the text has the names of what
/// [`view`] gives; false if it is the reason why the parameters cannot be used.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn create() -> bool {
    EXCHANGE.with_borrow_mut(|exchange| {
        let made = Ride::new(&Parameters::read(&mut Reader::new(&exchange.numbers)));
        let named = made.map(|mut ride| {
            let names: Vec<&str> = ride.view().into_iter().map(|(name, _)| name).collect();
            exchange.ride = Some(ride);
            json!(names).to_string()
        });
        exchange.say(named)
    })
}

/// Takes the parameters that the numbers hold. False if the text is the reason why it cannot.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn retune() -> bool {
    EXCHANGE.with_borrow_mut(|exchange| {
        let parameters = Parameters::read(&mut Reader::new(&exchange.numbers));
        let Some(ride) = exchange.ride.as_mut() else { return false };
        let done = ride.retune(&parameters).map(|_| String::new());
        exchange.say(done)
    })
}

/// Sets the friction of the road; false if it is out of range.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn set_friction(friction: f64) -> bool {
    with_ride(|ride, _| ride.set_friction(friction).is_ok())
}

/// Rides so many milliseconds.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn advance(milliseconds: u32, throttle: f64, brake: f64, stick: f64, is_helped: bool) {
    let command = Command { throttle, brake, stick, is_helped };
    with_ride(|ride, _| (0..milliseconds).for_each(|_| ride.step(&command)));
}

/// Ends the ride for the next one.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn restart() -> bool {
    with_ride(|ride, _| ride.restart().is_ok())
}

/// Writes what the page shows to the numbers, and returns their address.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn view() -> *const f64 {
    EXCHANGE.with_borrow_mut(|Exchange { ride, numbers, .. }| {
        numbers.clear();
        numbers.extend(ride.iter_mut().flat_map(Ride::view).map(|(_, value)| value));
        numbers.as_ptr()
    })
}

/// Writes the road to the numbers: x, y, heading and advised speed of each point. The result is the
/// number of points.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn road() -> usize {
    with_ride(|ride, numbers| {
        numbers.clear();
        numbers.extend(ride.course().points().flat_map(|(place, advised)| [place.x, place.y, place.yaw, advised]));
        numbers.len() / 4
    })
}

/// Address of the numbers.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn written() -> *const f64 {
    EXCHANGE.with_borrow(|exchange| exchange.numbers.as_ptr())
}

/// Makes a text of a lap's time and measures; false without such a lap.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn lap(number: usize) -> bool {
    EXCHANGE.with_borrow_mut(|exchange| {
        let Some(ride) = &exchange.ride else { return false };
        let Some(lap) = ride.laps().get(number) else { return false };
        let text = json!({ "time": lap.time, "is_mixed": lap.is_mixed, "ratings": ride.ratings(lap) });
        exchange.text = text.to_string();
        true
    })
}

/// Makes a text of the recording as a CSV file; false without a ride.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn csv() -> bool {
    EXCHANGE.with_borrow_mut(|exchange| {
        let Some(ride) = &exchange.ride else { return false };
        exchange.text = ride.recording().csv();
        ride.recording().samples() > 1
    })
}

/// Address of the text.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn text() -> *const u8 {
    EXCHANGE.with_borrow(|exchange| exchange.text.as_ptr())
}

/// Length of the text in bytes.
// SAFETY: no other function of this module has the name.
#[unsafe(no_mangle)]
pub extern "C" fn text_length() -> usize {
    EXCHANGE.with_borrow(|exchange| exchange.text.len())
}
