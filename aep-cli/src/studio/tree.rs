//! The models of a project: each with the one that it came from, so that nothing is lost by going back.

use std::collections::BTreeMap;

use missing_physics::report::Rung;
use serde::{Deserialize, Serialize};

/// How a model came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum By {
    /// It is a base model.
    Base,
    /// An effect was added by hand.
    Added,
    /// An effect was taken away by hand.
    Removed,
    /// A parameter was fixed or freed.
    Fixed,
    /// A search added it.
    Discovered,
}

/// A model of the tree.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Its number; its file is `models/ID.json`.
    pub id: u32,
    /// The model that it came from.
    pub parent: Option<u32>,
    /// How.
    pub by: By,
    /// What is different, in a few words: `+ stribeck`.
    pub name: String,
    /// Its errors and parameters.
    pub rung: Rung,
    /// Parameters that were not fitted, SI.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub fixed: BTreeMap<String, f64>,
}

/// All models, in the order in which they were made.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tree {
    /// The models.
    pub entries: Vec<Entry>,
    /// The one that is looked at.
    pub chosen: Option<u32>,
    /// Number of the next one; files of earlier recordings keep theirs.
    pub next: u32,
}

impl Tree {
    /// A tree without models that goes on counting.
    pub fn after(&self) -> Self {
        Self { next: self.next, ..Self::default() }
    }

    /// The model with this number.
    pub fn get(&self, id: u32) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.id == id)
    }

    /// From the base model to this one.
    pub fn path(&self, id: u32) -> Vec<&Entry> {
        let mut path = Vec::new();
        let mut at = self.get(id);
        // A file that was changed by hand may go in circles.
        while let Some(entry) = at.filter(|_| path.len() < self.entries.len()) {
            path.push(entry);
            at = entry.parent.and_then(|parent| self.get(parent));
        }
        path.reverse();
        path
    }

    /// Takes in a model under the next number, chooses it and returns its number.
    pub fn add(&mut self, entry: Entry) -> u32 {
        let id = self.next;
        self.entries.push(Entry { id, ..entry });
        self.chosen = Some(id);
        self.next += 1;
        id
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub fn entry(parent: Option<u32>, name: &str) -> Entry {
        let rung = serde_json::json!({"added": [], "effects": [], "parameters": {}, "error": {}, "p_value": null});
        let rung = serde_json::from_value(rung).unwrap();
        let fixed = BTreeMap::new();
        Entry { id: 0, parent, by: By::Added, name: name.to_owned(), rung, fixed }
    }

    #[test]
    fn a_branch_leaves_the_other_one_as_it_is() {
        let mut tree = Tree::default();
        let base = tree.add(entry(None, "base"));
        let left = tree.add(entry(Some(base), "left"));
        let right = tree.add(entry(Some(base), "right"));
        let names = |id| tree.path(id).iter().map(|e| e.name.clone()).collect::<Vec<_>>();
        assert_eq!(
            (names(left), names(right)),
            (vec!["base".into(), "left".into()], vec!["base".into(), "right".into()])
        );
        assert_eq!(tree.chosen, Some(right));
    }

    #[test]
    fn a_tree_that_goes_in_circles_ends() {
        let mut tree = Tree::default();
        let first = tree.add(entry(None, "first"));
        let second = tree.add(entry(Some(first), "second"));
        tree.entries[0].parent = Some(second);
        assert_eq!(tree.path(second).len(), 2);
    }
}
