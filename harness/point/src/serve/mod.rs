//! A server on this machine alone that sends the page and its photographs and measures what is pointed at.

mod guard;
mod http;
mod kept;
mod measuring;

use std::collections::VecDeque;
use std::io::{self, BufReader, Read, Write};
use std::net::{Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use guard::Guard;
use http::{Answer, Request, Timed};

pub use kept::Kept;
pub use measuring::Served;

/// Connections at a time: beyond them the one that waits longest for its request goes.
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
    patience: Duration,
}

/// What all connections have in common.
struct Common {
    /// When somebody used the page last.
    used: Mutex<Instant>,
    /// How many there are.
    count: AtomicUsize,
    /// Those whose request has not come, the oldest first.
    waiting: Mutex<VecDeque<(usize, TcpStream)>>,
}

impl Common {
    fn waiting(&self) -> MutexGuard<'_, VecDeque<(usize, TcpStream)>> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Makes room for one more; false where none is to be had within `patience`.
    fn room(&self, patience: Duration) -> bool {
        if self.count.load(Ordering::Relaxed) < MOST {
            return true;
        }
        // One that is sent away takes a moment to go; those that are answered now go by themselves.
        let sent_away = self.waiting().pop_front().is_some_and(|(_, stream)| stream.shutdown(Shutdown::Both).is_ok());
        let (most, begun) = (if sent_away { 2 * MOST } else { MOST }, Instant::now());
        while self.count.load(Ordering::Relaxed) >= most {
            if begun.elapsed() > patience {
                return false;
            }
            thread::sleep(Duration::from_millis(1));
        }
        true
    }

    fn idle(&self) -> Duration {
        self.used.lock().unwrap_or_else(PoisonError::into_inner).elapsed()
    }
}

impl Server {
    /// Listens at 127.0.0.1, at a port that is free, under a token of 128 bits that nobody can guess.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn open() -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        let address = listener.local_addr()?;
        Ok(Self { listener, address, guard: Guard::new(address)?, patience: PATIENCE })
    }

    /// The address of the page, with the token: a secret of whom it is shown to.
    pub fn url(&self) -> String {
        format!("http://{}/{}/", self.address, self.guard.token())
    }

    /// Answers until nobody used the page for `idle`: no request with the token came but those by which pages ask what others changed. Then it ends within the
    /// time that a request under way may take.
    ///
    /// # Errors
    /// What the system refuses; what a browser breaks off is none.
    pub fn run(&self, served: &Served<'_>, idle: Duration) -> io::Result<()> {
        let ended = AtomicBool::new(false);
        let common = Common { used: Mutex::new(Instant::now()), count: AtomicUsize::new(0), waiting: Mutex::default() };
        thread::scope(|scope| {
            scope.spawn(|| {
                while !ended.load(Ordering::Relaxed) {
                    let left = idle.saturating_sub(common.idle());
                    if left.is_zero() {
                        ended.store(true, Ordering::Relaxed);
                        // Wakes what waits for a connection; if that fails it is awake.
                        TcpStream::connect_timeout(&self.address, Duration::from_secs(1)).ok();
                    }
                    thread::sleep(left.min(Duration::from_millis(500)));
                }
            });
            for (number, stream) in self.listener.incoming().enumerate() {
                if ended.load(Ordering::Relaxed) {
                    break;
                }
                // One that is broken off before it is taken is none.
                let Some((stream, other)) = stream.ok().and_then(|stream| stream.try_clone().ok().map(|other| (stream, other))) else {
                    continue;
                };
                if !common.room(self.patience) {
                    continue;
                }
                common.count.fetch_add(1, Ordering::Relaxed);
                common.waiting().push_back((number, other));
                let common = &common;
                scope.spawn(move || {
                    // A browser that went away is no error.
                    self.serve((number, &stream), served, common).ok();
                    common.waiting().retain(|(other, _)| *other != number);
                    common.count.fetch_sub(1, Ordering::Relaxed);
                });
            }
            ended.store(true, Ordering::Relaxed);
            common.waiting().drain(..).for_each(|(_, stream)| drop(stream.shutdown(Shutdown::Both)));
        });
        Ok(())
    }

    fn serve(&self, (number, stream): (usize, &TcpStream), served: &Served<'_>, common: &Common) -> io::Result<()> {
        let mut input = BufReader::new(Timed::new(stream, self.patience));
        let answer = match Request::read(&mut input)? {
            Err(answer) => {
                answer.write(&mut Timed::new(stream, self.patience))?;
                // An answer is lost if the connection is closed while more of the request arrives.
                stream.shutdown(Shutdown::Write)?;
                io::copy(&mut input.take(MOST_LEFT), &mut io::sink())?;
                return Ok(());
            }
            Ok(request) => {
                common.waiting().retain(|(other, _)| *other != number);
                match self.guard.admits(&request) {
                    Err(answer) => answer,
                    Ok(path) => {
                        let (answer, use_of_page) = served.answer(&request, path);
                        if use_of_page {
                            *common.used.lock().unwrap_or_else(PoisonError::into_inner) = Instant::now();
                        }
                        answer
                    }
                }
            }
        };
        let mut output = io::BufWriter::new(Timed::new(stream, self.patience));
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
