//! What becomes of Ctrl-C.

use measure::{Interrupt, MeasureError};

/// Asks the interrupt to be raised by Ctrl-C; a second Ctrl-C ends the program at once.
pub fn interrupt_on_ctrl_c() -> anyhow::Result<Interrupt> {
    let interrupt = Interrupt::default();
    let raise = interrupt.clone();
    ctrlc::set_handler(move || {
        if raise.is_raised() {
            std::process::exit(130);
        }
        raise.raise();
    })?;
    Ok(interrupt)
}

/// Whether something was done to its end. If the user stopped it, that is no error yet: what was done until then
/// counts, and is told before [`Interrupted`](crate::failure::Interrupted) is.
pub fn to_its_end(done: anyhow::Result<()>) -> anyhow::Result<bool> {
    match done {
        Ok(()) => Ok(true),
        Err(error) if matches!(error.downcast_ref(), Some(MeasureError::Interrupted)) => Ok(false),
        Err(error) => Err(error),
    }
}
