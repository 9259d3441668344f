//! Many episodes on many machines, on several threads.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use anyhow::Result;
use clap::ValueEnum;
use serde::Serialize;

use super::episode::Episode;
use super::machine::Machines;
use super::oracle::{Breach, Quantity, Worst};
use super::random::Random;
use super::run::{Outcome, Runner};
use super::scenario::Scenarios;
use super::shrink::{is_geometry, shrink};
use super::target::Target;

/// Extent of a search.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// The search's seed.
    pub seed: u64,
    /// Number of the first machine.
    pub first_machine: u64,
    /// The search ends after this number of communication steps ...
    pub steps: u64,
    /// ... or this number of machines ...
    pub machines: u64,
    /// ... or this number of failures.
    pub breaches: usize,
    /// Threads that search.
    pub threads: usize,
    /// True: episodes found are shrunk.
    pub shrink: bool,
}

/// Failure of an episode.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Failure {
    /// A limit is broken.
    Breach(Breach),
    /// A valid call is refused, or the washout panics.
    Refused(String),
}

/// An episode that fails.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FoundEpisode {
    /// The episode, shrunk if that was asked for.
    pub episode: Episode,
    /// The failure in it.
    pub failure: Failure,
    /// Number of steps up to the breach before shrinking, or of the whole episode
    /// after a refused call.
    pub found_after: usize,
}

/// Summary of a search.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Summary {
    pub seed: u64,
    pub first_machine: u64,
    /// Number of machines that were built, and of those that were refused.
    pub machines: u64,
    pub refused_machines: u64,
    pub episodes: u64,
    pub steps: u64,
    pub seconds: f64,
    /// The largest ratio of each quantity to its limit; of positions, the largest excess in
    /// units of the tolerance.
    pub worst: Vec<(String, f64)>,
    pub found: Vec<FoundEpisode>,
}

/// Episodes on a machine of the default geometry, and on others, which take longer to build.
const EPISODES: [usize; 2] = [4, 16];

/// Number of refused machines after which the search gives up, if none was built before.
const MOST_REFUSED: u64 = 50;

/// Data shared by the threads.
struct Shared<'a> {
    plan: &'a Plan,
    runner: &'a Runner,
    next_machine: AtomicU64,
    refused: AtomicU64,
    episodes: AtomicU64,
    steps: AtomicU64,
    running: AtomicUsize,
    found: Mutex<Vec<FoundEpisode>>,
    worst: Mutex<Worst>,
    stop: AtomicBool,
}

/// Searches with one target a thread. `progress` is called once a second, and at
/// once for each failure.
///
/// # Errors
/// A target cannot be created, or the washout's interface lacks a variable.
pub fn search<T: Target>(
    plan: &Plan,
    target: impl Fn() -> Result<T> + Sync,
    mut progress: impl FnMut(&Summary),
) -> Result<Summary> {
    let runner = Runner::new()?;
    let started = Instant::now();
    let shared = Shared {
        plan,
        runner: &runner,
        next_machine: AtomicU64::new(0),
        refused: AtomicU64::new(0),
        episodes: AtomicU64::new(0),
        steps: AtomicU64::new(0),
        running: AtomicUsize::new(plan.threads),
        found: Mutex::default(),
        worst: Mutex::default(),
        stop: AtomicBool::new(false),
    };
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..plan.threads)
            .map(|_| {
                scope.spawn(|| {
                    let result = target().and_then(|mut target| shared.hunt(&mut target));
                    shared.running.fetch_sub(1, Ordering::Relaxed);
                    if result.is_err() {
                        shared.stop.store(true, Ordering::Relaxed);
                    }
                    result
                })
            })
            .collect();
        let mut reported = (Instant::now(), 0);
        while shared.running.load(Ordering::Relaxed) > 0 {
            std::thread::sleep(Duration::from_millis(20));
            let found = lock(&shared.found).len();
            if reported.0.elapsed() >= Duration::from_secs(1) || found > reported.1 {
                reported = (Instant::now(), found);
                progress(&shared.summary(started));
            }
        }
        for thread in threads {
            thread.join().expect("a searching thread catches what panics")?;
        }
        Ok(shared.summary(started))
    })
}

impl Shared<'_> {
    fn hunt<T: Target>(&self, target: &mut T) -> Result<()> {
        let variables = self.runner.variables();
        let machines = Machines::new(variables)?;
        let scenarios = Scenarios::new(variables, &machines);
        while !self.is_over() {
            let machine = self.next_machine.fetch_add(1, Ordering::Relaxed);
            if machine >= self.plan.machines {
                break;
            }
            self.hunt_on(self.plan.first_machine + machine, &machines, &scenarios, target)?;
        }
        Ok(())
    }

    fn is_over(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || self.steps.load(Ordering::Relaxed) >= self.plan.steps
    }

    /// All episodes on one machine.
    fn hunt_on<T: Target>(
        &self,
        number: u64,
        machines: &Machines,
        scenarios: &Scenarios,
        target: &mut T,
    ) -> Result<()> {
        let mut random = Random::numbered(self.plan.seed, number);
        let parameters = machines.draw(&mut random);
        if let Err(reason) = self.runner.make(&parameters, target) {
            let refused = 1 + self.refused.fetch_add(1, Ordering::Relaxed);
            // Random machines are refused now and then; a target that refuses all of them is no target.
            let all_are = refused >= MOST_REFUSED && self.episodes.load(Ordering::Relaxed) == 0;
            return if all_are {
                Err(reason.context(format!("{refused} machines are refused, the last")))
            } else {
                Ok(())
            };
        }
        let default_geometry = !parameters.keys().any(|name| is_geometry(name));
        for index in 0..EPISODES[usize::from(!default_geometry)] {
            let mut episode = scenarios.draw(&mut random, &parameters);
            episode.origin = Some([self.plan.seed as i64, number as i64, index as i64]);
            let Some(failure) = self.run(&episode, target) else {
                if self.is_over() {
                    break;
                }
                continue;
            };
            let found = self.shrunk(episode, failure, target)?;
            self.runner.make(&parameters, target)?;
            let mut all = lock(&self.found);
            all.push(found);
            if all.len() >= self.plan.breaches {
                self.stop.store(true, Ordering::Relaxed);
                break;
            }
        }
        Ok(())
    }

    /// Runs an episode and returns its failure, if any.
    fn run<T: Target>(&self, episode: &Episode, target: &mut T) -> Option<Failure> {
        let failure = match catch_unwind(AssertUnwindSafe(|| self.runner.run(episode, target))) {
            Ok(Ok(outcome)) => {
                let Outcome { steps, breach, worst } = outcome;
                self.steps.fetch_add(steps as u64, Ordering::Relaxed);
                if breach.is_none() {
                    let mut all = lock(&self.worst);
                    for (all, worst) in all.iter_mut().zip(worst) {
                        *all = all.max(worst);
                    }
                }
                breach.map(Failure::Breach)
            }
            Ok(Err(error)) => Some(Failure::Refused(format!("{error:#}"))),
            Err(_) => Some(Failure::Refused("a panic".to_owned())),
        };
        self.episodes.fetch_add(1, Ordering::Relaxed);
        failure
    }

    fn shrunk<T: Target>(&self, episode: Episode, failure: Failure, target: &mut T) -> Result<FoundEpisode> {
        let found_after = match failure {
            Failure::Breach(breach) => breach.step + 1,
            Failure::Refused(_) => episode.count,
        };
        let Failure::Breach(breach) = failure else { return Ok(FoundEpisode { episode, failure, found_after }) };
        let (episode, breach) =
            if self.plan.shrink { shrink(self.runner, target, &episode, breach)? } else { (episode, breach) };
        Ok(FoundEpisode { episode, failure: Failure::Breach(breach), found_after })
    }

    fn summary(&self, started: Instant) -> Summary {
        let worst = *lock(&self.worst);
        let refused = self.refused.load(Ordering::Relaxed);
        let machines = self.next_machine.load(Ordering::Relaxed).min(self.plan.machines);
        let names = Quantity::value_variants().iter().map(|quantity| format!("{quantity:?}"));
        Summary {
            seed: self.plan.seed,
            first_machine: self.plan.first_machine,
            machines: machines - refused.min(machines),
            refused_machines: refused,
            episodes: self.episodes.load(Ordering::Relaxed),
            steps: self.steps.load(Ordering::Relaxed),
            seconds: started.elapsed().as_secs_f64(),
            worst: names.zip(worst).collect(),
            found: lock(&self.found).clone(),
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}
