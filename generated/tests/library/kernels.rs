//! Every kernel that a requirement chooses, all with the same signatures.

use std::fmt;
use std::sync::LazyLock;

use raybreed::{
    Culling, Edges, EdgesWithNormal, Hits, Isa, Lists, Numeric, Origin, Packet, Scene, Triangle,
    TriangleWithNormal, Watertight,
};

use crate::calls::{
    Call, CallWithHits, WIDTH, packet_hits, ray_any, ray_closest, ray_hits, test, unwritten,
};

/// Rays of a packet: whole vectors of every instruction set, and more than one.
pub const RAYS: usize = 32;

pub type Rays = Packet<RAYS>;

/// A scene that asks for everything, by the places of what it requires in their enumerations.
pub struct Required<
    const NUMERIC: usize,
    const WATERTIGHT: usize,
    const LISTS: usize,
    const ORIGIN: usize,
    const CULLING: usize,
>;

impl<const N: usize, const W: usize, const L: usize, const O: usize, const C: usize> Scene
    for Required<N, W, L, O, C>
{
    const NUMERIC: Numeric = [Numeric::Fast, Numeric::Portable][N];
    const WATERTIGHT: Watertight = [Watertight::No, Watertight::Edges, Watertight::Full][W];
    const LISTS: Lists = [Lists::Short, Lists::Long][L];
    const ORIGIN: Origin = [Origin::General, Origin::Common][O];
    const CULLING: Culling = [Culling::None, Culling::Back, Culling::Front][C];
    const T_MIN: bool = true;
    const UV: bool = true;
    const TRIANGLE: bool = true;
    const NORMAL: bool = true;
    const POINT: bool = true;
}

/// What rays are handed over in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Calls {
    Packet,
    CommonOrigin,
    Ray,
}

/// The functions for what a scene requires, on all instruction sets.
pub struct Family {
    pub numeric: Numeric,
    pub watertight: Watertight,
    pub lists: Lists,
    pub calls: Calls,
    closest: Call<RAYS>,
    any: Call<RAYS>,
    back_culled: Call<RAYS>,
    front_culled: Call<RAYS>,
    /// By what is stored of a triangle; first is [`Triangle`].
    hits: Vec<(&'static str, CallWithHits<RAYS>)>,
}

/// A family on an instruction set that the processor has.
#[derive(Clone, Copy)]
pub struct Kernel {
    pub family: &'static Family,
    pub isa: Isa,
}

/// The rays as a kernel leaves them, and what it reports.
#[derive(Clone)]
pub struct Answer {
    pub rays: Rays,
    pub hits: Hits<RAYS>,
}

impl Kernel {
    pub fn closest(&self, rays: &Rays, triangles: &[Triangle]) -> Rays {
        self.call(self.family.closest, rays, triangles)
    }

    pub fn any(&self, rays: &Rays, triangles: &[Triangle]) -> Rays {
        self.call(self.family.any, rays, triangles)
    }

    pub fn culled(&self, culling: Culling, rays: &Rays, triangles: &[Triangle]) -> Rays {
        let function = match culling {
            Culling::None => self.family.closest,
            Culling::Back => self.family.back_culled,
            Culling::Front => self.family.front_culled,
        };
        self.call(function, rays, triangles)
    }

    pub fn closest_hits(&self, rays: &Rays, triangles: &[Triangle]) -> Answer {
        self.call_with_hits(self.family.hits[0].1, rays, triangles)
    }

    /// What [`closest_hits`](Self::closest_hits) answers, by what is stored of a triangle.
    pub fn of_each_record(
        &self,
        rays: &Rays,
        triangles: &[Triangle],
    ) -> Vec<(&'static str, Answer)> {
        let records = self.family.hits.iter();
        records
            .map(|&(record, function)| (record, self.call_with_hits(function, rays, triangles)))
            .collect()
    }

    fn call(&self, function: Call<RAYS>, rays: &Rays, triangles: &[Triangle]) -> Rays {
        let mut rays = rays.clone();
        function(self.isa, &mut rays, triangles);
        rays
    }

    fn call_with_hits(
        &self,
        function: CallWithHits<RAYS>,
        rays: &Rays,
        triangles: &[Triangle],
    ) -> Answer {
        let mut answer = Answer {
            rays: rays.clone(),
            hits: unwritten(),
        };
        function(self.isa, &mut answer.rays, &mut answer.hits, triangles);
        answer
    }
}

impl fmt::Display for Kernel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Family {
            numeric,
            watertight,
            lists,
            calls,
            ..
        } = self.family;
        write!(
            f,
            "{numeric:?} {watertight:?} {lists:?} {calls:?} on {}",
            self.isa
        )
    }
}

/// Every family on every instruction set that the processor has.
pub fn kernels() -> &'static [Kernel] {
    static KERNELS: LazyLock<Vec<Kernel>> = LazyLock::new(|| {
        let on_all = |family| {
            available()
                .into_iter()
                .map(move |isa| Kernel { family, isa })
        };
        families().iter().flat_map(on_all).collect()
    });
    &KERNELS
}

/// The instruction sets that the processor has; the others are named.
pub fn available() -> Vec<Isa> {
    let (available, missing): (Vec<_>, Vec<_>) =
        Isa::ALL.into_iter().partition(|isa| isa.is_available());
    for isa in missing {
        eprintln!("skipped: {isa}, which this processor lacks");
    }
    available
}

/// Every requirement, with every call.
pub fn families() -> &'static [Family] {
    static FAMILIES: LazyLock<Vec<Family>> = LazyLock::new(|| {
        [
            requirement!(Fast No Short),
            requirement!(Fast No Long),
            requirement!(Fast Edges Short),
            requirement!(Fast Edges Long),
            requirement!(Fast Full Short),
            requirement!(Fast Full Long),
            requirement!(Portable No Short),
            requirement!(Portable No Long),
            requirement!(Portable Edges Short),
            requirement!(Portable Edges Long),
            requirement!(Portable Full Short),
            requirement!(Portable Full Long),
        ]
        .into_iter()
        .flatten()
        .collect()
    });
    &FAMILIES
}

/// The families of a requirement. What is watertight takes no edges.
macro_rules! requirement {
    ($numeric:ident No $lists:ident) => {
        requirement!(@records $numeric No $lists: Triangle TriangleWithNormal Edges EdgesWithNormal)
    };
    ($numeric:ident $watertight:ident $lists:ident) => {
        requirement!(@records $numeric $watertight $lists: Triangle TriangleWithNormal)
    };
    (@records $numeric:ident $watertight:ident $lists:ident: $($record:ident)+) => {{
        const N: usize = Numeric::$numeric as usize;
        const W: usize = Watertight::$watertight as usize;
        const L: usize = Lists::$lists as usize;
        let mut general = of_packets::<N, W, L, 0>(Calls::Packet);
        let mut common = of_packets::<N, W, L, 1>(Calls::CommonOrigin);
        let mut ray = of_rays::<N, W, L>();
        $(
            let record = stringify!($record);
            general.hits.push((record, packet_hits::<Required<N, W, L, 0, 0>, $record, RAYS>));
            common.hits.push((record, packet_hits::<Required<N, W, L, 1, 0>, $record, RAYS>));
            ray.hits.push((record, ray_hits::<Required<N, W, L, 0, 0>, $record, RAYS, WIDTH>));
        )+
        [general, common, ray]
    }};
}
use requirement;

fn of_packets<const N: usize, const W: usize, const L: usize, const O: usize>(
    calls: Calls,
) -> Family {
    family::<Required<N, W, L, O, 0>>(
        calls,
        |isa, rays, triangles| test::<Required<N, W, L, O, 0>>(isa).closest(rays, triangles),
        |isa, rays, triangles| test::<Required<N, W, L, O, 0>>(isa).any(rays, triangles),
        |isa, rays, triangles| test::<Required<N, W, L, O, 1>>(isa).closest(rays, triangles),
        |isa, rays, triangles| test::<Required<N, W, L, O, 2>>(isa).closest(rays, triangles),
    )
}

fn of_rays<const N: usize, const W: usize, const L: usize>() -> Family {
    family::<Required<N, W, L, 0, 0>>(
        Calls::Ray,
        ray_closest::<Required<N, W, L, 0, 0>, RAYS>,
        ray_any::<Required<N, W, L, 0, 0>, RAYS>,
        ray_closest::<Required<N, W, L, 0, 1>, RAYS>,
        ray_closest::<Required<N, W, L, 0, 2>, RAYS>,
    )
}

fn family<S: Scene>(
    calls: Calls,
    closest: Call<RAYS>,
    any: Call<RAYS>,
    back_culled: Call<RAYS>,
    front_culled: Call<RAYS>,
) -> Family {
    Family {
        numeric: S::NUMERIC,
        watertight: S::WATERTIGHT,
        lists: S::LISTS,
        calls,
        closest,
        any,
        back_culled,
        front_culled,
        hits: Vec::new(),
    }
}
