//! The part of a kernel's assembly that a person wants to read: the one function that does the work.

use emit::Kernel;

use crate::assembly::is_arithmetic;
use crate::rustc::Rustc;

/// The assembly of a kernel's function, without what is there for linkers and debuggers; none if the kernel is no text,
/// or does not compile.
pub fn kernel_assembly(rustc: &Rustc, kernel: &Kernel) -> Option<String> {
    if kernel.library.is_some() {
        return None;
    }
    let alone = Kernel {
        prepare: None,
        ..kernel.clone()
    };
    let assembly = rustc.assembly(&emit::library(&[alone]))?;
    hot_function(&assembly)
}

/// The function with the most arithmetic.
fn hot_function(assembly: &str) -> Option<String> {
    let mut functions: Vec<Vec<&str>> = Vec::new();
    for line in assembly.lines() {
        let code = line.trim();
        let is_label = code.ends_with(':') && !code.contains(char::is_whitespace);
        let is_local = code.starts_with(".L");
        let is_directive = code.starts_with('.') && !is_label;
        if is_label && !is_local {
            functions.push(vec![line]);
        } else if let Some(function) = functions.last_mut()
            // Labels that nothing jumps to are of the unwinder.
            && !(is_directive || code.is_empty() || code.starts_with(".Lfunc"))
        {
            function.push(line);
        }
    }
    let arithmetic = |function: &Vec<&str>| {
        let lines = function.iter().filter(|line| is_arithmetic(line.trim()));
        lines.count()
    };
    let function = functions.into_iter().max_by_key(arithmetic)?;
    (arithmetic(&function) > 0).then(|| function.join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO: &str = "\
\t.text
\t.globl\tfirst
first:
\t.cfi_startproc
\taddps\t%xmm0, %xmm1
\tretq
.Lfunc_end0:
\t.size\tfirst, .Lfunc_end0-first
second:
\t.cfi_startproc
.LBB1_1:
\tmulps\t%xmm0, %xmm1
\taddps\t%xmm0, %xmm1
\tjne\t.LBB1_1
\tretq
.Lfunc_end1:
";

    #[test]
    fn of_several_functions_the_one_with_the_most_arithmetic_is_shown_without_directives() {
        let function = hot_function(TWO).unwrap();
        assert_eq!(
            function,
            "second:\n.LBB1_1:\n\tmulps\t%xmm0, %xmm1\n\taddps\t%xmm0, %xmm1\n\tjne\t.LBB1_1\n\tretq"
        );
        assert_eq!(hot_function("main:\n\tretq\n"), None);
        assert_eq!(hot_function(""), None);
    }
}
