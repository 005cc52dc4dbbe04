//! Who is answered: whoever has the token, from this machine, by this server's own page.

use std::fmt::Write;
use std::io::{self, Read};
use std::net::SocketAddr;

use rand::RngReader;
use rand::rngs::SysRng;

use super::http::{Answer, Request};

/// What a request must bring along.
pub(super) struct Guard {
    token: String,
    host: String,
    origin: String,
}

impl Guard {
    pub(super) fn new(address: SocketAddr) -> io::Result<Self> {
        let mut bytes = [0; 16];
        RngReader(SysRng).read_exact(&mut bytes)?;
        let mut token = String::new();
        for byte in bytes {
            // Writing to a String cannot fail.
            let _ = write!(token, "{byte:02x}");
        }
        Ok(Self { token, host: address.to_string(), origin: format!("http://{address}") })
    }

    pub(super) fn token(&self) -> &str {
        &self.token
    }

    /// The path behind the token, without `/` at its beginning.
    ///
    /// # Errors
    /// 403 for another host (a name that was made to lead here), another origin (a page of somebody else), another token or none.
    pub(super) fn admits<'r>(&self, request: &'r Request) -> Result<&'r str, Answer> {
        let refused = || Answer::words(403, "not for you: open the address that calibench printed");
        let own_origin = request.header("origin").is_none_or(|origin| origin == self.origin);
        let own_site = request.header("sec-fetch-site").is_none_or(|site| ["same-origin", "none"].contains(&site));
        if request.header("host") != Some(&self.host) || !own_origin || !own_site {
            return Err(refused());
        }
        let (token, path) = request.path[1..].split_once('/').ok_or_else(refused)?;
        if is_same(token.as_bytes(), self.token.as_bytes()) { Ok(path) } else { Err(refused()) }
    }
}

/// Takes as long wherever the two differ.
fn is_same(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).fold(0, |differ, (x, y)| differ | (x ^ y)) == 0
}
