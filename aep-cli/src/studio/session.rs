//! A recording in memory, prepared, and what was computed of it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use aep_data::{Loaded, Mapping, read};
use friction_ident::family::FrictionFamily;
use friction_ident::{Known, Model};
use missing_physics::ahead::ByHand;
use missing_physics::ahead::node::Node;
use missing_physics::measurement::check::{DataCheck, check};

use super::project::Decided;
use crate::args::{add_files, add_regressors, library};
use crate::failure::Failure;
use crate::steps;

/// Families with fixed parameters that are kept: each holds the whole recording.
const FAMILIES: usize = 4;
/// Models whose prediction errors are kept.
const NODES: usize = 12;

/// See the module.
pub struct Session {
    /// The recording and how it was read.
    pub loaded: Loaded,
    /// What was seen in it.
    pub check: DataCheck,
    /// Its models, all parameters free.
    pub family: Arc<FrictionFamily>,
    hold: Option<Decided>,
    families: Mutex<Vec<Arc<FrictionFamily>>>,
    nodes: Mutex<BTreeMap<u32, Arc<Node>>>,
}

impl Session {
    /// Reads a recording with the laws in `effects`. How the force acts between samples is decided once, where nobody says
    /// it, so that all models are compared in one reading.
    pub fn read(
        path: &Path,
        decided: Option<Decided>,
        effects: &[PathBuf],
    ) -> Result<Self, Failure> {
        add_files(effects)?;
        let columns =
            library().effects().iter().flat_map(|effect| effect.columns().to_vec()).collect();
        let mut loaded = read(path, &Mapping { columns, ..Mapping::default() })?;
        add_regressors(&loaded.recording)?;
        let stated = loaded.recording.known_hold().is_some();
        let decided = decided.filter(|_| !stated);
        if let Some(decided) = decided {
            loaded.recording = loaded.recording.with_hold(decided.hold);
        }
        let check = check(&loaded.recording);
        let mut family = steps::family(&loaded.recording, None, &Known::default())?;
        let hold =
            family.hold().map(|choice| Decided { hold: choice.hold, doubtful: choice.by_search });
        if let Some(now) = hold {
            loaded.recording = loaded.recording.with_hold(now.hold);
            if now.doubtful {
                family = steps::family(&loaded.recording, None, &Known::default())?;
            }
        }
        Ok(Self {
            loaded,
            check,
            family: Arc::new(family),
            hold: hold.or(decided),
            families: Mutex::default(),
            nodes: Mutex::default(),
        })
    }

    /// How the force acts between samples, where nobody said it.
    pub fn hold(&self) -> Option<Decided> {
        self.hold
    }

    /// The family in which these parameters are fixed.
    pub fn family(&self, fixed: &BTreeMap<String, f64>) -> Result<Arc<FrictionFamily>, Failure> {
        if fixed.is_empty() {
            return Ok(self.family.clone());
        }
        let mut families = lock(&self.families);
        if let Some(made) = families.iter().find(|family| &family.known().fixed == fixed) {
            return Ok(made.clone());
        }
        let known = Known { fixed: fixed.clone(), ..Known::default() };
        let made = Arc::new(steps::family(&self.loaded.recording, None, &known)?);
        if families.len() == FAMILIES {
            families.remove(0);
        }
        families.push(made.clone());
        Ok(made)
    }

    /// The prediction errors of a model by its number.
    pub fn node(
        &self,
        id: u32,
        (family, model): (&FrictionFamily, &Model),
        hand: &ByHand<'_>,
    ) -> Result<Arc<Node>, Failure> {
        if let Some(known) = lock(&self.nodes).get(&id) {
            return Ok(known.clone());
        }
        let node = Arc::new(hand.as_it_is(family.fitted(model)?));
        self.keep(id, node.clone());
        Ok(node)
    }

    /// Keeps the prediction errors of a model.
    pub fn keep(&self, id: u32, node: Arc<Node>) {
        let mut nodes = lock(&self.nodes);
        while nodes.len() >= NODES {
            nodes.pop_first();
        }
        nodes.insert(id, node);
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
