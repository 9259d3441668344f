//! Place of the legs at a start. A controller reports it, or has no report.

use std::net::UdpSocket;
use std::thread;
use std::time::Duration;

use moris_live::frame;

use crate::rig::{Live, free_port, lengths};

#[test]
fn a_controller_that_reports_its_lengths_is_followed_from_there() {
    let directory = tempfile::tempdir().unwrap();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    socket.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
    let to = format!("udp:{}", socket.local_addr().unwrap());
    let device = thread::spawn(move || {
        let mut frames: Vec<String> = Vec::new();
        let mut packet = [0; 2000];
        while frames.last().is_none_or(|frame| frame != "stop\n") {
            let (length, from) = socket.recv_from(&mut packet).unwrap();
            frames.push(String::from_utf8(packet[..length].to_vec()).unwrap());
            if frames.last().unwrap() == "legs?\n" {
                socket.send_to(b"legs,1.2,1.21,1.22,1.23,1.24,1.25\n", from).unwrap();
            }
        }
        frames
    });
    let from = format!("udp:{}", free_port());
    let mut live = Live::with(directory.path(), &from, &to, &["--format", "csv", "--engage"], device);
    live.wait_for("legs: as the controller reports");
    live.wait_for("neutral");
    live.command("stop");
    live.wait_for("off");
    live.interrupt();
    let (status, printed, frames) = live.end();
    assert!(status.success(), "{printed}");
    let start = frames.iter().position(|frame| frame == "start\n").unwrap();
    assert!(start > 0 && frames[..start].iter().all(|frame| frame == "legs?\n"), "{frames:?}");
    let first = lengths(&frames[start + 1]);
    let expected = [1.2, 1.21, 1.22, 1.23, 1.24, 1.25];
    assert!((0..6).all(|k| (first[k] - expected[k]).abs() < 2e-3), "{first:?}");
}

#[test]
fn frames_that_know_no_slow_start_wait_for_a_person() {
    let directory = tempfile::tempdir().unwrap();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let to = format!("udp:{}", socket.local_addr().unwrap());
    let arguments = ["--format", "csv", "--frames", "simtools"];
    let from = format!("udp:{}", free_port());
    let mut live = Live::with(directory.path(), &from, &to, &arguments, thread::spawn(Vec::new));
    live.wait_for("if the controller limits its own speed (--settled, --slow-start)");
    live.command("start");
    live.wait_for("or start slowly");
    socket.set_nonblocking(true).unwrap();
    assert!(socket.recv(&mut [0; 100]).is_err(), "a frame before anybody knows where the legs are");
    live.command("settled");
    live.command("start");
    live.wait_for("legs: settled");
    live.wait_for("homing");
    live.command("stop");
    live.wait_for("off");
    live.interrupt();
    assert!(live.end().0.success());
}

#[test]
fn a_controller_that_comes_back_reports_where_it_is() {
    let directory = tempfile::tempdir().unwrap();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let address = socket.local_addr().unwrap();
    let from = format!("udp:{}", free_port());
    let arguments = ["--format", "csv", "--settled"];
    let to = format!("udp:{address}");
    let mut live = Live::with(directory.path(), &from, &to, &arguments, thread::spawn(Vec::new));
    live.command("start");
    live.wait_for("homing");
    drop(socket);
    live.wait_for("fault");
    let socket = UdpSocket::bind(address).unwrap();
    socket.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
    let mut packet = [0; 2000];
    // Until they are known to be at rest.
    for _ in 0..4 {
        let (length, from) = socket.recv_from(&mut packet).unwrap();
        assert_eq!(&packet[..length], b"legs?\n", "a frame before the fault is cleared");
        socket.send_to(b"{\"legs\":[1.3,1.3,1.3,1.3,1.3,1.3]}", from).unwrap();
    }
    thread::sleep(Duration::from_millis(100));
    live.command("clear");
    live.wait_for("legs: as the controller reports");
    let first = loop {
        let length = socket.recv(&mut packet).unwrap();
        let text = str::from_utf8(&packet[..length]).unwrap();
        if text.contains(',') {
            break lengths(text);
        }
    };
    assert!(first.iter().all(|length| (length - 1.3).abs() < 2e-3), "{first:?}");
    live.command("stop");
    live.wait_for("off");
    live.interrupt();
    assert!(!live.end().0.success(), "the session was in a fault");
}

#[test]
fn settled_is_no_place_while_the_legs_follow_commands() {
    let directory = tempfile::tempdir().unwrap();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let to = format!("udp:{}", socket.local_addr().unwrap());
    let arguments = ["--format", "csv", "--frames", "simtools", "--settled"];
    let from = format!("udp:{}", free_port());
    let mut live = Live::with(directory.path(), &from, &to, &arguments, thread::spawn(Vec::new));
    live.command("start");
    live.wait_for("homing");
    live.command("settled");
    live.wait_for("their place is given in the state off");
    drop(socket);
    live.wait_for("fault");
    live.command("clear");
    live.wait_for("or start slowly");
    live.interrupt();
    live.wait_for("off");
    assert!(!live.end().0.success(), "the session was in a fault");
}

#[test]
fn a_computer_that_has_slept_sends_no_frame_before_the_place_is_known() {
    let directory = tempfile::tempdir().unwrap();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let to = format!("udp:{}", socket.local_addr().unwrap());
    let arguments = ["--format", "csv", "--frames", "simtools", "--settled"];
    let from = format!("udp:{}", free_port());
    let mut live = Live::with(directory.path(), &from, &to, &arguments, thread::spawn(Vec::new));
    live.command("start");
    live.wait_for("homing");
    live.signal("STOP");
    thread::sleep(Duration::from_millis(2300));
    socket.set_nonblocking(true).unwrap();
    while socket.recv(&mut [0; 100]).is_ok() {}
    live.signal("CONT");
    live.wait_for("Look where the legs are, then clear");
    live.wait_for("fault");
    live.command("clear");
    live.wait_for("or start slowly");
    assert!(socket.recv(&mut [0; 100]).is_err(), "a frame before anybody knows where the legs are");
    // The last frames may have left it elsewhere: whoever has looked says so twice.
    live.command("settled");
    live.command("settled");
    live.command("clear");
    live.wait_for("legs: settled");
    live.wait_for("homing");
    live.command("stop");
    live.wait_for("off");
    live.interrupt();
    assert!(!live.end().0.success(), "the session was in a fault");
}

#[test]
fn a_session_that_was_killed_is_not_followed_by_a_settled_one_unless_a_person_says_so() {
    let directory = tempfile::tempdir().unwrap();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let to = format!("udp:{}", socket.local_addr().unwrap());
    let arguments = ["--format", "csv", "--frames", "simtools", "--settled"];
    let from = format!("udp:{}", free_port());
    let start = || Live::with(directory.path(), &from, &to, &arguments, thread::spawn(Vec::new));
    let mut live = start();
    live.command("start");
    live.wait_for("neutral");
    live.signal("KILL");
    assert!(!live.end().0.success());
    let mut live = start();
    live.wait_for("has not parked. Look, then say settled");
    live.command("start");
    live.wait_for("or start slowly");
    live.command("settled");
    live.command("start");
    live.wait_for("neutral");
    live.interrupt();
    live.wait_for("off");
    assert!(live.end().0.success());
    // That one has parked.
    let mut live = start();
    live.command("start");
    live.wait_for("legs: settled");
    live.signal("KILL");
    live.end();
}

/// Servos report that they stand at -20 degrees. Their pulses go up from there, then down to the
/// lowest arms. No pulse follows a plug that is pulled.
#[test]
fn cranks_glide_from_reported_angles_park_and_are_silent_after_a_pulled_plug() {
    let directory = tempfile::tempdir().unwrap();
    let template = moris_live::shipped(frame::SHIPPED_FRAMES, "servos").unwrap();
    let template = template.replace("reversed = []", "reversed = [2, 4, 6]\nask = \"'?' 0A\"\nstop = \"'stop' 0A\"");
    std::fs::write(directory.path().join("own.toml"), template).unwrap();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let address = socket.local_addr().unwrap();
    let from = format!("udp:{}", free_port());
    let arguments = ["--format", "csv", "--rig", "crank-person", "--frames", "own.toml"];
    let mut live = Live::with(directory.path(), &from, &format!("udp:{address}"), &arguments, thread::spawn(Vec::new));
    socket.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
    // The degrees of the arms in frames until a question, which is answered with these.
    let listen = |socket: &UdpSocket, angles: &str, questions: usize| {
        let (mut packet, mut asked, mut frames) = ([0; 2000], 0, Vec::new());
        while asked < questions {
            let (length, from) = socket.recv_from(&mut packet).unwrap();
            let text = str::from_utf8(&packet[..length]).unwrap();
            if text == "?\n" {
                asked += 1;
                socket.send_to(angles.as_bytes(), from).unwrap();
            } else if text.contains(',') {
                let pulses = text.trim().split(',').map(|pulse| pulse.parse::<f64>().unwrap());
                let degrees =
                    pulses.zip([1.0, -1.0].into_iter().cycle()).map(|(pulse, sign)| sign * (pulse - 1500.0) / 10.0);
                frames.push(degrees.collect::<Vec<f64>>());
            }
        }
        frames
    };
    assert!(
        listen(&socket, "degrees,-20,20,-20,20,-20,20\n", 4).is_empty(),
        "a frame before anybody knows where the arms are"
    );
    thread::sleep(Duration::from_millis(100));
    live.command("start");
    live.wait_for("legs: as the controller reports");
    live.wait_for("neutral");
    live.command("park");
    live.wait_for("settled");
    live.command("stop");
    // In the state off the controller is asked again.
    let frames = listen(&socket, "degrees,-52,52,-52,52,-52,52\n", 4);
    let of = |frame: &Vec<f64>, angle: f64| frame.iter().all(|found| (found - angle).abs() < 0.6);
    assert!(of(&frames[0], -20.0), "{:?}", frames[0]);
    assert!(frames.iter().any(|frame| of(frame, 0.0)));
    assert!(of(frames.last().unwrap(), -52.2), "{:?}", frames.last());
    // A quarter of 6 rad/s on the way, in frames of 20 ms, and as much again for late ones.
    let fastest =
        frames.windows(2).flat_map(|pair| (0..6).map(|k| (pair[1][k] - pair[0][k]).abs())).fold(0.0, f64::max);
    assert!(fastest < 3.5, "{fastest} degrees from frame to frame");
    thread::sleep(Duration::from_millis(100));
    live.command("start");
    live.wait_for("homing");
    drop(socket);
    live.wait_for("fault");
    let socket = UdpSocket::bind(address).unwrap();
    socket.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
    assert!(listen(&socket, "", 4).is_empty(), "a frame before the fault is cleared");
    live.interrupt();
    live.wait_for("off");
    assert!(!live.end().0.success(), "the session was in a fault");
}
