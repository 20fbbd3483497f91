//! Server of `trackbed view`: the page is tested in a browser by `tests/view/check.mjs`.

use super::scenes::vtk;
use super::support::{Folder, repository, run, trackbed};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

const BED: &str = r#"title = "LIBRARY"

[[material]]
name = "stone"
density = 2650
stiffness = "0.5 MN/m"
friction = 0.5
restitution = 0.4

[[grains]]
name = "stones"
shape = "clump"
library = "STONES"
material = "stone"
count = 4
size = ["50 mm", "70 mm"]
fill = { low = [1000.0, 0.0, 0.05], high = [1000.3, 0.3] }

[[grains]]
name = "marbles"
shape = "sphere"
material = "stone"
count = 3
size = ["40 mm", "60 mm"]
fill = { low = [1000.0, 0.0, 0.3], high = [1000.3, 0.3] }

[[walls]]
kind = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
material = "stone"

[time]
end = "0.5 s"

[output]
frames = 3
"#;

fn bed(folder: &Folder, title: &str) -> PathBuf {
    let stones = repository().join("inputs/track/cyclic/stones.toml");
    let text = BED.replace("LIBRARY", title).replace("STONES", &stones.display().to_string());
    let scene = folder.write("scene.toml", &text);
    let out = folder.join("results");
    run(&scene, &out, &[]).good();
    out
}

/// Server process, ended with the test.
pub struct Server {
    pub program: Child,
    pub port: u16,
}

impl Server {
    pub fn start(dir: &Path) -> Server {
        Server::of(&mut Command::new(env!("CARGO_BIN_EXE_trackbed")), dir)
    }

    /// With at most `handles` open files.
    pub fn limited(dir: &Path, handles: usize) -> Server {
        let limit = format!("ulimit -n {handles}; exec \"$0\" \"$@\"");
        Server::of(Command::new("sh").args(["-c", &limit, env!("CARGO_BIN_EXE_trackbed")]), dir)
    }

    fn of(command: &mut Command, dir: &Path) -> Server {
        let mut program = command
            .args(["view", &dir.display().to_string(), "--no-open"])
            .stdout(Stdio::piped())
            .stderr(Stdio::inherit())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(program.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
        let port = line.strip_prefix("http://127.0.0.1:").and_then(|rest| rest.split('/').next()).unwrap();
        Server { port: port.parse().unwrap(), program }
    }

    fn raw(&self, request: &str) -> (u16, Vec<u8>) {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.write_all(format!("{request}\r\nConnection: close\r\n\r\n").as_bytes()).unwrap();
        let mut response = Vec::new();
        stream.read_to_end(&mut response).unwrap();
        let end = response.windows(4).position(|w| w == b"\r\n\r\n").expect("a head");
        let head = String::from_utf8_lossy(&response[..end]).into_owned();
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        assert!(!head.to_lowercase().contains("access-control-allow"), "{head}");
        let mut body = response.split_off(end + 4);
        if head.to_lowercase().contains("transfer-encoding: chunked") {
            body = joined(&body);
        }
        (status, body)
    }

    /// Status and body for an address.
    pub fn get(&self, address: &str) -> (u16, Vec<u8>) {
        self.raw(&format!("GET {address} HTTP/1.1\r\nHost: 127.0.0.1:{}", self.port))
    }

    #[track_caller]
    fn block(&self, name: &str) -> Block {
        let (status, body) = self.get(&format!("/data/{name}"));
        assert_eq!(status, 200, "{name}: {}", String::from_utf8_lossy(&body));
        Block::new(&body)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

fn joined(mut body: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    loop {
        let end = body.windows(2).position(|w| w == b"\r\n").unwrap();
        let length = usize::from_str_radix(std::str::from_utf8(&body[..end]).unwrap().trim(), 16).unwrap();
        if length == 0 {
            return out;
        }
        out.extend(&body[end + 2..end + 2 + length]);
        body = &body[end + 4 + length..];
    }
}

struct Block {
    text: serde_json::Value,
    bytes: Vec<u8>,
}

impl Block {
    fn new(bytes: &[u8]) -> Block {
        assert_eq!(&bytes[..4], b"TBV1");
        let length = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize;
        let text = serde_json::from_slice(&bytes[8..8 + length]).unwrap();
        Block { text, bytes: bytes[8 + length..].to_vec() }
    }

    fn array(&self, name: &str) -> Vec<f64> {
        let arrays = self.text["arrays"].as_array().unwrap();
        let entry = arrays.iter().find(|a| a["name"] == name).unwrap_or_else(|| panic!("no {name}"));
        let (at, count) =
            (entry["offset"].as_u64().unwrap() as usize, entry["count"].as_u64().unwrap() as usize);
        let whole = |k: usize| -> [u8; 4] { self.bytes[at + 4 * k..at + 4 * k + 4].try_into().unwrap() };
        (0..count)
            .map(|k| match entry["type"].as_str().unwrap() {
                "f32" => f64::from(f32::from_le_bytes(whole(k))),
                "u32" => f64::from(u32::from_le_bytes(whole(k))),
                _ => f64::from(self.bytes[at + k]),
            })
            .collect()
    }
}

fn points(file: &Path) -> Vec<f64> {
    vtk(file).0
}

fn point_values(file: &Path, name: &str) -> Vec<f64> {
    vtk(file).1.remove(name).unwrap_or_else(|| panic!("no {name}")).1
}

fn cell_values(file: &Path, name: &str) -> Vec<f64> {
    vtk(file).2.remove(name).unwrap_or_else(|| panic!("no {name}")).1
}

/// Vector rotated by the quaternion w, x, y, z.
fn turned(q: &[f64], v: &[f64]) -> [f64; 3] {
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
    };
    let (u, v) = ([q[1], q[2], q[3]], [v[0], v[1], v[2]]);
    let t = cross(u, v).map(|c| 2.0 * c);
    let around = cross(u, t);
    [0, 1, 2].map(|k| v[k] + q[0] * t[k] + around[k])
}

#[test]
fn grain_blocks_match_files() {
    let folder = Folder::new("view_grains");
    let out = bed(&folder, "bed");
    let server = Server::start(&out);
    let scene = server.block("scene").text["meta"].clone();
    assert_eq!((scene["title"].as_str(), scene["status"].as_str()), (Some("bed"), Some("done")));
    let origin: Vec<f64> = scene["origin"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    let common = server.block("grains");
    let (start, offset, radius) = (common.array("start"), common.array("offset"), common.array("radius"));
    assert_eq!(start.len(), 4 + 3 + 1);
    let frames = scene["frames"].as_array().unwrap().len();
    assert!(frames >= 3, "{frames} frames");
    let mut touching = 0;
    for frame in 0..frames {
        let file = out.join(format!("frames/grains_{frame:05}.vtp"));
        let block = server.block(&format!("grains/{frame}"));
        assert_eq!(block.text["meta"]["own"], false, "the bodies are rigid");
        let (position, orientation) = (block.array("position"), block.array("orientation"));
        let (places, radii) = (points(&file), point_values(&file, "radius"));
        let velocity = point_values(&file, "velocity");
        let speed = server.block(&format!("grains/{frame}/speed")).array("value");
        let id = point_values(&file, "id");
        for body in 0..start.len() - 1 {
            let spheres = start[body] as usize..start[body + 1] as usize;
            for s in spheres.clone() {
                let way = turned(&orientation[4 * body..4 * body + 4], &offset[3 * s..3 * s + 3]);
                for k in 0..3 {
                    // Single precision, up to 1 m from the origin.
                    let place = origin[k] + position[3 * body + k] + way[k];
                    assert!((place - places[3 * s + k]).abs() < 1e-7, "{place} and {}", places[3 * s + k]);
                }
                assert_eq!(radius[s], f64::from(radii[s] as f32));
                assert_eq!(common.array("id")[body], id[s]);
            }
            let mean =
                |k: usize| spheres.clone().map(|s| velocity[3 * s + k]).sum::<f64>() / spheres.len() as f64;
            let expected = (0..3).map(|k| mean(k).powi(2)).sum::<f64>().sqrt();
            assert!((speed[body] - expected).abs() <= 1e-6 * expected, "{} and {expected}", speed[body]);
        }
        let walls = server.block(&format!("walls/{frame}"));
        assert_eq!((walls.array("points").len(), walls.array("triangles").len()), (12, 6));
        assert_eq!(walls.array("kind"), [0.0, 0.0], "a plane");
        let chains = server.block(&format!("chains/{frame}"));
        let file = out.join(format!("frames/chains_{frame:05}.vtp"));
        // The first frame has no contacts, hence no lines to read.
        if fs::read_to_string(&file).unwrap().contains("NumberOfLines=\"0\"") {
            assert!(chains.array("ends").is_empty());
            continue;
        }
        touching += 1;
        let force = cell_values(&file, "magnitude");
        let single: Vec<f64> = force.iter().map(|f| f64::from(*f as f32)).collect();
        assert_eq!(chains.array("magnitude"), single);
        assert_eq!(chains.array("ends").len(), 6 * force.len());
    }
    assert!(touching > 0, "some frame has force chains");
    assert_eq!(server.get("/data/grains/99").0, 404);
    assert_eq!(server.get("/data/grains/0/nonsense").0, 422);
    assert_eq!(server.get("/data/table/history").0, 200);
}

#[test]
fn solid_blocks_match_file() {
    let folder = Folder::new("view_solid");
    let out = folder.join("results");
    run(&repository().join("tests/data/fem/E1_patch_curved/scene.toml"), &out, &[]).good();
    let server = Server::start(&out);
    let file = out.join("frames/solid_00000.vtu");
    let skin = server.block("solid");
    let (ids, all) = (skin.array("node_ids"), point_values(&file, "node_id"));
    let node = |k: usize| all.iter().position(|id| *id == ids[k]).unwrap();
    let displacement = server.block("solid/0").array("displacement");
    let (u, stress) = (point_values(&file, "displacement"), point_values(&file, "stress"));
    let shear = server.block("solid/0/stress_yz").array("value");
    let mean = server.block("solid/0/stress_mean").array("value");
    let principal = [1, 2, 3].map(|k| server.block(&format!("solid/0/stress_{k}")).array("value"));
    assert_eq!(displacement.len(), 3 * ids.len());
    let largest = stress.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
    for k in 0..ids.len() {
        for c in 0..3 {
            assert_eq!(displacement[3 * k + c], f64::from(u[3 * node(k) + c] as f32));
        }
        assert_eq!(shear[k], f64::from(stress[9 * node(k) + 5] as f32));
        let sum: f64 = principal.iter().map(|p| p[k]).sum();
        assert!((sum / 3.0 - mean[k]).abs() < 1e-6 * largest, "the principal stresses have the trace");
        assert!(principal[0][k] >= principal[1][k] && principal[1][k] >= principal[2][k]);
    }
    let triangles = skin.array("triangles");
    assert!(triangles.len() >= 3 * 6 * 6, "six faces of six triangles or more");
    let material = server.block("solid/0/element:material").array("value");
    assert_eq!(material.len(), triangles.len() / 3);
    assert!(material.iter().all(|m| cell_values(&file, "material").contains(m)));
}

#[test]
fn rejects_other_hosts_pages_and_methods() {
    let folder = Folder::new("view_hosts");
    let out = bed(&folder, "bed");
    let server = Server::start(&out);
    let port = server.port;
    let refused = |request: String, expected: u16| {
        let (status, body) = server.raw(&request);
        assert_eq!(status, expected, "{request}");
        assert!(body.len() < 200, "{}", String::from_utf8_lossy(&body));
    };
    for host in [
        "evil.example",
        &format!("evil.example:{port}"),
        "127.0.0.1",
        "127.0.0.1:1",
        &format!("127.0.0.1.evil:{port}"),
    ] {
        refused(format!("GET /data/scene HTTP/1.1\r\nHost: {host}"), 403);
        refused(format!("GET / HTTP/1.1\r\nHost: {host}"), 403);
    }
    refused("GET / HTTP/1.0".to_string(), 403);
    let own = format!("Host: 127.0.0.1:{port}");
    refused(format!("GET / HTTP/1.1\r\n{own}\r\nHost: evil.example"), 403);
    refused(format!("GET /data/scene HTTP/1.1\r\n{own}\r\nOrigin: http://evil.example"), 403);
    refused(format!("GET /data/scene HTTP/1.1\r\n{own}\r\nOrigin: null"), 403);
    refused(format!("DELETE /data/scene HTTP/1.1\r\n{own}"), 405);
    refused(format!("POST /data/scene HTTP/1.1\r\n{own}\r\nContent-Length: 0"), 405);
    refused(format!("GET /{} HTTP/1.1\r\n{own}", "a".repeat(3000)), 414);
    assert_eq!(server.raw(&format!("GET / HTTP/1.1\r\nHost: localhost:{port}")).0, 200);
    assert!(TcpStream::connect(("127.0.0.2", port)).is_err() || cfg!(not(target_os = "linux")));
}

/// Cross-site requests carry their origin; typed addresses have none.
#[test]
fn requests_of_other_sites_are_refused() {
    let folder = Folder::new("view_sites");
    let out = bed(&folder, "bed");
    let server = Server::start(&out);
    for (site, expected) in [
        ("same-origin", 200),
        ("none", 200),
        ("same-site", 403),
        ("cross-site", 403),
        ("", 403),
        ("None", 403),
    ] {
        let head = format!("GET /data/scene HTTP/1.1\r\nHost: 127.0.0.1:{}", server.port);
        assert_eq!(server.raw(&format!("{head}\r\nSec-Fetch-Site: {site}")).0, expected, "{site}");
    }
}

/// Hostile directory, title, material, group and wall names.
#[test]
fn hostile_names_stay_text() {
    let folder = Folder::new("view_names");
    let text = BED
        .replace("LIBRARY", "</title><script>alert(1)</script>")
        .replace("STONES", &repository().join("inputs/track/cyclic/stones.toml").display().to_string())
        .replace("\"stone\"", "\"<img src=x onerror=alert(2)>\"")
        .replace("\"marbles\"", "\"'><svg onload=alert(3)>\"")
        .replace(
            "[[walls]]\n",
            "[[walls]]\nname = \"wall</script><script>alert(4)</script>\"\nrecord = true\n",
        );
    let mut dir = folder.join("results");
    run(&folder.write("scene.toml", &text), &dir, &[]).good();
    let parts = |page: &str| {
        let names = page.split("data-block=\"").skip(1).map(|b| b[..b.find('"').unwrap()].to_string());
        let count = |element: &str| page.matches(element).count();
        (names.collect::<Vec<_>>(), ["<script", "</script", "<img", "<svg", "<style", "<"].map(count))
    };
    let mut plain = None;
    for (name, shown) in [
        ("plain", "plain"),
        ("{{DATA}}", "{{DATA}}"),
        ("{{STYLE}}{{DATA}}", "{{STYLE}}{{DATA}}"),
        ("}}{{", "}}{{"),
        ("\"><img src=x onerror=alert(1)>", "&quot;&gt;&lt;img src=x onerror=alert(1)&gt;"),
        ("<script>alert(5)<!--", "&lt;script&gt;alert(5)&lt;!--"),
        ("&lt;img src=x>", "&amp;lt;img src=x&gt;"),
    ] {
        let named = folder.join(name);
        fs::rename(&dir, &named).unwrap();
        dir = named;
        let html = folder.join("page.html");
        trackbed(["view", dir.to_str().unwrap(), "--force", "--export", html.to_str().unwrap()]).good();
        let page = fs::read_to_string(&html).unwrap();
        assert!(page.contains(&format!("<title>{shown} \u{2013} trackbed</title>")), "{name}");
        assert!(page.find("data-block").unwrap() > page.find("type=\"importmap\"").unwrap(), "{name}");
        let served = Server::start(&dir).get("/").1;
        let served = String::from_utf8(served).unwrap();
        assert!(served.len() > 500_000 && served.contains(&format!("<title>{shown} ")), "{name}");
        let found = (parts(&page), parts(&served));
        assert!(*plain.get_or_insert_with(|| found.clone()) == found, "{name}");
    }
}

#[test]
fn nothing_outside_the_folder_is_read() {
    let folder = Folder::new("view_outside");
    let out = bed(&folder, "bed");
    let inner = folder.join("shown");
    fs::create_dir_all(inner.join("frames")).unwrap();
    fs::rename(&out, inner.join("run")).unwrap();
    let other = bed(&folder, "secret");
    #[cfg(unix)]
    std::os::unix::fs::symlink(&other, inner.join("link")).unwrap();
    let server = Server::start(&inner);
    let (status, folders) = server.get("/folders");
    assert_eq!((status, folders.as_slice()), (200, br#"["run"]"#.as_slice()), "links are not followed");
    assert_eq!(server.get("/data/scene?run=run").0, 200);
    let absolute = format!("/data/scene?run={}", other.display().to_string().replace('/', "%2F"));
    for address in [
        "/data/scene?run=../results",
        "/data/scene?run=%2e%2e%2fresults",
        "/data/scene?run=run/../../results",
        "/data/scene?run=link",
        "/data/scene?run=link/frames",
        "/data/scene?run=run%00",
        "/data/scene?run=..%5cresults",
        &absolute,
        "/data/../../results/summary.json",
        "/../results/summary.json",
        "/%2e%2e/results/summary.json",
        "/data/table/../../../results/summary?run=run",
        "/data/grains/..%2f..%2fscene.toml?run=run",
        "/run/summary.json",
        "/summary.json",
    ] {
        let (status, body) = server.get(address);
        assert!((400..500).contains(&status), "{address}: {status}");
        let text = String::from_utf8_lossy(&body);
        assert!(!text.contains("secret") && body.len() < 400, "{address}: {text}");
    }
    // Links in the results are not followed.
    #[cfg(unix)]
    for name in ["summary.json", "history.csv"] {
        fs::remove_file(inner.join("run").join(name)).unwrap();
        std::os::unix::fs::symlink(other.join(name), inner.join("run").join(name)).unwrap();
    }
    let scene = server.get("/data/scene?run=run").1;
    assert!(!String::from_utf8_lossy(&scene).contains("secret"));
    assert_eq!(server.get("/data/table/history?run=run").0, 404);
    // Frame lists do not lead outside, directly or by a link.
    let pvd = |file: &str| {
        let text = format!(
            "<VTKFile><Collection><DataSet timestep=\"0\" part=\"1\" file=\"{file}\"/></Collection></VTKFile>"
        );
        fs::write(inner.join("results.pvd"), text).unwrap();
    };
    let file = other.join("frames/grains_00000.vtp");
    #[cfg(unix)]
    std::os::unix::fs::symlink(&file, inner.join("frames/grains_00000.vtp")).unwrap();
    for name in ["../results/frames/grains_00000.vtp", &file.display().to_string(), "frames/grains_00000.vtp"]
    {
        pvd(name);
        let (status, body) = server.get("/data/scene");
        assert_eq!(status, 422, "{name}");
        assert!(String::from_utf8_lossy(&body).contains("expected a file in the directory"), "{name}");
    }
}

#[test]
fn directory_without_results_is_error() {
    let folder = Folder::new("view_nothing");
    let empty = folder.join("empty");
    fs::create_dir(&empty).unwrap();
    let file = folder.write("file.txt", "no folder");
    let html = folder.join("page.html");
    let cases: [(&Path, &str); 3] = [
        (&empty, "found no such file, expected the list of frames of a run"),
        (&file, "found a file, expected the results directory of a run"),
        (&folder.join("nowhere"), "found no such directory, expected the results directory of a run"),
    ];
    for (dir, expected) in cases {
        for extra in [&["--no-open"][..], &["--export", html.to_str().unwrap()]] {
            let outcome = trackbed(["view", dir.to_str().unwrap()].iter().chain(extra));
            assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""), "{}", outcome.stderr);
            assert!(outcome.stderr.contains(expected), "{}", outcome.stderr);
            assert_eq!(outcome.stderr.lines().count(), 1);
            assert!(!html.exists());
        }
    }
    let outcome = trackbed(["view", empty.to_str().unwrap(), "--every", "0", "--export", "a.html"]);
    assert_eq!(outcome.code, 2);
}

#[test]
fn exported_page_escapes_hostile_titles() {
    let folder = Folder::new("view_export");
    let evil = "</script><script>alert(1)</script>";
    let out = bed(&folder, evil);
    let html = folder.join("page.html");
    let arguments = ["view", out.to_str().unwrap(), "--export", html.to_str().unwrap()];
    let said = trackbed(arguments).good().stdout;
    assert!(said.contains("page.html: 4 frames, "), "{said}");
    let page = fs::read_to_string(&html).unwrap();
    assert!(!page.contains("alert(1)"), "titles are in the deflated data alone");
    assert!(!page.contains("http://") || !page.contains("src=\"http"), "nothing is loaded");
    for name in ["scene", "grains", "grains/3", "grains/0/speed", "chains/3", "walls/3", "table/history"] {
        assert_eq!(page.matches(&format!("data-block=\"{name}\"")).count(), 1, "{name}");
    }
    let again = trackbed(arguments);
    assert_eq!(again.code, 2, "{}", again.stderr);
    assert!(again.stderr.contains("or --force to overwrite it"), "{}", again.stderr);
    let thinned = trackbed(arguments.iter().chain(&["--force", "--every", "2"])).good().stdout;
    assert!(thinned.contains("page.html: 3 frames, "), "{thinned}");
    let thin = fs::read_to_string(&html).unwrap();
    assert!(thin.len() < page.len() && thin.contains("data-block=\"grains/2\""));
    assert!(!thin.contains("data-block=\"grains/3\""));
    let frame = out.join("frames/grains_00002.vtp");
    let text = fs::read(&frame).unwrap();
    fs::write(&frame, &text[..text.len() / 2]).unwrap();
    let damaged = trackbed(arguments.iter().chain(&["--force"]));
    assert_eq!(damaged.code, 2, "{}", damaged.stderr);
    assert!(damaged.stderr.contains("grains_00002.vtp"), "{}", damaged.stderr);
    assert_eq!(fs::read_to_string(&html).unwrap(), thin);
}

#[test]
fn interrupted_run_is_shown() {
    let folder = Folder::new("view_interrupted");
    let out = bed(&folder, "bed");
    fs::remove_file(out.join("summary.json")).unwrap();
    fs::remove_file(out.join("frames/grains_00003.vtp")).unwrap();
    // Incomplete last row.
    let history = fs::read_to_string(out.join("history.csv")).unwrap();
    fs::write(out.join("history.csv"), &history[..history.trim_end().rfind(',').unwrap()]).unwrap();
    let server = Server::start(&out);
    let scene = server.block("scene").text["meta"].clone();
    assert_eq!((scene["title"].as_str(), scene["status"].as_str()), (Some("results"), Some("not finished")));
    let frames = scene["frames"].as_array().unwrap();
    assert_eq!(frames.len(), 4);
    assert!(frames[2]["parts"].to_string().contains("grains"));
    assert!(!frames[3]["parts"].to_string().contains("grains"));
    let rows = server.block("table/history").array("0").len();
    assert_eq!(rows, history.lines().count() - 2);
    fs::write(
        out.join("results.pvd"),
        fs::read_to_string(out.join("results.pvd")).unwrap().replace("_00003", "_00001"),
    )
    .unwrap();
    assert_eq!(server.block("scene").text["meta"]["frames"].as_array().unwrap().len(), 4);
}
