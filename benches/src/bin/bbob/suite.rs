//! All the runs of a contestant.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use clap::ValueEnum;
use coco_rs::{Observer, Suite, observer, suite};

use crate::Result;
use crate::contestant::Contestant;
use crate::noise::{self, Noise};
use crate::task::Task;

/// Which suite of COCO.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// 24 noiseless functions, 1 to 24
    Bbob,
    /// Ten of them under three models of noise, 101 to 130
    Noisy,
    /// The 24 functions with four of five components whole numbers (2, 4, 8 and 16 of them)
    Mixint,
}

impl Kind {
    /// All its functions.
    pub fn functions(self) -> Vec<usize> {
        if self == Self::Noisy { noise::FUNCTIONS.collect() } else { (1..=24).collect() }
    }

    /// All its dimensions, but large ones.
    pub fn dimensions(self) -> Vec<usize> {
        if self == Self::Mixint { vec![5, 10, 20] } else { vec![2, 3, 5, 10, 20] }
    }
}

/// Which functions, and how long.
pub struct Plan {
    pub kind: Kind,
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
            if self.kind != Kind::Bbob {
                return Err(
                    "COCO observes the noiseless suite only: leave --observe or --suite out".into(),
                );
            }
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
                let mut suite = self.suite_of(&[*place]).map_err(|error| error.to_string())?;
                let problem = suite.next_problem(None).ok_or("COCO's suite is empty")?;
                drop(guard);
                let seed = place.instance as u64;
                let noisy = self.kind == Kind::Noisy;
                let noise = noisy.then(|| Noise::new(place.function, place.dimension, seed));
                let budget = self.budget * place.dimension as u64;
                let task = Task::new(problem, budget, noise);
                let mut task = task.map_err(|error| error.to_string())?;
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

    fn suite_of(&self, places: &[Place]) -> Result<Suite> {
        let list = |of: &dyn Fn(&Place) -> usize| {
            let mut all: Vec<usize> = places.iter().map(of).collect();
            all.sort_unstable();
            all.dedup();
            all.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
        };
        let instances = format!("instances: {}", list(&|place| place.instance));
        let (name, base): (_, fn(usize) -> usize) = match self.kind {
            Kind::Bbob => (suite::Name::Bbob, |function| function),
            Kind::Noisy => (suite::Name::Bbob, noise::base),
            Kind::Mixint => (suite::Name::BbobMixint, |function| function),
        };
        let dimensions = list(&|place| place.dimension);
        let functions = list(&|place| base(place.function));
        let options = format!("dimensions: {dimensions} function_indices: {functions}");
        Suite::new(name, &instances, &options).ok_or_else(|| "COCO does not have this suite".into())
    }

    fn observed(&self, contestant: &Contestant, observer: &mut Observer) -> Result<Vec<Run>> {
        let places = self.places();
        let mut suite = self.suite_of(&places)?;
        let mut runs = Vec::new();
        // Problems come by dimension, then function, then instance, as the places.
        for place in places {
            let problem = suite.next_problem(Some(observer)).ok_or("COCO's suite is too short")?;
            let mut task = Task::new(problem, self.budget * place.dimension as u64, None)?;
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
