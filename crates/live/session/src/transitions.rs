//! States, events, and the table that leads from one state to the next.

macro_rules! named {
    ($(#[$attribute:meta])* $type:ident { $( $(#[doc = $text:literal])+ $(#[$item_attribute:ident])? $item:ident $name:literal, )+ }) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
        pub enum $type { $( $(#[doc = $text])+ $(#[$item_attribute])? $item, )+ }

        impl $type {
            /// All of them, in the order of the table.
            pub const ALL: &'static [Self] = &[$( $type::$item ),+];

            /// The name of the item.
            pub fn name(self) -> &'static str {
                match self { $( $type::$item => $name, )+ }
            }

            /// The description of the item.
            pub fn text(self) -> &'static str {
                match self { $( $type::$item => concat!($($text),+).trim_ascii(), )+ }
            }

            /// The one of this name.
            pub fn named(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|item| item.name() == name)
            }
        }
    };
}
pub(crate) use named;

named! {
    /// State of the platform.
    State {
        /// No frames are sent.
        Off "off",
        /// The platform rests at its lowest pose.
        Settled "settled",
        /// The platform goes to neutral.
        Homing "homing",
        /// The platform rests at neutral.
        Neutral "neutral",
        /// The cue comes in.
        Engaging "engaging",
        /// The vehicle's motion is cued.
        Engaged "engaged",
        /// The vehicle is paused or silent: the cue has gone to rest.
        Frozen "frozen",
        /// The cue goes out, and the platform to neutral.
        Disengaging "disengaging",
        /// The platform goes to neutral, then down.
        Parking "parking",
        /// As disengaging, until a person clears it.
        Fault "fault",
    }
}

named! {
    /// Something that may change the state.
    Event {
        /// A person starts the platform.
        Start "start",
        /// A person asks for cues.
        Engage "engage",
        /// A person asks for no more cues.
        Disengage "disengage",
        /// A person asks for the lowest pose.
        Park "park",
        /// A person ends all frames at once.
        Stop "stop",
        /// A person clears a fault.
        Clear "clear",
        /// The device or the computer fails.
        Fault "fault",
        /// The controller is gone.
        Lost "lost",
        /// The vehicle is paused.
        Pause "pause",
        /// No good sample for 0.5 s.
        Silence "silence",
        /// No good sample for 1.5 s.
        Stale "stale",
        /// Good samples of a running vehicle again.
        Resume "resume",
        /// The vehicle is somewhere else at once.
        Teleport "teleport",
        /// The state's own motion is complete.
        Arrived "arrived",
    }
}

impl Event {
    /// True for an event of a person or of the device, which a recorded session holds. The others
    /// follow from samples and time.
    pub fn is_external(self) -> bool {
        use Event::*;
        matches!(self, Start | Engage | Disengage | Park | Stop | Clear | Fault | Lost)
    }

    /// True for an event of the device or the computer.
    pub fn is_of_device(self) -> bool {
        matches!(self, Event::Fault | Event::Lost)
    }

    /// The command of a person with this name.
    pub fn of_person(name: &str) -> Option<Self> {
        Self::named(name).filter(|event| event.is_external() && !event.is_of_device())
    }
}

/// The next state, by state and event in the order of [`Event::ALL`].
#[rustfmt::skip]
pub const STATE_TRANSITIONS: [(State, [State; 14]); 10] = {
    use State::{Disengaging as Diseng, Engaged, Engaging, Fault, Frozen, Homing, Neutral, Off, Parking, Settled};
    [
        //          start    engage    disengage park     stop clear    fault  lost   pause    silence  stale    resume    teleport  arrived
        (Off,      [Homing,  Off,      Off,      Off,     Off, Off,     Off, Off,     Off,     Off,     Off,     Off,      Off,      Off]),
        (Settled,  [Homing,  Settled,  Settled,  Settled, Off, Settled, Fault, Fault, Settled, Settled, Settled, Settled,  Settled,  Settled]),
        (Homing,   [Homing,  Homing,   Homing,   Parking, Off, Homing,  Fault, Fault, Homing,  Homing,  Homing,  Homing,   Homing,   Neutral]),
        (Neutral,  [Neutral, Engaging, Neutral,  Parking, Off, Neutral, Fault, Fault, Neutral, Neutral, Neutral, Neutral,  Neutral,  Neutral]),
        (Engaging, [Engaging,Engaging, Diseng,   Parking, Off, Engaging,Fault, Fault, Frozen,  Frozen,  Diseng,  Engaging, Engaging, Engaged]),
        (Engaged,  [Engaged, Engaged,  Diseng,   Parking, Off, Engaged, Fault, Fault, Frozen,  Frozen,  Diseng,  Engaged,  Engaging, Engaged]),
        (Frozen,   [Frozen,  Frozen,   Diseng,   Parking, Off, Frozen,  Fault, Fault, Frozen,  Frozen,  Diseng,  Engaging, Frozen,   Frozen]),
        (Diseng,   [Diseng,  Engaging, Diseng,   Parking, Off, Diseng,  Fault, Fault, Diseng,  Diseng,  Diseng,  Diseng,   Diseng,   Neutral]),
        (Parking,  [Homing,  Parking,  Parking,  Parking, Off, Parking, Fault, Fault, Parking, Parking, Parking, Parking,  Parking,  Settled]),
        (Fault,    [Fault,   Fault,    Fault,    Fault,   Off, Homing,  Fault, Fault, Fault,   Fault,   Fault,   Fault,    Fault,    Fault]),
    ]
};

impl State {
    /// The state after an event.
    pub fn after(self, event: Event) -> State {
        STATE_TRANSITIONS[self as usize].1[event as usize]
    }

    /// True if the washout is engaged.
    pub fn is_engaged(self) -> bool {
        matches!(self, State::Engaging | State::Engaged | State::Frozen)
    }

    /// True if the washout's input is the telemetry; else it is rest.
    pub fn follows_telemetry(self) -> bool {
        matches!(self, State::Engaging | State::Engaged)
    }

    /// The table of transitions in Markdown. A dot: the state stays.
    pub fn table() -> String {
        let cells = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let events = || Event::ALL.iter().map(|event| event.name().to_owned());
        let mut text = cells(["state".to_owned()].into_iter().chain(events()).collect());
        text += &format!("|{}\n", "---|".repeat(Event::ALL.len() + 1));
        for (state, next) in STATE_TRANSITIONS {
            let shown = |next: &State| if *next == state { "·".to_owned() } else { next.name().to_owned() };
            text += &cells([format!("**{}**", state.name())].into_iter().chain(next.iter().map(shown)).collect());
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rows_and_columns_are_the_states_and_events_in_order() {
        assert!(STATE_TRANSITIONS.iter().map(|row| row.0).eq(State::ALL.iter().copied()));
        assert!(STATE_TRANSITIONS.iter().all(|row| row.1.len() == Event::ALL.len()));
        for (place, state) in State::ALL.iter().enumerate() {
            assert_eq!(*state as usize, place);
            assert_eq!(State::named(state.name()), Some(*state));
        }
    }

    #[test]
    fn a_fault_is_left_by_a_person_only() {
        for event in Event::ALL {
            let next = State::Fault.after(*event);
            assert_eq!(next != State::Fault, matches!(event, Event::Stop | Event::Clear), "{event:?}");
        }
    }

    #[test]
    fn only_a_person_engages_a_platform_at_neutral_and_anyone_can_end_it() {
        for state in State::ALL {
            for event in Event::ALL {
                let engages = !state.is_engaged() && state.after(*event).is_engaged();
                assert!(!engages || *event == Event::Engage, "{state:?} {event:?}");
            }
            assert_eq!(state.after(Event::Stop), State::Off);
            if state.is_engaged() {
                for event in [Event::Disengage, Event::Park, Event::Fault, Event::Stale] {
                    assert!(!state.after(event).is_engaged(), "{state:?} {event:?}");
                }
            }
        }
    }

    #[test]
    fn the_page_shows_this_table() {
        let page = include_str!("../../../../docs/live-reference.md");
        assert!(page.contains(&State::table()), "docs/live-reference.md lacks this table:\n{}", State::table());
        for state in State::ALL {
            let row = format!("| {} | {} |", state.name(), state.text());
            assert!(page.contains(&row), "docs/live-reference.md lacks: {row}");
        }
    }
}
