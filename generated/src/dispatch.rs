//! From what a scene requires to the kernel that is called: the scene is known to the compiler, the instruction set
//! is not. Which kernel it is, `kernels/choice.rs` says, a line for each requirement.

use crate::scene::{Lists, Numeric, Scene, Watertight};

/// Whether a scene requires this of its kernels.
pub(crate) const fn requires<S: Scene>(
    numeric: Numeric,
    watertight: Watertight,
    lists: Lists,
) -> bool {
    S::NUMERIC as u8 == numeric as u8
        && S::WATERTIGHT as u8 == watertight as u8
        && S::LISTS as u8 == lists as u8
}

/// Makes a function that calls the kernel of a requirement and an instruction set, and one that says which it is.
///
/// Only the branch of what the scene requires is ever compiled, and in it only vectors that numbers fill.
macro_rules! kernels {
    (
        $(#[$about:meta])*
        packet fn $name:ident, $which:ident { $($choices:tt)* }
    ) => {
        kernels! {
            @functions
            $(#[$about])*
            $name, $which
            [const N: usize, const M: usize, const ANY: bool, S: Scene, T: Record<f32>]
            [packet: &mut Packet<N>, hits: &mut Hits<M>, triangles: &[T]] []
            $($choices)*
            => N [N, M, ANY, S, T] [packet, hits, triangles]
        }
    };
    (
        $(#[$about:meta])*
        ray fn $name:ident, $which:ident { $($choices:tt)* }
    ) => {
        kernels! {
            @functions
            $(#[$about])*
            $name, $which
            [const M: usize, const ANY: bool, const W: usize, S: Scene, T: Record<[f32; W]>]
            [ray: &Ray, hits: &mut Hits<M>, blocks: &[T]] [-> f32]
            $($choices)*
            => W [M, ANY, W, S, T] [ray, hits, blocks]
        }
    };
    (
        @functions
        $(#[$about:meta])*
        $name:ident, $which:ident [$($generics:tt)*] [$($parameters:tt)*] [$($gives:tt)*]
        $(
            $numeric:ident $watertight:ident $lists:ident:
            $s_module:ident::$s:ident $two_module:ident::$two:ident $four_module:ident::$four:ident
            $avx_module:ident::$avx:ident $wide_module:ident::$wide:ident;
        )*
        => $count:ident $arguments:tt $values:tt
    ) => {
        $(#[$about])*
        ///
        /// # Safety
        ///
        /// The processor has the instruction set, and the numbers that are tested together are whole vectors of it.
        #[inline]
        pub(crate) unsafe fn $name<$($generics)*>(isa: Isa, $($parameters)*) $($gives)* {
            $(
                if const { requires::<S>(Numeric::$numeric, Watertight::$watertight, Lists::$lists) } {
                    // SAFETY: the caller knows that the processor has the instruction set.
                    #[allow(unused_unsafe, reason = "scalar kernels are safe, and elsewhere there are no others")]
                    return unsafe {
                        match isa {
                            #[cfg(target_arch = "x86_64")]
                            Isa::Sse2 => kernels!(@call 4 $count $two_module $two $arguments $values),
                            #[cfg(target_arch = "x86_64")]
                            Isa::Sse41 => kernels!(@call 4 $count $four_module $four $arguments $values),
                            #[cfg(target_arch = "x86_64")]
                            Isa::Avx2 => kernels!(@call 8 $count $avx_module $avx $arguments $values),
                            #[cfg(target_arch = "x86_64")]
                            Isa::Avx512 => kernels!(@call 16 $count $wide_module $wide $arguments $values),
                            _ => kernels!(@call 1 $count $s_module $s $arguments $values),
                        }
                    };
                }
            )*
            unreachable!("every requirement has its kernels")
        }

        /// The module and the name of the function that is called.
        pub(crate) const fn $which<S: Scene>(isa: Isa) -> (&'static str, &'static str) {
            $(
                if requires::<S>(Numeric::$numeric, Watertight::$watertight, Lists::$lists) {
                    return match isa {
                        Isa::Scalar => (stringify!($s_module), stringify!($s)),
                        Isa::Sse2 => (stringify!($two_module), stringify!($two)),
                        Isa::Sse41 => (stringify!($four_module), stringify!($four)),
                        Isa::Avx2 => (stringify!($avx_module), stringify!($avx)),
                        Isa::Avx512 => (stringify!($wide_module), stringify!($wide)),
                    };
                }
            )*
            unreachable!()
        }
    };
    (@call $lanes:literal $count:ident $module:ident $kernel:ident [$($argument:tt)*] [$($value:tt)*]) => {
        if const { $count.is_multiple_of($lanes) } {
            super::$module::$kernel::<$($argument)*>($($value)*)
        } else {
            unreachable!("whole vectors")
        }
    };
}

pub(crate) use kernels;
