//! The server of the page. One thread takes connections and reads their requests, which may never
//! come. Each request is answered on a thread of its own, of which there are few.

use std::collections::VecDeque;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result};
use moris_pages::live;
use moris_pages::report::{Parameter, Rig, Vehicle};
use moris_pages::ride::RoadMap;
use moris_setup::Setup;
use serde::Serialize;

use super::control_broker::ControlBroker;
use super::http::{self, Access, HttpError, Incoming, Request};
use super::track::Track;
use crate::Shared;
use crate::controls::Handling;
use crate::telemetry::Features;
use crate::thread_monitor::{Part, watch};
use moris_analysis::page::simulator::parameters;

/// Connections that the system keeps until they are taken: more than a flood makes meanwhile.
#[cfg(unix)]
const WAITING_CONNECTIONS: i32 = 4096;

/// Data of the page from its start on.
#[derive(Clone, Debug, Serialize)]
pub struct Start {
    rig: Rig,
    parameters: Vec<Parameter>,
    subtitle: String,
    handling: Option<Handling>,
    vehicle: Vehicle,
    road: Option<RoadMap>,
    track: Option<Track>,
}

impl Start {
    /// The page of a session with this rig, these parameters and telemetry, and of a road that is
    /// learned.
    pub fn of(setup: &Setup, features: &Features, track: Option<Track>) -> Self {
        Start {
            rig: (&setup.parameters).into(),
            parameters: parameters(&setup.parameters, &setup.rig_alone),
            subtitle: format!("{}, parameters: {}", setup.rig_name, setup.parameters_name),
            handling: features.handling,
            vehicle: features.shape.unwrap_or(Vehicle::Motorcycle),
            road: features.road.clone(),
            track,
        }
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
    broker: Arc<ControlBroker>,
    pages: Arc<()>,
    requests: Arc<()>,
    shared: Arc<Shared>,
}

impl Server {
    /// A server at this port, 0 for any, of this machine alone or for others too.
    ///
    /// # Errors
    /// The port is taken.
    pub fn open(
        port: u16,
        listen: bool,
        start: &Start,
        broker: Arc<ControlBroker>,
        shared: Arc<Shared>,
    ) -> Result<Self> {
        let address = if listen { Ipv4Addr::UNSPECIFIED } else { Ipv4Addr::LOCALHOST };
        let listener = TcpListener::bind(SocketAddr::new(IpAddr::V4(address), port))
            .with_context(|| format!("cannot serve the page at {address}:{port}"))?;
        listener.set_nonblocking(true)?;
        #[cfg(unix)]
        rustix::net::listen(&listener, WAITING_CONNECTIONS)?;
        let access = Access { token: secret()?, port: listener.local_addr()?.port() };
        let [pages, requests] = [(), ()].map(Arc::new);
        let site = Site { page: live::html(&start.subtitle, start), access, broker, pages, requests, shared };
        Ok(Server { listener, site: Arc::new(site) })
    }

    /// The address to open.
    pub fn address(&self) -> String {
        let Access { token, port } = &self.site.access;
        format!("http://127.0.0.1:{port}/?token={token}")
    }

    /// Answers until the loop has ended. Threads of connections may live a little longer.
    pub fn run(&self, shared: &Shared) {
        // Time between looks for a new connection, and for the rest of a request.
        const CONNECTION_CHECK_INTERVAL: Duration = Duration::from_millis(20);
        const REQUEST_CHECK_INTERVAL: Duration = Duration::from_millis(1);
        let mut strangers = VecDeque::new();
        while !shared.done.load(Ordering::Relaxed) {
            self.accept(&mut strangers);
            let before = strangers.len();
            strangers.retain_mut(|stranger: &mut Incoming| !self.serve_if_complete(stranger));
            if before == strangers.len() {
                let is_quiet = strangers.is_empty();
                thread::sleep(if is_quiet { CONNECTION_CHECK_INTERVAL } else { REQUEST_CHECK_INTERVAL });
            }
        }
    }

    /// Takes new connections. Before one closes the oldest, that has been read once at least.
    fn accept(&self, strangers: &mut VecDeque<Incoming>) {
        // Most connections at once whose request has not come yet: a new one closes the oldest.
        const MAX_STRANGERS: usize = 128;
        // Connections that are taken before those that are there are read again.
        const ACCEPTED_AT_ONCE: usize = 16;
        for _ in 0..ACCEPTED_AT_ONCE {
            let Ok((stream, _)) = self.listener.accept() else { return };
            let Ok(stranger) = Incoming::new(stream) else { continue };
            strangers.push_back(stranger);
            if strangers.len() > MAX_STRANGERS {
                strangers.pop_front();
            }
        }
    }

    /// Answers a request that has come whole, on a thread of its own. True if it has.
    fn serve_if_complete(&self, stranger: &mut Incoming) -> bool {
        let Some(request) = stranger.request() else { return false };
        let Ok(stream) = stranger.stream.try_clone() else { return true };
        let site = Arc::clone(&self.site);
        // Without a thread the connection is closed.
        let _ = thread::Builder::new()
            .name("page".to_owned())
            .spawn(move || watch(&site.shared.failed, Part::Page, || site.serve(stream, request)));
        true
    }
}

impl Site {
    fn serve(&self, mut stream: TcpStream, request: Result<Request, HttpError>) {
        let is_ready = stream.set_nonblocking(false).is_ok()
            && stream.set_nodelay(true).is_ok()
            && stream.set_write_timeout(Some(http::WRITE_TIME)).is_ok();
        let request = if is_ready { request } else { Err(HttpError::new(500, "")) };
        let answered = request.and_then(|request| self.answer(&request, &mut stream));
        if let Err(refusal) = answered {
            http::answer(&mut stream, refusal.number, "text/plain", &refusal.reason);
        }
    }

    fn answer(&self, request: &Request, stream: &mut TcpStream) -> Result<(), HttpError> {
        // Most pages, and most of their other requests at once.
        const MOST_PAGES: usize = 12;
        const MOST_REQUESTS: usize = 24;
        self.access.check(request)?;
        let (open, most) =
            if request.path == "/events" { (&self.pages, MOST_PAGES) } else { (&self.requests, MOST_REQUESTS) };
        // Counts for as long as it is answered.
        let open = Arc::clone(open);
        if Arc::strong_count(&open) > most + 1 {
            return Err(HttpError::new(503, "too many pages or requests at once"));
        }
        match (request.method.as_str(), request.path.as_str()) {
            ("GET", "/") => http::answer(stream, 200, "text/html", &self.page),
            ("GET", "/events") => self.send_events(stream)?,
            ("POST", "/ask") => {
                self.broker.ask(&request.body)?;
                http::answer(stream, 200, "text/plain", "");
            }
            _ => return Err(HttpError::new(404, "there is nothing here")),
        }
        Ok(())
    }

    fn send_events(&self, stream: &mut TcpStream) -> Result<(), HttpError> {
        let client = secret().map_err(|error| HttpError::new(500, error.to_string()))?;
        let welcome = serde_json::to_string(&self.broker.enter(&client)).unwrap_or_default();
        if http::begin_events(stream) && http::send_event(stream, "welcome", &welcome) {
            let mut number = 0;
            // What has come while a slow browser was reading is left out.
            while let Some((next, text)) = self.broker.message_after(number) {
                number = next;
                if !http::send_event(stream, "message", &text) {
                    break;
                }
            }
            http::send_event(stream, "end", "");
        }
        self.broker.leave(&client);
        Ok(())
    }
}

/// 128 random bits in hexadecimal digits.
fn secret() -> Result<String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|error| anyhow::anyhow!("no random numbers: {error}"))?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}
