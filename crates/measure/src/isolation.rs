//! What a worker does before it loads anything: candidate code may write, hang and allocate.

use std::io::{self, BufRead, Write};

use core_affinity::CoreId;

/// Bytes of address space that a worker may use, where the system keeps to it. The largest
/// workload and the libraries of a batch take a few hundred MiB; a candidate that takes more finds
/// no memory, and the machine does not swap.
pub const ADDRESS_SPACE: u64 = 2 << 30;

/// Puts this process where it can do little harm. Gives its two ends of the protocol, which are
/// no longer standard input and output.
pub(crate) fn isolate() -> io::Result<(impl BufRead, impl Write)> {
    #[cfg(unix)]
    limit()?;
    private_ends()
}

/// Stays on one core, if the system lets it: timings of a process that moves are worse.
pub(crate) fn stay_on(core: usize) {
    core_affinity::set_for_current(CoreId { id: core });
}

/// Files that a process may have open, as far as is known.
pub(crate) fn open_files() -> usize {
    #[cfg(unix)]
    {
        use rustix::process::{Resource, getrlimit};
        let limit = getrlimit(Resource::Nofile).current;
        limit.map_or(usize::MAX, |limit| {
            usize::try_from(limit).unwrap_or(usize::MAX)
        })
    }
    #[cfg(not(unix))]
    usize::MAX
}

/// Bounds the memory, and leaves no core files: crashes are nothing special here.
#[cfg(unix)]
fn limit() -> io::Result<()> {
    use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
    for (resource, most) in [(Resource::As, ADDRESS_SPACE), (Resource::Core, 0)] {
        // Whoever started the worker may have set a lower limit, which stays.
        let before = getrlimit(resource).maximum;
        let most = Some(before.map_or(most, |before| before.min(most)));
        let limit = Rlimit {
            current: most,
            maximum: most,
        };
        setrlimit(resource, limit)?;
    }
    Ok(())
}

/// Moves the protocol to descriptors of its own, and lets the standard ones lead nowhere. So
/// candidate code neither writes into the protocol nor reads from it.
#[cfg(unix)]
fn private_ends() -> io::Result<(impl BufRead, impl Write)> {
    use rustix::io::fcntl_dupfd_cloexec;
    use rustix::stdio::{dup2_stderr, dup2_stdin, dup2_stdout};
    use std::fs::File;
    /// The first descriptor that is not a standard one.
    const FIRST: i32 = 3;
    let requests = File::from(fcntl_dupfd_cloexec(io::stdin(), FIRST)?);
    let events = File::from(fcntl_dupfd_cloexec(io::stdout(), FIRST)?);
    let nowhere = File::options().read(true).write(true).open("/dev/null")?;
    dup2_stdin(&nowhere)?;
    dup2_stdout(&nowhere)?;
    dup2_stderr(&nowhere)?;
    Ok((io::BufReader::new(requests), events))
}

/// Elsewhere candidate code shares the worker's output; the driver drops lines that are no event.
#[cfg(not(unix))]
fn private_ends() -> io::Result<(impl BufRead, impl Write)> {
    Ok((io::stdin().lock(), io::stdout()))
}
