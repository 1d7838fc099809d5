//! A one-axis drive made of effects: friction laws, simulator, identification, and the model family for discovery.
