//! The loop that a regime makes around a kernel. It is what gets timed.

use crate::{Packet, RayHits, RayPacket, Regime, Triangle};

/// A kernel as candidates, rivals and the library's kernels are exported: a packet of rays, what is
/// reported of their hits, and the records of a list of triangles in the kernel's [`Layout`].
///
/// # Safety
///
/// `packet` and `hits` are valid for reads and writes and aligned, nothing else refers to them
/// during the call, `records` is valid for reads of `count` records, and the CPU has the ISA that
/// the kernel was emitted for.
///
/// [`Layout`]: crate::Layout
pub type KernelFn = unsafe extern "C" fn(
    packet: *mut RayPacket,
    hits: *mut RayHits,
    records: *const f32,
    count: usize,
);

/// What makes records of triangles for a kernel that has its own: of each as many numbers as its
/// [`Layout`](crate::Layout) says, one record after another.
///
/// # Safety
///
/// The first pointer is valid for `count` triangles, the second one for the numbers of as many records.
pub type PrepareFn =
    unsafe extern "C" fn(triangles: *const Triangle, count: usize, records: *mut f32);

/// Runs `kernel` over packets in `regime`, with `scratch` for the packets that it writes to.
///
/// Each packet sees the lists in turn. `t` is reset to what it was `initial`ly before each list,
/// `hit_t` before each packet. So every run leaves the same in `scratch`: the answers of each
/// packet's last list. Nothing is allocated.
///
/// `scratch` starts as a copy of `initial`; its origins and directions are not refreshed.
///
/// # Panics
///
/// `scratch` and `initial` differ in length.
pub fn drive<L>(
    initial: &[RayPacket],
    lists: impl Iterator<Item = L> + Clone,
    scratch: &mut [RayPacket],
    mut kernel: impl FnMut(&mut RayPacket, L),
) {
    drive_together(1, initial, lists, scratch, |packets, list| {
        kernel(&mut packets[0], list);
    });
}

/// The same with a kernel that takes so many packets at once; what is left over at the end is not run.
///
/// # Panics
///
/// `scratch` and `initial` differ in length, or no packets are taken at once.
pub fn drive_together<L>(
    together: usize,
    initial: &[RayPacket],
    lists: impl Iterator<Item = L> + Clone,
    scratch: &mut [RayPacket],
    mut kernel: impl FnMut(&mut [RayPacket], L),
) {
    assert_eq!(scratch.len(), initial.len(), "one scratch packet each");
    let chunks = scratch.chunks_exact_mut(together);
    for (packets, initial) in chunks.zip(initial.chunks_exact(together)) {
        for (packet, initial) in packets.iter_mut().zip(initial) {
            packet.hit_t = initial.hit_t;
        }
        for list in lists.clone() {
            for (packet, initial) in packets.iter_mut().zip(initial) {
                packet.t = initial.t;
            }
            kernel(packets, list);
        }
    }
}

/// Where the answers of a kernel built for `regime` are: `hit_t` in [`Regime::Fixed`], else `t`.
/// A ray without a hit has there what it had before.
pub fn answers<const N: usize>(regime: Regime, packet: &Packet<N>) -> &[f32; N] {
    match regime {
        Regime::Shrinking | Regime::Leaf => &packet.t,
        Regime::Fixed => &packet.hit_t,
    }
}

/// A packet's rays: x, y and z of the origins, then of the directions.
pub fn rays<const N: usize>(packet: &Packet<N>) -> [&[f32; N]; 6] {
    let Packet {
        ox,
        oy,
        oz,
        dx,
        dy,
        dz,
        ..
    } = packet;
    [ox, oy, oz, dx, dy, dz]
}

/// The same, to be changed.
pub fn rays_mut<const N: usize>(packet: &mut Packet<N>) -> [&mut [f32; N]; 6] {
    let Packet {
        ox,
        oy,
        oz,
        dx,
        dy,
        dz,
        ..
    } = packet;
    [ox, oy, oz, dx, dy, dz]
}

/// Ray `ray` of a packet, by itself.
///
/// # Panics
///
/// `ray` is not less than `N`.
pub fn one_ray<const N: usize>(packet: &Packet<N>, ray: usize) -> Packet<1> {
    let [ox, oy, oz, dx, dy, dz] = rays(packet).map(|component| [component[ray]]);
    Packet {
        ox,
        oy,
        oz,
        dx,
        dy,
        dz,
        t: [packet.t[ray]],
        hit_t: [packet.hit_t[ray]],
        t_min: [packet.t_min[ray]],
    }
}

#[cfg(test)]
mod tests {
    use super::drive;
    use crate::{Generator, INITIAL_T, Regime};

    #[test]
    fn every_regime_tests_each_ray_against_each_triangle_once() {
        let workload = Generator {
            triangles: 20,
            packets: 3,
            ..Generator::default()
        }
        .generate();
        let part = workload.part(1..3);
        for (regime, lists) in [
            (Regime::Shrinking, vec![20]),
            (Regime::Fixed, vec![20]),
            (Regime::Leaf, vec![8, 8, 4]),
        ] {
            let mut scratch = part.packets.to_vec();
            let mut seen = Vec::new();
            drive(
                part.packets,
                part.lists(regime),
                &mut scratch,
                |packet, triangles| {
                    assert_eq!(
                        packet.t, [INITIAL_T; 64],
                        "{regime}: t is reset before a list"
                    );
                    packet.t = [1.0; 64];
                    seen.push((packet.ox[0], triangles.len(), triangles[0].p0));
                },
            );
            let tests: usize = seen.iter().map(|&(_, triangles, _)| 64 * triangles).sum();
            assert_eq!(tests as u64, part.tests());

            let mut expected = Vec::new();
            for packet in part.packets {
                let mut first = 0;
                for &list in &lists {
                    expected.push((packet.ox[0], list, part.triangles[first].p0));
                    first += list;
                }
            }
            assert_eq!(seen, expected, "{regime}");
        }
    }

    #[test]
    fn repeated_runs_start_alike() {
        let workload = Generator {
            triangles: 8,
            packets: 1,
            ..Generator::default()
        }
        .generate();
        let mut scratch = workload.packets.clone();
        for _ in 0..2 {
            drive(
                &workload.packets,
                workload.whole().lists(Regime::Fixed),
                &mut scratch,
                |packet, _| {
                    assert_eq!(packet.hit_t, workload.packets[0].hit_t);
                    packet.hit_t = [0.5; 64];
                },
            );
        }
    }

    #[test]
    fn an_empty_list_of_triangles_is_no_call() {
        let workload = Generator {
            triangles: 0,
            packets: 1,
            ..Generator::default()
        }
        .generate();
        for &regime in Regime::ALL {
            drive(
                &workload.packets,
                workload.whole().lists(regime),
                &mut workload.packets.clone(),
                |_, _| panic!(),
            );
        }
    }
}
