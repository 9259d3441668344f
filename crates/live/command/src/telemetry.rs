//! Telemetry from a socket, from a recording in real time, or from a vehicle that is stepped here.

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
use super::sender::{Dropped, Followed};
use super::vehicle::{self, Fmu, Motorcycle, Vehicle};
use super::{Options, Shared, loop_clock, tables};
use moris_analysis::page::vehicle as drawn;
use moris_analysis::recording::formats::Format as Logger;
use moris_analysis::recording::{ConventionOptions, FADE_IN, Recording};

/// Time by which samples of a source inside are there before they are needed.
pub const SAMPLE_LEAD_TIME: Duration = Duration::from_millis(5);

/// A sample, and when it arrived.
#[derive(Clone, Copy, Debug)]
pub struct Received {
    /// Time of [`loop_clock::now`]; of a source inside that for which the sample is.
    pub arrival: Duration,
    /// Motion of the vehicle.
    pub sample: Sample,
}

/// The format of recordings of this name.
fn logger(name: &str) -> Result<Logger> {
    let known = || Logger::value_variants().iter().map(|format| format.word()).collect::<Vec<_>>().join(", ");
    Logger::from_str(name, true)
        .map_err(|_| anyhow::anyhow!("--format is {name}, but a recording's must be one of {}", known()))
}

/// Properties of a source that are known before it runs.
#[derive(Clone, Debug, Default)]
pub struct Features {
    /// True for a vehicle inside this program: its samples come before their time.
    pub is_inside: bool,
    /// True if the source sends the vehicle's position, or may do so.
    pub has_position: bool,
    /// Kind of the vehicle's controls; none if it drives by itself.
    pub handling: Option<Handling>,
    /// Shape in which the vehicle is drawn; none for one that the parameters name.
    pub shape: Option<Shape>,
    /// The road that the vehicle follows.
    pub road: Option<RoadMap>,
}

/// A source of telemetry.
pub struct Input {
    pub features: Features,
    source: Source,
}

enum Source {
    /// Packets of a format.
    Udp(UdpSocket, Box<Format>),
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
        // The accepted values of `--from`.
        const SOURCES: &str = "must be udp:PORT with a port from 1 to 65535, fmu:FILE, ride, or a recording's file";
        // Time after which a quiet socket is left to see whether all has ended.
        const PATIENCE: Duration = Duration::from_millis(100);
        let Options { format, map, listen, learn, .. } = options;
        let (format, map, listen) = (format.as_deref(), map.as_deref(), *listen);
        if from == "ride" {
            return Ok(Input::driven(Motorcycle::new()?));
        }
        if let Some(file) = from.strip_prefix("fmu:") {
            let map = map.context("--map names the file that maps the FMU's variables")?;
            return Ok(Input::driven(Fmu::open(Path::new(file), map)?));
        }
        let Some(port) = from.strip_prefix("udp:") else {
            anyhow::ensure!(Path::new(from).exists(), "--from is {from}, but {SOURCES}");
            let format = format.map(logger).transpose()?;
            let conventions = ConventionOptions { format, ..ConventionOptions::default() }.load_or_fade_in(FADE_IN)?;
            let conventions = conventions.with_position(learn.is_some());
            let recording = Recording::read(Path::new(from), &conventions)?;
            let features = Features {
                is_inside: true,
                has_position: recording.road.is_some(),
                shape: Some(drawn::vehicle(&recording)),
                ..Features::default()
            };
            return Ok(Input { features, source: Source::Played(Box::new(recording)) });
        };
        let port: u16 = port.parse().ok().with_context(|| format!("--from is {from}, but {SOURCES}"))?;
        let format = tables::format(format.context("--format names the packets' format; see moris-live formats")?)?;
        let address = if listen { "0.0.0.0" } else { "127.0.0.1" };
        let socket = UdpSocket::bind((address, port)).with_context(|| format!("cannot receive at {address}:{port}"))?;
        socket.set_read_timeout(Some(PATIENCE))?;
        let features = Features { has_position: format.has_position(), shape: shape(&format), ..Features::default() };
        Ok(Input { features, source: Source::Udp(socket, Box::new(format)) })
    }

    fn driven(vehicle: impl Vehicle + 'static) -> Input {
        Input { features: vehicle.features(), source: Source::Driven(Box::new(vehicle)) }
    }

    /// Passes samples on until all has ended. `controls` are those that its features name.
    pub fn run(self, controls: Option<&Controls>, samples: Producer<Received>, shared: &Shared) {
        match self.source {
            Source::Udp(socket, format) => receive(&socket, &format, samples, shared),
            Source::Played(recording) => play(&recording, samples, shared),
            Source::Driven(vehicle) => vehicle::drive(vehicle, controls, samples, shared),
        }
    }
}

/// Shape of the vehicle that a format names.
pub fn shape(format: &Format) -> Option<Shape> {
    (format.vehicle == Kind::Car).then_some(Shape::Car)
}

fn receive(socket: &UdpSocket, format: &Format, mut samples: Producer<Received>, shared: &Shared) {
    // Reads without a packet, of 0.1 s each, after which the port is doubted.
    const QUIET_READS: u32 = 30;
    // Largest packet [bytes].
    const LARGEST: usize = 65_536;
    let mut packet = vec![0; LARGEST];
    let mut decoded = Vec::new();
    let (mut quiet, mut is_heard) = (0, false);
    let requests = format.subscriptions();
    let (port, is_local) =
        socket.local_addr().map_or((0, true), |address| (address.port(), address.ip().is_loopback()));
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
            if quiet == QUIET_READS && !is_heard {
                shared.say(&no_packet(port, is_local));
            }
            continue;
        };
        let arrival = loop_clock::now();
        (quiet, is_heard) = (0, true);
        decoded.clear();
        match format.decode_all(&packet[..length], |sample| decoded.push(sample)) {
            Ok(()) if decoded.is_empty() => (),
            Ok(()) => match followed.accepts(from, arrival) {
                Ok(()) => {
                    for sample in decoded.drain(..) {
                        // A loop that is so late that the ring is full has no use for it.
                        let _ = samples.push(Received { arrival, sample });
                    }
                }
                Err(another) => drop(another.inspect(|line| shared.say(line))),
            },
            Err(_) => {
                shared.dropped.fetch_add(1, Ordering::Relaxed);
                if let Some(count) = dropped.take(arrival) {
                    shared.say(&format!("dropped: {count}; {}", format.explain(&packet[..length], port)));
                }
            }
        }
    }
}

/// The line for a port that has been quiet from the start.
fn no_packet(port: u16, is_local: bool) -> String {
    let elsewhere = if is_local { " From another machine use --listen." } else { "" };
    format!(
        "no packet on port {port} yet: is the game's telemetry on, and sent to this computer and this port?{elsewhere}"
    )
}

/// True if the platform engages.
pub fn engages(shared: &Shared) -> bool {
    [State::Engaging, State::Engaged].map(|state| state as u8).contains(&shared.state.load(Ordering::Relaxed))
}

/// Plays a recording once the platform engages; until then it repeats the first sample.
fn play(recording: &Recording, mut samples: Producer<Received>, shared: &Shared) {
    let step = Duration::from_secs_f64(recording.step());
    let begin = loop_clock::now();
    let (mut sent, mut played) = (0_u32, 0);
    while !shared.done.load(Ordering::Relaxed) {
        let Some(input) = recording.inputs().get(played) else {
            shared.played.store(true, Ordering::Relaxed);
            return;
        };
        let time = step * sent;
        loop_clock::wait_until(begin + time);
        let sample = sample(input, recording, played, time.as_secs_f64());
        let _ = samples.push(Received { arrival: begin + time + step + SAMPLE_LEAD_TIME, sample });
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
