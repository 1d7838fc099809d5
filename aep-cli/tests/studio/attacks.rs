//! What another page, another program or a careless user may try.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use serde_json::json;

use crate::server::{Server, aep};

/// A test without a browser.
type Test = fn();

pub const TESTS: &[(&str, Test)] = &[
    ("another_page_cannot_drive_the_studio", another_page),
    ("a_name_that_was_made_to_point_here_gets_no_answer", rebinding),
    ("without_the_token_of_the_page_nothing_changes", token),
    ("no_path_leaves_the_project", paths),
    ("an_upload_that_is_too_large_is_refused", oversized),
    ("an_upload_that_never_ends_stops_nobody_else", endless),
    ("a_script_in_a_name_is_text", scripts),
    ("a_formula_that_is_too_deep_or_too_long_is_refused_at_once", formulas),
    ("what_is_no_request_is_refused_in_words", nonsense),
    ("a_hundred_tabs_get_one_task_and_few_streams", tabs),
    ("requests_that_are_no_http_end_no_server", garbage),
    ("one_folder_has_one_studio", one_studio),
];

fn served() -> (tempfile::TempDir, Server) {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(&folder.path().join("p"), None);
    (folder, server)
}

fn another_page() {
    let (_folder, server) = served();
    let host = format!("127.0.0.1:{}", server.port);
    let own = format!("http://{host}");
    let base = [("Host", host.as_str()), ("x-aep-token", &server.token)];
    for more in [
        ("Origin", "http://evil.example"),
        ("Origin", "null"),
        ("Origin", "http://127.0.0.1:1"),
        ("Sec-Fetch-Site", "cross-site"),
        ("Sec-Fetch-Site", "same-site"),
    ] {
        let headers = [&base[..], &[more]].concat();
        assert_eq!(server.with("POST", "/api/example", &headers, b"{}").status, 403, "{more:?}");
        assert_eq!(server.with("GET", "/api/state", &headers, b"").status, 403, "{more:?}");
    }
    // A form of another page sends no header of its own, and a preflight is answered by nothing that allows.
    let preflight = server.with(
        "OPTIONS",
        "/api/example",
        &[("Host", &host), ("Origin", "http://evil.example")],
        b"",
    );
    assert!(!preflight.head.to_lowercase().contains("access-control-allow"), "{}", preflight.head);
    assert!(server.state()["brought"].is_null());
    // The page itself may.
    let headers =
        [&base[..], &[("Origin", own.as_str()), ("Sec-Fetch-Site", "same-origin")]].concat();
    assert_eq!(server.with("POST", "/api/example", &headers, b"{}").status, 200);
    // What it is may not stand in a frame, and nothing in it is a script.
    let head = server.get("/").head.to_lowercase();
    for part in [
        "frame-ancestors 'none'",
        "script-src 'self'",
        "nosniff",
        "no-store",
        "cross-origin-resource-policy: same-origin",
    ] {
        assert!(head.contains(part), "{part} is not in {head}");
    }
}

fn rebinding() {
    let (_folder, server) = served();
    for host in
        ["evil.example", "evil.example:80", "127.0.0.1.evil.example", "0.0.0.0", "192.168.0.1", ""]
    {
        let answer = server.with("GET", "/", &[("Host", host)], b"");
        assert_eq!(answer.status, 403, "{host}");
        assert!(!answer.text().contains(&server.token), "{host}");
        let headers = [("Host", host), ("x-aep-token", server.token.as_str())];
        assert_eq!(server.with("POST", "/api/example", &headers, b"{}").status, 403, "{host}");
    }
    assert_eq!(server.raw(b"GET / HTTP/1.0\r\n\r\n").status, 403, "no host at all");
    let tunnel = server.with("GET", "/", &[("Host", "localhost:9000")], b"");
    assert_eq!(tunnel.status, 200, "a tunnel has a port of its own");
}

fn token() {
    let (_folder, server) = served();
    let host = format!("127.0.0.1:{}", server.port);
    let other = "0".repeat(32);
    for headers in [vec![("Host", host.as_str())], vec![("Host", &host), ("x-aep-token", &other)]] {
        for path in [
            "/api/example",
            "/api/take",
            "/api/task",
            "/api/cancel",
            "/api/riddle",
            "/api/upload?name=a.csv",
        ] {
            assert_eq!(server.with("POST", path, &headers, b"{}").status, 403, "{path}");
        }
    }
    assert!(server.state()["brought"].is_null());
}

fn paths() {
    let (folder, server) = served();
    std::fs::write(folder.path().join("secret.csv"), "secret").unwrap();
    server.example();
    for path in [
        "../secret.csv",
        "..%2fsecret.csv",
        "exports/../../secret.csv",
        "data/../studio.json",
        "studio.json",
        "truth.json",
        "/etc/passwd",
        "%2fetc%2fpasswd",
        "data",
        "",
        "data/%00",
    ] {
        let answer = server.get(&format!("/api/file?path={path}"));
        assert_eq!(answer.status, 400, "{path}: {}", answer.text());
    }
    let name = "..%2f..%2f..%2fevil.csv";
    let text = b"time_s,force_N,position_m\n0,1,2\n1,2,3\n";
    assert_eq!(server.post_bytes(&format!("/api/upload?name={name}"), text).status, 200);
    assert!(folder.path().join("p/data/evil.csv").is_file());
    assert!(!folder.path().join("evil.csv").exists());
    // A law is a file, too.
    let law = json!({"name": "../../evil", "force": "a*v", "parameters": {"a": {"unit": "1", "low": 0.0, "high": 1.0, "default": 1.0}}});
    let refused =
        server.post_bytes("/api/effect", json!({"law": law, "from": 0}).to_string().as_bytes());
    assert_eq!(refused.status, 400, "{}", refused.text());
    assert!(!folder.path().join("evil.toml").exists());
    assert_eq!(server.get("/../../../etc/passwd").status, 404);
}

fn oversized() {
    let (_folder, server) = served();
    // What a request says of its own length is believed before anything of it is read.
    let head = |path: &str, length: usize| {
        format!(
            "POST {path} HTTP/1.0\r\nHost: 127.0.0.1:{}\r\nx-aep-token: {}\r\nContent-Length: {length}\r\n\r\n",
            server.port, server.token
        )
    };
    assert_eq!(server.raw(head("/api/upload?name=a.csv", 1 << 40).as_bytes()).status, 413);
    let large = vec![b' '; 100 << 10];
    let answer = server.raw(&[head("/api/task", large.len()).as_bytes(), &large].concat());
    assert_eq!(answer.status, 413, "{}", answer.head);
    assert!(server.state()["brought"].is_null());
}

fn endless() {
    let (_folder, server) = served();
    let begin = |path: &str| {
        let mut stream = TcpStream::connect(("127.0.0.1", server.port)).unwrap();
        let head = format!(
            "POST {path} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nx-aep-token: {}\r\nTransfer-Encoding: chunked\r\n\r\n1\r\n{{\r\n",
            server.port, server.token
        );
        stream.write_all(head.as_bytes()).unwrap();
        stream
    };
    let mut task = begin("/api/task");
    let _uploads: Vec<TcpStream> = (0..20).map(|_| begin("/api/upload?name=a.csv")).collect();
    // Others are heard meanwhile.
    let began = Instant::now();
    server.example();
    assert!(began.elapsed() < Duration::from_mins(1));
    // What does not come is not waited for.
    task.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    let mut answer = [0; 64];
    let read = task.read(&mut answer).unwrap();
    assert!(String::from_utf8_lossy(&answer[..read]).contains(" 408 "));
}

/// A text that ends whatever it stands in, were it not escaped.
pub const EVIL: &str = "</script><img src=x onerror='window.hacked=1'>";

/// Rows of time, force and position, one every millisecond.
pub fn rows(count: u32) -> String {
    let row = |k: u32| {
        let t = f64::from(k) * 1e-3;
        format!("{t},{},{}", (2.0 * t).cos().signum() * 8.0, 0.02 * (2.0 * t).sin())
    };
    (0..count).map(row).collect::<Vec<_>>().join("\n")
}

fn scripts() {
    let (_folder, server) = served();
    let rows = rows(300);
    let text = format!("time_s,\"{EVIL}\",position_m\n{rows}");
    let name = "%3Cimg%20src=x%20onerror=alert(1)%3E.csv";
    assert_eq!(server.post_bytes(&format!("/api/upload?name={name}"), text.as_bytes()).status, 200);
    let state = server.state();
    assert!(!state["brought"].as_str().unwrap().contains('<'), "{}", state["brought"]);
    // Names come as JSON, which is no page whatever it holds.
    let seen = server.get("/api/preview");
    assert!(seen.head.to_lowercase().contains("content-type: application/json"), "{}", seen.head);
    assert_eq!(seen.json()["columns"][1]["name"], EVIL);
    // The one piece of HTML that is made of a file is escaped.
    let mapping = json!({"mapping": {"force": {"column": EVIL, "unit": "N"}}});
    let checked = server.post("/api/check", &mapping);
    let html = checked["html"].as_str().unwrap();
    assert!(html.contains("&lt;img") && !html.contains("<img"), "{html}");
}

fn formulas() {
    let (_folder, server) = served();
    server.example();
    let deep = format!("{}v{}", "(".repeat(10_000), ")".repeat(10_000));
    let long = vec!["v"; 8000].join("+");
    for text in [deep.as_str(), &long, "v^", "f(v)", "1/0*unknown", ""] {
        let began = Instant::now();
        let body = json!({"law": {"name": "a", "force": text, "parameters": {}}, "from": 0});
        let answer = server.post_bytes("/api/law", body.to_string().as_bytes());
        assert_eq!(answer.status, 400, "{}", answer.text());
        assert!(began.elapsed() < Duration::from_secs(5));
    }
    // As the formula of a column, too.
    let body = json!({"mapping": {"force": deep}});
    assert_eq!(server.post_bytes("/api/check", body.to_string().as_bytes()).status, 400);
    // The largest that is allowed is drawn.
    let most = vec!["sin(v)"; 500].join("+");
    let drawn = server.post(
        "/api/law",
        &json!({"law": {"name": "a", "force": most, "parameters": {}}, "from": 0}),
    );
    assert!(drawn["law"].as_array().unwrap().len() > 50);
}

fn nonsense() {
    let (_folder, server) = served();
    server.example();
    for (path, body) in [
        ("/api/task", "{"),
        ("/api/task", "{\"task\": \"format_disk\"}"),
        ("/api/task", "{\"task\": \"add\", \"from\": 0, \"effect\": \"stribek\", \"more\": 1}"),
        ("/api/task", "{\"task\": \"add\", \"from\": 99, \"effect\": \"stribeck\"}"),
        ("/api/take", "{\"mapping\": {\"froce\": \"u\"}}"),
        ("/api/take", "{\"mapping\": {\"force\": \"no_such_column\"}}"),
        ("/api/choose", "{\"model\": 7}"),
        ("/api/guess", "{\"effect\": \"stribeck\"}"),
        ("/api/upload?name=a.csv", ""),
    ] {
        let answer = server.post_bytes(path, body.as_bytes());
        // A task that cannot be done is refused when it is begun or says so when it ends.
        let state = server.idle();
        let said = if answer.status == 400 {
            answer.json()["error"]["what"].clone()
        } else {
            state["failed"]["what"].clone()
        };
        assert!(
            said.as_str().is_some_and(|said| said.len() > 8),
            "{path} {body}: {} {said}",
            answer.status
        );
    }
    for path in ["/api/course", "/api/course?of=x", "/api/course?of=99", "/api/file", "/api/none"] {
        let status = server.get(path).status;
        assert!((400..=404).contains(&status), "{path}: {status}");
    }
    assert_eq!(server.state()["models"].as_array().unwrap().len(), 1);
}

fn tabs() {
    let (_folder, server) = served();
    server.example();
    // Streams that nobody reads.
    let open = |_: usize| {
        let mut stream = TcpStream::connect(("127.0.0.1", server.port)).unwrap();
        let head = format!("GET /api/events HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n", server.port);
        stream.write_all(head.as_bytes()).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        let mut answer = [0; 12];
        stream.read_exact(&mut answer).unwrap();
        (String::from_utf8_lossy(&answer[9..]).into_owned(), stream)
    };
    let streams: Vec<(String, TcpStream)> = (0..100).map(open).collect();
    let count = |status: &str| streams.iter().filter(|(code, _)| code == status).count();
    assert_eq!((count("200"), count("503")), (64, 36));
    // Every tab asks for a task; one gets it, the others are told.
    let body = json!({"task": "discover", "from": 0}).to_string();
    let begun: Vec<u16> = std::thread::scope(|scope| {
        let asking: Vec<_> = (0..100)
            .map(|_| scope.spawn(|| server.post_bytes("/api/task", body.as_bytes()).status))
            .collect();
        asking.into_iter().map(|asked| asked.join().unwrap()).collect()
    });
    let accepted = begun.iter().filter(|status| **status == 200).count();
    assert!(accepted >= 1 && begun.iter().all(|status| [200, 400].contains(status)), "{begun:?}");
    drop(streams);
    let state = server.idle();
    assert!(state["failed"].is_null(), "{}", state["failed"]);
    // One search at a time, whatever was asked for.
    let found = state["models"].as_array().unwrap().len();
    assert!(found <= 1 + 2 * accepted, "{found} models of {accepted} searches");
}

fn garbage() {
    let (_folder, server) = served();
    for bytes in [
        &b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03"[..],
        b"GET\r\n\r\n",
        &[0xff; 4096],
        b"GET / HTTP/9.9\r\n\r\n",
    ] {
        let answer = server.raw(bytes);
        assert_ne!(answer.status, 200);
    }
    let many = format!(
        "GET / HTTP/1.0\r\nHost: 127.0.0.1:{}\r\n{}\r\n",
        server.port,
        "a: b\r\n".repeat(10_0000)
    );
    assert_ne!(server.raw(many.as_bytes()).status, 200);
    assert_eq!(server.get("/").status, 200);
}

fn one_studio() {
    let (folder, _server) = served();
    let run = std::process::Command::new(env!("CARGO_BIN_EXE_aep"))
        .args(["studio", "--no-open", "--project"])
        .arg(folder.path().join("p"))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert_eq!(run.status.code(), Some(2), "{said}");
    assert!(said.contains("another studio") && said.contains("--project"), "{said}");
    assert!(aep(&["studio", "--help"]).contains("--port"));
}
