//! Rust crates that others have published: what a project could depend on instead.
//!
//! They come compiled, as Cargo builds any dependency, so they cannot be handed out as text. With the feature
//! `published` each is called as its users call it, in `code`; without it there is only the list of them.

use scene::Culling;

#[cfg(feature = "published")]
pub mod code;

/// A crate's ray-triangle test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Published {
    /// Its name in tables and on the command line, `[a-z0-9-]`. No two share one.
    pub name: &'static str,
    /// The crate.
    pub package: &'static str,
    /// Which version of it.
    pub version: &'static str,
    /// The function that is called.
    pub reference: &'static str,
    /// What it does that kernels here do not, and answers may differ for.
    pub differs: &'static str,
    /// Which side of a triangle it does not see.
    pub culling: Culling,
    /// How many numbers it keeps of a triangle, if these are not its vertices.
    pub numbers: Option<usize>,
}

/// All of them, in the order in which tables print them.
pub fn all() -> &'static [Published] {
    &PUBLISHED
}

/// The one of this name, if there is one.
///
/// ```
/// assert_eq!(rivals::published::find("bvh").unwrap().package, "bvh");
/// assert!(rivals::published::find("embree").is_none());
/// ```
pub fn find(name: &str) -> Option<&'static Published> {
    all().iter().find(|published| published.name == name)
}

static PUBLISHED: [Published; 5] = [
    Published {
        name: "obvhs",
        package: "obvhs",
        version: "0.4.0",
        reference: "obvhs::triangle::Triangle::intersect",
        differs: "from behind, two of the edges are outside (they are -0); gives no u and v",
        culling: Culling::None,
        numbers: Some(12),
    },
    Published {
        name: "obvhs-rt",
        package: "obvhs",
        version: "0.4.0",
        reference: "obvhs::rt_triangle::RtTriangle::intersect",
        differs: "as obvhs; edges and normal are stored",
        culling: Culling::None,
        numbers: Some(16),
    },
    Published {
        name: "bvh",
        package: "bvh",
        version: "0.13.0",
        reference: "bvh::ray::Ray::intersects_triangle",
        differs: "fronts alone; directions are normalised, and with that V is at least 2^-23 and the distance above it, \
                  or there is no hit",
        culling: Culling::Back,
        numbers: None,
    },
    Published {
        name: "parry3d",
        package: "parry3d",
        version: "0.31.1",
        reference: "parry3d::query::RayCast::cast_local_ray of parry3d::shape::Triangle",
        differs: "nothing in its answers; makes a unit normal for every hit before it looks at t_max, in a \
                  call that is not inlined",
        culling: Culling::None,
        numbers: None,
    },
    Published {
        name: "rayx",
        package: "rayx",
        version: "0.2.0",
        reference: "rayx::Triangle::intersect",
        differs: "no hit if V over the normal's greatest component is below 2^-23, nor if the normal's square is \
                  below 1e-20",
        culling: Culling::None,
        numbers: Some(12),
    },
];
