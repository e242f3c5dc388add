//! The C library's `drand48`, which the paper's benchmark draws its scene from.

/// The 48-bit linear congruential generator of `drand48`:
/// `X' = (0x5DEECE66D * X + 0xB) mod 2^48`, and a draw is `X' / 2^48`.
#[derive(Clone, Debug)]
pub struct Drand48 {
    state: u64,
}

impl Drand48 {
    const MULTIPLIER: u64 = 0x5_DEEC_E66D;
    const INCREMENT: u64 = 0xB;
    const MASK: u64 = (1 << 48) - 1;

    /// Starts where `seed48` does with the three words that Kensler-Shirley's appendix cuts out
    /// of its seed: bits 0..16, 8..24 and 16..32, the least significant word first.
    pub fn new(seed: u32) -> Self {
        let word = |shift: u32| u64::from(seed >> shift) & 0xffff;
        Self {
            state: word(16) << 32 | word(8) << 16 | word(0),
        }
    }

    /// The next number, uniform in `[0, 1)`.
    pub fn draw(&mut self) -> f64 {
        self.state = self
            .state
            .wrapping_mul(Self::MULTIPLIER)
            .wrapping_add(Self::INCREMENT)
            & Self::MASK;
        // 48 bits fit an f64 exactly.
        self.state as f64 / (Self::MASK + 1) as f64
    }

    /// The appendix's `drand48() - drand48()`: triangular in `(-1, 1)`.
    ///
    /// C leaves the order of the two draws open; here the left one comes first.
    pub fn difference(&mut self) -> f64 {
        let minuend = self.draw();
        minuend - self.draw()
    }
}

#[cfg(test)]
mod tests {
    use super::Drand48;

    /// States after each of the first four draws of glibc 2.x's `seed48` and `drand48`.
    #[test]
    fn draws_what_the_c_library_draws() {
        let cases: [(u32, [u64; 4]); 3] = [
            (
                0,
                [
                    0x0000_0000_000b,
                    0x0040_942d_e6ba,
                    0x0aa8_544e_593d,
                    0x2d38_73c4_cd04,
                ],
            ),
            (
                1,
                [
                    0x0005_deec_e678,
                    0xbb61_488d_f123,
                    0xdf41_1159_1df2,
                    0x6023_eaf1_2c15,
                ],
            ),
            (
                0xfedc_ba98,
                [
                    0x0145_9346_02c3,
                    0x95af_410e_5f12,
                    0x7b1c_dd20_a6b5,
                    0xc629_2189_991c,
                ],
            ),
        ];
        for (seed, states) in cases {
            let mut random = Drand48::new(seed);
            for state in states {
                assert_eq!(random.draw(), state as f64 / 2f64.powi(48), "seed {seed}");
            }
        }
    }

    #[test]
    fn continues_as_srand48_does_from_its_state() {
        let mut random = Drand48 {
            state: 1 << 16 | 0x330e,
        };
        assert_eq!(random.draw(), 0.041630344771878214);
        assert_eq!(random.draw(), 0.45449244472862915);
    }

    #[test]
    fn subtracts_the_second_draw_from_the_first() {
        let mut random = Drand48::new(5);
        let (first, second) = (random.draw(), random.draw());
        assert_eq!(Drand48::new(5).difference(), first - second);
    }
}
