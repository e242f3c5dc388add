//! The words of a scene model: what each field may say.

use serde::{Deserialize, Serialize};

/// Makes the enum of a field: its words, each with its meaning, and how it is read and shown.
macro_rules! words {
    ($(#[$about:meta])* $name:ident: $what:literal { $($(#[$doc:meta])* $variant:ident = $word:literal,)+ }) => {
        $(#[$about])*
        #[derive(
            Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
        )]
        pub enum $name {
            $($(#[$doc])* #[serde(rename = $word)] $variant,)+
        }

        impl $name {
            /// All of them, in the order in which they are explained.
            pub const ALL: &[$name] = &[$($name::$variant),+];

            /// The word for it in files and on the command line.
            pub fn word(self) -> &'static str {
                match self {
                    $($name::$variant => $word,)+
                }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.word())
            }
        }

        impl std::str::FromStr for $name {
            type Err = UnknownWord;

            fn from_str(word: &str) -> Result<$name, UnknownWord> {
                let known = || $name::ALL.iter().map(|one| one.word()).collect::<Vec<_>>();
                let found = $name::ALL.iter().find(|one| one.word() == word);
                found.copied().ok_or_else(|| UnknownWord {
                    what: $what,
                    word: word.chars().take(40).collect(),
                    known: known().join(", "),
                })
            }
        }
    };
}

/// A field does not have this word.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown {what} {word:?}; known: {known}")]
pub struct UnknownWord {
    what: &'static str,
    word: String,
    known: String,
}

words! {
    /// What one kernel call takes.
    Grouping: "grouping" {
        /// A packet of rays and a slice of triangles: work on a triangle is shared by the packet.
        #[default]
        Packet = "packet",
        /// One ray and a slice of blocks, each of as many triangles as a vector has lanes: the
        /// closest hit of them all. Work on the ray is shared by the triangles.
        Single = "single",
        /// One ray and a slice of triangles, one after the other.
        Scalar = "scalar",
    }
}

words! {
    /// Where the rays of a packet start.
    Origin: "origin" {
        /// Anywhere.
        #[default]
        General = "general",
        /// All in one point, as primary rays and shadow rays to a point light do: work without
        /// the direction is shared by the packet.
        Common = "common",
    }
}

words! {
    /// What is asked of a ray.
    Query: "query" {
        /// Its closest hit.
        #[default]
        Closest = "closest",
        /// Whether there is a hit at all, as for shadows: no `t` is reported, and what has been
        /// hit is not looked at again.
        Any = "any",
    }
}

words! {
    /// Which side of a triangle is not there. The front is where its vertices are seen
    /// counterclockwise.
    Culling: "culling" {
        /// Neither: triangles are seen from both sides.
        #[default]
        None = "none",
        /// Rays pass through a triangle from its back.
        Back = "back",
        /// Rays pass through a triangle from its front.
        Front = "front",
    }
}

words! {
    /// What is reported of a closest hit.
    Output: "output" {
        /// The ray parameter. Always.
        #[default]
        T = "t",
        /// The barycentric coordinates of `p1` and `p2`.
        Uv = "uv",
        /// Which triangle it was.
        Triangle = "triangle",
        /// The triangle's normal, of any length.
        Normal = "normal",
        /// Where it is.
        Point = "point",
    }
}

words! {
    /// Between which ends a hit counts: strictly between them, whatever they are.
    Range: "range" {
        /// 0 and `t_max`.
        #[default]
        TMax = "t_max",
        /// `t_min` and `t_max`; a negative `t_min` is 0.
        TMinMax = "t_min..t_max",
        /// The two ends of a segment: its origin, and a point instead of a direction. `t` is 1
        /// there, and `t_max` at most that.
        Segment = "segment",
    }
}

words! {
    /// What is kept of a triangle, computed once.
    Stored: "stored data" {
        /// Its vertices, 36 bytes.
        #[default]
        Vertices = "vertices",
        /// Its vertices and normal, 48 bytes.
        VerticesAndNormal = "vertices+normal",
        /// A vertex and two edges, 36 bytes.
        Edges = "edges",
        /// A vertex, two edges and the normal, 48 bytes.
        EdgesAndNormal = "edges+normal",
    }
}

words! {
    /// What the arithmetic of a kernel may be.
    Numeric: "numeric policy" {
        /// Estimates of reciprocals too, with a Newton step, and fused operations. They differ
        /// between instruction sets, and between makers of processors.
        #[default]
        Fast = "fast",
        /// Only what every processor rounds alike: one program has the same answers, to the last
        /// bit, on every instruction set.
        Portable = "portable",
    }
}

words! {
    /// How a workload treats `t`, which is what a kernel is bred on. A claim about speed holds for one
    /// regime.
    Regime: "regime" {
        /// `t` is the best so far through a long list of triangles, as in Kensler-Shirley's appendix.
        /// After a few hundred triangles the far test rejects nearly everything.
        #[default]
        Shrinking = "shrinking",
        /// `t` never rejects: Havel-Herout's worst case. Hits are stored in the packet's `hit_t`, the
        /// last one in the list's order staying there, and `t` is left alone.
        Fixed = "fixed",
        /// Lists of [`LEAF_TRIANGLES`](crate::LEAF_TRIANGLES) triangles, `t` reset before each: a BVH
        /// leaf.
        Leaf = "leaf",
    }
}

words! {
    /// How long the directions of rays are, as bounds have it.
    Directions: "length of directions" {
        /// Of any length.
        #[default]
        Any = "any",
        /// One.
        Unit = "unit",
    }
}

words! {
    /// Where a closed mesh may let a ray through.
    Watertight: "watertightness" {
        /// At edges and vertices, now and then.
        #[default]
        None = "none",
        /// At vertices only: an edge is the same for both of its triangles.
        Edges = "edges",
        /// Nowhere: a vertex, too, is the same for all of its triangles.
        Full = "full",
    }
}
