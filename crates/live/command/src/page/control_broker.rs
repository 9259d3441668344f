//! The broker between the browsers and the loop: who controls, what is asked, and what is shown.

use std::collections::BTreeMap;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use moris_interface::{Group as _, Reader, slots_of};
use moris_live::session::retune;
use moris_live::{Event, Legs, State, log};
use moris_pages::ride::RiderCommand;
use moris_setup::Setup;
use moris_washout::{ParameterError, Parameters, Washout};
use rtrb::{Consumer, Producer};
use serde::Deserialize;

use super::http::HttpError;
use super::snapshot::{self, ROW_NAMES, Snapshot};
use crate::controls::Controls;
use crate::frames::Loss;
use crate::{Shared, loop_clock};

/// An order to the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// A command of the operator.
    Event(Event),
    /// A value of a parameter, by its slot.
    Choose(u16, f64),
    /// The chosen parameters come into force.
    Retune,
    /// The controller does not follow any more.
    Lost(Loss),
    /// The controller has reported the legs' lengths \[m\].
    Report([f64; 6]),
    /// The operator has said where the legs are.
    Legs(Legs),
}

/// An order of a browser.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
enum Ask {
    /// A command by its name.
    Event(String),
    /// Where the legs are, for the next start: settled or slow.
    Legs(String),
    /// Values of parameters by their names.
    Set(BTreeMap<String, f64>),
    /// The vehicle's controls as they are held.
    Drive(RiderCommand),
    /// The vehicle begins a new ride.
    BeginAgain,
}

/// A browser's request, with the number that it was given.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Asked {
    client: String,
    ask: Ask,
}

/// All that the threads of the page share. The loop has no part in it.
pub struct ControlBroker {
    inner: Mutex<Inner>,
    /// Stop and park, which wait for nothing else.
    urgent: Mutex<Producer<Order>>,
    /// A new message, or the end.
    news: Condvar,
    controls: Option<Arc<Controls>>,
    /// All browsers command. The first one alone drives.
    shared_control: bool,
}

struct Inner {
    orders: Producer<Order>,
    /// The washout with the parameters in force, to try new ones with.
    trial: Washout,
    start: Vec<f64>,
    state: State,
    /// The browser that controls.
    controller: Option<Browser>,
    /// Browsers that are here, the latest last.
    browsers: Vec<Browser>,
    /// Browsers that have come.
    count: u64,
    /// The last message and its number.
    message: (u64, String),
    ended: bool,
}

/// A browser: its secret number, and the one that all may know.
#[derive(Clone, Debug, PartialEq)]
struct Browser {
    client: String,
    number: u64,
}

/// The first message to a browser.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Welcome {
    client: String,
    /// The browser's number among those that have come.
    number: u64,
    pub controls: bool,
    /// All browsers command.
    shared: bool,
    /// True if this browser holds the vehicle's controls.
    pub drives: bool,
    /// The vehicle has controls.
    can_drive: bool,
    names: Vec<&'static str>,
}

impl ControlBroker {
    /// A broker for a session that starts with these parameters.
    ///
    /// # Errors
    /// The parameters cannot be used.
    pub fn new(
        setup: &Setup,
        [orders, urgent]: [Producer<Order>; 2],
        controls: Option<Arc<Controls>>,
        shared_control: bool,
    ) -> Result<Self, moris_washout::ParameterError> {
        let trial = Washout::new(&setup.parameters)?;
        let inner = Inner {
            orders,
            start: slots_of(&setup.parameters),
            trial,
            state: State::Off,
            controller: None,
            browsers: Vec::new(),
            count: 0,
            message: (0, String::new()),
            ended: false,
        };
        Ok(ControlBroker {
            inner: Mutex::new(inner),
            urgent: Mutex::new(urgent),
            news: Condvar::new(),
            controls,
            shared_control,
        })
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        // A thread that panicked has left nothing half done that matters.
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Makes messages of what the loop shows, until it has ended. `refusals`: the parameters in
    /// force where the loop has refused others.
    pub fn show(&self, mut moments: Consumer<Snapshot>, mut refusals: Consumer<Parameters>, shared: &Shared) {
        // Time between messages.
        const MESSAGE_INTERVAL: Duration = Duration::from_millis(40);
        loop {
            let ended = moments.is_abandoned() || shared.done.load(Ordering::Relaxed);
            let taken: Vec<Snapshot> = std::iter::from_fn(|| moments.pop().ok()).collect();
            let [late, latest] = shared.late_frame.each_ref().map(|late| late.load(Ordering::Relaxed));
            let place = self.controls.as_ref().and_then(|controls| controls.place());
            let place = serde_json::to_string(&place).unwrap_or_default();
            let mut inner = self.lock();
            while let Ok(parameters) = refusals.pop() {
                inner.return_to(&parameters);
            }
            let holder = inner.controller.as_ref().map_or(0, |holder| holder.number);
            let changed = inner.changed();
            let status = format!(
                "\"changed\":{changed},\"holder\":{holder},\"late_frames\":[{late},{latest}],\"place\":{place}"
            );
            if let Some(text) = snapshot::message(&taken, &shared.lines(), &status) {
                inner.message = (inner.message.0 + 1, text);
                inner.state = taken.last().map_or(inner.state, |shown| shown.state);
            }
            inner.ended = ended;
            drop(inner);
            self.news.notify_all();
            if ended {
                return;
            }
            std::thread::sleep(MESSAGE_INTERVAL);
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

    /// A browser with this secret number has come. The first one controls.
    pub fn enter(&self, client: &str) -> Welcome {
        // Most browsers that are known.
        const MOST_BROWSERS: usize = 64;
        let mut inner = self.lock();
        inner.count += 1;
        let browser = Browser { client: client.to_owned(), number: inner.count };
        inner.browsers.push(browser.clone());
        if inner.browsers.len() > MOST_BROWSERS {
            inner.browsers.remove(0);
        }
        let is_first = *inner.controller.get_or_insert_with(|| browser.clone()) == browser;
        let can_drive = self.controls.is_some();
        Welcome {
            client: browser.client,
            number: browser.number,
            controls: self.shared_control || is_first,
            shared: self.shared_control,
            drives: is_first && can_drive,
            can_drive,
            names: ROW_NAMES.split(' ').collect(),
        }
    }

    /// A browser has gone. The next that asks controls.
    pub fn leave(&self, client: &str) {
        let mut inner = self.lock();
        inner.browsers.retain(|browser| browser.client != client);
        if inner.controller.as_ref().is_some_and(|holder| holder.client == client) {
            inner.controller = None;
            self.controls.as_ref().inspect(|controls| controls.release());
        }
    }

    /// Passes on what a browser asks for.
    ///
    /// # Errors
    /// The status of the refusal, and its reason.
    pub fn ask(&self, body: &[u8]) -> Result<(), HttpError> {
        let asked: Asked = serde_json::from_slice(body).map_err(|error| HttpError::new(400, error.to_string()))?;
        if let Ask::Event(name) = &asked.ask
            && let Some(event @ (Event::Stop | Event::Park)) = Event::of_person(name)
        {
            // From whichever page it comes.
            let mut urgent = self.urgent.lock().unwrap_or_else(PoisonError::into_inner);
            return urgent.push(Order::Event(event)).map_err(|_| HttpError::new(503, ORDERS_WAIT));
        }
        let mut inner = self.lock();
        if inner.controller.is_none() {
            inner.controller = inner.browsers.iter().find(|browser| browser.client == asked.client).cloned();
        }
        let drives = matches!(asked.ask, Ask::Drive(_) | Ask::BeginAgain);
        let holds = inner.controller.as_ref().is_some_and(|holder| holder.client == asked.client);
        if (drives || !self.shared_control) && !holds {
            return Err(HttpError::new(403, "another page controls; Stop and Park work here, too"));
        }
        match asked.ask {
            Ask::Drive(command) => self.drive(|controls| controls.hold(&command, loop_clock::now())),
            Ask::BeginAgain => self.drive(Controls::begin_again),
            Ask::Event(name) => {
                let event = Event::of_person(&name).ok_or_else(|| format!("there is no command {name}"))?;
                inner.send(&[Order::Event(event)])
            }
            Ask::Legs(name) => {
                let legs = Legs::of_person(&name).ok_or_else(|| format!("{name} is no place of the legs"))?;
                inner.send(&[Order::Legs(legs)])
            }
            Ask::Set(values) => {
                let values: Option<Vec<_>> =
                    values.iter().map(|(name, value)| Some((log::slot_of(name)?, *value))).collect();
                let values = values.ok_or_else(|| "there is no such parameter".to_owned())?;
                inner.choose(&values)
            }
        }
    }

    fn drive(&self, act: impl FnOnce(&Controls) -> Result<(), String>) -> Result<(), HttpError> {
        let controls = self.controls.as_ref().ok_or_else(|| "this vehicle has no controls".to_owned())?;
        Ok(act(controls)?)
    }
}

/// Reason of a refusal while the loop's ring is full.
const ORDERS_WAIT: &str = "the loop has not taken the last orders yet";

impl Inner {
    /// Passes orders on: all or none, because a part of a set may not fit together.
    fn send(&mut self, orders: &[Order]) -> Result<(), HttpError> {
        let Ok(place) = self.orders.write_chunk_uninit(orders.len()) else {
            return Err(HttpError::new(503, ORDERS_WAIT));
        };
        place.fill_from_iter(orders.iter().copied());
        Ok(())
    }

    /// The loop has refused what was chosen: these parameters are in force.
    fn return_to(&mut self, parameters: &Parameters) {
        let mut parameters = *parameters;
        // The session's own, whatever was given.
        parameters.conditioning.angular_velocity_frame = self.trial.parameters().conditioning.angular_velocity_frame;
        if let Ok(trial) = Washout::new(&parameters) {
            self.trial = trial;
        }
    }

    /// Puts values of slots in force if they can be used now.
    fn choose(&mut self, values: &[(usize, f64)]) -> Result<(), HttpError> {
        for (slot, value) in values {
            log::check_value(*slot, *value).map_err(|error| error.to_string())?;
        }
        let mut slots = slots_of(self.trial.parameters());
        values.iter().for_each(|(slot, value)| slots[*slot] = *value);
        let mut tried = self.trial.clone();
        let parameters = Parameters::read(&mut Reader::new(&slots));
        retune(&mut tried, &parameters, self.state).map_err(|error| self.reason(&parameters, &error))?;
        let chosen = values.iter().map(|(slot, value)| Order::Choose(*slot as u16, *value));
        self.send(&chosen.chain([Order::Retune]).collect::<Vec<_>>())?;
        self.trial = tried;
        Ok(())
    }

    /// The reason for which parameters are refused, in words of the operator at the platform.
    fn reason(&self, parameters: &Parameters, error: &ParameterError) -> String {
        if retune(&mut self.trial.clone(), parameters, State::Settled).is_err() {
            return error.to_string();
        }
        let [present, wanted] = [self.trial.parameters(), parameters].map(slots_of);
        let differing = (0..present.len()).filter(|slot| present[*slot] != wanted[*slot]).map(log::name_of);
        let names = differing.take(3).collect::<Vec<_>>().join(", ");
        format!("Park first: {names} cannot change like this before the platform is settled")
    }

    /// A JSON object of the parameters that differ from their start.
    fn changed(&self) -> String {
        let slots = slots_of(self.trial.parameters());
        let changed: BTreeMap<String, f64> = (0..slots.len())
            .filter(|slot| slots[*slot] != self.start[*slot])
            .map(|slot| (log::name_of(slot), slots[slot]))
            .collect();
        serde_json::to_string(&changed).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use rtrb::RingBuffer;

    use super::*;

    fn setup() -> Setup {
        Setup::load(None, &[]).unwrap()
    }

    fn broker(shared_control: bool) -> (ControlBroker, Consumer<Order>) {
        let (orders, asked) = RingBuffer::new(64);
        (ControlBroker::new(&setup(), [orders, RingBuffer::new(8).0], None, shared_control).unwrap(), asked)
    }

    fn taken(orders: &mut Consumer<Order>) -> Vec<Order> {
        std::iter::from_fn(|| orders.pop().ok()).collect()
    }

    #[test]
    fn control_passes_to_the_next_browser_that_asks() {
        let (broker, mut orders) = broker(false);
        let start = |client: &str| {
            broker.ask(format!("{{\"client\":\"{client}\",\"ask\":{{\"event\":\"start\"}}}}").as_bytes())
        };
        // Somebody who has not come.
        assert_eq!(start("one").unwrap_err().number, 403);
        assert!(broker.enter("one").controls && !broker.enter("two").controls && !broker.enter("three").controls);
        assert_eq!(start("two").unwrap_err().number, 403);
        start("one").unwrap();
        broker.leave("three");
        assert_eq!(start("two").unwrap_err().number, 403);
        broker.leave("one");
        assert_eq!(start("one").unwrap_err().number, 403);
        assert_eq!(start("three").unwrap_err().number, 403);
        start("two").unwrap();
        assert!(!broker.enter("four").controls);
        assert_eq!(start("four").unwrap_err().number, 403);
        assert_eq!(taken(&mut orders), [Order::Event(Event::Start); 2]);
    }

    #[test]
    fn stop_and_park_work_from_every_page_while_the_desk_is_busy_or_its_orders_are_not_taken() {
        let ([orders, urgent], [_asked, mut at_once]) = {
            let ((orders, asked), (urgent, at_once)) = (RingBuffer::new(1), RingBuffer::new(8));
            ([orders, urgent], [asked, at_once])
        };
        let broker = ControlBroker::new(&setup(), [orders, urgent], None, false).unwrap();
        broker.enter("one");
        broker.ask(b"{\"client\":\"one\",\"ask\":{\"event\":\"start\"}}").unwrap();
        assert_eq!(broker.ask(b"{\"client\":\"one\",\"ask\":{\"event\":\"start\"}}").unwrap_err().number, 503);
        let busy = broker.lock();
        broker.ask(b"{\"client\":\"two\",\"ask\":{\"event\":\"stop\"}}").unwrap();
        broker.ask(b"{\"client\":\"\",\"ask\":{\"event\":\"park\"}}").unwrap();
        drop(busy);
        assert_eq!(taken(&mut at_once), [Event::Stop, Event::Park].map(Order::Event));
    }

    #[test]
    fn all_browsers_control_if_they_may() {
        let (broker, mut orders) = broker(true);
        assert!(broker.enter("one").controls && broker.enter("two").controls);
        broker.ask(b"{\"client\":\"two\",\"ask\":{\"event\":\"engage\"}}").unwrap();
        assert_eq!(taken(&mut orders), [Order::Event(Event::Engage)]);
    }

    #[test]
    fn parameters_are_tried_before_the_loop_gets_them() {
        let (broker, mut orders) = broker(true);
        let set = |text: &str| broker.ask(format!("{{\"client\":\"\",\"ask\":{{\"set\":{text}}}}}").as_bytes());
        set("{\"tilt.angleLimit\":0.25,\"scale.specificForce.x\":0.5}").unwrap();
        let slot = |name: &str| log::slot_of(name).unwrap() as u16;
        let expected = [
            Order::Choose(slot("scale.specificForce.x"), 0.5),
            Order::Choose(slot("tilt.angleLimit"), 0.25),
            Order::Retune,
        ];
        assert_eq!(taken(&mut orders), expected);
        let text = broker.lock().changed();
        assert!(text.starts_with("{\"scale.specificForce.x\":0.5,\"tilt.angleLimit\":0.25}"), "{text}");
        for (wrong, status) in [
            ("{\"tilt.angleLimit\":1e300}", 422),
            ("{\"actuator.maxLength\":3}", 422),
            // No item of an enumeration is between two others or behind the last.
            ("{\"strategy\":2.5}", 422),
            ("{\"strategy\":1e300}", 422),
            ("{\"strategy\":0}", 422),
            ("{\"nothing\":3}", 422),
            ("{\"tilt.angleLimit\":NaN}", 400),
            ("{\"tilt.angleLimit\":\"../../etc/passwd\"}", 400),
            ("[]", 400),
        ] {
            assert_eq!(set(wrong).unwrap_err().number, status, "{wrong}");
        }
        for wrong in ["fault", "arrived", "explode", ""] {
            let text = format!("{{\"client\":\"\",\"ask\":{{\"event\":\"{wrong}\"}}}}");
            assert_eq!(broker.ask(text.as_bytes()).unwrap_err().number, 422, "{wrong}");
        }
        assert!(taken(&mut orders).is_empty());
        assert_eq!(broker.lock().changed(), text);
    }

    #[test]
    fn what_needs_a_settled_platform_is_said_as_park_first() {
        let (broker, mut orders) = broker(true);
        let set = |text: &str| broker.ask(format!("{{\"client\":\"\",\"ask\":{{\"set\":{text}}}}}").as_bytes());
        for state in [State::Neutral, State::Engaged, State::Fault] {
            broker.lock().state = state;
            for (change, name) in
                [("{\"strategy\":2}", "strategy"), ("{\"scale.specificForce.x\":-1}", "scale.specificForce.x")]
            {
                let HttpError { number: status, reason: why } = set(change).unwrap_err();
                assert_eq!(status, 422);
                assert!(why.starts_with("Park first: ") && why.contains(name), "{why}");
            }
            // What never can be used has its own reason.
            let why = set("{\"tilt.angleLimit\":1e300}").unwrap_err().reason;
            assert!(why.contains("tilt.angleLimit") && !why.contains("Park first"), "{why}");
        }
        assert!(taken(&mut orders).is_empty());
        broker.lock().state = State::Settled;
        set("{\"strategy\":2}").unwrap();
    }

    #[test]
    fn a_strategy_that_the_loop_has_refused_is_not_shown() {
        let (broker, _asked) = broker(true);
        let before = *broker.lock().trial.parameters();
        broker.lock().state = State::Settled;
        broker.ask(b"{\"client\":\"\",\"ask\":{\"set\":{\"strategy\":2}}}").unwrap();
        assert!(broker.lock().changed().contains("\"strategy\":2"));
        broker.lock().return_to(&before);
        assert_eq!(broker.lock().changed(), "{}");
    }

    #[test]
    fn orders_that_the_loop_does_not_take_are_refused_as_a_whole() {
        let (orders, mut asked) = RingBuffer::new(4);
        let broker = ControlBroker::new(&setup(), [orders, RingBuffer::new(8).0], None, true).unwrap();
        let set = b"{\"client\":\"\",\"ask\":{\"set\":{\"tilt.angleLimit\":0.25,\"scale.specificForce.x\":0.5}}}";
        broker.ask(set).unwrap();
        assert_eq!(broker.ask(set).unwrap_err().number, 503);
        assert_eq!(taken(&mut asked).len(), 3);
    }
}
