//! Processes that lead a group of their own and end with all of it: workers and compilers.

use std::io;
use std::process::{Child, Command, ExitStatus};

/// A process, and whatever it starts that does not leave its group.
#[must_use = "a group runs until it is ended"]
pub(crate) struct Group {
    leader: Child,
}

impl Group {
    /// Starts a process as the leader of a new group. On Linux it is killed when the thread that
    /// started it ends, whatever ends that.
    pub fn start(command: &mut Command) -> io::Result<Group> {
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(command, 0);
        #[cfg(target_os = "linux")]
        end_with_parent(command);
        let leader = command.spawn()?;
        Ok(Group { leader })
    }

    /// The process that was started.
    pub fn leader(&mut self) -> &mut Child {
        &mut self.leader
    }

    /// Whether the leader has ended. It is not waited for: until [`Group::end`], its number,
    /// which is the group's as well, is nobody else's.
    #[cfg(unix)]
    pub fn has_ended(&mut self) -> bool {
        use rustix::process::{WaitId, WaitIdOptions, waitid};
        let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
        self.number()
            .is_some_and(|number| matches!(waitid(WaitId::Pid(number), options), Ok(Some(_))))
    }

    /// Whether the leader has ended.
    #[cfg(not(unix))]
    pub fn has_ended(&mut self) -> bool {
        matches!(self.leader.try_wait(), Ok(Some(_)))
    }

    /// Kills whoever in the group still runs. No process can refuse.
    fn kill(&mut self) {
        #[cfg(unix)]
        if let Some(number) = self.number() {
            // Nobody may be left by now.
            let _ = rustix::process::kill_process_group(number, rustix::process::Signal::KILL);
        }
        let _ = self.leader.kill();
    }

    /// Kills what is left of the group. Gives the leader's status if it ended by itself.
    pub fn end(mut self) -> Option<ExitStatus> {
        let by_itself = self.has_ended();
        self.kill();
        let status = self.leader.wait().ok();
        status.filter(|_| by_itself)
    }

    #[cfg(unix)]
    fn number(&self) -> Option<rustix::process::Pid> {
        let number = i32::try_from(self.leader.id()).ok()?;
        rustix::process::Pid::from_raw(number)
    }
}

#[cfg(target_os = "linux")]
fn end_with_parent(command: &mut Command) {
    use rustix::process::{Signal, set_parent_process_death_signal};
    use std::os::unix::process::CommandExt;
    let ask = || Ok(set_parent_process_death_signal(Some(Signal::KILL))?);
    // SAFETY: between fork and exec this makes one system call; it takes no lock and allocates
    // nothing.
    unsafe { command.pre_exec(ask) };
}
