//! All the runs of a contestant.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use coco_rs::{Observer, Suite, observer, suite};

use crate::Result;
use crate::contestant::Contestant;
use crate::task::Task;

/// Which functions, and how long.
pub struct Plan {
    pub dimensions: Vec<usize>,
    pub functions: Vec<usize>,
    pub instances: Vec<usize>,
    /// Evaluations per component.
    pub budget: u64,
}

/// One run.
pub struct Run {
    pub method: String,
    pub dimension: usize,
    pub function: usize,
    pub instance: usize,
    pub evaluations: u64,
    /// Evaluations up to the target, if it was hit.
    pub solved: Option<u64>,
}

#[derive(Clone, Copy)]
struct Place {
    dimension: usize,
    function: usize,
    instance: usize,
}

impl Plan {
    fn places(&self) -> Vec<Place> {
        let mut places = Vec::new();
        for &dimension in &self.dimensions {
            for &function in &self.functions {
                for &instance in &self.instances {
                    places.push(Place { dimension, function, instance });
                }
            }
        }
        places
    }

    /// Every run of the plan, in its order; with `observe` also into `exdata/` on one thread.
    pub fn run(&self, contestant: &Contestant, observe: bool) -> Result<Vec<Run>> {
        if observe {
            let name = contestant.name().replace(' ', "-");
            let options = format!("result_folder: {name} algorithm_name: {name}");
            let observer = Observer::new(observer::Name::Bbob, &options);
            let mut observer = observer.ok_or("COCO has no observer of BBOB")?;
            return self.observed(contestant, &mut observer);
        }
        let places = self.places();
        // COCO's suites are made one at a time; their functions are evaluated side by side.
        let (next, making) = (AtomicUsize::new(0), Mutex::new(()));
        let done = Mutex::new(Vec::new());
        let work = || -> std::result::Result<(), String> {
            while let Some(place) = places.get(next.fetch_add(1, Ordering::Relaxed)) {
                let guard = making.lock().unwrap_or_else(PoisonError::into_inner);
                let mut suite = suite_of(&[*place]).map_err(|error| error.to_string())?;
                let problem = suite.next_problem(None).ok_or("COCO's suite is empty")?;
                drop(guard);
                let mut task = Task::new(problem, self.budget * place.dimension as u64);
                let seed = place.instance as u64;
                contestant.solve(&mut task, seed).map_err(|error| error.to_string())?;
                let run = run(contestant, *place, &task);
                done.lock().unwrap_or_else(PoisonError::into_inner).push(run);
                let _guard = making.lock().unwrap_or_else(PoisonError::into_inner);
                drop(task);
                drop(suite);
            }
            Ok(())
        };
        std::thread::scope(|scope| -> std::result::Result<(), String> {
            let threads = std::thread::available_parallelism().map_or(1, usize::from);
            let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
            workers.into_iter().try_for_each(|worker| {
                worker.join().unwrap_or_else(|_| Err("a method panicked".into()))
            })
        })?;
        let mut runs = done.into_inner().unwrap_or_else(PoisonError::into_inner);
        runs.sort_by_key(|run| (run.dimension, run.function, run.instance));
        Ok(runs)
    }

    fn observed(&self, contestant: &Contestant, observer: &mut Observer) -> Result<Vec<Run>> {
        let places = self.places();
        let mut suite = suite_of(&places)?;
        let mut runs = Vec::new();
        // Problems come by dimension, then function, then instance, as the places.
        for place in places {
            let problem = suite.next_problem(Some(observer)).ok_or("COCO's suite is too short")?;
            let mut task = Task::new(problem, self.budget * place.dimension as u64);
            contestant.solve(&mut task, place.instance as u64)?;
            runs.push(run(contestant, place, &task));
        }
        Ok(runs)
    }
}

fn run(contestant: &Contestant, place: Place, task: &Task<'_>) -> Run {
    let Place { dimension, function, instance } = place;
    let method = contestant.name().to_owned();
    Run { method, dimension, function, instance, evaluations: task.used(), solved: task.solved() }
}

fn suite_of(places: &[Place]) -> Result<Suite> {
    let list = |of: fn(&Place) -> usize| {
        let mut all: Vec<usize> = places.iter().map(of).collect();
        all.sort_unstable();
        all.dedup();
        all.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
    };
    let instances = format!("instances: {}", list(|place| place.instance));
    let (dimensions, functions) = (list(|place| place.dimension), list(|place| place.function));
    let options = format!("dimensions: {dimensions} function_indices: {functions}");
    Suite::new(suite::Name::Bbob, &instances, &options)
        .ok_or_else(|| "COCO has no BBOB suite".into())
}
