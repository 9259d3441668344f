//! The page's server: who may look, who may touch, and what hostile connections do.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

use crate::rig::{Live, free_port};

/// The page of a running command.
pub struct Page {
    address: SocketAddr,
    token: String,
}

impl Page {
    pub fn of(live: &mut Live) -> Self {
        let link = live.after("page: http://");
        let (address, token) = link.split_once("/?token=").unwrap();
        Page { address: address.parse().unwrap(), token: token.to_owned() }
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(self.address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        stream
    }

    /// The number of the answer, and its text.
    fn send(&self, request: &str) -> (u16, String) {
        let mut stream = self.connect();
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        let number = answer.split(' ').nth(1).unwrap().parse().unwrap();
        (number, answer)
    }

    pub fn get(&self, path: &str) -> (u16, String) {
        self.send(&format!("GET {path} HTTP/1.1\r\nHost: {}\r\n\r\n", self.address))
    }

    fn post(&self, origin: &str, token: &str, body: &str) -> (u16, String) {
        self.send(&format!(
            "POST /ask HTTP/1.1\r\nHost: {}\r\nOrigin: {origin}\r\nX-Token: {token}\r\nContent-Length: {}\r\n\r\n{body}",
            self.address,
            body.len()
        ))
    }

    /// The answer to an order of the own page.
    pub fn ask(&self, client: &str, order: &str) -> u16 {
        let own = format!("http://{}", self.address);
        self.post(&own, &self.token, &format!("{{\"client\":\"{client}\",\"ask\":{order}}}")).0
    }

    pub fn events(&self) -> Events {
        let mut stream = self.connect();
        let path = format!("/events?token={}", self.token);
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {}\r\n\r\n", self.address).unwrap();
        Events(BufReader::new(stream).lines())
    }
}

/// Events as a browser receives them.
pub struct Events(std::io::Lines<BufReader<TcpStream>>);

impl Events {
    pub fn next(&mut self) -> serde_json::Value {
        let data = self.0.by_ref().map(Result::unwrap).find_map(|line| line.strip_prefix("data: ").map(str::to_owned));
        serde_json::from_str(&data.expect("no event")).unwrap()
    }

    /// The number of this browser, and whether it controls.
    pub fn welcome(&mut self) -> (String, bool) {
        let welcome = self.next();
        (welcome["client"].as_str().unwrap().to_owned(), welcome["controls"].as_bool().unwrap())
    }

    pub fn wait_for(&mut self, mut is_there: impl FnMut(&serde_json::Value) -> bool) {
        while !is_there(&self.next()) {}
    }
}

fn start(directory: &std::path::Path, arguments: &[&str]) -> (Live, Page) {
    let arguments = [&["--format", "csv", "--page"], arguments].concat();
    let mut live = Live::start(directory, &format!("udp:{}", free_port()), &arguments);
    let page = Page::of(&mut live);
    (live, page)
}

/// Ends the command; all its frames have been sent.
pub fn end(live: Live) {
    live.interrupt();
    live.interrupt();
    let (status, printed, frames) = live.end();
    assert!(status.success() && printed.contains("sent, 0 not"), "{printed}");
    assert_eq!(frames.last().unwrap(), "stop\n");
}

#[test]
fn the_page_is_for_the_holder_of_the_token_alone() {
    let directory = tempfile::tempdir().unwrap();
    let (mut live, page) = start(directory.path(), &[]);
    assert!(page.address.ip().is_loopback());
    let (number, text) = page.get(&format!("/?token={}", page.token));
    assert!(number == 200 && text.contains("<title>Live</title>") && !text.contains(&page.token));
    let other = format!("{:032x}", 7);
    for path in ["/", "/?token=", &format!("/?token={other}"), "/events", &format!("/events?token={other}")] {
        let (number, text) = page.get(path);
        assert!(number == 403 && !text.contains("<title>"), "{path}: {text}");
    }
    assert_eq!(page.get(&format!("/../Cargo.toml?token={}", page.token)).0, 404);
    let mut events = page.events();
    let (client, _) = events.welcome();
    let order = format!("{{\"client\":\"{client}\",\"ask\":{{\"event\":\"start\"}}}}");
    let own = format!("http://{}", page.address);
    assert_eq!(page.post("http://127.0.0.1:1", &page.token, &order).0, 403);
    assert_eq!(page.post("null", &page.token, &order).0, 403);
    assert_eq!(page.post(&own, &other, &order).0, 403);
    assert_eq!(page.post(&own, &page.token, &order).0, 200);
    live.wait_for("homing");
    end(live);
}

#[test]
fn the_first_page_controls_and_a_second_one_looks() {
    let directory = tempfile::tempdir().unwrap();
    let (mut live, page) = start(directory.path(), &["--record", "session.csv"]);
    // One after the other: connections that are made at once may be taken in either order.
    let mut first = page.events();
    let (one, controls) = first.welcome();
    let mut second = page.events();
    let (two, also) = second.welcome();
    assert!(controls && !also);
    assert_eq!(page.ask(&two, "{\"event\":\"start\"}"), 403);
    assert_eq!(page.ask(&two, "{\"set\":{\"tilt.angleLimit\":0.2}}"), 403);
    // A fixed parameter changes while the platform is off, and not later.
    assert_eq!(page.ask(&one, "{\"set\":{\"strategy\":3}}"), 200);
    assert_eq!(page.ask(&one, "{\"set\":{\"tilt.angleLimit\":0.25}}"), 200);
    assert_eq!(page.ask(&one, "{\"set\":{\"tilt.angleLimit\":1e9}}"), 422);
    assert_eq!(page.ask(&one, "{\"event\":\"start\"}"), 200);
    second.wait_for(|message| message["state"] == "neutral");
    assert_eq!(page.ask(&one, "{\"set\":{\"strategy\":1}}"), 422);
    assert_eq!(page.ask(&one, "{\"event\":\"engage\"}"), 200);
    live.wait_for("refused: engage needs telemetry of a running vehicle; the source is waiting");
    second.wait_for(|message| message["lines"].to_string().contains("refused: engage"));
    second.wait_for(|message| message["changed"] == serde_json::json!({"strategy": 3.0, "tilt.angleLimit": 0.25}));
    end(live);
    let replayed = std::process::Command::new(env!("CARGO_BIN_EXE_moris-live"))
        .args(["--replay", "session.csv"])
        .current_dir(&directory)
        .output()
        .unwrap();
    let text = String::from_utf8(replayed.stdout).unwrap();
    assert!(text.contains("homing\n") && text.contains("to the bit"), "{text}");
}

#[test]
fn hostile_connections_do_no_harm() {
    let directory = tempfile::tempdir().unwrap();
    let (mut live, page) = start(directory.path(), &["--allow-control"]);
    // More than there are places; none of them reads, so that what is written to them fills up.
    let silent: Vec<TcpStream> = (0..20)
        .map(|_| {
            let mut stream = page.connect();
            // The server may have closed it at once.
            let _ = write!(stream, "GET /events?token={} HTTP/1.1\r\nHost: {}\r\n\r\n", page.token, page.address);
            stream
        })
        .collect();
    live.command("start");
    live.wait_for("homing");
    drop(silent);
    // What is random, or large, is refused or closed.
    let mut random = 1_u64;
    for k in 0..300 {
        let mut stream = page.connect();
        let bytes: Vec<u8> = (0..k * 20)
            .map(|_| {
                random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (random >> 33) as u8
            })
            .collect();
        let begin = ["", "GET /", "POST /ask HTTP/1.1\r\nContent-Length: 10\r\n\r\n"][k % 3];
        let _ = stream.write_all(&[begin.as_bytes(), &bytes].concat());
    }
    let mut stream = page.connect();
    let _ = stream.write_all(&vec![b'a'; 10_000_000]);
    drop(stream);
    live.wait_for("neutral");
    // The browsers that are gone have left their places.
    let mut events = loop {
        let mut events = page.events();
        if let Some(Ok(line)) = events.0.next() {
            assert!(line.contains("200"), "{line}");
            break events;
        }
    };
    let (client, controls) = events.welcome();
    assert!(controls);
    events.wait_for(|message| message["state"] == "neutral");
    assert_eq!(page.ask(&client, "{\"event\":\"park\"}"), 200);
    live.wait_for("parking");
    end(live);
}

/// Sets its flag when it is dropped, by a panic too: threads that wait for it end.
struct SetAtEnd<'a>(&'a std::sync::atomic::AtomicBool);

impl Drop for SetAtEnd<'_> {
    fn drop(&mut self) {
        self.0.store(true, std::sync::atomic::Ordering::Relaxed);
    }
}

/// Connections without end from the same machine, which ask for nothing: an order is answered.
#[test]
fn a_flood_of_connections_loses_no_stop() {
    let directory = tempfile::tempdir().unwrap();
    let (mut live, page) = start(directory.path(), &[]);
    let ends = std::sync::atomic::AtomicBool::new(false);
    std::thread::scope(|scope| {
        let _ended = SetAtEnd(&ends);
        for _ in 0..4 {
            scope.spawn(|| {
                let mut held = std::collections::VecDeque::new();
                while !ends.load(std::sync::atomic::Ordering::Relaxed) {
                    held.extend(TcpStream::connect(page.address));
                    if held.len() > 50 {
                        held.pop_front();
                    }
                    // Thousands a second, and time for others on a machine with one core.
                    std::thread::sleep(std::time::Duration::from_micros(200));
                }
            });
        }
        live.command("start");
        live.wait_for("homing");
        let answers = [(); 20].map(|()| page.ask("", "{\"event\":\"stop\"}"));
        assert_eq!(answers, [200; 20]);
        live.wait_for("off");
    });
    live.interrupt();
    assert!(live.end().0.success());
}
