//! The library's functions with one signature, whatever rays are handed over in and triangles stored as.

use raybreed::{
    Edges, EdgesWithNormal, Hits, Intersector, Isa, Packet, Record, Scene, Triangle,
    TriangleWithNormal,
};

/// Triangles of a block: whole vectors of every instruction set.
pub const WIDTH: usize = 16;

/// Tests rays against triangles on an instruction set.
pub type Call<const N: usize> = fn(Isa, &mut Packet<N>, &[Triangle]);

/// The same, and reports hits.
pub type CallWithHits<const N: usize> = fn(Isa, &mut Packet<N>, &mut Hits<N>, &[Triangle]);

/// The test of a scene, on an instruction set that is known to be available.
pub fn test<S: Scene>(isa: Isa) -> Intersector<S> {
    Intersector::with_isa(isa).expect("only available ones are listed")
}

/// What is stored of a triangle, with its blocks.
pub trait Stored: Record<f32> + From<Triangle> {
    type Block<const W: usize>: Record<[f32; W]>;

    fn in_blocks<const W: usize>(triangles: &[Triangle]) -> Vec<Self::Block<W>>;
}

macro_rules! stored {
    ($($record:ident)+) => {$(
        impl Stored for $record {
            type Block<const W: usize> = $record<[f32; W]>;

            fn in_blocks<const W: usize>(triangles: &[Triangle]) -> Vec<Self::Block<W>> {
                let stored: Vec<$record> = triangles.iter().map(|&one| one.into()).collect();
                $record::<[f32; W]>::blocks(&stored).collect()
            }
        }
    )+};
}

stored!(Triangle TriangleWithNormal Edges EdgesWithNormal);

pub fn packet_hits<S: Scene, T: Stored, const N: usize>(
    isa: Isa,
    packet: &mut Packet<N>,
    hits: &mut Hits<N>,
    triangles: &[Triangle],
) {
    let stored: Vec<T> = triangles.iter().map(|&one| one.into()).collect();
    test::<S>(isa).closest_hits(packet, hits, &stored);
}

/// Every ray of a packet by itself, against blocks.
pub fn ray_hits<S: Scene, T: Stored, const N: usize, const W: usize>(
    isa: Isa,
    packet: &mut Packet<N>,
    hits: &mut Hits<N>,
    triangles: &[Triangle],
) {
    let blocks = T::in_blocks::<W>(triangles);
    for i in 0..N {
        let mut ray = packet.ray(i);
        let hit = test::<S>(isa).ray_closest_hit(&mut ray, &blocks);
        let is_lowered = ray.t.to_bits() != packet.t[i].to_bits();
        assert_eq!(
            hit.is_some(),
            is_lowered,
            "a hit is what lowers t: {:?}",
            packet.ray(i)
        );
        packet.set(i, ray);
        if let Some(hit) = hit {
            assert_eq!(hit.t.to_bits(), ray.t.to_bits());
            (hits.u[i], hits.v[i], hits.triangle[i]) = (hit.u, hit.v, hit.triangle);
            for axis in 0..3 {
                hits.normal[axis][i] = hit.normal[axis];
                hits.point[axis][i] = hit.point[axis];
            }
        }
    }
}

pub fn ray_closest<S: Scene, const N: usize>(
    isa: Isa,
    packet: &mut Packet<N>,
    triangles: &[Triangle],
) {
    let blocks = Triangle::in_blocks::<WIDTH>(triangles);
    for i in 0..N {
        let mut ray = packet.ray(i);
        let is_hit = test::<S>(isa).ray_closest(&mut ray, &blocks);
        let is_lowered = ray.t.to_bits() != packet.t[i].to_bits();
        assert_eq!(
            is_hit,
            is_lowered,
            "a hit is what lowers t: {:?}",
            packet.ray(i)
        );
        packet.set(i, ray);
    }
}

/// As of packets, `t` of what has a hit becomes negative infinity.
pub fn ray_any<S: Scene, const N: usize>(isa: Isa, packet: &mut Packet<N>, triangles: &[Triangle]) {
    let blocks = Triangle::in_blocks::<WIDTH>(triangles);
    for i in 0..N {
        if test::<S>(isa).ray_any(&packet.ray(i), &blocks) {
            packet.t[i] = f32::NEG_INFINITY;
        }
    }
}

/// What nobody has written to: a NaN like no other.
pub const UNWRITTEN: u32 = 0xffc0_5eed;

pub fn unwritten<const N: usize>() -> Hits<N> {
    let lanes = [f32::from_bits(UNWRITTEN); N];
    Hits {
        u: lanes,
        v: lanes,
        triangle: [UNWRITTEN; N],
        normal: [lanes; 3],
        point: [lanes; 3],
        first: 0,
    }
}
