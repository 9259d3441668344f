//! An emulator of the motion base MOOG 6DOF2000E.

use std::net::UdpSocket;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, Ordering};
use std::thread;
use std::time::Duration;

use crate::rig::{APART, Live, free_port, vehicle};

/// Packets for which the base moves between its home and neutral.
const MOVING: u32 = 40;

/// A packet: its command and its six numbers.
type Packet = (u32, [f32; 6]);

/// Flags between a test and the base.
#[derive(Default)]
struct Told {
    fails: AtomicBool,
    /// Times that it has been engaged.
    engaged: AtomicU32,
    /// True once the base has moved by 5 mm or 0.3 degrees.
    has_moved: AtomicBool,
    /// State of the next answer, in the place of the true one; 0xFF: none.
    lie: AtomicU8,
}

/// A base that answers each packet with its state, until it is parked or no packet comes.
fn base(socket: &UdpSocket, told: &Told) -> Vec<Packet> {
    let Told { fails, engaged, has_moved, lie } = told;
    let (mut state, mut moved) = (0_u8, 0);
    let mut packets = Vec::new();
    let mut bytes = [0; 64];
    while let Ok((length, from)) = socket.recv_from(&mut bytes) {
        assert_eq!(length, 32);
        let word = |place: usize| <[u8; 4]>::try_from(&bytes[4 * place..4 * place + 4]).unwrap();
        let command = u32::from_be_bytes(word(0));
        packets.push((command, std::array::from_fn(|k| f32::from_be_bytes(word(k + 1)))));
        has_moved.fetch_or(
            packets.last().is_some_and(|packet| packet.1.iter().any(|one| one.abs() > 0.005)),
            Ordering::Relaxed,
        );
        moved += 1;
        let before = state;
        state = match (state, command) {
            _ if fails.load(Ordering::Relaxed) => 0x8,
            // Repaired, and switched on again.
            (0x8, _) => 0x1,
            (0x0, 170) => 0x1,
            (0x1, 180) => 0x2,
            (0x2, _) if moved > MOVING => 0x3,
            (0x2 | 0x3, 210) => 0x7,
            (0x7, _) if moved > MOVING => 0x1,
            (state, _) => state,
        };
        if before != state {
            moved = 0;
            engaged.fetch_add(u32::from(command == 180), Ordering::Relaxed);
        }
        let mut answer = [0; 40];
        let said = Some(lie.swap(0xFF, Ordering::Relaxed)).filter(|lie| *lie != 0xFF).unwrap_or(state);
        answer[11] = 0x20 | said;
        socket.send_to(&answer, from).unwrap();
    }
    packets
}

struct Session {
    live: Live,
    base: thread::JoinHandle<Vec<Packet>>,
    told: Arc<Told>,
}

fn start(directory: &std::path::Path, port: u16, arguments: &[&str]) -> Session {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    socket.set_read_timeout(Some(Duration::from_secs(2))).unwrap();
    let to = format!("udp:{}", socket.local_addr().unwrap());
    let told = Arc::new(Told { lie: AtomicU8::new(0xFF), ..Told::default() });
    let of_base = Arc::clone(&told);
    // Before the first packet the base waits for as long as the command takes to start.
    let base = thread::spawn(move || {
        while socket.peek(&mut [0; 64]).is_err() {}
        base(&socket, &of_base)
    });
    let arguments = [&["--format", "csv", "--frames", "moog-6dof2000e"], arguments].concat();
    let nothing = thread::spawn(Vec::new);
    Session { live: Live::with(directory, &format!("udp:{port}"), &to, &arguments, nothing), base, told }
}

/// Each command once for each run of it.
fn runs(packets: &[Packet]) -> Vec<u32> {
    let mut runs: Vec<u32> = packets.iter().map(|packet| packet.0).collect();
    runs.dedup();
    runs
}

#[test]
fn the_base_goes_up_follows_and_goes_home_at_a_stop() {
    let directory = tempfile::tempdir().unwrap();
    let port = free_port();
    let Session { mut live, base, told } = start(directory.path(), port, &["--engage"]);
    let is_running = AtomicBool::new(true);
    thread::scope(|scope| {
        scope.spawn(|| vehicle(port, &is_running));
        live.wait_for("engaging");
        while !told.has_moved.load(Ordering::Relaxed) {
            thread::sleep(Duration::from_millis(10));
        }
        // Each other state once, in a base that follows.
        for state in [0x0, 0x1, 0x2, 0x7, 0x9] {
            told.lie.store(state, Ordering::Relaxed);
            thread::sleep(Duration::from_millis(100));
        }
        is_running.store(false, Ordering::Relaxed);
    });
    live.command("stop");
    live.wait_for("off");
    live.interrupt();
    assert!(live.end().0.success());
    let packets = base.join().unwrap();
    assert_eq!(runs(&packets), [130, 170, 180, 130, 210]);
    assert!(packets.iter().flat_map(|packet| packet.1).all(|number| number.abs() < 0.5));
    // No packet is far from the one before it: at most 0.6 m/s or rad/s, with some packets left out.
    for pair in packets.windows(2) {
        for (before, after) in pair[0].1.iter().zip(pair[1].1) {
            assert!((after - before).abs() < 0.05, "{pair:?}");
        }
    }
    // At rest at neutral wherever it does not follow; the way home begins where it is.
    assert!(packets.iter().filter(|packet| [170, 180].contains(&packet.0)).all(|packet| packet.1 == [0.0; 6]));
    let home = packets.iter().position(|packet| packet.0 == 210).unwrap();
    assert_eq!(packets[home].1, packets[home - 1].1);
}

#[test]
fn a_base_that_fails_is_engaged_again_by_a_person_only() {
    let directory = tempfile::tempdir().unwrap();
    let Session { mut live, base, told } = start(directory.path(), free_port(), &[]);
    live.command("start");
    live.wait_for("neutral");
    told.fails.store(true, Ordering::Relaxed);
    live.wait_for("Repair it, then clear");
    live.wait_for("fault");
    told.fails.store(false, Ordering::Relaxed);
    live.command("engage");
    live.wait_for("refused: engage does nothing in the state fault");
    live.command("clear");
    live.wait_for("neutral");
    while told.engaged.load(Ordering::Relaxed) < 2 {
        thread::sleep(Duration::from_millis(10));
    }
    live.command("stop");
    live.wait_for("off");
    live.interrupt();
    assert!(!live.end().0.success(), "the session was in a fault");
    let packets = base.join().unwrap();
    let runs = runs(&packets);
    // The stop may come before the next position.
    assert_eq!(runs[..5], [130, 170, 180, 130, 180], "{runs:?}");
    assert!(matches!(runs[5..], [130, 210] | [210]), "{runs:?}");
}

#[test]
fn a_base_that_does_not_answer_is_a_fault() {
    let directory = tempfile::tempdir().unwrap();
    let silent = UdpSocket::bind("127.0.0.1:0").unwrap();
    let to = format!("udp:{}", silent.local_addr().unwrap());
    let arguments = ["--format", "csv", "--frames", "moog-6dof2000e", "--engage"];
    let from = format!("udp:{}", free_port());
    let mut live = Live::with(directory.path(), &from, &to, &arguments, thread::spawn(Vec::new));
    live.wait_for("Repair it, then clear");
    live.wait_for("fault");
    live.interrupt();
    thread::sleep(APART);
    live.interrupt();
    assert!(!live.end().0.success(), "the session was in a fault");
}
