//! The report page: a self-contained HTML document of a discovery.
//!
//! [`report::html`] makes one file with its styles, drawings, data and scripts inside: nothing is loaded
//! from elsewhere, and without scripts its drawings stand still. Light or dark as the reader's system asks, and fit to
//! print. [`studio`] is the same front end as a live page, for a server. [`words`] has the sentences that page, terminal and
//! [`json`](mod@json) share.

mod front;
mod html;
pub mod json;
mod plot;
pub mod report;
mod source;
pub mod studio;
pub mod words;

pub use html::escape;
pub use source::Source;

/// The examples of the README, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
