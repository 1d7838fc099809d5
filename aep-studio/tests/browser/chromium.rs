//! A headless Chromium, spoken to over a pipe (Chrome `DevTools` protocol): no port, no further dependency.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use base64::Engine;
use serde_json::{Value, json};

/// Longest wait for an answer.
const PATIENCE: Duration = Duration::from_mins(2);
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// The Chromium of this machine: `AEP_CHROMIUM`, or the first of the usual names on the path.
pub fn installed() -> Option<String> {
    let answers = |name: &String| {
        let mut run = Command::new(name);
        let run = run.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
        run.status().is_ok_and(|status| status.success())
    };
    let asked = std::env::var("AEP_CHROMIUM").ok();
    asked.into_iter().chain(NAMES.map(str::to_owned)).find(answers)
}

/// A tab, and what went wrong in it so far.
pub struct Tab {
    child: Child,
    to: ChildStdin,
    from: Receiver<Value>,
    session: String,
    asked: u64,
    scripted: bool,
    /// Errors on the console and exceptions.
    pub errors: Vec<String>,
    _profile: tempfile::TempDir,
}

impl Tab {
    /// A tab of its own browser, `width` x `height` pixels large.
    pub fn new(chromium: &str, (width, height): (u32, u32)) -> Self {
        let profile = tempfile::tempdir().unwrap();
        // The protocol is read from descriptor 3 and written to 4.
        let script = "exec \"$0\" \"$@\" 3<&0 4>&1 </dev/null >/dev/null 2>&1";
        let mut child = Command::new("sh")
            .args(["-c", script, chromium, "--headless=new", "--remote-debugging-pipe"])
            .args(["--no-sandbox", "--disable-gpu", "--no-first-run", "--hide-scrollbars"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let to = child.stdin.take().unwrap();
        let mut reader = BufReader::new(child.stdout.take().unwrap());
        let (sender, from) = channel();
        std::thread::spawn(move || {
            let mut bytes = Vec::new();
            while reader.read_until(0, &mut bytes).is_ok_and(|read| read > 0) {
                bytes.pop();
                let Ok(message) = serde_json::from_slice(&bytes) else { break };
                if sender.send(message).is_err() {
                    break;
                }
                bytes.clear();
            }
        });
        let session = String::new();
        let (asked, errors) = (0, Vec::new());
        let mut tab =
            Self { child, to, from, session, asked, scripted: true, errors, _profile: profile };
        let target = tab.ask("Target.createTarget", &json!({"url": "about:blank"}));
        let attach = json!({"targetId": target["targetId"], "flatten": true});
        let attached = tab.ask("Target.attachToTarget", &attach);
        attached["sessionId"].as_str().unwrap().clone_into(&mut tab.session);
        for domain in ["Page", "Runtime", "Log"] {
            tab.ask(&format!("{domain}.enable"), &json!({}));
        }
        tab.size(width, height);
        tab
    }

    /// Makes the tab so large; below 500 pixels it is a telephone.
    pub fn size(&mut self, width: u32, height: u32) {
        let mobile = width < 500;
        let size =
            json!({"width": width, "height": height, "deviceScaleFactor": 1, "mobile": mobile});
        self.ask("Emulation.setDeviceMetricsOverride", &size);
    }

    /// Light or dark, as the reader's system would ask.
    pub fn scheme(&mut self, scheme: &str) {
        let features = json!({"features": [{"name": "prefers-color-scheme", "value": scheme}]});
        self.ask("Emulation.setEmulatedMedia", &features);
    }

    /// Whether pages may run scripts.
    pub fn scripts(&mut self, run: bool) {
        self.scripted = run;
        self.ask("Emulation.setScriptExecutionDisabled", &json!({"value": !run}));
    }

    /// Opens a file and waits until it has loaded.
    pub fn open(&mut self, path: &Path) {
        self.visit(&format!("file://{}", path.display()));
        if self.scripted {
            // All that the first screen draws.
            self.until(
                "[...document.querySelectorAll('section.screen')].every((s) => s.dataset.ready)",
            );
        }
    }

    /// Opens an address and waits until it has loaded.
    pub fn visit(&mut self, url: &str) {
        self.ask("Page.navigate", &json!({"url": url}));
        self.until("document.readyState === 'complete' && location.protocol !== 'about:'");
    }

    /// The value of an expression; promises are awaited.
    pub fn eval(&mut self, expression: &str) -> Value {
        let asked = json!({"expression": expression, "awaitPromise": true, "returnByValue": true});
        let answer = self.ask("Runtime.evaluate", &asked);
        assert!(
            answer["exceptionDetails"].is_null(),
            "{expression}: {}",
            answer["exceptionDetails"]
        );
        answer["result"]["value"].clone()
    }

    /// Waits until an expression holds.
    pub fn until(&mut self, expression: &str) {
        for _ in 0..600 {
            if self.eval(expression) == json!(true) {
                return;
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        panic!("never came true: {expression}");
    }

    /// A step of the mouse: `mouseMoved`, `mousePressed`, `mouseReleased`, `mouseWheel`.
    pub fn mouse(&mut self, kind: &str, (x, y): (f64, f64), more: Value) {
        let mut event = json!({"type": kind, "x": x, "y": y});
        if kind == "mousePressed" || kind == "mouseReleased" {
            event["button"] = json!("left");
            event["clickCount"] = json!(1);
        }
        if let Value::Object(more) = more {
            for (key, value) in more {
                event[key] = value;
            }
        }
        self.ask("Input.dispatchMouseEvent", &event);
    }

    /// A key, by its name.
    pub fn key(&mut self, name: &str) {
        for kind in ["keyDown", "keyUp"] {
            self.ask("Input.dispatchKeyEvent", &json!({"type": kind, "key": name}));
        }
    }

    /// A picture of what is seen, as PNG.
    pub fn screenshot(&mut self, path: &Path) {
        let taken = self.ask("Page.captureScreenshot", &json!({"format": "png"}));
        let engine = base64::engine::general_purpose::STANDARD;
        std::fs::write(path, engine.decode(taken["data"].as_str().unwrap()).unwrap()).unwrap();
    }

    /// How many pages of paper it takes.
    pub fn pages(&mut self) -> usize {
        let printed = self.ask("Page.printToPDF", &json!({"printBackground": true}));
        let engine = base64::engine::general_purpose::STANDARD;
        let pdf = engine.decode(printed["data"].as_str().unwrap()).unwrap();
        let (page, pages) = (b"/Type /Page", b"/Type /Pages");
        let count = |mark: &[u8]| pdf.windows(mark.len()).filter(|here| *here == mark).count();
        count(page) - count(pages)
    }

    fn ask(&mut self, method: &str, params: &Value) -> Value {
        self.asked += 1;
        let mut question = json!({"id": self.asked, "method": method, "params": params});
        if !self.session.is_empty() {
            question["sessionId"] = json!(self.session);
        }
        let mut bytes = question.to_string().into_bytes();
        bytes.push(0);
        self.to.write_all(&bytes).unwrap();
        self.to.flush().unwrap();
        loop {
            let answer =
                self.from.recv_timeout(PATIENCE).unwrap_or_else(|why| panic!("{method}: {why}"));
            if answer["id"] == json!(self.asked) {
                assert!(answer["error"].is_null(), "{method}: {}", answer["error"]);
                return answer["result"].clone();
            }
            self.note(&answer);
        }
    }

    fn note(&mut self, event: &Value) {
        let params = &event["params"];
        let error = match event["method"].as_str() {
            Some("Runtime.exceptionThrown") => Some(params["exceptionDetails"].to_string()),
            Some("Runtime.consoleAPICalled") if params["type"] == "error" => {
                Some(params["args"].to_string())
            }
            Some("Log.entryAdded") if params["entry"]["level"] == "error" => {
                Some(params["entry"].to_string())
            }
            _ => None,
        };
        self.errors.extend(error);
    }
}

impl Drop for Tab {
    fn drop(&mut self) {
        // A browser that has gone already is gone.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
