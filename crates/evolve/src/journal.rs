//! The journal of a run: one line of JSON for every individual evaluated, and one for every time
//! that it was judged again.

use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::evaluate::Evaluation;
use crate::individual::{Individual, Origin};

/// One line of the journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// The individual's number.
    pub id: u64,
    /// The generation that it was evaluated in.
    pub generation: usize,
    /// Whether this is not the first line about it: what is known of it now.
    pub again: bool,
    /// How it was made.
    #[serde(flatten)]
    pub origin: Origin,
    /// What became of it.
    #[serde(flatten)]
    pub evaluation: Evaluation,
}

/// A journal being written. Lines are only ever appended.
#[derive(Debug)]
pub struct Journal {
    file: BufWriter<File>,
}

impl Journal {
    /// Begins a journal.
    ///
    /// # Errors
    ///
    /// If there is one already, or none can be made.
    pub fn create(path: &Path) -> io::Result<Journal> {
        let file = OpenOptions::new()
            .append(true)
            .create_new(true)
            .open(path)?;
        let file = BufWriter::new(file);
        Ok(Journal { file })
    }

    /// Appends a generation's individuals, and those judged again in it; when this returns the
    /// system has them.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn append(
        &mut self,
        generation: usize,
        new: &[Individual],
        confirmed: &[Individual],
    ) -> io::Result<()> {
        let new = new.iter().map(|individual| (individual, false));
        let confirmed = confirmed.iter().map(|individual| (individual, true));
        for (individual, again) in new.chain(confirmed) {
            let line = Line {
                id: individual.id,
                generation,
                again,
                origin: individual.origin,
                evaluation: individual.evaluation.clone(),
            };
            serde_json::to_writer(&mut self.file, &line)?;
            self.file.write_all(b"\n")?;
        }
        self.file.flush()
    }
}
