//! The desk between the browsers and the loop: who controls, what is asked, and what is shown.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use moris_interface::{Group as _, Reader, Writer, slots_of};
use moris_live::session::retune;
use moris_live::{Event, State, log};
use moris_washout::{Parameters, Washout};
use rtrb::{Consumer, Producer};
use serde::Deserialize;

use super::shown::{self, NAMES, Shown};
use crate::live::Shared;

/// Time between messages.
const INTERVAL: Duration = Duration::from_millis(40);
/// Most lines of the journal that are kept.
const MOST_LINES: usize = 50;

/// An order to the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// A command.
    Event(Event),
    /// A value of a parameter, by its slot.
    Choose(u16, f64),
    /// The chosen parameters come into force.
    Retune,
}

/// An order of a browser.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
enum Ask {
    /// A command by its name.
    Event(String),
    /// Values of parameters by their names.
    Set(BTreeMap<String, f64>),
}

/// A browser's request, with the number that it was given.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Asked {
    client: String,
    ask: Ask,
}

/// All that the threads of the page share. The loop has no part in it.
pub struct Desk {
    inner: Mutex<Inner>,
    /// A new message, or the end.
    news: Condvar,
    /// All browsers control.
    shared_control: bool,
}

struct Inner {
    orders: Producer<Order>,
    /// The washout with the parameters in force, to try new ones with.
    trial: Washout,
    start: Vec<f64>,
    state: State,
    /// The browser that controls.
    controller: Option<String>,
    lines: VecDeque<String>,
    /// Parameters that differ from their start, as JSON.
    changed: String,
    /// The last message and its number.
    message: (u64, String),
    ended: bool,
}

/// The first message to a browser.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Welcome {
    client: String,
    pub controls: bool,
    names: [&'static str; NAMES.len()],
}

impl Desk {
    /// A desk for a session that starts with these parameters.
    ///
    /// # Errors
    /// They cannot be used.
    pub fn new(
        parameters: &Parameters,
        orders: Producer<Order>,
        shared_control: bool,
    ) -> Result<Self, moris_washout::ParameterError> {
        let trial = Washout::new(parameters)?;
        let inner = Inner {
            orders,
            start: slots_of(parameters),
            trial,
            state: State::Off,
            controller: None,
            lines: VecDeque::new(),
            changed: "{}".to_owned(),
            message: (0, String::new()),
            ended: false,
        };
        Ok(Desk { inner: Mutex::new(inner), news: Condvar::new(), shared_control })
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        // A thread that panicked has left nothing half done that matters.
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A line for the page's journal.
    pub fn say(&self, line: &str) {
        let mut inner = self.lock();
        inner.lines.push_back(line.trim().to_owned());
        if inner.lines.len() > MOST_LINES {
            inner.lines.pop_front();
        }
    }

    /// Makes messages of what the loop shows, until it has ended.
    pub fn show(&self, mut moments: Consumer<Shown>, shared: &Shared) {
        let mut taken = Vec::new();
        loop {
            let ended = moments.is_abandoned() || shared.done.load(std::sync::atomic::Ordering::Relaxed);
            taken.clear();
            while let Ok(moment) = moments.pop() {
                taken.push(moment);
            }
            let mut inner = self.lock();
            if let Some(text) = shown::message(&taken, &inner.lines, &inner.changed) {
                inner.message = (inner.message.0 + 1, text);
                inner.state = taken.last().map_or(inner.state, Shown::state);
            }
            inner.ended = ended;
            drop(inner);
            self.news.notify_all();
            if ended {
                return;
            }
            std::thread::sleep(INTERVAL);
        }
    }

    /// The message after this number; none at the end, or an empty one if there is none for long.
    pub fn message_after(&self, number: u64) -> Option<(u64, String)> {
        let inner = self.lock();
        let waits = |inner: &mut Inner| inner.message.0 <= number && !inner.ended;
        let (inner, waited) =
            self.news.wait_timeout_while(inner, Duration::from_secs(1), waits).unwrap_or_else(PoisonError::into_inner);
        match () {
            () if inner.message.0 > number => Some(inner.message.clone()),
            () if inner.ended => None,
            () => Some((number, if waited.timed_out() { "{}".to_owned() } else { String::new() })),
        }
    }

    /// A browser with this number has come. The first one controls.
    pub fn enter(&self, client: &str) -> Welcome {
        let mut inner = self.lock();
        let holder = inner.controller.get_or_insert_with(|| client.to_owned());
        let controls = self.shared_control || holder == client;
        Welcome { client: client.to_owned(), controls, names: NAMES }
    }

    /// A browser has gone.
    pub fn leave(&self, client: &str) {
        let mut inner = self.lock();
        if inner.controller.as_deref() == Some(client) {
            inner.controller = None;
        }
    }

    /// Passes on what a browser asks for.
    ///
    /// # Errors
    /// The number of the answer, and the reason for which it is refused.
    pub fn ask(&self, body: &[u8]) -> Result<(), (u16, String)> {
        let asked: Asked = serde_json::from_slice(body).map_err(|error| (400, error.to_string()))?;
        let mut inner = self.lock();
        if !self.shared_control && inner.controller.as_ref() != Some(&asked.client) {
            return Err((403, "another page controls".to_owned()));
        }
        let orders = match asked.ask {
            Ask::Event(name) => {
                let event = Event::of_person(&name).ok_or_else(|| (422, format!("there is no command {name}")))?;
                vec![Order::Event(event)]
            }
            Ask::Set(values) => inner.choose(&values)?,
        };
        // All or none: a part of a set may not fit together.
        let Ok(place) = inner.orders.write_chunk_uninit(orders.len()) else {
            return Err((503, "the loop has not taken the last orders yet".to_owned()));
        };
        place.fill_from_iter(orders);
        Ok(())
    }
}

impl Inner {
    /// The orders for parameters that can be used now.
    fn choose(&mut self, values: &BTreeMap<String, f64>) -> Result<Vec<Order>, (u16, String)> {
        let mut slots = slots_of(self.trial.parameters());
        let mut orders = Vec::with_capacity(values.len() + 1);
        for (name, value) in values {
            let slot = log::slot_of(name).ok_or_else(|| (422, format!("there is no parameter {name}")))?;
            slots[slot] = *value;
            orders.push(Order::Choose(slot as u16, *value));
        }
        orders.push(Order::Retune);
        let parameters = Parameters::read(&mut Reader::new(&slots));
        retune(&mut self.trial, &parameters, self.state).map_err(|error| (422, error.to_string()))?;
        self.trial.parameters().write(&mut Writer::new(&mut slots));
        let changed: BTreeMap<String, f64> = (0..slots.len())
            .filter(|slot| slots[*slot] != self.start[*slot])
            .map(|slot| (log::name_of(slot), slots[slot]))
            .collect();
        self.changed = serde_json::to_string(&changed).unwrap_or_default();
        Ok(orders)
    }
}

#[cfg(test)]
mod tests {
    use rtrb::RingBuffer;

    use super::*;

    fn desk(shared_control: bool) -> (Desk, Consumer<Order>) {
        let (orders, asked) = RingBuffer::new(64);
        (Desk::new(&Parameters::default(), orders, shared_control).unwrap(), asked)
    }

    fn taken(orders: &mut Consumer<Order>) -> Vec<Order> {
        std::iter::from_fn(|| orders.pop().ok()).collect()
    }

    #[test]
    fn the_first_browser_controls_until_it_leaves() {
        let (desk, mut orders) = desk(false);
        let park =
            |client: &str| desk.ask(format!("{{\"client\":\"{client}\",\"ask\":{{\"event\":\"park\"}}}}").as_bytes());
        assert_eq!(park("one").unwrap_err().0, 403);
        assert!(desk.enter("one").controls && !desk.enter("two").controls);
        assert_eq!(park("two").unwrap_err().0, 403);
        park("one").unwrap();
        desk.leave("two");
        park("one").unwrap();
        desk.leave("one");
        assert_eq!(park("one").unwrap_err().0, 403);
        assert_eq!(park("two").unwrap_err().0, 403);
        assert!(desk.enter("three").controls);
        assert_eq!(taken(&mut orders), [Order::Event(Event::Park); 2]);
    }

    #[test]
    fn all_browsers_control_if_they_may() {
        let (desk, mut orders) = desk(true);
        assert!(desk.enter("one").controls && desk.enter("two").controls);
        desk.ask(b"{\"client\":\"two\",\"ask\":{\"event\":\"engage\"}}").unwrap();
        assert_eq!(taken(&mut orders), [Order::Event(Event::Engage)]);
    }

    #[test]
    fn parameters_are_tried_before_the_loop_gets_them() {
        let (desk, mut orders) = desk(true);
        let set = |text: &str| desk.ask(format!("{{\"client\":\"\",\"ask\":{{\"set\":{text}}}}}").as_bytes());
        set("{\"tilt.angleLimit\":0.25,\"scale.specificForce.x\":0.5}").unwrap();
        let slot = |name: &str| log::slot_of(name).unwrap() as u16;
        let expected = [
            Order::Choose(slot("scale.specificForce.x"), 0.5),
            Order::Choose(slot("tilt.angleLimit"), 0.25),
            Order::Retune,
        ];
        assert_eq!(taken(&mut orders), expected);
        let text = desk.lock().changed.clone();
        assert_eq!(text, "{\"scale.specificForce.x\":0.5,\"tilt.angleLimit\":0.25}");
        for (wrong, number) in [
            ("{\"tilt.angleLimit\":1e300}", 422),
            ("{\"actuator.maxLength\":3}", 422),
            ("{\"nothing\":3}", 422),
            ("{\"tilt.angleLimit\":NaN}", 400),
            ("{\"tilt.angleLimit\":\"../../etc/passwd\"}", 400),
            ("[]", 400),
        ] {
            assert_eq!(set(wrong).unwrap_err().0, number, "{wrong}");
        }
        for wrong in ["fault", "arrived", "explode", ""] {
            let text = format!("{{\"client\":\"\",\"ask\":{{\"event\":\"{wrong}\"}}}}");
            assert_eq!(desk.ask(text.as_bytes()).unwrap_err().0, 422, "{wrong}");
        }
        assert!(taken(&mut orders).is_empty());
        assert_eq!(desk.lock().changed, text);
    }

    #[test]
    fn orders_that_the_loop_does_not_take_are_refused_as_a_whole() {
        let (orders, mut asked) = RingBuffer::new(4);
        let desk = Desk::new(&Parameters::default(), orders, true).unwrap();
        let set = b"{\"client\":\"\",\"ask\":{\"set\":{\"tilt.angleLimit\":0.25,\"scale.specificForce.x\":0.5}}}";
        desk.ask(set).unwrap();
        assert_eq!(desk.ask(set).unwrap_err().0, 503);
        assert_eq!(taken(&mut asked).len(), 3);
    }
}
