//! Telemetry from a socket, from a topic of ROS 2, from a recording in real time, or from a vehicle
//! that is stepped here.

use std::net::UdpSocket;
use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::Duration;

use anyhow::{Context, Result};
use clap::ValueEnum;
use moris_live::format::{Format, Vehicle as Kind};
use moris_live::{Motion, Sample, State};
use moris_pages::report::Vehicle as Shape;
use moris_pages::ride::RoadMap;
use moris_washout::Input as Sampled;
use moris_washout::interface::AngularVelocityFrame;
use moris_washout::motion::orientation::Orientation;
use nalgebra::Vector3;
use rtrb::Producer;

use super::controls::{Controls, Handling};
use super::journal::say;
use super::page::Desk;
#[cfg(feature = "ros2")]
use super::ros2::Subscription;
use super::sender::{Dropped, Followed};
use super::vehicle::{self, Fmu, Motorcycle, Vehicle};
use super::{Options, Shared, pace, tables};
use crate::recording::formats::Format as Logger;
use crate::recording::{ConventionOptions, FADE_IN, Recording};
use crate::simulate::vehicle as drawn;

/// Time by which samples of a source inside are there before they are needed.
pub const BEFORE: Duration = Duration::from_millis(5);

/// A sample, and when it arrived.
#[derive(Clone, Copy, Debug)]
pub struct Received {
    /// Time of [`pace::now`]; of a source inside that for which the sample is.
    pub arrival: Duration,
    /// Motion of the vehicle.
    pub sample: Sample,
}

/// The accepted values of `--from`.
const SOURCES: &str = "must be udp:PORT with a port from 1 to 65535, ros2:TOPIC, fmu:FILE, ride, or a recording's file";

/// The format of recordings of this name.
fn logger(name: &str) -> Result<Logger> {
    let known = || Logger::value_variants().iter().map(|format| format.word()).collect::<Vec<_>>().join(", ");
    Logger::from_str(name, true)
        .map_err(|_| anyhow::anyhow!("--format is {name}, but a recording's must be one of {}", known()))
}

/// Largest packet \[bytes\].
const LARGEST: usize = 65_536;
/// Time after which a quiet socket is left to see whether all has ended.
pub const PATIENCE: Duration = Duration::from_millis(100);

/// A source of telemetry.
pub enum Input {
    /// Packets of a format.
    Udp(UdpSocket, Box<Format>),
    /// A topic of ROS 2.
    #[cfg(feature = "ros2")]
    Ros2(Box<Subscription>),
    /// Playback of a recording.
    Played(Box<Recording>),
    /// A vehicle.
    Driven(Box<dyn Vehicle>),
}

impl Input {
    /// The source that an option names.
    ///
    /// # Errors
    /// The port, the format or the recording cannot be used.
    pub fn open(from: &str, options: &Options) -> Result<Input> {
        let Options { format, map, listen, learn, .. } = options;
        let (format, map, listen) = (format.as_deref(), map.as_deref(), *listen);
        if from == "ride" {
            return Ok(Input::Driven(Box::new(Motorcycle::new()?)));
        }
        if let Some(file) = from.strip_prefix("fmu:") {
            let map = map.context("--map names the file that maps the FMU's variables")?;
            return Ok(Input::Driven(Box::new(Fmu::open(Path::new(file), map)?)));
        }
        if let Some(topic) = from.strip_prefix("ros2:") {
            return Input::open_ros2(topic, listen);
        }
        let Some(port) = from.strip_prefix("udp:") else {
            anyhow::ensure!(Path::new(from).exists(), "--from is {from}, but {SOURCES}");
            let format = format.map(logger).transpose()?;
            let conventions = ConventionOptions { format, ..ConventionOptions::default() }.load_or_fade_in(FADE_IN)?;
            let conventions = conventions.with_position(learn.is_some());
            return Ok(Input::Played(Box::new(Recording::read(Path::new(from), &conventions)?)));
        };
        let port: u16 = port.parse().ok().with_context(|| format!("--from is {from}, but {SOURCES}"))?;
        let format = tables::format(format.context("--format names the packets' format; see moris live formats")?)?;
        let address = if listen { "0.0.0.0" } else { "127.0.0.1" };
        let socket = UdpSocket::bind((address, port)).with_context(|| format!("cannot receive at {address}:{port}"))?;
        socket.set_read_timeout(Some(PATIENCE))?;
        Ok(Input::Udp(socket, Box::new(format)))
    }

    #[cfg(feature = "ros2")]
    fn open_ros2(topic: &str, listen: bool) -> Result<Input> {
        Ok(Input::Ros2(Box::new(Subscription::open(topic, listen)?)))
    }

    #[cfg(not(feature = "ros2"))]
    fn open_ros2(_: &str, _: bool) -> Result<Input> {
        anyhow::bail!("moris was built without ROS 2; build it with --features ros2")
    }

    /// True for a source that runs inside this program, whose samples come before their time.
    pub fn is_inside(&self) -> bool {
        matches!(self, Input::Played(_) | Input::Driven(_))
    }

    /// True if it sends the vehicle's position, or may do so.
    pub fn has_position(&self) -> bool {
        match self {
            Input::Udp(_, format) => format.has_position(),
            #[cfg(feature = "ros2")]
            Input::Ros2(_) => false,
            Input::Played(recording) => recording.road.is_some(),
            Input::Driven(vehicle) => vehicle.has_position(),
        }
    }

    /// The controls that it has.
    pub fn handling(&self) -> Option<Handling> {
        match self {
            Input::Driven(vehicle) => vehicle.handling(),
            #[cfg(feature = "ros2")]
            Input::Ros2(_) => None,
            Input::Udp(..) | Input::Played(_) => None,
        }
    }

    /// Shape in which the vehicle is drawn, with parameters of this name.
    pub fn shape(&self, parameters_name: &str) -> Shape {
        let own = match self {
            Input::Udp(_, format) => (format.vehicle == Kind::Car).then_some(Shape::Car),
            #[cfg(feature = "ros2")]
            Input::Ros2(_) => None,
            Input::Played(recording) => Some(drawn::vehicle(recording, parameters_name)),
            Input::Driven(vehicle) => vehicle.shape(),
        };
        own.unwrap_or_else(|| drawn::of_parameters(parameters_name))
    }

    /// The road on which the vehicle is ridden.
    pub fn road(&self) -> Option<RoadMap> {
        if let Input::Driven(vehicle) = self { vehicle.road() } else { None }
    }

    /// Passes samples on until all has ended. `controls` are those of [`Input::handling`].
    pub fn run(self, controls: Option<&Controls>, samples: Producer<Received>, shared: &Shared, page: Option<&Desk>) {
        match self {
            Input::Udp(socket, format) => receive(&socket, &format, samples, shared, page),
            #[cfg(feature = "ros2")]
            Input::Ros2(subscription) => subscription.run(samples, shared),
            Input::Played(recording) => play(&recording, samples, shared),
            Input::Driven(vehicle) => vehicle::drive(vehicle, controls, samples, shared),
        }
    }
}

fn receive(socket: &UdpSocket, format: &Format, mut samples: Producer<Received>, shared: &Shared, page: Option<&Desk>) {
    let mut packet = vec![0; LARGEST];
    let mut quiet = 0;
    let requests = format.subscriptions();
    let port = socket.local_addr().map_or(0, |address| address.port());
    let mut followed = Followed::default();
    let mut dropped = Dropped::default();
    while !shared.done.load(Ordering::Relaxed) {
        let Ok((length, from)) = socket.recv_from(&mut packet) else {
            // At first, and about once a second while nothing comes.
            if let Some(subscribe) = format.subscribe.as_ref().filter(|_| quiet % 10 == 0) {
                for request in &requests {
                    let _ = socket.send_to(request, ("127.0.0.1", subscribe.port));
                }
            }
            quiet += 1;
            continue;
        };
        let arrival = pace::now();
        quiet = 0;
        match format.decode(&packet[..length]).map(|sample| (sample, followed.accepts(from, arrival))) {
            // A loop that is so late that the ring is full has no use for it.
            Ok((sample, Ok(()))) => drop(samples.push(Received { arrival, sample })),
            Ok((_, Err(another))) => drop(another.inspect(|line| say(line, page))),
            Err(_) => {
                shared.dropped.fetch_add(1, Ordering::Relaxed);
                if let Some(count) = dropped.take(arrival) {
                    say(&format!("dropped: {count}; {}", format.explain(&packet[..length], port)), page);
                }
            }
        }
    }
}

/// True if the platform engages.
pub fn engages(shared: &Shared) -> bool {
    [State::Engaging, State::Engaged].map(|state| state as u8).contains(&shared.state.load(Ordering::Relaxed))
}

/// Plays a recording once the platform engages; until then it repeats the first sample.
fn play(recording: &Recording, mut samples: Producer<Received>, shared: &Shared) {
    let step = Duration::from_secs_f64(recording.step());
    let begin = pace::now();
    let (mut sent, mut played) = (0_u32, 0);
    while !shared.done.load(Ordering::Relaxed) {
        let Some(input) = recording.inputs().get(played) else {
            shared.played.store(true, Ordering::Relaxed);
            return;
        };
        let time = step * sent;
        pace::wait_until(begin + time);
        let sample = sample(input, recording, played, time.as_secs_f64());
        let _ = samples.push(Received { arrival: begin + time + step + BEFORE, sample });
        sent += 1;
        played += usize::from(played > 0 || engages(shared));
    }
}

fn sample(input: &Sampled, recording: &Recording, number: usize, time: f64) -> Sample {
    let rates = match recording.angular_velocity_frame {
        AngularVelocityFrame::Body => input.angular_velocity,
        AngularVelocityFrame::World => Orientation::new(input.orientation).rotation.tr_mul(&input.angular_velocity),
    };
    Sample {
        time: Some(time),
        motion: Motion::new(input.specific_force, rates, input.orientation, input.speed),
        position: recording.road.as_ref().and_then(|road| road.position(number)).map(Vector3::from),
        has_angles: recording.has_orientation,
        ..Sample::default()
    }
}
