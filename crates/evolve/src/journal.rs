//! The journal of a run, a line of JSON for everything that was measured: the only truth about
//! the run, from which everything else can be made again.
//!
//! Every line ends with a checksum of itself and the line before, so a line that is damaged,
//! missing, doubled or moved is noticed. Lines are appended by the batch and synced; what is torn
//! off at the end by a crash is dropped when the run is resumed. While a journal is open it is
//! locked, and a second run that opens it is refused.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::path::Path;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::evaluate::Evaluation;
use crate::individual::{Candidate, Origin};

/// One line of a journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "line", rename_all = "kebab-case")]
pub enum Line {
    /// The first line: all that the run depends on, as its owner describes it.
    Run {
        /// The description.
        run: Value,
    },
    /// A candidate that was judged.
    New {
        /// Which one, and how it was made.
        #[serde(flatten)]
        candidate: Identity,
        /// What became of it.
        #[serde(flatten)]
        evaluation: Evaluation,
    },
    /// A candidate with a source that was judged before.
    Duplicate {
        /// Which one, and how it was made.
        #[serde(flatten)]
        candidate: Identity,
    },
    /// An individual that was judged again.
    Again {
        /// Which one.
        id: u64,
        /// In which generation.
        generation: usize,
        /// The hash of its source.
        source: String,
        /// What is known of it now.
        #[serde(flatten)]
        evaluation: Evaluation,
    },
}

/// A candidate without its genome, which follows from the seed and the evaluations before it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Identity {
    /// Its number.
    pub id: u64,
    /// The generation that it was made for.
    pub generation: usize,
    /// How it was made.
    #[serde(flatten)]
    pub origin: Origin,
    /// The hash of its source.
    pub source: String,
}

impl Identity {
    /// Which candidate this is.
    pub(crate) fn of(candidate: &Candidate) -> Identity {
        Identity {
            id: candidate.id,
            generation: candidate.generation,
            origin: candidate.origin,
            source: candidate.source.clone(),
        }
    }
}

/// A journal as it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded {
    /// The first line's description of the run.
    pub run: Value,
    /// The lines after it.
    pub lines: Vec<Line>,
    /// How many bytes at the end are no whole line: the write that a crash cut short.
    pub torn: usize,
    /// How many bytes the whole lines have.
    length: usize,
    /// The checksum of the last whole line.
    chain: String,
}

/// A journal that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum JournalError {
    /// It cannot be opened, read or written.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// Another run has it open.
    #[error("another run is writing to it; wait for that, or use another directory")]
    Busy,
    /// Not one whole line.
    #[error("it has no whole line, so nothing of the run was recorded; begin a new run")]
    Empty,
    /// A line that is not what was written.
    #[error(
        "line {0} is damaged: its checksum does not fit; \
         what stands before it can be saved by cutting the file off there"
    )]
    Damaged(usize),
    /// A sound line that is out of place, or of another version.
    #[error("line {0} is sound but is not a line of this version's journals")]
    Foreign(usize),
}

/// A journal being written. Lines are only ever appended.
#[derive(Debug)]
pub struct Journal {
    file: File,
    chain: String,
}

impl Journal {
    /// Begins a journal with the description of a run.
    ///
    /// # Errors
    ///
    /// If there is one already, or none can be made.
    pub fn create(path: &Path, run: Value) -> Result<Journal, JournalError> {
        let file = OpenOptions::new()
            .append(true)
            .create_new(true)
            .open(path)?;
        lock(&file)?;
        let chain = String::new();
        let mut journal = Journal { file, chain };
        journal.append(&[Line::Run { run }])?;
        Ok(journal)
    }

    /// Opens a journal to go on with it. What is torn off at its end is removed.
    ///
    /// # Errors
    ///
    /// [`JournalError`] if there is none, another run has it open, or it is damaged; then it is
    /// left as it is.
    pub fn resume(path: &Path) -> Result<(Journal, Recorded), JournalError> {
        let mut file = OpenOptions::new().read(true).append(true).open(path)?;
        lock(&file)?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        let recorded = Recorded::parse(&bytes)?;
        file.set_len(recorded.length as u64)?;
        let chain = recorded.chain.clone();
        Ok((Journal { file, chain }, recorded))
    }

    /// Appends lines; when this returns they are on the disk.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn append(&mut self, lines: &[Line]) -> io::Result<()> {
        let mut text = String::new();
        for line in lines {
            let line = serde_json::to_string(line)?;
            self.chain = checksum(&self.chain, &line);
            let open = line.strip_suffix('}').expect("a line is an object");
            text += &format!("{open}{CHECK}{}{END}\n", self.chain);
        }
        self.file.write_all(text.as_bytes())?;
        self.file.sync_data()
    }
}

/// How often a locked journal is tried again, and how long that takes each time. A process that was
/// just started by whoever had it open holds the lock for a moment, until it runs its own program.
const TRIES: u32 = 20;
const TRY: Duration = Duration::from_millis(10);

fn lock(file: &File) -> Result<(), JournalError> {
    for _ in 0..TRIES {
        match file.try_lock() {
            Ok(()) => return Ok(()),
            Err(TryLockError::WouldBlock) => std::thread::sleep(TRY),
            Err(TryLockError::Error(error)) => return Err(error.into()),
        }
    }
    Err(JournalError::Busy)
}

/// What stands around the checksum at the end of a line.
const CHECK: &str = ",\"check\":\"";
const END: &str = "\"}";

/// The checksum of a line after the line with the checksum `before`.
fn checksum(before: &str, line: &str) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(before.as_bytes());
    hasher.update(line.as_bytes());
    hasher.finalize().to_hex()[..16].to_owned()
}

impl Recorded {
    /// Reads a journal without opening it for a run.
    ///
    /// # Errors
    ///
    /// [`JournalError`] if there is none or it is damaged.
    pub fn read(path: &Path) -> Result<Recorded, JournalError> {
        Recorded::parse(&std::fs::read(path)?)
    }

    /// How many candidates it has.
    pub fn candidates(&self) -> usize {
        let is_candidate = |line: &&Line| matches!(line, Line::New { .. } | Line::Duplicate { .. });
        self.lines.iter().filter(is_candidate).count()
    }

    fn parse(bytes: &[u8]) -> Result<Recorded, JournalError> {
        let length = bytes.iter().rposition(|&byte| byte == b'\n');
        let length = length.ok_or(JournalError::Empty)? + 1;
        let (whole, torn) = bytes.split_at(length);
        let mut chain = String::new();
        let mut lines = Vec::new();
        for (number, line) in (1..).zip(whole[..length - 1].split(|&byte| byte == b'\n')) {
            let sound = std::str::from_utf8(line).ok().and_then(|line| {
                let (open, check) = line.strip_suffix(END)?.rsplit_once(CHECK)?;
                let line = format!("{open}}}");
                (checksum(&chain, &line) == check).then(|| (line, check.to_owned()))
            });
            let (line, check) = sound.ok_or(JournalError::Damaged(number))?;
            chain = check;
            let line = serde_json::from_str(&line).map_err(|_| JournalError::Foreign(number))?;
            lines.push(line);
        }
        let Line::Run { run } = lines.remove(0) else {
            return Err(JournalError::Foreign(1));
        };
        let is_run = |line: &Line| matches!(line, Line::Run { .. });
        if let Some(index) = lines.iter().position(is_run) {
            return Err(JournalError::Foreign(index + 2));
        }
        Ok(Recorded {
            run,
            lines,
            torn: torn.len(),
            length,
            chain,
        })
    }
}
