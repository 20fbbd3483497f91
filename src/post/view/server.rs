//! HTTP server of page and data, for this machine only.
//!
//! Other sites could send requests under a name resolved to this machine (DNS rebinding), so only its own
//! names are accepted.

use std::collections::HashMap;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use hyper::Method;
use hyper::body::Bytes;
use hyper::http::request::Parts;
use serde_json::json;

use super::chunk::{Blocks, Coding};
use super::connections::{self, Reply, Respond};
use super::page;
use super::preview::Live;
use super::results::Results;
use trackbed_io::failure::Failure;
use trackbed_io::results::series;

/// Runs kept open.
const OPEN: usize = 8;
const LONGEST: usize = 2000;

struct Site {
    shown: Shown,
    port: u16,
    page: Bytes,
}

enum Shown {
    /// Directory, and runs below it.
    Folder(PathBuf, Mutex<HashMap<String, Arc<Results>>>),
    Scene(Live),
}

type Refusal = (u16, String);

struct Content(&'static str, Bytes);

/// Binds the port, 0 for any; returns the listener and its port.
///
/// # Errors
/// Port in use or not allowed.
pub fn bind(port: u16) -> Result<(TcpListener, u16), Failure> {
    let bound = TcpListener::bind(("127.0.0.1", port)).and_then(|l| l.local_addr().map(|a| (l, a.port())));
    bound.map_err(|error| {
        Failure::Input(format!("--port: found {port}, which cannot be used ({error}), expected a free port"))
    })
}

/// Serves a directory until the process ends.
///
/// # Errors
/// Missing directory.
pub fn serve(listener: TcpListener, port: u16, dir: &Path) -> Result<(), Failure> {
    let root = dir.canonicalize()?;
    let title = root.file_name().map(|n| n.to_string_lossy().into_owned());
    site(listener, port, &title.unwrap_or_default(), Shown::Folder(root, Mutex::default()))
}

/// Serves a scene until the process ends.
///
/// # Errors
/// I/O errors.
pub fn serve_scene(listener: TcpListener, port: u16, live: Live) -> Result<(), Failure> {
    let title = live.title();
    site(listener, port, &title, Shown::Scene(live))
}

fn site(listener: TcpListener, port: u16, title: &str, shown: Shown) -> Result<(), Failure> {
    let watch = matches!(shown, Shown::Scene(_));
    let (head, tail) = page::pieces(title, &json!({ "served": true, "watch": watch }));
    let site = Site { shown, port, page: (head.0 + &tail.0).into() };
    Ok(connections::serve(listener, Arc::new(site))?)
}

impl Respond for Site {
    fn respond(&self, head: &Parts) -> Reply {
        let address = head.uri.path_and_query().map_or("/", |address| address.as_str());
        match self.checked(head, address).and_then(|()| self.content(address)) {
            Ok(Content(kind, content)) => Reply { status: 200, kind, content },
            Err((status, sentence)) => {
                Reply { status, kind: "text/plain; charset=utf-8", content: sentence.into() }
            }
        }
    }

    fn fields(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("Content-Security-Policy", page::POLICY),
            ("Cross-Origin-Resource-Policy", "same-origin"),
            ("X-Content-Type-Options", "nosniff"),
            ("Referrer-Policy", "no-referrer"),
            ("Cache-Control", "no-store"),
        ]
    }
}

impl Site {
    fn checked(&self, head: &Parts, address: &str) -> Result<(), Refusal> {
        // Non-ASCII values never match.
        let values =
            |name: &'static str| head.headers.get_all(name).iter().map(|v| v.to_str().unwrap_or("?"));
        let own = [format!("127.0.0.1:{}", self.port), format!("localhost:{}", self.port)];
        let is_own = |host: &str| own.iter().any(|o| host.eq_ignore_ascii_case(o));
        let hosts: Vec<&str> = values("Host").collect();
        let named = head.uri.authority().is_none_or(|authority| is_own(authority.as_str()));
        if hosts.len() != 1 || !is_own(hosts[0]) || !named {
            return Err((403, format!("only requests to {} are answered", own[0])));
        }
        if values("Origin").any(|origin| !origin.strip_prefix("http://").is_some_and(is_own)) {
            return Err((403, "requests of other pages are not answered".to_string()));
        }
        // "none" is an address typed by the user.
        if values("Sec-Fetch-Site").any(|site| !matches!(site, "same-origin" | "none")) {
            return Err((403, "requests of other sites are not answered".to_string()));
        }
        if head.method != Method::GET {
            return Err((405, "only GET is answered".to_string()));
        }
        if address.len() > LONGEST {
            return Err((414, format!("an address has at most {LONGEST} bytes")));
        }
        let length = values("Content-Length").any(|length| length != "0");
        if length || head.headers.contains_key("Transfer-Encoding") {
            return Err((413, "a request has no body".to_string()));
        }
        Ok(())
    }

    fn content(&self, url: &str) -> Result<Content, Refusal> {
        let (path, query) = url.split_once('?').unwrap_or((url, ""));
        let bad = || (400, "the address is damaged".to_string());
        let path = decoded(path).ok_or_else(bad)?;
        let run = query.split('&').find_map(|pair| pair.strip_prefix("run="));
        let run = run.map(decoded).unwrap_or(Some(String::new())).ok_or_else(bad)?;
        match (path.as_str(), &self.shown) {
            ("/", _) => Ok(Content("text/html; charset=utf-8", self.page.clone())),
            ("/folders", shown) => {
                let folders = match shown {
                    Shown::Folder(root, _) => series::folders(root),
                    Shown::Scene(_) => Vec::new(),
                };
                Ok(Content("application/json", json!(folders).to_string().into()))
            }
            ("/version", Shown::Scene(live)) => {
                Ok(Content("application/json", json!(live.version()).to_string().into()))
            }
            _ => match path.strip_prefix("/data/") {
                Some(name) => self.block(name, &run),
                None => Err((404, "there is no such page".to_string())),
            },
        }
    }

    fn block(&self, name: &str, run: &str) -> Result<Content, Refusal> {
        let block = match &self.shown {
            Shown::Folder(root, runs) => results(root, runs, run, name == "scene")?.block(name),
            Shown::Scene(live) => live.block(name),
        };
        match block {
            Ok(Some(bytes)) => Ok(Content("application/octet-stream", bytes.into())),
            Ok(None) => Err((404, "there are no such data".to_string())),
            Err(failure) => Err((422, failure.to_string())),
        }
    }
}

/// Run in a subdirectory, reread if `fresh`: it may have grown.
fn results(
    root: &Path,
    runs: &Mutex<HashMap<String, Arc<Results>>>,
    run: &str,
    fresh: bool,
) -> Result<Arc<Results>, Refusal> {
    let mut runs = runs.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(results) = runs.get(run).filter(|_| !fresh) {
        return Ok(results.clone());
    }
    let dir = match run {
        "" => Some(root.to_path_buf()),
        _ => series::inside(root, run).map_err(|failure| (403, failure.to_string()))?,
    };
    let dir = dir.ok_or_else(|| (404, "no such directory".to_string()))?;
    let results = Results::open(&dir, Coding::Exact).map_err(|failure| (422, failure.to_string()))?;
    if runs.len() >= OPEN {
        runs.clear();
    }
    let results = Arc::new(results);
    runs.insert(run.to_string(), results.clone());
    Ok(results)
}

/// Decodes `%41` and similar; `None` for invalid UTF-8 or control characters.
fn decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((first, tail)) = rest.split_first() {
        rest = tail;
        if *first != b'%' {
            bytes.push(*first);
            continue;
        }
        let digits = std::str::from_utf8(tail.get(..2)?).ok()?;
        bytes.push(u8::from_str_radix(digits, 16).ok()?);
        rest = &tail[2..];
    }
    String::from_utf8(bytes).ok().filter(|text| !text.contains(char::is_control))
}

#[cfg(test)]
mod tests {
    use super::decoded;

    #[test]
    fn addresses_are_decoded_once() {
        assert_eq!(decoded("/a%20b%2Fc").unwrap(), "/a b/c");
        assert_eq!(decoded("%252e").unwrap(), "%2e");
        for damaged in ["%", "%2", "%zz", "%ff", "%00", "%0a"] {
            assert_eq!(decoded(damaged), None, "{damaged}");
        }
    }
}
