//! A running plug-in: asked line by line, ended when it does not do as it should.

use std::io;
use std::os::fd::AsFd;
use std::os::unix::process::CommandExt;
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use calibench_model::{Rejection, stop};
use rustix::event::{PollFd, PollFlags, poll};
use rustix::io::{Errno, ioctl_fionbio};
use rustix::process::{Pid, Signal, kill_process_group};
use rustix::time::Timespec;

use crate::answer::Fault;
use crate::descendants;

/// How much of what it says on standard error is kept, bytes.
const TAIL: usize = 4096;
/// How often it is seen whether a program has ended that holds its output open.
const WAIT: Duration = Duration::from_millis(10);
/// The same of one that has closed it.
const LOOK: Duration = Duration::from_micros(500);
/// How often it is asked, while an answer is waited for, whether the user ends it all.
const ASKED: Duration = Duration::from_millis(50);
/// How much is read at once.
const CHUNK: usize = 1 << 16;

/// A started program and its pipes.
pub struct Process {
    child: Child,
    /// `None` once it has been told all.
    stdin: Option<ChildStdin>,
    stdout: ChildStdout,
    stderr: ChildStderr,
    /// Whether its standard error has ended.
    silent: bool,
    /// What it said beyond the last line.
    pending: Vec<u8>,
    /// The end of what it said on standard error.
    tail: Vec<u8>,
}

impl Process {
    /// Starts `command` in a process group of its own.
    ///
    /// # Errors
    /// What the system says.
    pub fn start(command: &mut Command) -> io::Result<Self> {
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).process_group(0);
        let mut child = command.spawn()?;
        let missing = || io::Error::other("no pipe to the program");
        let (stdin, stdout, stderr) = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let process = Self {
            stdin: Some(stdin.ok_or_else(missing)?),
            stdout: stdout.ok_or_else(missing)?,
            stderr: stderr.ok_or_else(missing)?,
            child,
            silent: false,
            pending: Vec::new(),
            tail: Vec::new(),
        };
        process.stdin.iter().try_for_each(|stdin| ioctl_fionbio(stdin, true))?;
        ioctl_fionbio(&process.stdout, true)?;
        ioctl_fionbio(&process.stderr, true)?;
        Ok(process)
    }

    /// Writes `request` and reads one line of at most `most` bytes.
    ///
    /// # Errors
    /// That it ended, took longer than `limit`, said something before it was asked or more than it may. It is of no use then.
    pub fn ask(&mut self, request: &[&[u8]], limit: Duration, most: usize) -> Result<String, Fault> {
        let deadline = Instant::now() + limit;
        // An answer that nobody asked for must not be taken for that to the next image.
        let mut over = self.read();
        if !self.pending.is_empty() && !request.is_empty() {
            return Err(Fault::new(Rejection::Malformed, "it said more than one line"));
        }
        let mut left: Vec<&[u8]> = request.iter().rev().copied().filter(|part| !part.is_empty()).collect();
        let mut closed = false;
        loop {
            // What it had said before it ended counts, and what it said before anybody looked.
            if let Some(line) = self.line(left.is_empty(), most)? {
                return Ok(line);
            }
            if over {
                return Err(self.ended());
            }
            stop::point();
            let wait = deadline.checked_duration_since(Instant::now());
            let Some(wait) = wait else {
                let said = self.said();
                return Err(Fault::new(Rejection::TooSlow, format!("no answer within {} s{said}", limit.as_secs_f64())));
            };
            let writes = !left.is_empty() && !closed;
            let [readable, writable, erring] =
                self.wait(writes, wait.min(ASKED)).map_err(|error| Fault::new(Rejection::Ended, error.to_string()))?;
            if erring {
                self.hear();
            }
            if writable {
                closed = !self.write(&mut left);
            }
            if readable {
                over = self.read();
            }
        }
    }

    /// The line that it said, if it has said one; `asked`: whether it was told all before.
    fn line(&mut self, asked: bool, most: usize) -> Result<Option<String>, Fault> {
        let Some(end) = self.pending.iter().position(|&byte| byte == b'\n') else {
            let long = self.pending.len() > most;
            return if long { Err(Fault::new(Rejection::Malformed, format!("its answer is longer than {most} bytes"))) } else { Ok(None) };
        };
        let line: Vec<u8> = self.pending.drain(..=end).collect();
        if !asked {
            return Err(Fault::new(Rejection::Malformed, "it answered before it had read the image"));
        }
        let line = String::from_utf8(line).map_err(|_| Fault::new(Rejection::Malformed, "its answer is no UTF-8"))?;
        Ok(Some(line.trim().to_owned()))
    }

    /// Tells it nothing more and waits until it has ended by itself; what it says is read over.
    ///
    /// # Errors
    /// That it failed, or took longer than `limit` from when it was `started`.
    pub fn finish(&mut self, started: Instant, limit: Duration) -> Result<(), Fault> {
        let deadline = started + limit;
        self.stdin = None;
        let mut closed = false;
        loop {
            stop::point();
            match self.child.try_wait() {
                Ok(None) => {}
                Ok(Some(status)) if status.success() => return Ok(()),
                _ => return Err(self.ended()),
            }
            let Some(left) = deadline.checked_duration_since(Instant::now()) else {
                let said = self.said();
                return Err(Fault::new(Rejection::TooSlow, format!("it did not end within {} s{said}", limit.as_secs_f64())));
            };
            if closed {
                self.hear();
                std::thread::sleep(LOOK.min(left));
                continue;
            }
            // What it started may hold its output open after its end.
            let [readable, _, erring] =
                self.wait(false, WAIT.min(left)).map_err(|error| Fault::new(Rejection::Ended, error.to_string()))?;
            if erring {
                self.hear();
            }
            if readable {
                closed = self.read();
                self.pending.clear();
            }
        }
    }

    /// Waits until something can be done: read, write, hear.
    fn wait(&self, writes: bool, most: Duration) -> rustix::io::Result<[bool; 3]> {
        let out = if writes { PollFlags::OUT } else { PollFlags::empty() };
        let mut fds = vec![PollFd::new(&self.stdout, PollFlags::IN), PollFd::new(&self.stderr, PollFlags::IN)];
        let stderr = if self.silent { fds.pop().map(|_| usize::MAX) } else { Some(1) };
        if let Some(stdin) = self.stdin.as_ref().filter(|_| writes) {
            fds.push(PollFd::new(stdin, out));
        }
        // Rounded up, so that the last turn does not spin.
        let time = Timespec { tv_sec: most.as_secs() as i64, tv_nsec: i64::from(most.subsec_nanos()) };
        match poll(&mut fds, Some(&time)) {
            Ok(_) | Err(Errno::INTR) => {}
            Err(error) => return Err(error),
        }
        let ready = |place: usize| fds.get(place).is_some_and(|fd| !fd.revents().is_empty());
        Ok([ready(0), writes && ready(fds.len() - 1), stderr.is_some_and(ready)])
    }

    /// Writes what goes in; false when nobody reads any more.
    fn write(&self, left: &mut Vec<&[u8]>) -> bool {
        let Some(stdin) = &self.stdin else { return false };
        while let Some(part) = left.last_mut() {
            match rustix::io::write(stdin, part) {
                Ok(count) => {
                    *part = &part[count..];
                    if part.is_empty() {
                        left.pop();
                    }
                }
                Err(Errno::AGAIN | Errno::INTR) => return true,
                Err(_) => return false,
            }
        }
        true
    }

    /// Reads what is there; true at the end.
    fn read(&mut self) -> bool {
        let mut chunk = vec![0; CHUNK];
        match rustix::io::read(self.stdout.as_fd(), &mut chunk) {
            Ok(0) => true,
            Ok(count) => {
                self.pending.extend_from_slice(&chunk[..count]);
                false
            }
            Err(Errno::AGAIN | Errno::INTR) => false,
            Err(_) => true,
        }
    }

    /// Keeps the end of what it says on standard error.
    fn hear(&mut self) {
        let mut chunk = vec![0; CHUNK];
        match rustix::io::read(self.stderr.as_fd(), &mut chunk) {
            Ok(0) => self.silent = true,
            Ok(count) => {
                self.tail.extend_from_slice(&chunk[..count]);
                let excess = self.tail.len().saturating_sub(TAIL);
                self.tail.drain(..excess);
            }
            Err(Errno::AGAIN | Errno::INTR) => {}
            Err(_) => self.silent = true,
        }
    }

    /// How it ended, with the last that it said.
    fn ended(&mut self) -> Fault {
        // It closed its output; it may live on.
        let mut status = None;
        for _ in 0..50 {
            status = self.child.try_wait().ok().flatten();
            if status.is_some() {
                break;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        while !self.silent {
            let before = self.tail.len();
            self.hear();
            if self.tail.len() == before {
                break;
            }
        }
        let how = status.map_or_else(|| "it closed its output".to_owned(), |status| format!("it ended: {status}"));
        Fault::new(Rejection::Ended, how + &self.said())
    }

    /// The most memory that it has had in use so far, MB; `None` where the system does not tell.
    pub fn peak_mb(&self) -> Option<f64> {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.child.id())).ok()?;
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
        line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok().map(|kilobytes| kilobytes * 1.024e-3)
    }

    /// The processor's time that it and what it started have taken so far, s; `None` where the system does not tell.
    pub fn processor_seconds(&self) -> Option<f64> {
        descendants::processor_seconds(Pid::from_child(&self.child))
    }

    /// The last line that it said on standard error.
    fn said(&self) -> String {
        let text = String::from_utf8_lossy(&self.tail);
        text.lines().rev().find(|line| !line.trim().is_empty()).map_or_else(String::new, |line| format!(": {}", line.trim()))
    }
}

/// Its whole process group is ended, and what it started.
impl Drop for Process {
    fn drop(&mut self) {
        if matches!(self.child.try_wait(), Ok(None)) {
            descendants::end(Pid::from_child(&self.child));
        }
        if let Some(group) = Pid::from_raw(self.child.id() as i32) {
            kill_process_group(group, Signal::KILL).ok();
        }
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A program that has spoken and ended before anybody looked.
    #[test]
    fn what_was_said_before_the_end_counts() {
        for (script, left) in [("echo hello", ""), ("echo hello; exec sleep 5", ""), ("printf 'hello\nmore'", "more")] {
            let mut process = Process::start(Command::new("sh").args(["-c", script])).unwrap();
            std::thread::sleep(Duration::from_millis(60));
            assert_eq!(process.ask(&[], Duration::from_secs(3), 100).as_deref(), Ok("hello"), "{script}");
            assert_eq!(process.pending, left.as_bytes());
        }
        let mut process = Process::start(Command::new("sh").args(["-c", "exit 3"])).unwrap();
        let fault = process.ask(&[], Duration::from_secs(3), 100).unwrap_err();
        assert!(fault.rejection == Rejection::Ended && fault.message.contains("exit status: 3"), "{fault:?}");
    }
}
