//! How long a kernel runs.
//!
//! On a shared machine a thread that is timed is made to wait now and then, and a kernel that waits looks slow, or the
//! reference beside it does and the kernel looks fast. So the clock is the thread's own, which stands while others run,
//! where the system has one; elsewhere it is the wall's.

/// A clock that was started.
pub(crate) struct Stopwatch(Moment);

#[cfg(any(target_os = "linux", target_os = "macos"))]
type Moment = rustix::time::Timespec;

#[cfg(any(target_os = "linux", target_os = "macos"))]
impl Stopwatch {
    /// Starts.
    pub fn start() -> Stopwatch {
        Stopwatch(now())
    }

    /// Seconds that this thread has run since. It must be the one that started.
    pub fn seconds(&self) -> f64 {
        let (Stopwatch(then), now) = (self, now());
        (now.tv_sec - then.tv_sec) as f64 + (now.tv_nsec - then.tv_nsec) as f64 * 1e-9
    }
}

/// How long this thread has run.
#[cfg(any(target_os = "linux", target_os = "macos"))]
fn now() -> Moment {
    rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime)
}

#[cfg(not(any(target_os = "linux", target_os = "macos")))]
type Moment = std::time::Instant;

#[cfg(not(any(target_os = "linux", target_os = "macos")))]
impl Stopwatch {
    /// Starts.
    pub fn start() -> Stopwatch {
        Stopwatch(std::time::Instant::now())
    }

    /// Seconds since.
    pub fn seconds(&self) -> f64 {
        self.0.elapsed().as_secs_f64()
    }
}

#[cfg(test)]
mod tests {
    use std::hint::black_box;
    use std::time::Instant;

    use super::*;

    fn work() -> u64 {
        (0..1 << 24).fold(0, |sum: u64, number| black_box(sum ^ number))
    }

    #[test]
    fn what_runs_takes_time() {
        let watch = Stopwatch::start();
        black_box(work());
        let some = watch.seconds();
        black_box(work());
        assert!(0.0 < some && some < watch.seconds());
    }

    #[test]
    fn waiting_for_others_is_not_counted_where_the_system_tells() {
        if cfg!(not(any(target_os = "linux", target_os = "macos"))) {
            println!("skipped: the clock is the wall's here");
            return;
        }
        let (watch, start) = (Stopwatch::start(), Instant::now());
        let other = std::thread::spawn(work);
        black_box(other.join().unwrap());
        assert!(watch.seconds() < start.elapsed().as_secs_f64() / 2.0);
    }
}
