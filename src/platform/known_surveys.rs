//! Surveys of the last rigs: a sweep makes many washouts of one rig, and a survey takes 20 ms.

use std::sync::{Mutex, PoisonError};

use super::survey::{Survey, SurveyFailed, survey};
use crate::interface::Rig;

/// Number of rigs that are kept.
const SURVEY_CACHE_CAPACITY: usize = 4;

type Surveyed = Result<Survey, SurveyFailed>;

static SURVEY_CACHE: Mutex<Known> = Mutex::new(Known { rigs: [None; SURVEY_CACHE_CAPACITY], next: 0 });

/// The last rigs and their surveys; the oldest gives way.
struct Known {
    rigs: [Option<(Rig, Surveyed)>; SURVEY_CACHE_CAPACITY],
    next: usize,
}

impl Known {
    fn find(&self, rig: &Rig) -> Option<Surveyed> {
        self.rigs.iter().flatten().find(|(known, _)| known == rig).map(|(_, surveyed)| *surveyed)
    }

    fn keep(&mut self, rig: Rig, surveyed: Surveyed) {
        if self.find(&rig).is_none() {
            self.rigs[self.next] = Some((rig, surveyed));
            self.next = (self.next + 1) % SURVEY_CACHE_CAPACITY;
        }
    }
}

/// As [`survey()`], at once for a rig of the last ones.
///
/// # Errors
/// As [`survey()`].
pub fn known_survey(rig: &Rig) -> Surveyed {
    known_or(&SURVEY_CACHE, rig, survey)
}

fn known_or(known: &Mutex<Known>, rig: &Rig, survey: impl FnOnce(&Rig) -> Surveyed) -> Surveyed {
    // Limits of speed leave the poses as they are.
    let rig = Rig { velocity_limit: 0.0, acceleration_limit: 0.0, ..*rig };
    let locked = || known.lock().unwrap_or_else(PoisonError::into_inner);
    let found = locked().find(&rig);
    // Not under the lock: other threads survey other rigs.
    found.unwrap_or_else(|| {
        let surveyed = survey(&rig);
        locked().keep(rig, surveyed);
        surveyed
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const FOUND: Surveyed = Ok(Survey { smallest_singular_value: 0.5, worst_condition: 3.0 });
    const FAILED: Surveyed = Err(SurveyFailed { lengths: [1.0; 6] });

    fn of_height(height: f64) -> Rig {
        Rig { neutral_height: height, ..Rig::default() }
    }

    #[test]
    fn a_rig_is_surveyed_once() {
        let known = Mutex::new(Known { rigs: [None; SURVEY_CACHE_CAPACITY], next: 0 });
        for surveyed in [FOUND, FAILED] {
            let rig = of_height(if surveyed.is_ok() { 1.1 } else { 1.2 });
            assert_eq!(known_or(&known, &rig, |_| surveyed), surveyed);
            let faster = Rig { velocity_limit: 2.0, acceleration_limit: 30.0, ..rig };
            for same in [rig, faster] {
                assert_eq!(known_or(&known, &same, |_| panic!("surveyed again")), surveyed);
            }
        }
    }

    #[test]
    fn another_rig_is_surveyed_and_the_oldest_gives_way() {
        let known = Mutex::new(Known { rigs: [None; SURVEY_CACHE_CAPACITY], next: 0 });
        let mut count = 0;
        let mut of = |height: f64| {
            known_or(&known, &of_height(height), |_| {
                count += 1;
                FOUND
            })
            .unwrap();
            count
        };
        for k in 0..SURVEY_CACHE_CAPACITY {
            assert_eq!(of(1.0 + k as f64), k + 1);
        }
        assert_eq!(of(1.0), SURVEY_CACHE_CAPACITY);
        assert_eq!(of(99.0), SURVEY_CACHE_CAPACITY + 1);
        assert_eq!(of(2.0), SURVEY_CACHE_CAPACITY + 1);
        assert_eq!(of(1.0), SURVEY_CACHE_CAPACITY + 2, "the oldest is no longer known");
        // Any joint and each end of the stroke make another rig.
        let mut rig = of_height(99.0);
        rig.platform[5].z += 1e-9;
        assert_eq!(known_or(&known, &rig, |_| FAILED), FAILED);
        assert_eq!(known_or(&known, &Rig { max_length: 1.61, ..rig }, |_| FOUND), FOUND);
    }
}
