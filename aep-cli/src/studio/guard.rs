//! Which requests are heard: those of the studio's own page. Another page in the same browser can send requests to this
//! machine, too, under a name of its own that it lets point here (DNS rebinding); neither gets an answer.

use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, HOST, HeaderName, HeaderValue, ORIGIN, REFERRER_POLICY,
    X_CONTENT_TYPE_OPTIONS, X_FRAME_OPTIONS,
};
use axum::http::{HeaderMap, Method, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use super::Studio;
use super::routes::Refused;

/// Carries the token of the page.
pub const TOKEN: &str = "x-aep-token";
const SITE: &str = "sec-fetch-site";
const RESOURCES: HeaderName = HeaderName::from_static("cross-origin-resource-policy");
/// Names of this machine that cannot point elsewhere.
const HERE: [&str; 3] = ["127.0.0.1", "localhost", "[::1]"];
/// Scripts come from the studio alone: nothing on the page is one.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; \
                      img-src data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// What tells the studio's page from others.
pub struct Guard {
    token: String,
}

impl Guard {
    /// One with a token of its own.
    pub fn new() -> Self {
        Self { token: format!("{:032x}", rand::random::<u128>()) }
    }

    /// What the page must send with whatever changes something.
    pub fn token(&self) -> &str {
        &self.token
    }

    fn check(&self, method: &Method, headers: &HeaderMap) -> Result<(), &'static str> {
        let text = |name: &str| headers.get(name).map(|value| value.to_str().unwrap_or("?"));
        let host = text(HOST.as_str()).filter(|host| is_here(host));
        let Some(host) = host else {
            return Err("the studio answers at 127.0.0.1 and localhost only");
        };
        if text(SITE).is_some_and(|site| site != "same-origin" && site != "none") {
            return Err("another page asked");
        }
        if text(ORIGIN.as_str()).is_some_and(|origin| origin != format!("http://{host}")) {
            return Err("another page asked");
        }
        let reads = method == Method::GET || method == Method::HEAD;
        if !reads && text(TOKEN) != Some(self.token()) {
            return Err("the token of the page is missing or old: load the page again");
        }
        Ok(())
    }
}

/// Whether a `Host` is this machine under a name that is always this machine, at any port (a tunnel has its own).
fn is_here(host: &str) -> bool {
    let (name, port) = match host.rsplit_once(':') {
        Some((name, port)) if !port.ends_with(']') => (name, Some(port)),
        _ => (host, None),
    };
    HERE.contains(&name)
        && port.is_none_or(|port| !port.is_empty() && port.bytes().all(|b| b.is_ascii_digit()))
}

/// Lets requests of the page pass, and says with every answer what a browser may do with it.
pub async fn guarded(State(studio): State<Arc<Studio>>, request: Request, next: Next) -> Response {
    let mut answer = match studio.guard.check(request.method(), request.headers()) {
        Ok(()) => next.run(request).await,
        Err(why) => Refused::because(StatusCode::FORBIDDEN, why).into_response(),
    };
    let headers = answer.headers_mut();
    for (name, value) in [
        (CONTENT_SECURITY_POLICY, POLICY),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (X_FRAME_OPTIONS, "DENY"),
        (REFERRER_POLICY, "no-referrer"),
        (CACHE_CONTROL, "no-store"),
        (RESOURCES, "same-origin"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    answer
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_that_always_point_here_are_this_machine() {
        for host in ["127.0.0.1", "127.0.0.1:80", "localhost:9", "[::1]:7", "[::1]"] {
            assert!(is_here(host), "{host}");
        }
        for host in [
            "",
            "evil.example",
            "evil.example:80",
            "127.0.0.1.evil.example",
            "localhost:",
            "localhost:x",
            "127.0.0.1:1@evil",
        ] {
            assert!(!is_here(host), "{host}");
        }
    }
}
