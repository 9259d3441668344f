//! The command between an emulated vehicle and an emulated device.

use std::io::{BufRead, BufReader, Write};
use std::net::UdpSocket;
use std::path::Path;
use std::process::{Child, ChildStderr, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

/// The command with its lines of standard error, and the device that receives its frames.
pub struct Live {
    pub child: Child,
    lines: std::io::Lines<BufReader<ChildStderr>>,
    device: thread::JoinHandle<Vec<String>>,
}

impl Live {
    /// Starts the command. The device receives until `stop`.
    pub fn start(directory: &Path, from: &str, arguments: &[&str]) -> Live {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        // A command that fails leaves no test waiting for ever.
        socket.set_read_timeout(Some(Duration::from_secs(120))).unwrap();
        let to = format!("udp:{}", socket.local_addr().unwrap());
        let device = thread::spawn(move || {
            let mut frames: Vec<String> = Vec::new();
            while frames.last().is_none_or(|frame| frame != "stop\n") {
                let mut packet = [0; 2000];
                let length = socket.recv(&mut packet).unwrap();
                frames.push(String::from_utf8(packet[..length].to_vec()).unwrap());
            }
            frames
        });
        // A new emulator is at its lowest pose.
        Live::with(directory, from, &to, &[&["--settled"], arguments].concat(), device)
    }

    /// Starts the command with another device. The command ends by itself, so that
    /// no test waits for ever.
    pub fn with(
        directory: &Path,
        from: &str,
        to: &str,
        arguments: &[&str],
        device: thread::JoinHandle<Vec<String>>,
    ) -> Live {
        let mut child = Command::new(env!("CARGO_BIN_EXE_moris-live"))
            .args(["--from", from, "--to", to, "--for", "100"])
            .args(arguments)
            .current_dir(directory)
            // Locks of other tests' controllers lie elsewhere.
            .env("TMPDIR", directory)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let lines = BufReader::new(child.stderr.take().unwrap()).lines();
        Live { child, lines, device }
    }

    pub fn wait_for(&mut self, word: &str) {
        let found = self.lines.by_ref().map_while(Result::ok).any(|line| line.trim_end().ends_with(word));
        assert!(found, "moris-live has ended before: {word}");
    }

    /// The rest of the line that begins with these words.
    pub fn after(&mut self, words: &str) -> String {
        let found =
            self.lines.by_ref().map_while(Result::ok).find_map(|line| line.strip_prefix(words).map(str::to_owned));
        found.expect(words)
    }

    pub fn command(&mut self, line: &str) {
        writeln!(self.child.stdin.as_mut().unwrap(), "{line}").unwrap();
    }

    pub fn interrupt(&self) {
        self.signal("INT");
    }

    pub fn signal(&self, name: &str) {
        let [name, child] = [format!("-{name}"), self.child.id().to_string()];
        assert!(Command::new("kill").args([name, child]).status().unwrap().success());
    }

    /// The exit status, what has been printed, and all frames.
    pub fn end(self) -> (ExitStatus, String, Vec<String>) {
        let output = self.child.wait_with_output().unwrap();
        (output.status, String::from_utf8(output.stdout).unwrap(), self.device.join().unwrap())
    }
}

/// A port that is free now.
pub fn free_port() -> u16 {
    UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}

/// Sends a drive at 100 Hz to the port while `runs`.
pub fn vehicle(port: u16, runs: &AtomicBool) {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let mut k = 0;
    while runs.load(Ordering::Relaxed) {
        let t = f64::from(k) * 0.01;
        let line = format!("{t},{},0.3,9.80665,0,0,{}", 1.5 * (0.9 * t).sin(), 0.05 * (0.7 * t).sin());
        socket.send_to(line.as_bytes(), ("127.0.0.1", port)).unwrap();
        thread::sleep(Duration::from_millis(10));
        k += 1;
    }
}

/// A time after which a second interrupt is one of its own.
pub const APART: Duration = Duration::from_millis(700);

/// The six lengths in a frame.
pub fn lengths(frame: &str) -> Vec<f64> {
    frame.split(',').skip(1).take(6).map(|field| field.parse().unwrap()).collect()
}
