//! What a kernel leaves in a packet.

use scene::{PACKET_SIZE, RayPacket, Regime, rays};

/// What a kernel left in the two arrays of a packet that it may write to, bit by bit.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct Left {
    t: [u32; PACKET_SIZE],
    hit_t: [u32; PACKET_SIZE],
}

impl Left {
    /// What is in `packet`.
    pub fn of(packet: &RayPacket) -> Left {
        Left {
            t: packet.t.map(f32::to_bits),
            hit_t: packet.hit_t.map(f32::to_bits),
        }
    }

    /// The packet that holds this, of which `before` is what the kernel was given.
    pub fn in_packet(&self, before: &RayPacket) -> RayPacket {
        RayPacket {
            t: self.t.map(f32::from_bits),
            hit_t: self.hit_t.map(f32::from_bits),
            ..before.clone()
        }
    }

    /// The rays whose answers, of a kernel for `regime`, differ from the other's by more than
    /// `share` of them, or of which what must be left alone differs at all.
    pub fn rays_unlike(&self, other: &Left, regime: Regime, share: f32) -> Vec<usize> {
        let (answers, kept) = self.split(regime);
        let (other_answers, other_kept) = other.split(regime);
        let near = |a: u32, b: u32| {
            let (a_t, b_t) = (f32::from_bits(a), f32::from_bits(b));
            a == b || (a_t - b_t).abs() <= share * a_t.abs().min(b_t.abs())
        };
        let like =
            |ray: usize| kept[ray] == other_kept[ray] && near(answers[ray], other_answers[ray]);
        (0..PACKET_SIZE).filter(|&ray| !like(ray)).collect()
    }

    /// The answers, and the array that has none.
    fn split(&self, regime: Regime) -> (&[u32; PACKET_SIZE], &[u32; PACKET_SIZE]) {
        match regime {
            Regime::Shrinking | Regime::Leaf => (&self.t, &self.hit_t),
            Regime::Fixed => (&self.hit_t, &self.t),
        }
    }
}

/// Whether the rays of a packet are still what they were `before`, bit by bit.
pub(crate) fn keeps_rays(packet: &RayPacket, before: &RayPacket) -> bool {
    let bits = |packet| rays(packet).map(|component| component.map(f32::to_bits));
    bits(packet) == bits(before)
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::Generator;

    fn packet() -> RayPacket {
        let generator = Generator {
            triangles: 1,
            packets: 1,
            ..Generator::default()
        };
        generator.generate().packets.remove(0)
    }

    #[test]
    fn near_is_relative_for_answers_and_bitwise_for_what_is_kept() {
        let before = packet();
        let mut after = before.clone();
        after.t[3] *= 1.00001;
        let [before, after] = [before, after].map(|packet| Left::of(&packet));
        let unlike = |regime, share| after.rays_unlike(&before, regime, share);
        assert!(unlike(Regime::Shrinking, 1e-4).is_empty());
        assert_eq!(unlike(Regime::Shrinking, 1e-6), [3]);
        assert_eq!(unlike(Regime::Fixed, 1e-4), [3]);
    }

    #[test]
    fn no_hit_is_near_no_hit_and_nothing_else() {
        let before = packet();
        let mut after = before.clone();
        after.hit_t[9] = 1.0;
        let [none, one] = [&before, &after].map(Left::of);
        let unlike = |a: &Left, b: &Left| a.rays_unlike(b, Regime::Fixed, 1e-4);
        assert!(unlike(&none, &none).is_empty());
        assert_eq!(unlike(&one, &none), [9]);
        assert_eq!(unlike(&none, &one), [9]);
        after.hit_t[9] = f32::NAN;
        assert_eq!(unlike(&Left::of(&after), &one), [9]);
    }

    #[test]
    fn a_changed_ray_is_seen_and_an_answer_is_none() {
        let before = packet();
        let mut after = before.clone();
        after.t[0] = 1.0;
        assert!(keeps_rays(&after, &before));
        after.dz[63] = -after.dz[63];
        assert!(!keeps_rays(&after, &before));
    }
}
