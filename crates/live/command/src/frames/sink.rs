//! Places to which frames go: an address, a serial line, or standard output.

use std::cell::RefCell;
use std::io::Read as _;
use std::io::{self, Write, stdout};
use std::net::UdpSocket;
use std::time::Duration;

use anyhow::{Context, Result};
use serialport::{SerialPort, SerialPortBuilder};

/// Time in which a serial line must take a frame.
const LINE_TIME: Duration = Duration::from_millis(100);

/// A serial line; closed once it is pulled, so that its name is free for the one that comes back.
pub struct Serial {
    settings: SerialPortBuilder,
    line: RefCell<Option<Box<dyn SerialPort>>>,
}

/// Place to which frames go.
pub enum Sink {
    /// Address of a device.
    Udp(UdpSocket),
    Serial(Serial),
    /// No device: frames go to standard output.
    Dry,
    /// One with an error of this program in the third and fifth message, and after a thousand.
    #[cfg(test)]
    Panicking(std::cell::Cell<u32>),
}

impl Sink {
    /// The device at `udp:HOST:PORT` or `serial:LINE:BAUD`.
    ///
    /// # Errors
    /// There is no such host or line.
    pub fn open(target: &str) -> Result<Sink> {
        if let Some(line) = target.strip_prefix("serial:") {
            return Sink::open_serial(line);
        }
        let address = target.strip_prefix("udp:").context("--to is udp:HOST:PORT or serial:LINE:BAUD")?;
        let socket = UdpSocket::bind(("0.0.0.0", 0)).context("cannot open a socket")?;
        socket.connect(address).with_context(|| format!("cannot send to {address}"))?;
        Ok(Sink::Udp(socket))
    }

    fn open_serial(line: &str) -> Result<Sink> {
        let (line, baud) = line.rsplit_once(':').context("--to is serial:LINE:BAUD")?;
        let baud = baud.parse().context("--to is serial:LINE:BAUD")?;
        let settings = serialport::new(line, baud).timeout(LINE_TIME);
        let open = settings.clone().open().with_context(|| format!("cannot open {line}"))?;
        Ok(Sink::Serial(Serial { settings, line: RefCell::new(Some(open)) }))
    }

    /// A packet that a device has sent, if there is one; only after [`Sink::listen`]. Of a line,
    /// some bytes.
    pub fn receive<'a>(&self, packet: &'a mut [u8]) -> Option<&'a [u8]> {
        let length = match self {
            Sink::Udp(socket) => socket.recv(packet).ok()?,
            Sink::Serial(serial) => {
                let mut line = serial.line.borrow_mut();
                let port = line.as_mut()?;
                // A read of nothing would wait.
                let waiting = port.bytes_to_read().ok()?.min(packet.len() as u32) as usize;
                port.read(&mut packet[..waiting]).ok().filter(|length| *length > 0)?
            }
            _ => return None,
        };
        Some(&packet[..length])
    }

    /// Time in which a serial line carries so many bytes, each with a start and a stop bit
    /// \[s\]; 0 by other ways.
    pub fn line_time(&self, bytes: usize) -> f64 {
        match self {
            Sink::Serial(serial) => {
                let baud = serial.line.borrow().as_ref().and_then(|line| line.baud_rate().ok());
                baud.map_or(0.0, |baud| 10.0 * bytes as f64 / f64::from(baud))
            }
            _ => 0.0,
        }
    }

    /// True for a way on which answers are lines, in parts as they come.
    pub fn is_line(&self) -> bool {
        matches!(self, Sink::Serial(_))
    }

    /// Waits for no answer from now on.
    ///
    /// # Errors
    /// The device cannot be asked.
    pub fn listen(&self) -> Result<()> {
        if let Sink::Udp(socket) = self { Ok(socket.set_nonblocking(true)?) } else { Ok(()) }
    }

    /// Closes a line that takes no frames.
    pub fn close(&self) {
        if let Sink::Serial(serial) = self {
            serial.line.replace(None);
        }
    }

    /// Opens a closed line, if it has come back.
    pub fn reopen(&self) {
        if let Sink::Serial(Serial { settings, line }) = self
            && line.borrow().is_none()
        {
            line.replace(settings.clone().open().ok());
        }
    }

    pub fn send(&self, bytes: &[u8]) -> io::Result<()> {
        match self {
            _ if bytes.is_empty() => Ok(()),
            Sink::Udp(socket) => socket.send(bytes).map(drop),
            Sink::Serial(serial) => match &mut *serial.line.borrow_mut() {
                Some(line) => line.write_all(bytes),
                None => Err(io::ErrorKind::NotConnected.into()),
            },
            // The reader of the output may be gone.
            Sink::Dry => stdout().write_all(shown(bytes).as_bytes()),
            #[cfg(test)]
            Sink::Panicking(sends) => {
                sends.set(sends.get() + 1);
                assert!(!matches!(sends.get(), 3 | 5 | 1001..), "deliberate");
                Ok(())
            }
        }
    }
}

/// A frame as a line: text as it is, other bytes in hexadecimal digits.
pub fn shown(bytes: &[u8]) -> String {
    match str::from_utf8(bytes) {
        Ok(text) if text.chars().all(|c| !c.is_control() || c == '\n') => format!("{}\n", text.trim_end()),
        _ => bytes.iter().map(|byte| format!("{byte:02X} ")).collect::<String>().trim_end().to_owned() + "\n",
    }
}
