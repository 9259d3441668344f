//! Requests of a browser: bounded, and from the own page only.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{IpAddr, TcpStream};
use std::time::{Duration, Instant};

/// Most bytes of a request's head, and of its body.
const MAX_PART_SIZE: usize = 16_384;
/// Time in which a browser must take what is written.
pub const WRITE_TIME: Duration = Duration::from_secs(2);

/// Answer to a request that is refused: HTTP's number of the status, and the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HttpError {
    pub number: u16,
    pub reason: String,
}

impl HttpError {
    /// A refusal with this status, for this reason.
    pub fn new(number: u16, reason: impl Into<String>) -> Self {
        HttpError { number, reason: reason.into() }
    }
}

/// A refusal of a request that is understood, but cannot be carried out.
impl From<String> for HttpError {
    fn from(reason: String) -> Self {
        HttpError::new(422, reason)
    }
}

fn refused<T>(number: u16, reason: &str) -> Result<T, HttpError> {
    Err(HttpError::new(number, reason))
}

/// A request of a browser, read and bounded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Request {
    pub method: String,
    pub path: String,
    /// From the address or a header.
    pub token: String,
    pub host: String,
    pub origin: Option<String>,
    pub body: Vec<u8>,
}

/// A connection whose request has not come whole yet.
#[derive(Debug)]
pub struct Incoming {
    pub stream: TcpStream,
    begin: Instant,
    bytes: Vec<u8>,
}

impl Incoming {
    /// A new connection, which is read without waiting.
    ///
    /// # Errors
    /// The system does not permit that.
    pub fn new(stream: TcpStream) -> io::Result<Self> {
        stream.set_nonblocking(true)?;
        Ok(Incoming { stream, begin: Instant::now(), bytes: Vec::new() })
    }

    /// Takes what has come. The request, once it is whole; its refusal, if it is none,
    /// too large, or too slow.
    pub fn request(&mut self) -> Option<Result<Request, HttpError>> {
        // Time in which a request must be complete.
        const REQUEST_TIMEOUT: Duration = Duration::from_secs(1);
        let mut part = [0; 4096];
        loop {
            match self.stream.read(&mut part) {
                Ok(0) => return Some(refused(408, "the request is not complete")),
                Ok(count) => self.bytes.extend(&part[..count]),
                Err(error) if error.kind() == ErrorKind::Interrupted => (),
                Err(error) if error.kind() == ErrorKind::WouldBlock && self.begin.elapsed() < REQUEST_TIMEOUT => {
                    return None;
                }
                Err(_) => return Some(refused(408, "the request is not complete")),
            }
            match parsed(&self.bytes) {
                Ok(Some((mut request, head, length))) if self.bytes.len() >= head + length => {
                    request.body = self.bytes[head..head + length].to_vec();
                    return Some(Ok(request));
                }
                Ok(_) => (),
                Err(refusal) => return Some(Err(refusal)),
            }
        }
    }
}

/// A request without its body, the length of its head and of its body; none if the head goes on.
fn parsed(bytes: &[u8]) -> Result<Option<(Request, usize, usize)>, HttpError> {
    let mut headers = [httparse::EMPTY_HEADER; 64];
    let mut parsed = httparse::Request::new(&mut headers);
    let head = match parsed.parse(bytes) {
        Ok(httparse::Status::Complete(head)) => head,
        Ok(httparse::Status::Partial) if bytes.len() < MAX_PART_SIZE => return Ok(None),
        Ok(httparse::Status::Partial) => return refused(431, "the request's head is too large"),
        Err(error) => return refused(400, &error.to_string()),
    };
    let (path, query) =
        parsed.path.unwrap_or_default().split_once('?').unwrap_or((parsed.path.unwrap_or_default(), ""));
    let mut request =
        Request { method: parsed.method.unwrap_or_default().into(), path: path.into(), ..Request::default() };
    request.token = query.split('&').find_map(|part| part.strip_prefix("token=")).unwrap_or_default().into();
    let mut length = 0;
    for header in parsed.headers {
        let Ok(value) = std::str::from_utf8(header.value) else {
            return refused(400, "a header is no text");
        };
        match header.name.to_ascii_lowercase().as_str() {
            "host" => request.host = value.into(),
            "origin" => request.origin = Some(value.into()),
            "x-token" => request.token = value.into(),
            "content-length" => match value.parse() {
                Ok(count) if count <= MAX_PART_SIZE => length = count,
                _ => return refused(413, "the request is too large"),
            },
            "transfer-encoding" => return refused(411, "the request has no length"),
            _ => (),
        }
    }
    Ok(Some((request, head, length)))
}

/// Token and port that a request must have to be answered.
#[derive(Clone, Debug)]
pub struct Access {
    pub token: String,
    pub port: u16,
}

impl Access {
    /// Checks where a request comes from.
    ///
    /// # Errors
    /// The request has no token, or comes from another page.
    pub fn check(&self, request: &Request) -> Result<(), HttpError> {
        // A name would let another page's server point its own name here.
        let (host, port) = request.host.rsplit_once(':').unwrap_or((&request.host, "80"));
        let address = host.trim_start_matches('[').trim_end_matches(']');
        let is_own = (host == "localhost" || address.parse::<IpAddr>().is_ok()) && port == self.port.to_string();
        if !is_own {
            return refused(403, "the address is not that of this page");
        }
        let own = format!("http://{}", request.host);
        match &request.origin {
            Some(origin) if *origin != own => return refused(403, "the request comes from another page"),
            None if request.method != "GET" => return refused(403, "the request comes from no page"),
            _ => (),
        }
        let given = request.token.as_bytes();
        let differences = given.iter().zip(self.token.as_bytes()).fold(0, |sum, (one, other)| sum | (one ^ other));
        if given.len() != self.token.len() || differences != 0 {
            return refused(403, "the token is missing or wrong; open the address that moris-live has printed");
        }
        Ok(())
    }
}

/// Headers of every answer.
const COMMON_HEADERS: &str = "Cache-Control: no-store\r\nReferrer-Policy: no-referrer\r\nX-Content-Type-Options: nosniff\r\n\
    X-Frame-Options: DENY\r\nCross-Origin-Resource-Policy: same-origin\r\nConnection: close\r\n";

/// Answers a request with a text.
pub fn answer(stream: &mut TcpStream, number: u16, kind: &str, text: &str) {
    let head = format!(
        "HTTP/1.1 {number} {number}\r\nContent-Type: {kind}; charset=utf-8\r\nContent-Length: {}\r\n{COMMON_HEADERS}\r\n",
        text.len()
    );
    // The browser may be gone.
    let _ = stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(text.as_bytes()));
}

/// Begins an answer of events. False if the browser is gone.
pub fn begin_events(stream: &mut TcpStream) -> bool {
    let head = format!("HTTP/1.1 200 200\r\nContent-Type: text/event-stream\r\n{COMMON_HEADERS}\r\n");
    stream.write_all(head.as_bytes()).is_ok()
}

/// Sends an event, a text of one line.
pub fn send_event(stream: &mut TcpStream, kind: &str, text: &str) -> bool {
    stream.write_all(format!("event: {kind}\ndata: {text}\n\n").as_bytes()).is_ok()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn access() -> Access {
        Access { token: "0123".into(), port: 8080 }
    }

    fn request(method: &str, token: &str, host: &str, origin: Option<&str>) -> Request {
        let origin = origin.map(str::to_owned);
        Request { method: method.into(), token: token.into(), host: host.into(), origin, ..Request::default() }
    }

    #[test]
    fn only_the_own_page_with_the_token_has_access() {
        let own = Some("http://127.0.0.1:8080");
        for fine in [
            request("GET", "0123", "127.0.0.1:8080", None),
            request("POST", "0123", "127.0.0.1:8080", own),
            request("POST", "0123", "[::1]:8080", Some("http://[::1]:8080")),
            request("POST", "0123", "localhost:8080", Some("http://localhost:8080")),
        ] {
            assert_eq!(access().check(&fine), Ok(()), "{fine:?}");
        }
        for wrong in [
            request("GET", "", "127.0.0.1:8080", None),
            request("GET", "0124", "127.0.0.1:8080", None),
            request("GET", "012", "127.0.0.1:8080", None),
            request("GET", "01233", "127.0.0.1:8080", None),
            request("POST", "0123", "127.0.0.1:8080", None),
            request("POST", "0123", "127.0.0.1:8080", Some("http://evil.example")),
            request("POST", "0123", "127.0.0.1:8080", Some("null")),
            request("GET", "0123", "127.0.0.1:8080", Some("http://127.0.0.1:8081")),
            request("POST", "0123", "evil.example:8080", Some("http://evil.example:8080")),
            request("GET", "0123", "127.0.0.1:8081", None),
            request("GET", "0123", "", None),
        ] {
            assert_eq!(access().check(&wrong).map_err(|refusal| refusal.number), Err(403), "{wrong:?}");
        }
    }

    #[test]
    fn a_request_is_taken_apart() {
        let text =
            b"POST /order?a=1&token=77 HTTP/1.1\r\nHost: h:1\r\nOrigin: http://h:1\r\nContent-Length: 2\r\n\r\n{}";
        let (request, head, length) = parsed(text).unwrap().unwrap();
        assert_eq!((request.method.as_str(), request.path.as_str(), request.token.as_str()), ("POST", "/order", "77"));
        assert_eq!((request.host.as_str(), request.origin.as_deref()), ("h:1", Some("http://h:1")));
        assert_eq!((head, length), (text.len() - 2, 2));
        assert_eq!(parsed(&text[..head - 1]).unwrap(), None);
    }

    #[test]
    fn large_requests_are_refused() {
        let number = |text: String| parsed(text.as_bytes()).unwrap_err().number;
        assert_eq!(number(format!("GET /{} HTTP/1.1", "a".repeat(MAX_PART_SIZE))), 431);
        assert_eq!(number("POST / HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n".into()), 413);
        assert_eq!(number("POST / HTTP/1.1\r\nContent-Length: 16385\r\n\r\n".into()), 413);
        assert_eq!(number("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n".into()), 411);
    }

    proptest! {
        #[test]
        fn no_bytes_are_parsed_with_a_panic(bytes in prop::collection::vec(any::<u8>(), 0..300), known in 0..3_usize) {
            let begin: &[u8] = [&b""[..], b"GET / HTTP/1.1\r\n", b"POST /order HTTP/1.1\r\nContent-Length: "][known];
            let _ = parsed(&[begin, &bytes].concat());
        }
    }
}
