//! A controller on a serial line: the other end of a pseudo-terminal.

use std::fs::File;
use std::io::{Read, Write};
use std::thread;
use std::time::{Duration, Instant};

use rustix::io::{FdFlags, fcntl_setfd};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

use crate::rig::{Live, free_port};

/// Frames of AMC-AASD15A, and a stop string of its own.
const TEMPLATE: &str = "name = 'amc'\nabout = ''\nnote = ''\ninterval = 0.002\nstop = \"'STOP' 0A\"\n\
    frame = 'FF FF leg1:u16 leg2:u16 leg3:u16 leg4:u16 leg5:u16 leg6:u16 00 00 00 00 0A 0D'";

/// A pseudo-terminal: the controller's end, which no child has, and the path of the line.
fn pair() -> (File, String) {
    let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    fcntl_setfd(&master, FdFlags::CLOEXEC).unwrap();
    grantpt(&master).unwrap();
    unlockpt(&master).unwrap();
    let line = ptsname(&master, Vec::new()).unwrap().into_string().unwrap();
    (File::from(master), line)
}

#[test]
fn a_line_that_is_pulled_is_a_fault_and_an_exit_status() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("amc.toml"), TEMPLATE).unwrap();
    let (mut master, line) = pair();
    let to = format!("serial:{line}:250000");
    let arguments = ["--format", "csv", "--frames", "amc.toml", "--settled"];
    let from = format!("udp:{}", free_port());
    let mut live = Live::with(directory.path(), &from, &to, &arguments, thread::spawn(Vec::new));
    live.command("start");
    live.wait_for("homing");
    let mut part = [0; 4096];
    for _ in 0..20 {
        assert!(master.read(&mut part).unwrap() > 0);
    }
    let pulled = Instant::now();
    drop(master);
    live.wait_for("Repair it, then clear");
    let taken = pulled.elapsed();
    live.wait_for("fault");
    assert!(taken < Duration::from_millis(500), "said after {taken:?}");
    // Where the legs are is unknown now, and these frames know no slow start.
    live.command("clear");
    live.wait_for("or start slowly");
    live.interrupt();
    live.wait_for("off");
    assert!(!live.end().0.success());
}

/// The line of a link, as the system names an adapter anew when it comes back.
#[test]
#[cfg(unix)]
fn a_line_that_comes_back_takes_frames_from_where_the_legs_are() {
    let directory = tempfile::tempdir().unwrap();
    let path = |name: &str| directory.path().join(name);
    std::fs::write(path("amc.toml"), TEMPLATE.replace("stop =", "ask = \"'legs?' 0A\"\nstop =")).unwrap();
    let (mut master, line) = pair();
    std::os::unix::fs::symlink(line, path("line")).unwrap();
    let to = format!("serial:{}:250000", path("line").display());
    let arguments = ["--format", "csv", "--frames", "amc.toml", "--settled"];
    let from = format!("udp:{}", free_port());
    let mut live = Live::with(directory.path(), &from, &to, &arguments, thread::spawn(Vec::new));
    live.command("start");
    live.wait_for("homing");
    assert!(master.read(&mut [0; 4096]).unwrap() > 0);
    drop(master);
    live.wait_for("fault");
    let (mut master, line) = pair();
    std::fs::remove_file(path("line")).unwrap();
    std::os::unix::fs::symlink(line, path("line")).unwrap();
    // The line is open again with a question. Four answers say that the legs are at rest.
    let read_until = |master: &mut File, word: &[u8]| {
        let (mut bytes, mut part) = (Vec::new(), [0; 4096]);
        while !bytes.windows(word.len()).any(|found: &[u8]| found == word) {
            let count = master.read(&mut part).unwrap();
            bytes.extend_from_slice(&part[..count]);
        }
    };
    for _ in 0..4 {
        read_until(&mut master, b"legs?\n");
        master.write_all(b"legs,1.3,1.3,1.3,1.3,1.3,1.3\r\n").unwrap();
    }
    thread::sleep(Duration::from_millis(100));
    live.command("clear");
    live.wait_for("legs: as the controller reports");
    read_until(&mut master, &[0xFF, 0xFF]);
    let controller = thread::spawn(move || while master.read(&mut [0; 4096]).is_ok_and(|count| count > 0) {});
    live.interrupt();
    live.wait_for("off");
    // The fault is in the exit status.
    assert!(!live.end().0.success());
    controller.join().unwrap();
}

#[test]
fn whole_frames_arrive_and_the_stop_string_after_an_interrupt() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("amc.toml"), TEMPLATE).unwrap();
    let (mut master, line) = pair();
    let controller = thread::spawn(move || {
        let mut bytes = Vec::new();
        let mut part = [0; 4096];
        while !bytes.ends_with(b"STOP\n") {
            let count = master.read(&mut part).unwrap();
            bytes.extend(&part[..count]);
        }
        bytes
    });
    let to = format!("serial:{line}:250000");
    let arguments = ["--format", "csv", "--frames", "amc.toml", "--settled"];
    let from = format!("udp:{}", free_port());
    let mut live = Live::with(directory.path(), &from, &to, &arguments, thread::spawn(Vec::new));
    live.command("start");
    live.wait_for("homing");
    live.interrupt();
    live.wait_for("off");
    let (status, printed, _) = live.end();
    assert!(status.success() && printed.contains("sent, 0 not"), "{printed}");
    let bytes = controller.join().unwrap();
    let frames = bytes.strip_suffix(b"STOP\n").unwrap().chunks(20);
    let positions: Vec<u16> = frames
        .map(|frame| {
            assert!(frame.starts_with(&[0xFF, 0xFF]) && frame.ends_with(&[0, 0, 0, 0, 0x0A, 0x0D]), "{frame:?}");
            u16::from_be_bytes([frame[2], frame[3]])
        })
        .collect();
    // On the way up it turns round, and rests at 2 % of the stroke.
    assert!(positions.len() > 100);
    let last = &positions[positions.len() - 3..];
    assert!(last.iter().all(|position| (1_300..2_100).contains(position)), "{last:?}");
}

#[test]
fn a_line_slower_than_the_frames_gets_fewer_of_them() {
    let directory = tempfile::tempdir().unwrap();
    let template = "name = 'slow'\nabout = ''\nnote = ''\ninterval = 0.01\nstop = \"'STOP' 0A\"\n\
        frame = \"time:3 ',' leg1:dec 0A\"";
    std::fs::write(directory.path().join("slow.toml"), template).unwrap();
    let (mut master, line) = pair();
    let controller = thread::spawn(move || {
        let mut text = String::new();
        let mut part = [0; 4096];
        while !text.ends_with("STOP\n") {
            let count = master.read(&mut part).unwrap();
            text += str::from_utf8(&part[..count]).unwrap();
        }
        text
    });
    let to = format!("serial:{line}:1200");
    let arguments = ["--format", "csv", "--frames", "slow.toml", "--settled"];
    let from = format!("udp:{}", free_port());
    let mut live = Live::with(directory.path(), &from, &to, &arguments, thread::spawn(Vec::new));
    live.wait_for("instead of every 10 ms; a higher rate of the line is better");
    live.command("start");
    live.wait_for("homing");
    live.interrupt();
    live.wait_for("off");
    assert!(live.end().0.success());
    let text = controller.join().unwrap();
    let times: Vec<f64> = text.lines().filter_map(|line| line.split_once(',')?.0.parse().ok()).collect();
    // 13 to 15 bytes of 10 bits at 1,200 bits a second. The last frame comes with the stop.
    let before_stop = &times[..times.len() - 1];
    assert!(times.len() > 5 && before_stop.windows(2).all(|pair| pair[1] - pair[0] > 0.1), "{times:?}");
}

#[test]
fn a_controller_reports_its_lengths_on_the_line() {
    let directory = tempfile::tempdir().unwrap();
    let asking = TEMPLATE.replace("stop =", "ask = \"'legs?' 0A\"\nstop =");
    std::fs::write(directory.path().join("amc.toml"), asking).unwrap();
    let (mut master, line) = pair();
    let controller = thread::spawn(move || {
        let mut bytes = Vec::new();
        let mut part = [0; 4096];
        let (mut asked, mut frames_at) = (0, None);
        while !bytes.ends_with(b"STOP\n") {
            let count = master.read(&mut part).unwrap();
            bytes.extend(&part[..count]);
            let questions = bytes.windows(6).filter(|word| *word == b"legs?\n").count();
            if frames_at.is_none() {
                frames_at = bytes.windows(2).position(|head| head == [0xFF, 0xFF]);
            }
            for _ in asked..questions {
                // In two parts, after some noise.
                master.write_all(b"\xFE\r\nlegs,1.3,1.3,1.").unwrap();
                thread::sleep(Duration::from_millis(30));
                master.write_all(b"3,1.3,1.3,1.3\r\n").unwrap();
            }
            asked = questions;
        }
        let at = frames_at.unwrap();
        bytes[at..at + 20].to_vec()
    });
    let to = format!("serial:{line}:250000");
    let arguments = ["--format", "csv", "--frames", "amc.toml", "--engage"];
    let from = format!("udp:{}", free_port());
    let mut live = Live::with(directory.path(), &from, &to, &arguments, thread::spawn(Vec::new));
    live.wait_for("legs: as the controller reports");
    live.wait_for("homing");
    live.interrupt();
    live.wait_for("off");
    assert!(live.end().0.success());
    let first = controller.join().unwrap();
    // In the middle of the stroke from 1.0 to 1.6 m.
    let positions = first[2..14].chunks(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]]));
    assert!(positions.into_iter().all(|position| position.abs_diff(0x8000) < 200), "{first:?}");
}
