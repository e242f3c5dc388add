//! A kernel's hot path in its assembly, and what llvm-mca says of it.
//!
//! Most tests end at the first exit. That way through the innermost loop is the shortest one, and is found
//! without knowing anything of the kernel: among the loops of the machine code that hold no other, the one with
//! the most arithmetic, and in it the way of the fewest instructions from its head to its head.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::io::Write;
use std::process::{Command, Stdio};

use emit::{Isa, Kernel};

use crate::rustc::Rustc;

/// Names that Debian and others give it, the plain one first.
const NAMES: [&str; 9] = [
    "llvm-mca",
    "llvm-mca-22",
    "llvm-mca-21",
    "llvm-mca-20",
    "llvm-mca-19",
    "llvm-mca-18",
    "llvm-mca-17",
    "llvm-mca-16",
    "llvm-mca-15",
];

/// How often llvm-mca goes through a loop.
const ITERATIONS: u32 = 100;

/// llvm-mca, which estimates how long this processor takes for a piece of assembly.
#[derive(Clone, Debug)]
pub struct Mca(&'static str);

impl Mca {
    /// It, if it is installed.
    pub fn find() -> Option<Mca> {
        let answers = |name: &&&str| {
            let mut command = Command::new(name);
            command.arg("--version").stdout(Stdio::null());
            command.stderr(Stdio::null());
            command.status().is_ok_and(|status| status.success())
        };
        NAMES.iter().find(answers).map(|name| Mca(name))
    }

    /// Its estimate, in cycles, for a test of one ray and one triangle that leaves at the first exit; none for
    /// kernels that are no text, and those whose hot path it does not understand.
    pub fn cycles(&self, rustc: &Rustc, kernel: &Kernel) -> Option<f64> {
        if kernel.library.is_some() {
            return None;
        }
        // The precomputation would be another loop.
        let test = Kernel {
            prepare: None,
            ..kernel.clone()
        };
        let assembly = rustc.assembly(&emit::library(&[test]))?;
        let path = hot_path(&assembly)?;
        let tests = path.vectors(kernel.isa) * kernel.isa.lane_count();
        let cycles = self.total_cycles(&path.instructions)? / f64::from(ITERATIONS);
        Some(cycles / tests as f64)
    }

    fn total_cycles(&self, instructions: &[&str]) -> Option<f64> {
        let mut mca = Command::new(self.0)
            .args(["-mtriple=x86_64-unknown-linux-gnu", "-iterations"])
            .arg(ITERATIONS.to_string())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .ok()?;
        let mut stdin = mca.stdin.take()?;
        stdin.write_all(instructions.join("\n").as_bytes()).ok()?;
        drop(stdin);
        let output = mca.wait_with_output().ok()?;
        let said = String::from_utf8_lossy(&output.stdout);
        let cycles = said
            .lines()
            .find_map(|line| line.strip_prefix("Total Cycles:"))?;
        cycles.trim().parse().ok()
    }
}

/// The way of most tests through a kernel's innermost loop.
#[derive(Debug, PartialEq, Eq)]
struct Path<'a> {
    instructions: Vec<&'a str>,
}

impl Path<'_> {
    /// How many vectors of tests it makes: a compiler may have unrolled the loop. Each has its exit, which asks
    /// whether a mask is empty.
    fn vectors(&self, isa: Isa) -> usize {
        const ASK: [&str; 7] = [
            "movmskps",
            "vmovmskps",
            "vtestps",
            "ptest",
            "vptest",
            "kortest",
            "ktest",
        ];
        if isa == Isa::Scalar {
            return 1;
        }
        let asks = |line: &&&str| ASK.iter().any(|ask| line.starts_with(ask));
        self.instructions.iter().filter(asks).count().max(1)
    }
}

/// Instructions up to a label or a jump, and where they go on.
#[derive(Debug, Default)]
struct Block<'a> {
    instructions: Vec<&'a str>,
    next: Vec<usize>,
}

/// The hot path of the function with the most arithmetic in an innermost loop.
fn hot_path(assembly: &str) -> Option<Path<'_>> {
    let blocks = blocks(assembly);
    let loops = loops(&blocks);
    let is_innermost = |(head, body): &(&usize, &BTreeSet<usize>)| {
        let mut others = loops.keys().filter(|other| other != head);
        !others.any(|other| body.contains(other))
    };
    let arithmetic = |body: &BTreeSet<usize>| -> usize {
        let instructions = body.iter().flat_map(|&block| &blocks[block].instructions);
        instructions.filter(|line| is_arithmetic(line)).count()
    };
    let (&head, body) = loops
        .iter()
        .filter(is_innermost)
        .max_by_key(|(_, body)| arithmetic(body))?;
    let way = shortest_round(&blocks, head, body)?;
    let instructions = way.iter().flat_map(|&block| &blocks[block].instructions);
    Some(Path {
        instructions: instructions.copied().collect(),
    })
}

/// Whether an instruction computes with numbers of 32 bits.
pub(crate) fn is_arithmetic(line: &str) -> bool {
    let name = line.split_whitespace().next().unwrap_or("");
    let name = name.strip_prefix('v').unwrap_or(name);
    let computes = [
        "add", "sub", "mul", "div", "fm", "fnm", "cmp", "min", "max", "rcp", "ucomi",
    ];
    (name.ends_with("ps") || name.ends_with("ss"))
        && computes.iter().any(|start| name.starts_with(start))
}

/// The blocks of all functions, in order.
fn blocks(assembly: &str) -> Vec<Block<'_>> {
    let mut blocks = vec![Block::default()];
    let mut labels: HashMap<&str, usize> = HashMap::new();
    // Jumps, by the block that they end.
    let mut jumps: Vec<(usize, &str)> = Vec::new();
    for line in assembly.lines() {
        let code = line.split('#').next().unwrap_or("").trim();
        if let Some(label) = code.strip_suffix(':') {
            let falls_through = label.starts_with(".L");
            let before = blocks.len() - 1;
            blocks.push(Block::default());
            if falls_through && !ends(&blocks[before]) {
                blocks[before].next.push(before + 1);
            }
            labels.insert(label, before + 1);
            continue;
        }
        if code.is_empty() || code.starts_with('.') {
            continue;
        }
        let block = blocks.len() - 1;
        blocks[block].instructions.push(code);
        if let Some((name, target)) = code.split_once(char::is_whitespace)
            && name.starts_with('j')
        {
            jumps.push((block, target.trim()));
            blocks.push(Block::default());
            if name != "jmp" {
                blocks[block].next.push(block + 1);
            }
        }
    }
    for (block, target) in jumps {
        blocks[block].next.extend(labels.get(target).copied());
    }
    blocks
}

/// Whether nothing comes after a block's last instruction.
fn ends(block: &Block<'_>) -> bool {
    let last = block.instructions.last();
    last.is_some_and(|line| line.starts_with("ret") || line.starts_with("jmp") || *line == "ud2")
}

/// Loops by their heads: the blocks that are on some way from the head to itself.
fn loops(blocks: &[Block<'_>]) -> BTreeMap<usize, BTreeSet<usize>> {
    let mut before: Vec<Vec<usize>> = vec![Vec::new(); blocks.len()];
    for (number, block) in blocks.iter().enumerate() {
        for &next in &block.next {
            before[next].push(number);
        }
    }
    let mut loops: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for (tail, head) in back_edges(blocks) {
        let body = loops.entry(head).or_insert_with(|| BTreeSet::from([head]));
        let mut to_see = vec![tail];
        while let Some(block) = to_see.pop() {
            if body.insert(block) {
                to_see.extend(&before[block]);
            }
        }
    }
    loops
}

/// Edges to a block that the walk is in the middle of.
fn back_edges(blocks: &[Block<'_>]) -> Vec<(usize, usize)> {
    let mut seen = vec![false; blocks.len()];
    let mut edges = Vec::new();
    for root in 0..blocks.len() {
        // The way from the root, each block with how many of its edges were followed.
        let mut way: Vec<(usize, usize)> = Vec::new();
        if !seen[root] {
            seen[root] = true;
            way.push((root, 0));
        }
        while let Some((block, followed)) = way.last_mut() {
            let block = *block;
            let Some(&next) = blocks[block].next.get(*followed) else {
                way.pop();
                continue;
            };
            *followed += 1;
            if way.iter().any(|(on_way, _)| *on_way == next) {
                edges.push((block, next));
            } else if !seen[next] {
                seen[next] = true;
                way.push((next, 0));
            }
        }
    }
    edges
}

/// The way of the fewest instructions from a loop's head to itself.
fn shortest_round(blocks: &[Block<'_>], head: usize, body: &BTreeSet<usize>) -> Option<Vec<usize>> {
    // Dijkstra's algorithm; bodies have a dozen blocks.
    let mut ways: BTreeMap<usize, (usize, Vec<usize>)> = BTreeMap::new();
    let mut done: BTreeSet<usize> = BTreeSet::new();
    let mut here = (0, vec![head]);
    loop {
        let block = *here.1.last()?;
        let length = here.0 + blocks[block].instructions.len();
        for &next in blocks[block].next.iter().filter(|next| body.contains(next)) {
            let known = ways.get(&next).map(|(length, _)| *length);
            if !done.contains(&next) && known.is_none_or(|known| length < known) {
                let way = here.1.iter().copied().chain([next]).collect();
                ways.insert(next, (length, way));
            }
        }
        let nearest = ways.iter().min_by_key(|(_, (length, _))| *length);
        let (&nearest, _) = nearest?;
        here = ways.remove(&nearest)?;
        if nearest == head {
            here.1.pop();
            return Some(here.1);
        }
        done.insert(nearest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows in triangles; the first exit is taken by jumping over the second half.
    const NESTED: &str = "\
kernel:
\t.cfi_startproc
\ttestq %rcx, %rcx
\tje .LBB0_6
.LBB0_1:
\tmovss (%rsi), %xmm0
\txorl %eax, %eax
.LBB0_2:
\tmulps %xmm0, %xmm1
\tmovmskps %xmm1, %edx
\ttestl %edx, %edx
\tje .LBB0_4
\taddps %xmm0, %xmm1
\tdivps %xmm0, %xmm1
.LBB0_4:
\taddq $16, %rax
\tcmpq $256, %rax
\tjne .LBB0_2
\tdecq %rcx
\tjne .LBB0_1
.LBB0_6:
\tretq
";

    #[test]
    fn the_hot_path_leaves_at_the_first_exit_of_the_innermost_loop() {
        let path = hot_path(NESTED).unwrap();
        let names = path.instructions.iter();
        let names: Vec<&str> = names.filter_map(|line| line.split(' ').next()).collect();
        assert_eq!(
            names,
            ["mulps", "movmskps", "testl", "je", "addq", "cmpq", "jne"]
        );
        assert_eq!(path.vectors(Isa::Sse2), 1);
    }

    #[test]
    fn an_unrolled_loop_has_several_vectors_of_tests() {
        let twice = NESTED.replace(
            "\taddq $16, %rax\n",
            "\tmulps %xmm0, %xmm2\n\tmovmskps %xmm2, %edx\n\taddq $32, %rax\n",
        );
        assert_eq!(hot_path(&twice).unwrap().vectors(Isa::Sse2), 2);
    }

    #[test]
    fn straight_code_has_no_hot_path() {
        assert_eq!(hot_path("kernel:\n\tmulps %xmm0, %xmm1\n\tretq\n"), None);
        assert_eq!(hot_path(""), None);
    }
}
