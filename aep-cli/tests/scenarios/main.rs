//! The command line as users meet it: what they type, what they read, which files they get.

mod axes;
mod bad_input;
mod control;
mod discovery;
mod faults;
mod files;
mod hard_inputs;
mod harness;
mod help;
mod killed;
mod loop_by_hand;
mod manual;
mod optimizers;
mod own_model;
mod plant;
mod same_bytes;
mod series;
mod simulators;
