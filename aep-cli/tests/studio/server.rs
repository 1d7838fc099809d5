//! A running `aep studio`, spoken to byte by byte: what a browser would never send is sent here.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// Longest wait for a task.
const PATIENCE: Duration = Duration::from_mins(2);

/// The server, in a folder.
pub struct Server {
    child: Child,
    /// Its port.
    pub port: u16,
    /// The token of its page.
    pub token: String,
}

/// An answer.
pub struct Answer {
    /// Status of HTTP.
    pub status: u16,
    /// Headers as they came.
    pub head: String,
    /// The body.
    pub body: Vec<u8>,
}

impl Answer {
    /// The body as JSON.
    #[track_caller]
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap_or_else(|_| panic!("{}", self.text()))
    }

    /// The body as text.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }
}

impl Server {
    /// Starts one on a project, at any port.
    pub fn start(project: &Path, data: Option<&Path>) -> Self {
        Self::start_at(0, project, data)
    }

    /// The same at a port.
    pub fn start_at(port: u16, project: &Path, data: Option<&Path>) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_aep"));
        command.args(["studio", "--no-open", "--port", &port.to_string(), "--project"]);
        command.arg(project).args(data);
        let mut child = command.stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        let mut out = BufReader::new(child.stdout.take().unwrap());
        out.read_line(&mut line).unwrap();
        let url = line.split_whitespace().find(|word| word.starts_with("http://")).unwrap();
        let port = url.trim_end_matches('/').rsplit(':').next().unwrap().parse().unwrap();
        // What it prints later is read, so that it never waits for room.
        std::thread::spawn(move || std::io::copy(&mut out, &mut std::io::sink()));
        let mut server = Self { child, port, token: String::new() };
        let page = server.get("/").text();
        let token = page.split("aep-token content=\"").nth(1).unwrap();
        token.split('"').next().unwrap().clone_into(&mut server.token);
        server
    }

    /// Its address.
    pub fn url(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// Sends a request as it is and reads all of the answer.
    pub fn raw(&self, bytes: &[u8]) -> Answer {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        // A server that has heard enough closes before everything was sent.
        let _ = stream.write_all(bytes);
        let mut got = Vec::new();
        let _ = stream.read_to_end(&mut got);
        let end = got.windows(4).position(|four| four == b"\r\n\r\n").unwrap_or(got.len());
        let head = String::from_utf8_lossy(&got[..end]).into_owned();
        let status = head.split(' ').nth(1).and_then(|code| code.parse().ok()).unwrap_or(0);
        Answer { status, head, body: got[(end + 4).min(got.len())..].to_vec() }
    }

    /// A request with these headers in place of the usual ones.
    pub fn with(&self, method: &str, path: &str, headers: &[(&str, &str)], body: &[u8]) -> Answer {
        let first = format!("{method} {path} HTTP/1.0\r\nContent-Length: {}", body.len());
        let lines = headers.iter().map(|(name, value)| format!("{name}: {value}"));
        let head = std::iter::once(first).chain(lines).collect::<Vec<_>>().join("\r\n");
        self.raw(&[head.as_bytes(), b"\r\n\r\n", body].concat())
    }

    fn host(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    /// Asks as the page does.
    pub fn get(&self, path: &str) -> Answer {
        self.with("GET", path, &[("Host", &self.host())], b"")
    }

    /// Sends as the page does.
    pub fn post_bytes(&self, path: &str, body: &[u8]) -> Answer {
        let host = self.host();
        self.with("POST", path, &[("Host", &host), ("x-aep-token", &self.token)], body)
    }

    /// The same with JSON that must be accepted.
    #[track_caller]
    pub fn post(&self, path: &str, content: &Value) -> Value {
        let answer = self.post_bytes(path, content.to_string().as_bytes());
        assert_eq!(answer.status, 200, "{path} {content}: {}", answer.text());
        answer.json()
    }

    /// What the page is told.
    pub fn state(&self) -> Value {
        self.get("/api/state").json()
    }

    /// Waits until no task is in progress.
    #[track_caller]
    pub fn idle(&self) -> Value {
        let began = Instant::now();
        loop {
            let state = self.state();
            if state["job"].is_null() {
                return state;
            }
            assert!(began.elapsed() < PATIENCE, "{}", state["job"]);
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Does a task; it must not fail.
    #[track_caller]
    pub fn task(&self, task: &Value) -> Value {
        self.post("/api/task", task);
        let state = self.idle();
        assert!(state["failed"].is_null(), "{task}: {}", state["failed"]);
        state
    }

    /// The example, read and fitted.
    #[track_caller]
    pub fn example(&self) -> Value {
        self.post("/api/example", &json!({}));
        self.post("/api/take", &json!({"mapping": {"hold": "zero-order"}}));
        let state = self.idle();
        assert!(state["failed"].is_null(), "{}", state["failed"]);
        state
    }

    /// Ends it as a power cut would.
    pub fn kill(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // One that was killed is gone.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Runs `aep` with the words of a line; it must do its work.
#[track_caller]
pub fn aep(words: &[&str]) -> String {
    let run = Command::new(env!("CARGO_BIN_EXE_aep")).args(words).output().unwrap();
    assert!(run.status.success(), "{words:?}: {}", String::from_utf8_lossy(&run.stderr));
    String::from_utf8(run.stdout).unwrap()
}

/// A file of the measured data that may lie beside the project; says so where it does not.
pub fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data").join(name);
    // A worktree of the repository may lie one folder deeper or elsewhere.
    let path = std::env::var_os("AEP_SHARED_DATA").map_or(path, |data| Path::new(&data).join(name));
    if path.exists() {
        return path.canonicalize().ok();
    }
    eprintln!("skipped: {} is not there", path.display());
    None
}
