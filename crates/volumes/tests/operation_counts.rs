//! The operation counts of the paper's section 4, and the formulations it prints.

use std::num::NonZeroU16;

use volumes::{Case, Cost, Count, Formulation, Model, Stored, Volume, cheapest, read_ports};

const RAYS: NonZeroU16 = NonZeroU16::new(64).unwrap();

/// The three cases, each with `V` and with `V0`: what they are, cost, and number of formulations.
const ROWS: [(Case, [Volume; 4], &str, usize); 6] = [
    (Case::SINGLE, Formulation::WITH_V, "47", 6),
    (Case::SINGLE, Formulation::WITH_V0, "47", 6),
    (Case::packet(RAYS), Formulation::WITH_V, "32 + 15/64", 2),
    (Case::packet(RAYS), Formulation::WITH_V0, "44 + 6/64", 48),
    (
        Case::common_origin(RAYS),
        Formulation::WITH_V,
        "15 + 41/64",
        12,
    ),
    (
        Case::common_origin(RAYS),
        Formulation::WITH_V0,
        "15 + 41/64",
        12,
    ),
];

/// Asserts that a formulation, as text, is among the cheapest ones.
fn assert_cheapest(case: Case, expected: [&str; 4]) {
    let formulations = cheapest(case, &Model::paper(), Formulation::WITH_V).formulations;
    let found = formulations
        .iter()
        .any(|formulation| formulation.to_string() == expected.join("\n"));
    assert!(found, "{expected:#?} is not among {formulations:#?}");
}

#[test]
fn cheapest_formulations_cost_and_number_what_the_paper_says() {
    for (case, volumes, cost, number) in ROWS {
        let count = cheapest(case, &Model::paper(), volumes);
        assert_eq!(count.cost.to_string(), cost, "{case:?} {volumes:?}");
        assert_eq!(count.formulations.len(), number, "{case:?} {volumes:?}");
    }
}

#[test]
fn every_combination_is_counted() {
    let count = cheapest(Case::SINGLE, &Model::paper(), Formulation::WITH_V);
    assert_eq!(count.combinations, 36 * 384 * 36 * 36);
    assert_eq!(count.combinations, 17_915_904);
}

#[test]
fn found_formulations_cost_what_the_search_says_and_are_in_ascending_order() {
    for (case, volumes, ..) in ROWS {
        let Count {
            cost, formulations, ..
        } = cheapest(case, &Model::paper(), volumes);
        assert!(
            formulations
                .iter()
                .all(|formulation| formulation.cost(case, &Model::paper()) == cost)
        );
        assert!(formulations.is_sorted_by(|a, b| a < b));
    }
}

#[test]
fn found_formulations_have_a_way_for_each_of_their_volumes() {
    for (case, volumes, ..) in ROWS {
        for formulation in cheapest(case, &Model::paper(), volumes).formulations {
            assert_eq!(formulation.products.map(|(volume, _)| volume), volumes);
            for (volume, product) in formulation.products {
                assert!(
                    volume.triple_products().contains(&product),
                    "{volume} = {product}"
                );
                assert_eq!(formulation.product(volume), Some(product));
            }
        }
    }
}

// The formulations that section 4 prints have the signs of its equations 2 in every volume, so they
// are found as printed: no cross needs swapping.

#[test]
fn equations_2_are_cheapest_for_single_rays() {
    assert_cheapest(
        Case::SINGLE,
        [
            "V  = (d × (p2-p0)) · (p1-p0)",
            "Va = ((a-p0) × (p1-p0)) · (p2-p0)",
            "V1 = (d × (p2-p0)) · (a-p0)",
            "V2 = ((a-p0) × (p1-p0)) · d",
        ],
    );
}

#[test]
fn the_printed_packet_formulation_is_cheapest_for_packets() {
    assert_cheapest(
        Case::packet(RAYS),
        [
            "V  = ((p1-p0) × (p0-p2)) · d",
            "Va = ((p1-p0) × (p0-p2)) · (p0-a)",
            "V1 = ((p0-a) × d) · (p0-p2)",
            "V2 = ((p0-a) × d) · (p1-p0)",
        ],
    );
}

#[test]
fn the_printed_common_origin_formulation_is_cheapest_for_common_origins() {
    assert_cheapest(
        Case::common_origin(RAYS),
        [
            "V  = ((p1-p0) × (p0-p2)) · d",
            "Va = ((p1-p0) × (p0-p2)) · (p0-a)",
            "V1 = ((p0-p2) × (p0-a)) · d",
            "V2 = ((p1-p0) × (p0-a)) · d",
        ],
    );
}

#[test]
fn a_cost_is_shown_exactly() {
    let cost = |units| Cost { units, parts: 64 };
    assert_eq!(cost(32 * 64 + 15).to_string(), "32 + 15/64");
    assert_eq!(cost(47 * 64).to_string(), "47");
    assert_eq!(cost(15).to_string(), "15/64");
    assert_eq!(cost(32 * 64 + 16).operations(), 32.25);
}

#[test]
fn a_packet_of_one_ray_is_a_single_ray() {
    assert_eq!(Case::packet(NonZeroU16::MIN), Case::SINGLE);
}

#[test]
fn the_largest_packet_does_not_overflow_a_cost() {
    let case = Case::packet(NonZeroU16::MAX);
    assert_eq!(
        cheapest(case, &Model::paper(), Formulation::WITH_V)
            .cost
            .to_string(),
        "32 + 15/65535"
    );
}

/// The cost of the cheapest formulation with `V`, and how many there are.
fn count(case: Case, model: &Model) -> (String, usize) {
    let count = cheapest(case, model, Formulation::WITH_V);
    (count.cost.to_string(), count.formulations.len())
}

#[test]
fn fused_multiplications_and_additions_count_as_one() {
    // Of the 47: two crosses of 9 are 6 each, four dots of 5 are 3 each.
    assert_eq!(count(Case::SINGLE, &Model::fma()), ("33".into(), 6));
    // Of the 32: one cross, four dots.
    let packet = count(Case::packet(RAYS), &Model::fma());
    assert_eq!(packet, ("21 + 12/64".into(), 2));
}

#[test]
fn one_port_for_everything_is_the_papers_model() {
    let ports = Model::ports(read_ports("mul+add=1").unwrap());
    for (case, volumes, ..) in ROWS {
        assert_eq!(
            cheapest(case, &ports, volumes),
            cheapest(case, &Model::paper(), volumes)
        );
    }
}

#[test]
fn the_busier_port_is_the_cost() {
    // 24 multiplications and 23 additions, two each a cycle.
    let ports = Model::ports(read_ports("mul=2,add=2").unwrap());
    assert_eq!(count(Case::SINGLE, &ports).0, "12");
    let ports = Model::ports(read_ports("mul=1,add=2").unwrap());
    assert_eq!(count(Case::SINGLE, &ports).0, "24");
}

#[test]
fn a_ray_that_meets_triangles_shares_little() {
    // Only what has neither vertices nor edges could be shared, and there is nothing of that.
    let case = Case::triangles(NonZeroU16::new(4).unwrap());
    assert_eq!(count(case, &Model::paper()), ("47".into(), 6));
}

#[test]
fn a_stored_triangle_has_a_vertex_two_edges_and_their_normal() {
    let case = Case {
        stored: true,
        ..Case::SINGLE
    };
    let count = cheapest(case, &Model::paper(), Formulation::WITH_V);
    assert_eq!(count.cost.to_string(), "32");
    assert_eq!(count.bytes, Some(48));
    for formulation in count.formulations {
        assert_eq!(formulation.bytes(case), 48, "{formulation}");
        let stored = formulation.stored(case);
        let is_vertex = |one: &&Stored| matches!(one, Stored::Vertex(_));
        assert_eq!(stored.iter().filter(is_vertex).count(), 1);
    }
}

#[test]
fn ports_are_read_or_refused_with_a_sentence() {
    for table in [
        "", "mul", "mul=0", "mul=99", "mull=1", "mul=1,", "mul=1/0", "mul=-1",
    ] {
        let error = read_ports(table).unwrap_err().to_string();
        assert!(!error.contains('\n') && error.len() < 200, "{error}");
    }
    assert!(read_ports(&["mul=1"; 9].join(",")).is_err());
    let port = read_ports("div+test=1/5").unwrap()[0];
    assert_eq!(port.throughput, (1, 5));
    assert_eq!(port.takes, [false, false, false, true, true]);
}
