//! Test functions for optimizers, with domain, optimum and reference.
