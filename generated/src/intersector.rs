//! The test that a program calls: what its scene requires, with the instructions that its processor has.

use core::marker::PhantomData;

use crate::entry::Entry;
use crate::isa::Isa;
use crate::kernels::choice;
use crate::ray::{Hit, Hits, Packet, Ray};
use crate::scene::{Origin, Scene, Watertight};
use crate::triangle::Record;

/// The test for a scene, on this processor.
///
/// It is made once, and is as large as a byte. A packet of rays is tested against a slice of triangles; one ray
/// against a slice of blocks of them. No input makes it panic; what is no hit leaves everything as it was.
///
/// ```
/// use raybreed::{Intersector, Packet, Ray, Triangle};
///
/// let triangle = Triangle::new([-1.0, -1.0, 5.0], [1.0, -1.0, 5.0], [0.0, 1.0, 5.0]);
/// let mut packet = Packet::<64>::new();
/// packet.set(0, Ray::new([0.0; 3], [0.0, 0.0, 1.0]));
///
/// let test = Intersector::<()>::new();
/// test.closest(&mut packet, &[triangle]);
/// assert_eq!(packet.t[0], 5.0);
/// ```
#[derive(Debug)]
pub struct Intersector<S: Scene = ()> {
    isa: Isa,
    scene: PhantomData<fn() -> S>,
}

impl<S: Scene> Intersector<S> {
    /// The test with the widest instructions that the processor has.
    #[inline]
    pub fn new() -> Self {
        let isa = Isa::detect();
        // SAFETY: it has been detected.
        unsafe { Self::with_isa_unchecked(isa) }
    }

    /// The test with these instructions, if the processor has them.
    #[inline]
    pub fn with_isa(isa: Isa) -> Option<Self> {
        // SAFETY: it is available.
        isa.is_available()
            .then(|| unsafe { Self::with_isa_unchecked(isa) })
    }

    /// The test with these instructions, whether the processor has them or not.
    ///
    /// # Safety
    ///
    /// The processor must have them and all that are narrower: where [`Isa::is_available`] is true it has.
    #[inline]
    pub const unsafe fn with_isa_unchecked(isa: Isa) -> Self {
        Intersector {
            isa,
            scene: PhantomData,
        }
    }

    /// The instructions that it has. Where numbers do not fill their vectors, narrower ones are used: AVX2 for blocks
    /// of 8 triangles, or packets of 8 rays.
    #[inline]
    pub const fn isa(self) -> Isa {
        self.isa
    }

    /// The kernel that is called for packets of `N` rays.
    ///
    /// ```
    /// use raybreed::{Intersector, Isa};
    ///
    /// let test = Intersector::<()>::with_isa(Isa::Scalar).unwrap();
    /// assert_eq!(test.packet_kernel::<64>().name, "packet-leaf");
    /// ```
    pub fn packet_kernel<const N: usize>(self) -> &'static Entry {
        let isa = self.isa.of_whole_vectors(N);
        Entry::find(match S::ORIGIN {
            Origin::General => choice::packet_name::<S>(isa),
            Origin::Common => choice::common_origin_name::<S>(isa),
        })
    }

    /// The kernel that is called for a ray and blocks of `W` triangles.
    pub fn ray_kernel<const W: usize>(self) -> &'static Entry {
        Entry::find(choice::ray_name::<S>(self.isa.of_whole_vectors(W)))
    }

    /// Lowers each `packet.t[i]` to the closest hit of ray `i` with any of `triangles`, if there is one between
    /// `packet.t_min[i]`, or zero, and it.
    #[inline]
    pub fn closest<const N: usize, T: Record<f32>>(self, packet: &mut Packet<N>, triangles: &[T]) {
        self.packet::<N, 0, false, T>(packet, &mut Hits::new(), triangles);
    }

    /// The same as [`closest`](Self::closest), and reports of each ray whose `t` was lowered what the scene asks for.
    #[inline]
    pub fn closest_hits<const N: usize, T: Record<f32>>(
        self,
        packet: &mut Packet<N>,
        hits: &mut Hits<N>,
        triangles: &[T],
    ) {
        self.packet::<N, N, false, T>(packet, hits, triangles);
    }

    /// Makes each `packet.t[i]` negative infinity if ray `i` hits any of `triangles`: the ray is inactive then. These
    /// are the rays whose `t` [`closest`](Self::closest) would lower.
    #[inline]
    pub fn any<const N: usize, T: Record<f32>>(self, packet: &mut Packet<N>, triangles: &[T]) {
        self.packet::<N, 0, true, T>(packet, &mut Hits::new(), triangles);
    }

    /// Lowers `ray.t` to the closest hit with any triangle of `blocks`, if there is one; says whether there is.
    #[inline]
    pub fn ray_closest<const W: usize, T: Record<[f32; W]>>(
        self,
        ray: &mut Ray,
        blocks: &[T],
    ) -> bool {
        let t = self.ray::<0, false, W, T>(ray, &mut Hits::new(), blocks);
        let is_hit = t < ray.t;
        ray.t = t;
        is_hit
    }

    /// The same as [`ray_closest`](Self::ray_closest), with what the scene asks for of the hit. Of hits at the same
    /// `t` the first triangle's counts.
    #[inline]
    pub fn ray_closest_hit<const W: usize, T: Record<[f32; W]>>(
        self,
        ray: &mut Ray,
        blocks: &[T],
    ) -> Option<Hit> {
        let mut hits = Hits::<1>::new();
        let t = self.ray::<1, false, W, T>(ray, &mut hits, blocks);
        let is_hit = t < ray.t;
        ray.t = t;
        is_hit.then(|| hits.hit(0, t))
    }

    /// Whether the ray hits any triangle of `blocks`: whether [`ray_closest`](Self::ray_closest) would find one.
    #[inline]
    pub fn ray_any<const W: usize, T: Record<[f32; W]>>(self, ray: &Ray, blocks: &[T]) -> bool {
        self.ray::<0, true, W, T>(ray, &mut Hits::new(), blocks) < ray.t
    }

    /// Calls the kernel for a packet; reported are hits of `M` rays, all or none.
    #[inline]
    fn packet<const N: usize, const M: usize, const ANY: bool, T: Record<f32>>(
        self,
        packet: &mut Packet<N>,
        hits: &mut Hits<M>,
        triangles: &[T],
    ) {
        const { assert_fits::<S>(T::EDGES) };
        if N == 0 {
            return;
        }
        let isa = self.isa.of_whole_vectors(N);
        // SAFETY: the processor has what this was made with, and what is narrower.
        unsafe {
            if const { matches!(S::ORIGIN, Origin::Common) } {
                choice::common_origin::<N, M, ANY, S, T>(isa, packet, hits, triangles);
            } else {
                choice::packet::<N, M, ANY, S, T>(isa, packet, hits, triangles);
            }
        }
    }

    /// Calls the kernel for one ray, and gives its `t` after that.
    #[inline]
    fn ray<const M: usize, const ANY: bool, const W: usize, T: Record<[f32; W]>>(
        self,
        ray: &Ray,
        hits: &mut Hits<M>,
        blocks: &[T],
    ) -> f32 {
        const { assert_fits::<S>(T::EDGES) };
        let isa = self.isa.of_whole_vectors(W);
        // SAFETY: the processor has what this was made with, and what is narrower.
        unsafe { choice::ray::<M, ANY, W, S, T>(isa, ray, hits, blocks) }
    }
}

/// Refuses what cannot be had together.
const fn assert_fits<S: Scene>(edges: bool) {
    assert!(
        !edges || matches!(S::WATERTIGHT, Watertight::No),
        "what is watertight compares vertices that triangles share: store vertices instead of edges"
    );
}

impl<S: Scene> Clone for Intersector<S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Scene> Copy for Intersector<S> {}

impl<S: Scene> Default for Intersector<S> {
    fn default() -> Self {
        Self::new()
    }
}
