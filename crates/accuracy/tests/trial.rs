//! A trial says of kernels what the lab says of them at length.

mod kernels;

use accuracy::{PairCase, Scalar, Trial, Tried, profiles};
use kernels::{kensler_shirley, moller_trumbore, three_volumes, woop};
use scene::{Ray, Triangle};

const RAYS: u64 = 4_000;

type Kernel = fn(&Ray, &Triangle) -> Option<f32>;

fn tried(seed: u64, kernel: Kernel) -> Tried {
    Trial::new(RAYS, seed).of(&mut Scalar(kernel))
}

#[test]
fn leaking_kernels_leak_and_watertight_ones_do_not() {
    for seed in [1, 7] {
        for (kernel, least, most) in [
            (moller_trumbore as Kernel, 0.03, 0.2),
            (kensler_shirley, 0.03, 0.2),
            // At vertices alone.
            (three_volumes, 1e-5, 0.01),
            (woop, 0.0, 0.0),
        ] {
            let leak = tried(seed, kernel).leak;
            assert!(leak.samples > 10_000, "{leak:?}");
            assert!((least..=most).contains(&leak.share()), "{leak:?}");
        }
    }
}

#[test]
fn the_error_is_that_of_as_many_rays_of_the_lab() {
    for kernel in [moller_trumbore as Kernel, kensler_shirley, woop] {
        let lab = profiles(|| Scalar(kernel), &[PairCase::Ordinary], 4 * RAYS, 1);
        let errors = lab[0].profile.relative_error.unwrap();
        // Ties, which the lab counts as well, are few.
        let found = tried(1, kernel).t_p9999 / errors.p9999;
        assert!((0.9..1.1).contains(&found), "{found} of {errors:?}");
    }
}

#[test]
fn of_several_the_worse_counts() {
    let [one, other] = [tried(1, moller_trumbore), tried(1, woop)];
    let worse = one.or_worse(other);
    assert_eq!(worse, other.or_worse(one));
    assert_eq!(worse.leak, one.leak);
    assert_eq!(worse.t_p9999, one.t_p9999.max(other.t_p9999));
}
