//! What tests of graphs share: ways to a node, random programs, and inputs for them.

#![allow(dead_code, reason = "each test file takes what it needs")]

use std::collections::{BTreeSet, VecDeque};

use program::{CheckedIn, Genome, Graph, NodeId, Program, Ray, Triangle};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Every graph, with its name.
pub fn graphs() -> Vec<(&'static str, Graph)> {
    let graphs = CheckedIn::ALL.map(|one| (one.name(), one.graph()));
    graphs.to_vec()
}

/// Calls `check` with programs of random genomes.
pub fn for_random_programs(graph: &Graph, genomes: usize, mut check: impl FnMut(&Program)) {
    let mut rng = ChaCha8Rng::seed_from_u64(2006);
    for _ in 0..genomes {
        let genome = Genome::random(graph.nodes().len(), &mut rng);
        check(&graph.program(&genome).unwrap());
    }
}

/// All nodes that the goal leads to.
pub fn reachable(graph: &Graph) -> BTreeSet<NodeId> {
    let mut reached = BTreeSet::from([graph.goal()]);
    let mut frontier = vec![graph.goal()];
    while let Some(id) = frontier.pop() {
        let node = graph.node(id);
        for &next in node.required.iter().chain(&node.optional) {
            if reached.insert(next) {
                frontier.push(next);
            }
        }
    }
    reached
}

/// Random genomes that prefer every node on a path from the goal to `target`.
pub fn genomes_towards(graph: &Graph, target: NodeId) -> impl Iterator<Item = Genome> {
    let path = path_to(graph, target);
    let nodes = graph.nodes().len();
    let mut rng = ChaCha8Rng::seed_from_u64(target.index() as u64);
    (0..200).map(move |_| Genome::random(nodes, &mut rng).preferring(&path))
}

/// A shortest path from the goal to `target`, target first.
fn path_to(graph: &Graph, target: NodeId) -> Vec<NodeId> {
    let mut from = vec![None; graph.nodes().len()];
    let mut queue = VecDeque::from([graph.goal()]);
    while let Some(id) = queue.pop_front() {
        let node = graph.node(id);
        for &next in node.required.iter().chain(&node.optional) {
            if from[next.index()].is_none() && next != graph.goal() {
                from[next.index()] = Some(id);
                queue.push_back(next);
            }
        }
    }
    let mut path = vec![target];
    while let Some(previous) = from[path[path.len() - 1].index()] {
        path.push(previous);
    }
    path
}

/// Random rays and triangles of about unit size, exact in `f32`. Rays end at `t = 1`, as segments do, most
/// of them far behind the triangle.
pub fn random_pair(rng: &mut ChaCha8Rng) -> (Ray<f64>, Triangle<f64>) {
    let mut point = |size: f32| [0; 3].map(|_| f64::from(rng.random_range(-size..size)));
    let a = point(3.0);
    let target = point(0.6);
    let d = [0, 1, 2].map(|axis| f64::from(4.0 * (target[axis] - a[axis]) as f32));
    let triangle = Triangle {
        p0: point(1.0),
        p1: point(1.0),
        p2: point(1.0),
    };
    (Ray { a, d, t_max: 1.0 }, triangle)
}

pub fn narrow_ray(ray: &Ray<f64>) -> Ray<f32> {
    let narrow = |v: [f64; 3]| v.map(|x| x as f32);
    Ray {
        a: narrow(ray.a),
        d: narrow(ray.d),
        t_max: ray.t_max as f32,
    }
}

pub fn narrow_triangle(triangle: &Triangle<f64>) -> Triangle<f32> {
    let narrow = |v: [f64; 3]| v.map(|x| x as f32);
    Triangle {
        p0: narrow(triangle.p0),
        p1: narrow(triangle.p1),
        p2: narrow(triangle.p2),
    }
}

/// A ray that hits a triangle squarely, with no zero in sight.
pub fn a_hit() -> (Ray<f32>, Triangle<f32>) {
    let ray = Ray {
        a: [0.25, 0.3, 3.0],
        d: [0.04, -0.08, -4.0],
        t_max: 1.0,
    };
    let triangle = Triangle {
        p0: [-1.0, -1.5, 0.0],
        p1: [2.0, -1.0, 0.0],
        p2: [-0.5, 2.0, 0.0],
    };
    (ray, triangle)
}

/// Möller-Trumbore in `f64`: the hit's `t` or a miss, or `None` where the ray passes too near an
/// edge, or too nearly in the triangle's plane, for a verdict in `f32`.
pub fn reference(ray: &Ray<f64>, triangle: &Triangle<f64>) -> Option<Option<f64>> {
    let sub = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = |a: [f64; 3], b: [f64; 3]| {
        let component = |j: usize, k: usize| a[j] * b[k] - a[k] * b[j];
        [component(1, 2), component(2, 0), component(0, 1)]
    };
    let e1 = sub(triangle.p1, triangle.p0);
    let e2 = sub(triangle.p2, triangle.p0);
    let p = cross(ray.d, e2);
    let v = dot(e1, p);
    let from_p0 = sub(ray.a, triangle.p0);
    let q = cross(from_p0, e1);
    let (beta, gamma, t) = (dot(from_p0, p) / v, dot(ray.d, q) / v, dot(e2, q) / v);
    let inside = beta.min(gamma).min(1.0 - beta - gamma);
    let margin = 1e-4 / v.abs().min(1.0);
    let to_ends = t.abs().min((ray.t_max - t).abs());
    if v.abs() < 0.01 || inside.abs() < margin || to_ends < margin {
        return None;
    }
    Some((inside > 0.0 && 0.0 < t && t < ray.t_max).then_some(t))
}

/// Checks that `program` finds what Möller-Trumbore finds in `f64`, on `samples` random pairs
/// where that has a verdict, and gives the number of hits.
pub fn agrees_away_from_edges(program: &Program, samples: usize, rng: &mut ChaCha8Rng) -> usize {
    let mut hits = 0;
    for _ in 0..samples {
        let (ray, triangle) = random_pair(rng);
        let Some(expected) = reference(&ray, &triangle) else {
            continue;
        };
        let single = program.run(&narrow_ray(&ray), &narrow_triangle(&triangle));
        let double = program.run(&ray, &triangle);
        let Some(t) = expected else {
            assert!(single.is_none() && double.is_none(), "{program:?}");
            continue;
        };
        let close = |found: Option<f64>, tolerance: f64| {
            found.is_some_and(|found| (found - t).abs() <= tolerance * t)
        };
        assert!(
            close(single.map(f64::from), 2e-3),
            "{single:?} {t} {program:?}"
        );
        assert!(close(double, 1e-9), "{double:?} {t} {program:?}");
        hits += 1;
    }
    hits
}
