//! Refused requests.

/// Status of a refused request, with HTTP's number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u16)]
pub enum Status {
    BadRequest = 400,
    Forbidden = 403,
    NotFound = 404,
    Timeout = 408,
    LengthRequired = 411,
    TooLarge = 413,
    Unprocessable = 422,
    HeadTooLarge = 431,
    Internal = 500,
    Unavailable = 503,
}

/// Answer to a request that is refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HttpError {
    pub status: Status,
    pub reason: String,
}

impl HttpError {
    /// A refusal with this status, for this reason.
    pub fn new(status: Status, reason: impl Into<String>) -> Self {
        HttpError { status, reason: reason.into() }
    }

    /// A refusal of a request that is understood, but cannot be carried out.
    pub fn unprocessable(reason: impl Into<String>) -> Self {
        HttpError::new(Status::Unprocessable, reason)
    }

    /// HTTP's number of the status.
    pub fn number(&self) -> u16 {
        self.status as u16
    }
}
