//! Kernels as libraries.

use tempfile::TempDir;

use crate::compile::Compiled;
use crate::protocol::Entry;
use crate::verdict::Verdict;

/// Kernels that were built, to be timed as often as wanted.
pub struct Built {
    pub(crate) kernels: Vec<Result<Compiled, Verdict>>,
    /// Where their libraries are.
    pub(crate) _directory: TempDir,
}

impl Built {
    /// A hash of every kernel's machine code, the same for kernels that are the same; none of those that were not
    /// built here.
    pub fn codes(&self) -> impl Iterator<Item = Option<&str>> {
        let kernels = self.kernels.iter();
        kernels.map(|built| built.as_ref().ok()?.code.as_deref())
    }

    /// Those that came to be libraries, and their places.
    pub(crate) fn entries(&self) -> impl Iterator<Item = (usize, &Entry)> {
        let numbered = self.kernels.iter().enumerate();
        numbered.filter_map(|(place, built)| Some((place, &built.as_ref().ok()?.entry)))
    }

    /// Leaves out the kernels at whose places `keep` is false. Those that stay move up.
    pub fn retain(&mut self, keep: &[bool]) {
        let mut keep = keep.iter();
        self.kernels
            .retain(|_| keep.next().is_none_or(|keep| *keep));
    }
}
