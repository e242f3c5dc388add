//! What makes genomes of genomes, and who is drawn to be their parent.
//!
//! Every operator gives permutations, and a permutation always picks a legal program. The paper's know no more
//! than that, so most of what they change is dead: of 1294 nodes about a hundred are live. The [moves](flip) know
//! the graph, and change what is live.

mod moves;
mod parents;
mod permutation;

pub use moves::{flip, graft, slide};
pub use parents::{draw_parent, tournament};
pub(crate) use permutation::random_cut;
pub use permutation::{crossover, mutate};
