//! The catalogue: figures that can be, of kernels that are there.

use std::collections::HashSet;
use std::path::Path;

use raybreed::{Entry, Watertight, catalogue};

use crate::kernels::{RAYS, Rays, available, families, kernels};

#[test]
fn every_kernel_is_listed_once() {
    let names: HashSet<_> = catalogue()
        .iter()
        .map(|entry| (entry.name, entry.isa))
        .collect();
    assert_eq!(names.len(), catalogue().len());
    assert!(!names.is_empty());
}

#[test]
fn figures_are_ones_that_can_be() {
    for entry in catalogue() {
        let Entry {
            name,
            isa,
            t_error,
            stability,
            ..
        } = entry;
        let what = format!("{name} on {isa}");
        assert!(entry.ratio.is_finite() && entry.ratio > 0.0, "{what}");
        assert!(
            entry.operations.is_finite() && entry.operations > 0.0,
            "{what}"
        );
        assert!(
            [36, 48].contains(&entry.bytes),
            "{what}: vertices, with a normal or without"
        );
        assert!(
            0.0 < t_error.median && t_error.median < t_error.p99,
            "{what}: {t_error:?}"
        );
        assert!(
            t_error.p99 <= 4e-6 && t_error.p99 < t_error.max,
            "{what}: {t_error:?}"
        );
        assert!(t_error.hits > 10_000, "{what}: {t_error:?}");
        let Some(stability) = stability else { continue };
        for share in [stability.edge_leak, stability.vertex_leak, stability.double] {
            assert!(
                share.events <= share.samples && share.samples > 10_000,
                "{what}: {share:?}"
            );
        }
        assert!(
            stability.t_p9999 >= t_error.median && stability.t_p9999 < 1e-3,
            "{what}"
        );
        assert!(
            stability
                .uv_p9999
                .is_none_or(|error| 0.0 < error && error < 1e-3),
            "{what}"
        );
        let (least, most) = stability.scale;
        assert!(least < -15 && 15 < most, "{what}: {:?}", stability.scale);
    }
}

#[test]
fn what_statements_promise_was_measured() {
    for entry in catalogue() {
        let what = format!("{} on {}", entry.name, entry.isa);
        for (least, most) in [
            entry.tags.scales.everything,
            entry.tags.scales.positions,
            entry.tags.scales.directions,
        ] {
            assert!(least < -15 && 15 < most, "{what}: {:?}", entry.tags.scales);
        }
        if let Some(stability) = entry.stability {
            if entry.tags.watertight >= Watertight::Edges {
                assert_eq!(stability.edge_leak.events, 0, "{what}");
            }
            if entry.tags.watertight >= Watertight::Full {
                assert_eq!(stability.vertex_leak.events, 0, "{what}");
            }
        }
    }
}

#[test]
fn recipes_are_in_the_package() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    for entry in catalogue() {
        assert!(package.join(entry.recipe).is_file(), "{}", entry.recipe);
    }
}

#[test]
fn every_requirement_has_a_kernel_on_every_instruction_set() {
    assert_eq!(families().len(), 2 * 3 * 2 * 3);
    assert_eq!(kernels().len(), families().len() * available().len());
    for kernel in kernels() {
        let rays = Rays::new();
        let answer = kernel.closest_hits(&rays, &[]);
        assert_eq!(answer.rays.t, [0.0; RAYS], "{kernel}");
        kernel.closest(&rays, &[]);
        kernel.any(&rays, &[]);
    }
}
