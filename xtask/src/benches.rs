//! A bench for each instruction set, and one verdict on a program of all its kernels.

use emit::Kernel;
use measure::{Bench, MeasureError, Plan, Spent, Verdict};

/// Benches for the instruction sets of an arena, in its order.
pub struct Benches(Vec<Bench>);

impl Benches {
    /// At least one.
    pub fn new(benches: Vec<Bench>) -> Benches {
        Benches(benches)
    }

    /// Builds, checks and times programs, each given by its kernels for all instruction sets. The
    /// first verdict is that of the reference.
    ///
    /// With several instruction sets nobody races: who is ahead on one of them need not be on
    /// average.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be measured at all.
    pub fn measure(
        &mut self,
        programs: &[&[Kernel]],
        plan: &Plan,
    ) -> Result<Vec<Verdict>, MeasureError> {
        let plan = match self.0.len() {
            1 => plan.clone(),
            _ => Plan {
                race: None,
                racers: 0,
                ..plan.clone()
            },
        };
        let mut verdicts: Vec<Vec<Verdict>> = vec![Vec::new(); programs.len() + 1];
        for (place, bench) in self.0.iter_mut().enumerate() {
            let kernels: Vec<&Kernel> = programs.iter().map(|kernels| &kernels[place]).collect();
            let of_isa = bench.measure(&kernels, &plan)?;
            for (all, one) in verdicts.iter_mut().zip(of_isa) {
                all.push(one);
            }
        }
        Ok(verdicts.into_iter().map(Verdict::on_average).collect())
    }

    /// Where the time went so far.
    pub fn spent(&self) -> Spent {
        let spent = self.0.iter().map(Bench::spent);
        spent.fold(Spent::default(), |sum, one| Spent {
            compile: sum.compile + one.compile,
            check: sum.check + one.check,
            time: sum.time + one.time,
        })
    }
}
