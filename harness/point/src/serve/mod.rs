//! A server on this machine alone that sends the page and its photographs and measures what is pointed at.

mod guard;
mod http;
mod measuring;

use std::io::{self, BufReader, Read, Write};
use std::net::{Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use guard::Guard;
use http::{Answer, Request};

pub use measuring::Served;

/// Requests at a time; more are not answered.
const MOST: usize = 32;
/// Bytes that are read of what follows a request that is none.
const MOST_LEFT: u64 = 1 << 20;
/// A request has to come, and an answer to be taken, within this.
const PATIENCE: Duration = Duration::from_secs(10);

/// A server that listens and does not answer yet.
pub struct Server {
    listener: TcpListener,
    address: SocketAddr,
    guard: Guard,
}

impl Server {
    /// Listens at 127.0.0.1, at a port that is free, under a token of 128 bits that nobody can guess.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn open() -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        let address = listener.local_addr()?;
        Ok(Self { listener, address, guard: Guard::new(address)? })
    }

    /// The address of the page, with the token: a secret of whom it is shown to.
    pub fn url(&self) -> String {
        format!("http://{}/{}/", self.address, self.guard.token())
    }

    /// Answers until no request with the token came for `idle`.
    ///
    /// # Errors
    /// What the system refuses; what a browser breaks off is none.
    pub fn run(&self, served: &Served<'_>, idle: Duration) -> io::Result<()> {
        let last = Mutex::new(Instant::now());
        let (ended, under_way) = (AtomicBool::new(false), AtomicUsize::new(0));
        thread::scope(|scope| {
            scope.spawn(|| {
                let since = || last.lock().unwrap_or_else(PoisonError::into_inner).elapsed();
                while !ended.load(Ordering::Relaxed) {
                    let left = idle.saturating_sub(since());
                    if left.is_zero() {
                        ended.store(true, Ordering::Relaxed);
                        // Wakes what waits for a connection; if that fails it is awake.
                        TcpStream::connect(self.address).ok();
                    }
                    thread::sleep(left.min(Duration::from_millis(500)));
                }
            });
            for stream in self.listener.incoming() {
                if ended.load(Ordering::Relaxed) {
                    break;
                }
                // One that is broken off before it is taken is none.
                let Ok(stream) = stream else { continue };
                if under_way.fetch_add(1, Ordering::Relaxed) >= MOST {
                    under_way.fetch_sub(1, Ordering::Relaxed);
                    continue;
                }
                let (last, under_way) = (&last, &under_way);
                scope.spawn(move || {
                    // A browser that went away is no error.
                    self.serve(&stream, served, last).ok();
                    under_way.fetch_sub(1, Ordering::Relaxed);
                });
            }
            ended.store(true, Ordering::Relaxed);
        });
        Ok(())
    }

    fn serve(&self, stream: &TcpStream, served: &Served<'_>, last: &Mutex<Instant>) -> io::Result<()> {
        stream.set_read_timeout(Some(PATIENCE))?;
        stream.set_write_timeout(Some(PATIENCE))?;
        let mut input = BufReader::new(stream);
        let answer = match Request::read(&mut input, PATIENCE)? {
            Err(answer) => {
                answer.write(&mut { stream })?;
                // An answer is lost if the connection is closed while more of the request arrives.
                stream.shutdown(Shutdown::Write)?;
                io::copy(&mut input.take(MOST_LEFT), &mut io::sink())?;
                return Ok(());
            }
            Ok(request) => match self.guard.admits(&request) {
                Err(answer) => answer,
                Ok(path) => {
                    *last.lock().unwrap_or_else(PoisonError::into_inner) = Instant::now();
                    served.answer(&request, path)
                }
            },
        };
        let mut output = io::BufWriter::new(stream);
        answer.write(&mut output)?;
        output.flush()
    }
}

/// What is answered where nothing else is.
fn not_found() -> Answer {
    Answer::words(404, "there is nothing here")
}

#[cfg(test)]
mod tests;
