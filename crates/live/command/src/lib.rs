//! The command `moris-live`: steps the washout beside a running vehicle and commands a platform.
//!
//! `moris_live` decides; here are its clock, its sockets and its threads:
//!
//! - `priority` asks for real time, `lateness` counts how late steps and frames are.
//! - `console` prints without waiting, `thread_monitor` sees the ends of threads,
//!   `signals` those of the system.
//! - `commands` reads lines; `parking` says how long it takes.
//! - `leg_position` has where the legs are at a start.
//! - `telemetry_watch` tells what is wrong with it; `terminal` knows whose the terminal is.
//! - `telemetry` receives packets, or plays a recording; `vehicle` steps an FMU or a motorcycle.
//! - `controls` has what the page holds of a vehicle's controls.
//! - `steps` is the loop of 1 kHz; `loop_clock` its clock.
//! - `frames` sends frames; `actuator_limits` keeps them within the speed of actuators,
//!   `connection` sees a controller that is gone, `controller_lock` one that another session has.
//! - `sender` follows one sender of telemetry and explains what it sends; `event_log` prints what
//!   happens; `recorder` records the session.
//! - `page` serves the page in a browser.
//! - `tables` lists formats and templates.
//!
//! Threads exchange values through rings without locks. The loop waits for none of them.

#![forbid(unsafe_code)]

mod actuator_limits;
mod commands;
mod connection;
mod controller_lock;
mod controls;
mod event_log;
mod frames;
mod lateness;
mod leg_position;
mod lines;
mod loop_clock;
mod page;
mod parking;
mod priority;
mod recorder;
mod sender;
mod signals;
mod steps;
mod tables;
mod telemetry;
mod telemetry_watch;
#[cfg(unix)]
mod terminal;
mod thread_monitor;
mod vehicle;

use std::collections::VecDeque;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result, bail, ensure};
use moris_analysis::host::check_predictive;
use moris_laps::Laps;
use moris_live::frame::{Encoder, Message, Values};
use moris_live::{STEP, Session, Settings, log, moog};
use moris_setup::Setup;
use moris_washout::interface::AutomaticScale;
use rtrb::RingBuffer;

use actuator_limits::Actuators;
use commands::COMMAND_NAMES;
use controller_lock::Occupied;
use controls::{Controls, Handling};
use frames::{Device, Sender, Sent, Sink};
use leg_position::LegPosition;
use moris_analysis::learned_road;
use moris_analysis::option_values::number_in;
use moris_command_line::console;
use moris_command_line::setup_options::SetupOptions;
use page::{ControlBroker, Server, Start};
use recorder::Recorder;
use signals::{Interrupts, Signals};
use telemetry::{Features, Input};
use thread_monitor::{Failed, Part, watch};

/// Step the washout beside a running vehicle, and command a platform
///
/// Receives telemetry, steps the washout at 1 kHz and sends frames to the actuators. Lines on
/// standard input are commands: start, engage, disengage, park, stop, clear. Ctrl-C and all signals
/// that can be caught park the platform and end; a second Ctrl-C, at least 0.5 s after the first,
/// ends at once. Not a safety device: an emergency stop and
/// limits of power belong outside of this program.
#[derive(Clone, Debug, clap::Args)]
#[command(args_conflicts_with_subcommands = true)]
pub struct Options {
    #[command(subcommand)]
    list: Option<tables::List>,

    /// Telemetry: udp:PORT. The FMU of a vehicle or a recording runs in real time once the platform
    /// engages. ride: a motorcycle that the page's controls ride then
    #[arg(long, value_name = "udp:PORT|fmu:FILE|ride|RECORDING", required_unless_present_any = ["replay", "empty_loop"])]
    from: Option<String>,

    /// Format of the packets: a name of `moris-live formats`, or a TOML file; of a recording: its
    /// logger, as for simulate
    #[arg(long, value_name = "NAME|FILE")]
    format: Option<String>,

    /// Map of the FMU's variables: a TOML file
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,

    /// Receive from other machines, and serve the page to them, too; otherwise to this one alone
    #[arg(long)]
    listen: bool,

    /// Device to which frames are sent
    #[arg(long, value_name = "udp:HOST:PORT|serial:LINE:BAUD", required_unless_present_any = ["dry", "replay", "empty_loop"])]
    to: Option<String>,

    /// Frames: a name of `moris-live frames`, or a TOML file
    #[arg(long, value_name = "NAME|FILE", default_value = "csv")]
    frames: String,

    /// Print ten frames a second instead of sending them
    #[arg(long, conflicts_with = "to")]
    dry: bool,

    #[command(flatten)]
    setup: SetupOptions,

    /// Delay of the telemetry [default: as short as its gaps permit]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    delay: Option<f64>,

    /// Start at once, and engage whenever the vehicle runs, until a command says otherwise
    #[arg(long)]
    engage: bool,

    /// Ask for no real-time priority
    #[arg(long)]
    no_priority: bool,

    /// Keep the loop on this core of the processor: one on which the system does little
    #[arg(long, value_name = "NUMBER")]
    core: Option<usize>,

    /// Only wait for each step, and print how late that was: what this computer can do at best
    #[arg(long, requires = "duration", conflicts_with_all = ["from", "replay"])]
    empty_loop: bool,

    /// Engage although the telemetry contradicts itself or its table
    #[arg(long)]
    ignore_signs: bool,

    /// Serve a page with curves, buttons and sliders, and print its address
    #[arg(long, value_name = "PORT", num_args = 0..=1, default_missing_value = "0", conflicts_with = "replay")]
    page: Option<u16>,

    /// Let every page control; otherwise only the first one that is opened
    #[arg(long, requires = "page")]
    allow_control: bool,

    /// Time without frames after which the controller stops by itself; a longer gap is a fault
    /// [default: that of the template, if it has one]
    #[arg(long, value_name = "SECONDS", value_parser = |text: &str| number_in(text, 0.001..=10.0, "a number of seconds from 0.001 to 10"))]
    time_out: Option<f64>,

    /// The platform is at its lowest pose now, as a person sees. Otherwise the controller is asked
    /// where the legs are, if its frames can, or starts slowly
    #[arg(long, conflicts_with_all = ["slow_start", "dry"])]
    settled: bool,

    /// The controller itself goes from anywhere to the first lengths, at this speed or faster
    /// [default: that of the template, if it has one; without a number 0.02]
    #[arg(long, value_name = "M/S", num_args = 0..=1, default_missing_value = "0.02", value_parser = |text: &str| number_in(text, 0.001..=1.0, "a number of m/s from 0.001 to 1"), conflicts_with = "dry")]
    slow_start: Option<f64>,

    /// Send poses that are ahead of now by this time, such as a headset's latency; lengths stay
    #[arg(long, value_name = "SECONDS", default_value = "0", value_parser = |text: &str| number_in(text, 0.0..=0.1, "a number of seconds from 0 to 0.1"))]
    pose_ahead: f64,

    /// Park and end after this time
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds)]
    duration: Option<f64>,

    /// Record the session to a file
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,

    /// Learn the road by the vehicle's position, and preview what comes, with the predictive
    /// strategy. A file, one for each vehicle and track, is read first and written at the end
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true, conflicts_with = "replay")]
    learn: Option<Option<PathBuf>>,

    /// Start with the automatic scale that the last session has found. The file, one for each
    /// vehicle and rig, is a parameter file; it is written at the end
    #[arg(long, value_name = "FILE", conflicts_with = "replay")]
    learn_scale: Option<PathBuf>,

    /// Repeat a recorded session, as fast as possible, and check that each command is the same
    #[arg(long, value_name = "FILE", conflicts_with_all = ["from", "to", "record"])]
    replay: Option<PathBuf>,
}

fn seconds(text: &str) -> Result<f64, String> {
    number_in(text, 0.0..=1e6, "a number of seconds from 0 to 1e6")
}

/// Values that all threads read.
#[derive(Debug, Default)]
struct Shared {
    /// The session's state.
    state: AtomicU8,
    /// The recording that is played has ended.
    played: AtomicBool,
    /// The loop has ended.
    done: AtomicBool,
    /// The controller is to be asked where the legs are.
    asks: AtomicBool,
    /// Packets that are not of the format.
    dropped: AtomicU32,
    /// Threads that have failed.
    failed: Failed,
    /// Lateness of the latest frame, and of the latest of all \[us\].
    late_frame: [AtomicU64; 2],
    /// Latest lines of the journal, for the page; the newest first.
    lines: Mutex<VecDeque<String>>,
}

impl Shared {
    /// Prints a line, which the page shows as well.
    fn say(&self, line: &str) {
        // Most lines that the page shows.
        const MAX_JOURNAL_LINES: usize = 8;
        console::line(line);
        let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        lines.truncate(MAX_JOURNAL_LINES - 1);
        lines.push_front(line.trim().to_owned());
    }

    /// The latest lines, the newest first.
    fn lines(&self) -> VecDeque<String> {
        self.lines.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// A frame has left so late.
    fn show_late(&self, late: Duration) {
        let late = late.as_micros().min(u128::from(u64::MAX)) as u64;
        let [last, most] = &self.late_frame;
        last.store(late, Ordering::Relaxed);
        most.fetch_max(late, Ordering::Relaxed);
    }
}

/// Runs the command.
///
/// # Errors
/// An option, file or socket cannot be used, or the session cannot be repeated.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    // Largest recording of a session [bytes]. One of a day is smaller.
    const LARGEST_SESSION: u64 = 200_000_000;
    if let Some(list) = &options.list {
        return tables::main(list, out);
    }
    if let Some(file) = &options.replay {
        return replay(
            options,
            &moris_fmu_host::files::text(file, LARGEST_SESSION).with_context(|| file.display().to_string())?,
            out,
        );
    }
    options.core.map_or(Ok(()), priority::check_core)?;
    if options.empty_loop {
        return empty_loop(options, out);
    }
    let setup = with_learned_scale(options)?.load_to_drive()?;
    let from = options.from.as_deref().unwrap_or_default();
    let input = Input::open(from, options)?;
    let features = &input.features;
    let laps = options.learn.as_ref().map(|file| known_laps(file.as_deref(), features, &setup)).transpose()?;
    // The motorcycle's signs are known, and its falls are like nothing that the test knows.
    let ignore_signs = options.ignore_signs || features.handling == Some(Handling::Rider);
    // Until the end: another session has no part in this controller.
    let mut occupied = options.to.as_deref().map(Occupied::take).transpose()?;
    let was_left = occupied.as_ref().is_some_and(Occupied::was_left);
    let sink = options.to.as_deref().map_or(Ok(Sink::Dry), Sink::open)?;
    let rig = &setup.parameters.rig;
    let (device, interval, time_out, place) = if options.frames == moog::FRAME_NAME {
        ensure!(!sink.is_line(), "this device answers by UDP: --to udp:HOST:PORT");
        sink.listen()?;
        // The base itself goes from its home to neutral.
        (Device::moog(rig), moog::PACKET_INTERVAL, None, LegPosition::own())
    } else {
        let template = tables::frames(&options.frames)?;
        let encoder = Encoder::new(&template, rig).with_context(|| format!("--frames {}", options.frames))?;
        let place = match options.dry {
            true => LegPosition::own(),
            false => LegPosition::of(&template, &encoder, options.settled && !was_left, options.slow_start),
        };
        // Also where the operator has said it: after a loss the controller is asked.
        if encoder.asks() {
            sink.listen()?;
        }
        let interval = line_interval(&sink, &encoder, template.interval, options.time_out.or(template.time_out))?;
        (Device::of_template(encoder), interval, template.time_out, place)
    };
    let doubts = options.settled && was_left && !place.starts_settled();
    if doubts {
        console::line(
            "--settled is not believed: the last session with this controller has not parked. Look, then say settled",
        );
    }
    if options.engage && !place.can_start() {
        bail!(
            "--engage starts the platform, but nobody has said where its legs are: add --settled if it is at its \
             lowest pose, or --slow-start if the controller limits its own speed"
        );
    }
    let settings = Settings {
        delay: options.delay,
        ignore_signs,
        is_inside: features.is_inside,
        starts_settled: place.starts_settled(),
        slow_speed: place.slow_speed(),
    };
    let mut session = Session::new(&setup.parameters, &settings)?;
    let header = log::header(&setup.parameters, &settings, laps.as_ref());
    let track = laps.as_ref().map(page::track);
    if let Some(laps) = laps {
        session.learn(laps);
    }
    let time_out = options.time_out.or(time_out).map(Duration::from_secs_f64);
    let record = options.record.as_ref().map(|path| {
        let mut file = File::create(path)?;
        file.write_all(header.as_bytes())?;
        Recorder::new(file)
    });
    let record = record.transpose().context("cannot record the session")?;
    let shared = Arc::new(Shared::default());
    let signals = Signals::listen()?;
    let interrupts = Interrupts::new(signals.clone());

    let (samples, received) = RingBuffer::new(1024);
    let (commands, commanded) = RingBuffer::new(64);
    // As many as there are parameters, and more.
    let (to_loop, asked) = RingBuffer::new(1024);
    let (urgent, asked_at_once) = RingBuffer::new(64);
    let controls = features.handling.map(|handling| Arc::new(Controls::new(handling)));
    let broker = Arc::new(ControlBroker::new(&setup, [to_loop, urgent], controls.clone(), options.allow_control)?);
    let page = Start::of(&setup, features, track);
    let open = |port| Server::open(port, options.listen, &page, Arc::clone(&broker), Arc::clone(&shared));
    let server = options.page.map(open).transpose()?;
    let (shown, showing) = RingBuffer::new(256);
    let (refused, refusals) = RingBuffer::new(8);
    let (from_device, reported) = RingBuffer::new(16);
    let (to_device, to_send) = RingBuffer::new(256);
    let (to_journal, journal) = RingBuffer::new(8192);
    let (to_forecast, parking) = RingBuffer::new(1);
    console::line(&format!("commands: {COMMAND_NAMES}; Ctrl-C parks and ends"));
    if let Some(advice) = place.advice(rig.stroke_length()) {
        console::line(&advice);
    }
    if let Some(server) = &server {
        console::line(&format!("page: {}", server.address()));
    }
    // It waits for a line for ever: nobody joins it.
    let listening = Arc::clone(&shared);
    thread::spawn(move || watch(&listening.failed, Part::Commands, || commands::read(commands::input(), commands)));
    let interval = frames::whole_steps(if options.dry { interval.max(0.1) } else { interval });
    let rig = &setup.parameters.rig;
    let actuators = Actuators { speed: rig.velocity_limit, acceleration: rig.acceleration_limit, stroke: rig.stroke() };
    occupied.iter_mut().for_each(|occupied| occupied.leave(true));
    let summary = thread::scope(|scope| {
        let (shared, broker) = (&*shared, &broker);
        let sender = scope.spawn(move || {
            prepare_helper(options);
            let mut sender = Sender::new(to_send, device, sink, from_device, (interval, actuators), shared);
            sender.time_out = time_out;
            sender.signals = signals;
            sender.run()
        });
        let printer = scope
            .spawn(move || watch(&shared.failed, Part::Journal, || event_log::write_notes(journal, record, shared)));
        if let Some(server) = &server {
            scope.spawn(|| watch(&shared.failed, Part::Page, || server.run(shared)));
            scope.spawn(|| watch(&shared.failed, Part::Page, || broker.show(showing, refusals, shared)));
        }
        scope.spawn(move || watch(&shared.failed, Part::Page, || parking::forecast(parking, shared)));
        let controls = controls.as_deref();
        scope.spawn(move || {
            prepare_helper(options);
            watch(&shared.failed, Part::Telemetry, || input.run(controls, samples, shared))
        });
        let mut steps = steps::Steps {
            session: &mut session,
            shared,
            received,
            orders: [commanded, asked_at_once, asked, reported],
            interrupts,
            parking: to_forecast,
            is_lost: false,
            place,
            known: [false; Part::ALL.len()],
            frames: frames::Frames::new(to_device, sender.thread().clone(), interval, options.pose_ahead),
            journal: to_journal,
            shown: server.as_ref().map(|_| shown),
            refused,
            starts: options.engage,
            engages: options.engage,
            ends_at: options.duration,
        };
        // In a thread of its own, so that its panic leaves the others to end.
        let summary = thread::Builder::new().name("steps".to_owned()).spawn_scoped(scope, move || {
            prepare_loop(options);
            steps.run()
        });
        let summary = summary.map(thread::ScopedJoinHandle::join);
        shared.done.store(true, Ordering::Relaxed);
        let sent = sender.join();
        let kept = printer.join();
        (summary, sent, kept)
    });
    console::flush();
    let (Ok(Ok(summary)), Ok(sent), Ok(kept)) = summary else {
        bail!("the loop has ended by an error of this program; the stop string has been sent");
    };
    let mut report = summary.to_string();
    let counts = session.source().counts();
    report += &format!(
        "telemetry: {} packets, {} of another format, {} bad, {} repeated, {} teleports; delay {:.1} ms\n",
        counts.received,
        shared.dropped.load(Ordering::Relaxed),
        counts.bad,
        counts.repeated,
        counts.teleports,
        1e3 * session.delay()
    );
    let Sent { sent, failed, skipped, passage, late, gap, last } = sent;
    let has_parked = session.is_located() && last.is_some_and(|lengths| session.way_from_settled(&lengths) < 1e-3);
    occupied.iter_mut().for_each(|occupied| occupied.leave(if last.is_none() { was_left } else { !has_parked }));
    report += &format!("frames: {sent} sent, {} not, {skipped} left out for newer ones", failed + summary.lost_frames);
    report += &format!("; the longest gap {:.0} ms\n", 1e3 * gap.as_secs_f64());
    report += &format!("frames late by: {}\n", late.summary());
    report += &format!("from a packet to the next frame: {}\n", passage.summary());
    let written = out.write_all(report.as_bytes());
    // A reader of the report that is gone hides no failure.
    if let Some(part) = Part::ALL.into_iter().find(|part| shared.failed.has(*part)) {
        bail!("the thread that {} has failed by an error of this program", part.name());
    }
    if let (Some(Some(file)), Some(road)) = (&options.learn, session.road()) {
        learned_road::save(file, road.laps())?;
    }
    if let Some(file) = &options.learn_scale
        && session.washout().parameters().automatic_scale.automatic == AutomaticScale::On
    {
        let text = format!("automaticScale.start = {:.3}\n", session.washout().output().scale_factor);
        learned_road::write_learned("scale", file, &text)?;
    }
    if let Some(loss) = summary.loss {
        bail!("the session was in a fault: {loss}");
    }
    kept.unwrap_or(Ok(())).context("cannot record the session")?;
    written?;
    Ok(ExitCode::SUCCESS)
}

/// The options for rig and parameters, with the scale that the last session has found.
fn with_learned_scale(options: &Options) -> Result<SetupOptions> {
    let mut setup = options.setup.clone();
    if let Some(file) = &options.learn_scale {
        learned_road::check_is_writable("scale", file)?;
        if file.try_exists().with_context(|| file.display().to_string())? {
            setup.parameters.push(file.to_str().context("--learn-scale: the file's name is no UTF-8")?.to_owned());
        }
    }
    Ok(setup)
}

/// Time between frames \[s\]: the template's `interval`, or a longer one with a message where a
/// serial line takes longer for a frame.
///
/// # Errors
/// The controller's time-out ends before the line has carried a frame.
fn line_interval(sink: &Sink, encoder: &Encoder, interval: f64, time_out: Option<f64>) -> Result<f64> {
    // With as many digits as numbers of a frame have.
    let values = Values { time: 1000.0, length: [1.234567; 6], pose: [-0.123456; 6], ..Values::default() };
    let mut frame = Vec::new();
    encoder.write(Message::Frame, &values, &mut frame);
    let line_time = sink.line_time(frame.len());
    if line_time <= interval {
        return Ok(interval);
    }
    let line = format!("the serial line takes {:.0} ms for a frame of {} bytes", 1e3 * line_time, frame.len());
    if time_out.is_some_and(|time_out| line_time >= time_out) {
        bail!("{line}, and the controller stops sooner without one: use a higher rate of the line, or shorter frames");
    }
    // A tenth of the line stays free, so that no frame waits behind others.
    let longer = frames::whole_steps(1.1 * line_time);
    console::line(&format!(
        "{line}: one is sent every {:.0} ms instead of every {:.0} ms; a higher rate of the line is better",
        1e3 * longer,
        1e3 * interval
    ));
    Ok(longer)
}

/// The laps of the road that are known at first.
fn known_laps(file: Option<&Path>, features: &Features, setup: &Setup) -> Result<Laps> {
    check_predictive("learn", setup.parameters.structure.strategy)?;
    ensure!(features.has_position, "--learn needs the vehicle's position, which this source does not send");
    Ok(file.map_or_else(|| Ok(Laps::new()), learned_road::load)?)
}

/// Gives the calling thread, which the loop needs on time, its priority.
fn prepare_helper(options: &Options) {
    if !options.no_priority {
        priority::claim_below();
    }
}

/// Gives the calling thread, the loop's, its priority and its core.
fn prepare_loop(options: &Options) {
    if !options.no_priority {
        console::line(&priority::claim());
    }
    if let Some(Err(error)) = options.core.map(priority::pin_to_core) {
        console::line(&format!("the loop is on no core of its own: {error}"));
    }
}

/// Waits for each step and does nothing.
fn empty_loop(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    prepare_loop(options);
    let lateness = steps::empty((options.duration.unwrap_or_default() / STEP) as u64);
    write!(out, "{lateness}")?;
    Ok(ExitCode::SUCCESS)
}

/// Repeats a recorded session.
fn replay(options: &Options, text: &str, out: &mut dyn Write) -> Result<ExitCode> {
    let mut state = None;
    let template = tables::frames(&options.frames)?;
    let rig = options.setup.load()?.parameters.rig;
    let encoder = Encoder::new(&template, &rig)?;
    let mut bytes = Vec::new();
    let mut lines = String::new();
    let replayed = log::replay(text, |session| {
        let commands = session.commands();
        if state.replace(commands.state) != Some(commands.state) {
            lines += &format!("{}\n", event_log::timed(commands.time, commands.state.name()));
        }
        if options.dry && ((commands.time / STEP).round() as u64).is_multiple_of(100) {
            encoder.write(Message::Frame, &Values::from(commands), &mut bytes);
            lines += &frames::shown(&bytes);
        }
    })?;
    write!(out, "{lines}")?;
    match replayed.recorded {
        Some(recorded) if recorded == replayed.digest => {
            writeln!(out, "{} steps, the same commands to the bit", replayed.steps)?;
        }
        Some(_) => bail!("the commands differ from the recorded ones"),
        None => writeln!(out, "{} steps; the recording has no end to compare with", replayed.steps)?,
    }
    Ok(ExitCode::SUCCESS)
}
