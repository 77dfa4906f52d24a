//! Whether a job runs faster on several threads, found out by doing it.
//!
//! On an idle machine threads pay from some size on; on one that is busy with other work they
//! may wait for each other longer than they help. Results never depend on the choice.
// SPDX-License-Identifier: BSD-3-Clause

use std::time::Instant;

/// Runs after which the slower way gets another chance.
const AGAIN: u32 = 24;
/// A way that takes this many times as long is not tried again.
const MAX_SLOWDOWN: f64 = 4.0;

/// Times of the same job on one thread and on several.
#[derive(Clone, Copy, Debug, Default)]
pub struct ThreadAutotuner {
    /// Seconds alone and shared, smoothed; zero before the first run.
    seconds: [f64; 2],
    /// Whether a first run, which also pays for memory, is over.
    warm: bool,
    /// Runs since the slower way was taken.
    since: u32,
}

impl ThreadAutotuner {
    /// Whether the next run should be shared.
    fn shared(&self) -> bool {
        let [alone, shared] = self.seconds;
        if shared == 0.0 {
            return true;
        }
        if alone == 0.0 {
            return false;
        }
        let better = shared < alone;
        let (fast, slow) = if better { (shared, alone) } else { (alone, shared) };
        better != (self.since >= AGAIN && slow < MAX_SLOWDOWN * fast)
    }

    /// Take in the time of a run.
    fn tell(&mut self, shared: bool, seconds: f64) {
        if !self.warm {
            self.warm = true;
            return;
        }
        let known = &mut self.seconds[usize::from(shared)];
        *known = if *known == 0.0 { seconds } else { seconds.min(0.5 * (*known + seconds)) };
        let [alone, shared_] = self.seconds;
        let slower = shared == (shared_ > alone);
        self.since = if slower { 0 } else { self.since + 1 };
    }

    /// Do the job; its argument says whether to share its work among threads.
    pub fn run<R>(&mut self, job: impl FnOnce(bool) -> R) -> R {
        let shared = self.shared();
        let begin = Instant::now();
        let result = job(shared);
        self.tell(shared, begin.elapsed().as_secs_f64());
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Share of 240 runs that were shared, given the seconds of both ways.
    fn shared_runs(seconds: impl Fn(bool, u32) -> f64) -> u32 {
        let mut tuner = ThreadAutotuner::default();
        let mut count = 0;
        for k in 0..240 {
            let shared = tuner.shared();
            tuner.tell(shared, seconds(shared, k));
            count += u32::from(shared);
        }
        count
    }

    #[test]
    fn the_faster_way_is_taken_but_for_a_few_trials() {
        assert!(shared_runs(|shared, _| if shared { 1.0 } else { 1.8 }) > 220);
        assert!(shared_runs(|shared, _| if shared { 1.2 } else { 1.0 }) < 20);
        assert_eq!(shared_runs(|shared, _| if shared { 9.0 } else { 1.0 }), 2);
    }

    #[test]
    fn a_change_of_the_machine_is_noticed() {
        let busy_at_first = |shared: bool, k: u32| match (shared, k < 60) {
            (true, true) => 1.5,
            (true, false) => 0.5,
            (false, _) => 1.0,
        };
        assert!(shared_runs(busy_at_first) > 120);
    }
}
