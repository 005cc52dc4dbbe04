//! As much of HTTP as one page needs: one request a connection.

use std::io::{self, BufRead, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Bytes of a request before its body.
const MOST_HEAD: u64 = 16 << 10;
/// Bytes of a body: positions of ten thousand targets.
const MOST_BODY: u64 = 1 << 20;

/// A connection that must be done by a moment, however little comes or goes at a time.
pub(super) struct Timed<'s> {
    stream: &'s TcpStream,
    until: Instant,
}

impl<'s> Timed<'s> {
    pub(super) fn new(stream: &'s TcpStream, patience: Duration) -> Self {
        Self { stream, until: Instant::now() + patience }
    }

    fn left(&self) -> io::Result<Option<Duration>> {
        let left = self.until.saturating_duration_since(Instant::now());
        if left.is_zero() { Err(ErrorKind::TimedOut.into()) } else { Ok(Some(left)) }
    }
}

impl Read for Timed<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(self.left()?)?;
        (&mut { self.stream }).read(buffer)
    }
}

impl Write for Timed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(self.left()?)?;
        (&mut { self.stream }).write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A request.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Request {
    pub(super) method: String,
    /// As it was sent, from `/`.
    pub(super) path: String,
    /// Names in small letters.
    headers: Vec<(String, String)>,
    pub(super) body: Vec<u8>,
}

impl Request {
    /// The next request; what is wrong with it as an answer.
    ///
    /// # Errors
    /// A connection that ends early, and what its reader refuses.
    pub(super) fn read(input: &mut impl BufRead) -> io::Result<Result<Self, Answer>> {
        let mut head = Vec::new();
        let mut limited = input.by_ref().take(MOST_HEAD);
        while !head.ends_with(b"\r\n\r\n") {
            if limited.read_until(b'\n', &mut head)? == 0 {
                let whole = limited.limit() == 0;
                return if whole { Ok(Err(Answer::words(431, "the head is too long"))) } else { Err(ErrorKind::UnexpectedEof.into()) };
            }
        }
        let Some(mut request) = std::str::from_utf8(&head).ok().and_then(Self::of_head) else {
            return Ok(Err(Answer::words(400, "this is no request")));
        };
        let length = match (request.header("content-length"), request.header("transfer-encoding")) {
            (_, Some(_)) => None,
            (None, None) => Some(0),
            (Some(text), None) => text.parse::<u64>().ok(),
        };
        match length {
            None => return Ok(Err(Answer::words(400, "expected the length of the body"))),
            Some(length) if length > MOST_BODY => return Ok(Err(Answer::words(413, "the body is too long"))),
            Some(length) => {
                request.body = vec![0; length as usize];
                input.read_exact(&mut request.body)?;
            }
        }
        Ok(Ok(request))
    }

    fn of_head(head: &str) -> Option<Self> {
        let mut lines = head.split("\r\n");
        let mut first = lines.next()?.split(' ');
        let (method, path, version) = (first.next()?, first.next()?, first.next()?);
        if first.next().is_some() || !path.starts_with('/') || !version.starts_with("HTTP/1.") {
            return None;
        }
        let header = |line: &str| {
            let (name, value) = line.split_once(':')?;
            let plain = !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_graphic());
            plain.then(|| (name.to_ascii_lowercase(), value.trim().to_owned()))
        };
        let headers = lines.filter(|line| !line.is_empty()).map(header).collect::<Option<Vec<_>>>()?;
        Some(Self { method: method.to_owned(), path: path.to_owned(), headers, body: Vec::new() })
    }

    /// The value of a header that is there once; of one that is there twice a value that nothing is equal to.
    pub(super) fn header(&self, name: &str) -> Option<&str> {
        let mut found = self.headers.iter().filter(|(other, _)| other == name).map(|(_, value)| value.as_str());
        let first = found.next()?;
        Some(if found.next().is_none() { first } else { "\0" })
    }
}

/// An answer.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Answer {
    pub(super) status: u16,
    kind: &'static str,
    pub(super) body: Vec<u8>,
}

impl Answer {
    pub(super) fn new(kind: &'static str, body: Vec<u8>) -> Self {
        Self { status: 200, kind, body }
    }

    pub(super) fn json(value: &serde_json::Value) -> Self {
        Self::new("application/json", value.to_string().into_bytes())
    }

    pub(super) fn words(status: u16, words: &str) -> Self {
        Self { status, kind: "text/plain; charset=utf-8", body: format!("{words}\n").into_bytes() }
    }

    pub(super) fn write(&self, output: &mut impl Write) -> io::Result<()> {
        let reason = match self.status {
            200 => "OK",
            400 => "Bad Request",
            403 => "Forbidden",
            404 => "Not Found",
            405 => "Method Not Allowed",
            413 => "Content Too Large",
            431 => "Request Header Fields Too Large",
            _ => "Internal Server Error",
        };
        write!(
            output,
            "HTTP/1.1 {} {reason}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\nCache-Control: no-store\r\n\
             X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n\
             Cross-Origin-Opener-Policy: same-origin\r\nX-Frame-Options: DENY\r\nContent-Security-Policy: frame-ancestors 'none'\r\n\r\n",
            self.status,
            self.kind,
            self.body.len()
        )?;
        output.write_all(&self.body)
    }
}
