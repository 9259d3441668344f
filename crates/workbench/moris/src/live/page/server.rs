//! The server of the page: a thread for each connection, of which there are few.

use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result};
use moris_report::{Parameter, Rig, shared};
use moris_ride::page as ride;
use moris_setup::Setup;
use serde::Serialize;

use super::desk::Desk;
use super::http::{self, Access, Request};
use crate::live::Shared;
use crate::live::controls::Handling;
use crate::simulate::simulator::{parameters, sets};

const TEMPLATE: &str = include_str!("../../../page/live.html");
const STYLE: &str = include_str!("../../../page/live.css");
const SCRIPTS: [&str; 4] = [
    include_str!("../../../page/orders.js"),
    include_str!("../../../page/driving.js"),
    include_str!("../../../page/pair.js"),
    include_str!("../../../page/live.js"),
];
/// Most connections at once.
const MOST: usize = 16;
/// Time between looks for a new connection.
const LOOK: Duration = Duration::from_millis(20);

/// Data of the page from its start on.
#[derive(Clone, Debug, Serialize)]
pub struct Start {
    rig: Rig,
    parameters: Vec<Parameter>,
    sets: Vec<(String, Vec<(String, f64)>)>,
    subtitle: String,
    handling: Option<Handling>,
}

impl Start {
    /// The page of a session with this rig, these parameters and controls.
    pub fn of(setup: &Setup, handling: Option<Handling>) -> Self {
        Start {
            rig: (&setup.parameters).into(),
            parameters: parameters(&setup.parameters, &setup.rig_alone),
            sets: sets(),
            subtitle: format!("{}, parameters: {}", setup.rig_name, setup.parameters_name),
            handling,
        }
    }

    fn html(&self) -> String {
        let head = shared::Head {
            title: "Live",
            subtitle: &self.subtitle,
            style: &[ride::STYLE, STYLE].join("\n"),
            policy: "script-src 'unsafe-inline'; connect-src 'self'",
        };
        shared::assembled(&head, TEMPLATE, self, &[&ride::SHARED[..], &[ride::CONTROLS], &SCRIPTS].concat())
    }
}

/// The server.
pub struct Server {
    listener: TcpListener,
    site: Arc<Site>,
}

/// Data of all connections.
struct Site {
    page: String,
    access: Access,
    desk: Arc<Desk>,
    connections: AtomicUsize,
}

impl Server {
    /// A server at this port, 0 for any, of this machine alone or for others too.
    ///
    /// # Errors
    /// The port is taken.
    pub fn open(port: u16, listen: bool, start: &Start, desk: Arc<Desk>) -> Result<Self> {
        let address = if listen { Ipv4Addr::UNSPECIFIED } else { Ipv4Addr::LOCALHOST };
        let listener = TcpListener::bind(SocketAddr::new(IpAddr::V4(address), port))
            .with_context(|| format!("cannot serve the page at {address}:{port}"))?;
        listener.set_nonblocking(true)?;
        let access = Access { token: secret()?, port: listener.local_addr()?.port() };
        let site = Site { page: start.html(), access, desk, connections: AtomicUsize::new(0) };
        Ok(Server { listener, site: Arc::new(site) })
    }

    /// The address to open.
    pub fn address(&self) -> String {
        let Access { token, port } = &self.site.access;
        format!("http://127.0.0.1:{port}/?token={token}")
    }

    /// Answers until the loop has ended. Threads of connections may live a little longer.
    pub fn run(&self, shared: &Shared) {
        while !shared.done.load(Ordering::Relaxed) {
            let Ok((stream, _)) = self.listener.accept() else {
                thread::sleep(LOOK);
                continue;
            };
            let place = Place(Arc::clone(&self.site));
            if self.site.connections.fetch_add(1, Ordering::Relaxed) < MOST {
                // Without a thread the connection is closed.
                let _ = thread::Builder::new().name("page".to_owned()).spawn(move || {
                    let place = place;
                    place.0.serve(stream);
                });
            }
        }
    }
}

/// A connection's place, which it leaves at its end.
struct Place(Arc<Site>);

impl Drop for Place {
    fn drop(&mut self) {
        self.0.connections.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Site {
    fn serve(&self, mut stream: TcpStream) {
        let is_ready = stream.set_nonblocking(false).is_ok()
            && stream.set_nodelay(true).is_ok()
            && stream.set_write_timeout(Some(http::WRITE_TIME)).is_ok();
        if !is_ready {
            return;
        }
        let answered = http::read(&mut stream).and_then(|request| self.answer(&request, &mut stream));
        if let Err((number, why)) = answered {
            http::answer(&mut stream, number, "text/plain", &why);
        }
    }

    fn answer(&self, request: &Request, stream: &mut TcpStream) -> Result<(), http::Refusal> {
        self.access.check(request)?;
        match (request.method.as_str(), request.path.as_str()) {
            ("GET", "/") => http::answer(stream, 200, "text/html", &self.page),
            ("GET", "/events") => self.send_events(stream)?,
            ("POST", "/ask") => {
                self.desk.ask(&request.body)?;
                http::answer(stream, 200, "text/plain", "");
            }
            _ => return Err((404, "there is nothing here".to_owned())),
        }
        Ok(())
    }

    fn send_events(&self, stream: &mut TcpStream) -> Result<(), http::Refusal> {
        let client = secret().map_err(|error| (500, error.to_string()))?;
        let welcome = serde_json::to_string(&self.desk.enter(&client)).unwrap_or_default();
        if http::begin_events(stream) && http::send_event(stream, "welcome", &welcome) {
            let mut number = 0;
            // What has come while a slow browser was reading is left out.
            while let Some((next, text)) = self.desk.message_after(number) {
                number = next;
                if !http::send_event(stream, "message", &text) {
                    break;
                }
            }
            http::send_event(stream, "end", "");
        }
        self.desk.leave(&client);
        Ok(())
    }
}

/// 128 random bits in hexadecimal digits.
fn secret() -> Result<String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|error| anyhow::anyhow!("no random numbers: {error}"))?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}
