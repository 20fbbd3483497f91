//! Hostile clients (`tests/data/view/clients.toml`): errors for them, service for others, bounded memory.

use super::support::{Folder, repository, run};
use super::view::Server;
use serde::Deserialize;
use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Server memory limit [kB]: four responses, hyper, system.
const MEMORY: u64 = 120_000;
/// Response time limit, above the server's own timeout.
const DEAD: Duration = Duration::from_secs(60);

#[derive(Deserialize)]
struct Clients {
    client: Vec<Client>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Client {
    name: String,
    #[serde(default)]
    head: String,
    #[serde(default)]
    fill: String,
    #[serde(default)]
    times: usize,
    #[serde(default)]
    tail: String,
    #[serde(default = "one")]
    clients: usize,
    #[serde(default = "yes")]
    reads: bool,
    #[serde(default)]
    status: Vec<u16>,
}

fn one() -> usize {
    1
}

fn yes() -> bool {
    true
}

impl Client {
    fn send(&self, port: u16) -> TcpStream {
        let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
        stream.set_read_timeout(Some(DEAD)).unwrap();
        // A client that never reads must not wait for the server.
        let patience = if self.reads { DEAD } else { Duration::from_millis(200) };
        stream.set_write_timeout(Some(patience)).unwrap();
        let [head, fill, tail] =
            [&self.head, &self.fill, &self.tail].map(|text| text.replace("{port}", &port.to_string()));
        let once = (65_536 / fill.len().max(1)).clamp(1, self.times.max(1));
        let piece = fill.repeat(once);
        let mut send = |bytes: &[u8]| stream.write_all(bytes).is_ok();
        let mut open = send(head.as_bytes());
        let mut left = self.times;
        while open && left > 0 {
            let now = left.min(once);
            open = send(&piece.as_bytes()[..now * fill.len()]);
            left -= now;
        }
        _ = open && send(tail.as_bytes());
        stream
    }

    fn status(&self, stream: &mut TcpStream) -> u16 {
        let mut head = Vec::new();
        let mut byte = [0];
        while head.len() < 13 && matches!(stream.read(&mut byte), Ok(1)) {
            head.push(byte[0]);
        }
        let text = String::from_utf8_lossy(&head);
        text.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap_or(0)
    }
}

/// Peak memory of a process [kB]; 0 if unknown.
fn memory(process: u32) -> u64 {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let line = status.lines().find(|l| l.starts_with("VmHWM:"));
    line.and_then(|l| l.split_whitespace().nth(1)?.parse().ok()).unwrap_or(0)
}

#[test]
fn hostile_clients_do_not_block_server() {
    let text = fs::read_to_string(repository().join("tests/data/view/clients.toml")).unwrap();
    let Clients { client: clients } = toml::from_str(&text).unwrap();
    assert!(clients.len() >= 30);
    let folder = Folder::new("view_clients");
    let out = folder.join("results");
    let set = ["grains.0.count=300", "time.end=0.01", "output.frames=2"];
    run(&repository().join("inputs/grains/box.toml"), &out, &set).good();
    let mut server = Server::start(&out);
    for client in &clients {
        let mut streams: Vec<TcpStream> = (0..client.clients).map(|_| client.send(server.port)).collect();
        let statuses: Vec<u16> = match client.reads {
            true => streams.iter_mut().map(|stream| client.status(stream)).collect(),
            false => Vec::new(),
        };
        let memory = memory(server.program.id());
        println!("{}: {statuses:?}, {memory} kB", client.name);
        assert!(statuses.iter().all(|s| client.status.contains(s)), "{}: {statuses:?}", client.name);
        assert!(memory < MEMORY, "{}: {memory} kB", client.name);
        assert_eq!(server.get("/folders"), (200, br#"[""]"#.to_vec()), "after {}", client.name);
        assert!(server.get("/data/grains/0").1.len() > 3600, "after {}", client.name);
        assert!(server.program.try_wait().unwrap().is_none(), "{} has ended the server", client.name);
    }
}

/// Idle clients of more handles than the limit; the oldest are closed.
#[test]
fn idle_clients_leave_handles() {
    let folder = Folder::new("view_idle");
    let out = folder.join("results");
    let set = ["grains.0.count=30", "time.end=0.001", "output.frames=1"];
    run(&repository().join("inputs/grains/box.toml"), &out, &set).good();
    let server = Server::limited(&out, 24);
    let idle: Vec<TcpStream> =
        (0..60).map(|_| TcpStream::connect(("127.0.0.1", server.port)).unwrap()).collect();
    let begun = Instant::now();
    assert_eq!(server.get("/folders").0, 200);
    assert!(begun.elapsed() < Duration::from_secs(5), "{:?}", begun.elapsed());
    drop(idle);
}
