//! The command line: aep.
fn main() {}
