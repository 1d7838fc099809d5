//! A generic evolutionary optimizer: Problem, Individual, Mutation, Selection, and the algorithms composed of them.
