//! Emulators of devices that have frames of their own, and no start or stop string.

use std::net::UdpSocket;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use crate::cases::cases;

use crate::rig::{Live, free_port, vehicle};

/// A device: its name, and its reading of a frame as positions from 0 to 1 of the actuators'
/// strokes; none if it refuses the frame.
type Device = (&'static str, fn(&[u8]) -> Option<Vec<f64>>);

const DEVICES: [Device; 5] = [
    ("amc-aasd15a", |frame| {
        let legs = frame.strip_prefix(&[0xFF, 0xFF])?.strip_suffix(&[0, 0, 0, 0, 0x0A, 0x0D])?;
        let legs = legs.as_chunks::<2>();
        legs.1.is_empty().then(|| legs.0.iter().map(|leg| f64::from(u16::from_be_bytes(*leg)) / 65_535.0).collect())
    }),
    ("motion4sim", |frame| {
        let legs = frame.strip_prefix(&[0xFF, 0xFF])?.strip_suffix(&[0, 0, 0, 0x0A, 0x0D])?;
        let legs = legs.as_chunks::<3>();
        let position = |[a, b, c]: &[u8; 3]| f64::from(u32::from_be_bytes([0, *a, *b, *c])) / 16_777_215.0;
        legs.1.is_empty().then(|| legs.0.iter().map(position).collect())
    }),
    ("bff", |frame| {
        let legs = frame.strip_prefix(&[b'B', b'C', 0])?.strip_suffix(&[0x0D])?;
        let (high, low) = legs.split_at_checked(6).filter(|(_, low)| low.len() == 6)?;
        let position = |(high, low): (&u8, &u8)| f64::from(256 * u32::from(*high) + u32::from(*low)) / 65_535.0;
        Some(high.iter().zip(low).map(position).collect())
    }),
    ("simtools", |frame| {
        let text = str::from_utf8(frame).ok()?.strip_suffix('X')?;
        let position = |field: &str| field.parse::<u16>().ok().map(|leg| f64::from(leg) / 65_535.0);
        text.split(',').map(position).collect()
    }),
    // No actuators: a pose of at most 500 mm and 500 degrees, of which the heave goes up and down.
    ("vr-pose", |frame| {
        let numbers = frame.as_chunks::<8>();
        let number = |bytes: &[u8; 8]| 0.5 + f64::from_le_bytes(*bytes) / 1000.0;
        numbers.1.is_empty().then(|| numbers.0.iter().map(number).collect())
    }),
];

/// Receives until the command has ended.
fn receive(socket: &UdpSocket, read: fn(&[u8]) -> Option<Vec<f64>>, ended: &AtomicBool) -> Vec<Vec<f64>> {
    let mut packet = [0; 2000];
    let mut positions = Vec::new();
    // What has arrived before the end is read to the last.
    loop {
        match socket.recv(&mut packet) {
            Ok(length) => {
                let frame = &packet[..length];
                let legs =
                    read(frame).filter(|legs| legs.len() == 6 && legs.iter().all(|leg| (0.0..=1.0).contains(leg)));
                positions.push(legs.unwrap_or_else(|| panic!("a frame that is refused: {frame:02X?}")));
            }
            Err(_) if ended.load(Ordering::Relaxed) => return positions,
            Err(_) => (),
        }
    }
}

#[test]
fn each_device_reads_every_frame_and_its_last_ones_are_at_rest() {
    thread::scope(|scope| {
        // Two of few cases: one of numbers in bytes, one of text.
        for (name, read) in DEVICES.iter().filter(|(name, _)| cases(true, ["bff", "simtools"].contains(name))) {
            scope.spawn(move || ride(name, *read));
        }
    });
}

fn ride(name: &str, read: fn(&[u8]) -> Option<Vec<f64>>) {
    let directory = tempfile::tempdir().unwrap();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    socket.set_read_timeout(Some(Duration::from_millis(100))).unwrap();
    let to = format!("udp:{}", socket.local_addr().unwrap());
    let (port, runs, ended) = (free_port(), AtomicBool::new(true), AtomicBool::new(false));
    let arguments = ["--format", "csv", "--frames", name, "--engage", "--settled"];
    let positions = thread::scope(|scope| {
        let device = scope.spawn(|| receive(&socket, read, &ended));
        let drive = scope.spawn(|| vehicle(port, &runs));
        let mut live = Live::with(directory.path(), &format!("udp:{port}"), &to, &arguments, thread::spawn(Vec::new));
        live.wait_for("engaged");
        // The source is killed.
        runs.store(false, Ordering::Relaxed);
        drive.join().unwrap();
        live.wait_for("neutral");
        live.interrupt();
        live.wait_for("off");
        let (status, printed, _) = live.end();
        ended.store(true, Ordering::Relaxed);
        assert!(status.success() && printed.contains("sent, 0 not"), "{name}: {printed}");
        device.join().unwrap()
    });
    let moved =
        |one: &[f64], other: &[f64]| one.iter().zip(other).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
    let largest = positions.iter().map(|one| moved(one, &positions[0])).fold(0.0, f64::max);
    assert!(largest > 0.2, "{name}: {largest} of the stroke");
    let [.., before, last] = &positions[..] else { panic!("{name}: no frames") };
    assert!(moved(before, last) < 1e-4 && moved(&positions[0], last) < 0.05, "{name}: {before:?}, {last:?}");
}
